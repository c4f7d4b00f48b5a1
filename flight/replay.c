/* Replay: write and solve the program of each recorded step, on the emulated board. By semihosting it
 * reads law.bin, a `struct law`, and steps.bin, a `struct step` each, and writes a `struct answer` each
 * to answers.bin. The instructions between the two marks are what the counting plugin counts. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "guidance.h"

#ifdef __arm__
#define MARK_BEGIN() __asm__ volatile("mov r10, r10" ::: "memory")
#define MARK_END() __asm__ volatile("mov r11, r11" ::: "memory")
#else
#define MARK_BEGIN()
#define MARK_END()
#endif
enum { PAINTED = 1 << 14, PAINT = 0x5a }; /* bytes of stack below a solve, and what is on them */

struct step {
    double phase, time, state[STATES];
};

struct answer {
    double status, iterations, stack, heap; /* bytes: of stack in this solve, of heap so far */
    double controls[STAGES][CONTROLS]; /* scaled */
};

static struct law law;
static struct program program;
static struct solution solution;
static double start[STATES];

/* The linker puts these in the place of the allocator's, so that what a solver asks for is known. */
void *__real_malloc(size_t bytes);
void *__wrap_malloc(size_t bytes);
void *__wrap_calloc(size_t count, size_t bytes);
static double heap;

void *__wrap_malloc(size_t bytes)
{
    heap += (double)bytes;
    return __real_malloc(bytes);
}

void *__wrap_calloc(size_t count, size_t bytes)
{
    void *found = __wrap_malloc(count * bytes);
    return found ? memset(found, 0, count * bytes) : found;
}

/* Solve, and return how many bytes of stack that took. */
static __attribute__((noinline)) double measured(void)
{
    volatile uint8_t *top = __builtin_frame_address(0), *low = top - PAINTED;
    for (volatile uint8_t *at = low; at < top - 64; at++)
        *at = PAINT;
    MARK_BEGIN();
    solve(&program, start, &solution);
    MARK_END();
    while (low < top && *low == PAINT)
        low++;
    return (double)(top - low);
}

int main(void)
{
    FILE *laws = fopen("law.bin", "rb"), *steps = fopen("steps.bin", "rb");
    FILE *answers = fopen("answers.bin", "wb");
    struct step step;
    if (!laws || !steps || !answers || fread(&law, sizeof law, 1, laws) != 1)
        return 1;
    for (bool prepared = false; fread(&step, sizeof step, 1, steps) == 1; prepared = true) {
        struct answer answer;
        write_program(&law, (enum phase)step.phase, step.state, step.time, &program, start);
        if (!prepared)
            prepare(&program, start);
        answer.stack = measured();
        answer.heap = heap;
        answer.status = solution.status;
        answer.iterations = solution.iterations;
        for (int i = 0; i < STAGES; i++)
            for (int k = 0; k < CONTROLS; k++)
                answer.controls[i][k] = solution.controls[i][k];
        if (fwrite(&answer, sizeof answer, 1, answers) != 1)
            return 1;
    }
    return fclose(answers) != 0;
}
