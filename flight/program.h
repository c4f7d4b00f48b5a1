/* One quadratic program of the guidance law, scaled, as smallsat.optimal_control.riccati_interior_point
 * has it; the build says for how many stages there is room. */
#ifndef PROGRAM_H
#define PROGRAM_H

#ifndef STAGES
#error "say for how many stages there is room: -DSTAGES=30"
#endif
enum { STATES = 6, CONTROLS = 3, PLANES = 5, BOUNDS = 6 };

struct program {
    int stages; /* at most STAGES */
    double transition[STATES][STATES];
    double state_hessian[STATES]; /* its diagonal */
    double terminal_hessian[STATES][STATES];
    double state_gradient[STAGES + 1][STATES];
    double control_hessian[CONTROLS]; /* its diagonal */
    /* Rows on the position, as many a stage as plane_count says: normal x <= offset. */
    int plane_count[STAGES + 1];
    double normals[STAGES + 1][PLANES][3];
    double offsets[STAGES + 1][PLANES];
    double plane_weights[STAGES + 1][PLANES];
    /* Rows on one component of the state, at every stage: sign x[component] <= bound. */
    int bound_count;
    int components[BOUNDS];
    double signs[BOUNDS];
    double bounds[STAGES + 1][BOUNDS];
    double bound_weights[STAGES + 1][BOUNDS];
};

enum status { SOLVED, ITERATION_LIMIT, NUMERICAL };

struct solution {
    enum status status;
    int iterations;
    double controls[STAGES][CONTROLS]; /* scaled, in [-1, 1] */
};

/* What each of the solvers offers: once, with a program like those to come, and then for each of them.
 * `start` is the state, scaled, that the program starts from. No memory is asked for after `prepare`. */
void prepare(const struct program *program, const double start[STATES]);
void solve(const struct program *program, const double start[STATES], struct solution *found);

#endif
