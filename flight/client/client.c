/* The flight program as a client of the simulation (Figure 6.1): for each relative state that comes over
 * a socket it sends the change of velocity that the guidance law commands.
 *
 *   client PORT LAW
 *
 * LAW is a file with a `struct law`. Both sides are little-endian and send whole records of doubles.
 * A phase of DOCKED in an order says that the last phase has ended. */
#include <arpa/inet.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "guidance.h"

enum { DOCKED = DOCKING + 1 };

struct report {
    double time, state[STATES];
};

struct order {
    double phase, status, command[CONTROLS]; /* m/s */
};

static struct law law;
static struct program program;
static struct solution solution;

/* The solved plan whose next control is taken where a program is not solved; a phase begins with none. */
static double plan[STAGES][CONTROLS];
static int left, stages;

static void command(enum phase phase, const struct report *report, struct order *order)
{
    double start[STATES];
    write_program(&law, phase, report->state, report->time, &program, start);
    solve(&program, start, &solution);
    if (solution.status == SOLVED) {
        left = stages = program.stages;
        for (int i = 0; i < stages; i++)
            for (int k = 0; k < CONTROLS; k++)
                plan[i][k] = law.control_bounds[phase] * solution.controls[i][k];
    }
    for (int k = 0; k < CONTROLS; k++)
        order->command[k] = left > 0 ? plan[stages - left][k] : 0.0;
    left -= left > 0;
    order->status = solution.status;
}

static bool receive(int socket, void *record, size_t bytes)
{
    return recv(socket, record, bytes, MSG_WAITALL) == (ssize_t)bytes;
}

static int fail(const char *what, int steps)
{
    fprintf(stderr, "flight program: %s after %d steps\n", what, steps);
    return 1;
}

int main(int argc, char **argv)
{
    FILE *laws = argc == 3 ? fopen(argv[2], "rb") : NULL;
    if (!laws || fread(&law, sizeof law, 1, laws) != 1)
        return fail("no law to read", 0);
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)atoi(argv[1]))};
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    int server = socket(AF_INET, SOCK_STREAM, 0);
    if (connect(server, (struct sockaddr *)&address, sizeof address))
        return fail("no simulation to connect to", 0);

    struct report report;
    struct order order = {.phase = RENDEZVOUS};
    for (int steps = 0;; steps++) {
        if (!receive(server, &report, sizeof report))
            return fail("connection lost", steps);
        if (steps > 0 && phase_ended(&law, (enum phase)order.phase, report.state, report.time)) {
            order.phase++;
            left = 0;
        }
        if (order.phase < DOCKED)
            command((enum phase)order.phase, &report, &order);
        if (send(server, &order, sizeof order, MSG_NOSIGNAL) != sizeof order)
            return fail("connection lost", steps);
        if (order.phase == DOCKED)
            return close(server);
    }
}
