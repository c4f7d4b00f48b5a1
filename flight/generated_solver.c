/* The solver that CVXPYgen writes from describe.py, behind the interface of program.h. Its memory is
 * all asked for by the first solve, which `prepare` makes. */
#include "cpg_solve.h"
#include "program.h"

#define MOST_ITERATIONS 100
/* As fine as it reaches in all programs; its default, 1e-7, leaves flat optima open. */
#define TOLERANCE 1e-9

typedef void (*update)(cpg_int index, cpg_float value);
static const update NORMALS[] = {
    cpg_update_normal0, cpg_update_normal1, cpg_update_normal2, cpg_update_normal3,
#if ROWS_A_STAGE == 5
    cpg_update_normal4,
#endif
};
static const update OFFSETS[] = {
    cpg_update_offset0, cpg_update_offset1, cpg_update_offset2, cpg_update_offset3,
#if ROWS_A_STAGE == 5
    cpg_update_offset4,
#endif
};

/* Parameters and variables with an entry for each stage are stored column by column. */
void solve(const struct program *p, const double start[STATES], struct solution *found)
{
    for (int k = 0; k < STATES; k++)
        cpg_update_start(k, start[k]);
    for (int i = 1; i <= STAGES; i++)
        for (int k = 0; k < STATES; k++)
            cpg_update_gradient(i - 1 + STAGES * k, p->state_gradient[i][k]);
    for (int row = 0; row < ROWS_A_STAGE; row++) {
        int first = p->plane_count[1] > row ? 1 : STAGES, count = STAGES - first + 1;
        for (int i = first; i <= STAGES; i++) {
            OFFSETS[row](i - first, p->offsets[i][row]);
            for (int k = 0; k < 3; k++)
                NORMALS[row](i - first + count * k, p->normals[i][row][k]);
        }
    }
    cpg_solve();
    found->iterations = CPG_Info.iter;
    found->status = CPG_Info.status == QOCO_SOLVED     ? SOLVED
                    : CPG_Info.status == QOCO_MAX_ITER ? ITERATION_LIMIT
                                                       : NUMERICAL;
    for (int i = 0; i < STAGES; i++)
        for (int k = 0; k < CONTROLS; k++)
            found->controls[i][k] = CPG_Result.prim->controls[i + STAGES * k];
}

void prepare(const struct program *program, const double start[STATES])
{
    struct solution unused;
    cpg_set_solver_max_iters(MOST_ITERATIONS);
    cpg_set_solver_abstol(TOLERANCE);
    cpg_set_solver_reltol(TOLERANCE);
    solve(program, start, &unused);
}
