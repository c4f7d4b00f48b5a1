/* The project's primal-dual interior-point method with a Riccati recursion over the stages, for
 * programs of the 2-norm. Words and symbols are those of
 * smallsat.optimal_control.riccati_interior_point, which explains the method. All memory is static. */
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "program.h"

#define BOUNDARY 0.995   /* share of the way to the boundary that a step may go */
#define START_SLACK 0.5  /* scaled, of a violated row in the first iterate */
#define TOLERANCE 1e-10  /* of complementarity and stationarity, relative */
#define ITERATIONS 100   /* at most */

enum { ROWS = STAGES * (PLANES + BOUNDS), BOXES = STAGES * CONTROLS };

/* Motion in the orbit's plane and out of it does not mix in the transition. */
static const struct { int count, index[4]; } PARTS[2] = {{4, {0, 1, 3, 4}}, {2, {2, 5}}};

static double x[STAGES + 1][STATES], u[STAGES][CONTROLS];
static double dx[STAGES + 1][STATES], du[STAGES][CONTROLS];
/* Rows: limit b, weight w, value g'x, slack t, excess s, multiplier y, their steps, curvature D, what
 * a row adds to the gradient along g, and the step of g'x. */
static double limit[ROWS], weight[ROWS], value[ROWS], t[ROWS], s[ROWS], y[ROWS];
static double dt[ROWS], ds[ROWS], dy[ROWS], row_curvature[ROWS], push[ROWS], moved[ROWS];
/* Bounds of the controls: room above and below, its inverse, multipliers, their steps, curvature. */
static double above[BOXES], below[BOXES], by_above[BOXES], by_below[BOXES];
static double upper[BOXES], lower[BOXES], dupper[BOXES], dlower[BOXES], box_curvature[BOXES];
/* What the recursion starts from, and its factors. */
static double curvature[STAGES + 1][STATES][STATES], state_rhs[STAGES + 1][STATES];
static double control_rhs[STAGES][CONTROLS];
static double gains[STAGES][CONTROLS][STATES], inverses[STAGES][CONTROLS][CONTROLS];
static double feedforward[STAGES][CONTROLS];

void prepare(const struct program *program, const double start[STATES])
{
    (void)program, (void)start; /* nothing is to be prepared */
}

static double largest(double a, double b) { return a > b ? a : b; }

/* out = A in */
static void apply(const struct program *p, const double in[STATES], double out[STATES])
{
    for (int part = 0; part < 2; part++)
        for (int j = 0; j < PARTS[part].count; j++) {
            double total = 0.0;
            for (int k = 0; k < PARTS[part].count; k++)
                total += p->transition[PARTS[part].index[j]][PARTS[part].index[k]]
                         * in[PARTS[part].index[k]];
            out[PARTS[part].index[j]] = total;
        }
}

/* out = A' in */
static void apply_transposed(const struct program *p, const double in[STATES], double out[STATES])
{
    for (int part = 0; part < 2; part++)
        for (int j = 0; j < PARTS[part].count; j++) {
            double total = 0.0;
            for (int k = 0; k < PARTS[part].count; k++)
                total += p->transition[PARTS[part].index[k]][PARTS[part].index[j]]
                         * in[PARTS[part].index[k]];
            out[PARTS[part].index[j]] = total;
        }
}

/* States of some controls: x_{i+1} = A (x_i + [0; u_i]). */
static void roll_out(const struct program *p, double states[][STATES], double controls[][CONTROLS])
{
    for (int i = 0; i < p->stages; i++) {
        double pushed[STATES];
        for (int k = 0; k < 3; k++) {
            pushed[k] = states[i][k];
            pushed[3 + k] = states[i][3 + k] + controls[i][k];
        }
        apply(p, pushed, states[i + 1]);
    }
}

static int list_rows(const struct program *p)
{
    int r = 0;
    for (int i = 1; i <= p->stages; i++) {
        for (int k = 0; k < p->plane_count[i]; k++, r++) {
            limit[r] = p->offsets[i][k];
            weight[r] = p->plane_weights[i][k];
        }
        for (int b = 0; b < p->bound_count; b++, r++) {
            limit[r] = p->bounds[i][b];
            weight[r] = p->bound_weights[i][b];
        }
    }
    return r;
}

/* g'x of every row. */
static void gather(const struct program *p, double states[][STATES], double values[])
{
    int r = 0;
    for (int i = 1; i <= p->stages; i++) {
        for (int k = 0; k < p->plane_count[i]; k++, r++)
            values[r] = p->normals[i][k][0] * states[i][0] + p->normals[i][k][1] * states[i][1]
                        + p->normals[i][k][2] * states[i][2];
        for (int b = 0; b < p->bound_count; b++, r++)
            values[r] = p->signs[b] * states[i][p->components[b]];
    }
}

/* Add each row's coefficient times g to the gradient. */
static void scatter(const struct program *p, const double coefficients[])
{
    int r = 0;
    for (int i = 1; i <= p->stages; i++) {
        for (int k = 0; k < p->plane_count[i]; k++, r++)
            for (int j = 0; j < 3; j++)
                state_rhs[i][j] += coefficients[r] * p->normals[i][k][j];
        for (int b = 0; b < p->bound_count; b++, r++)
            state_rhs[i][p->components[b]] += coefficients[r] * p->signs[b];
    }
}

/* Gradient of the cost at the iterate, without the rows. */
static void objective_gradient(const struct program *p)
{
    for (int i = 1; i < p->stages; i++)
        for (int k = 0; k < STATES; k++)
            state_rhs[i][k] = p->state_hessian[k] * x[i][k] + p->state_gradient[i][k];
    for (int j = 0; j < STATES; j++) {
        double total = p->state_gradient[p->stages][j];
        for (int k = 0; k < STATES; k++)
            total += p->terminal_hessian[j][k] * x[p->stages][k];
        state_rhs[p->stages][j] = total;
    }
    for (int i = 0; i < p->stages; i++)
        for (int k = 0; k < CONTROLS; k++)
            control_rhs[i][k] = p->control_hessian[k] * u[i][k];
}

static double largest_control_gradient(const struct program *p)
{
    double costate[STATES], mapped[STATES], found = 0.0;
    memcpy(costate, state_rhs[p->stages], sizeof costate);
    for (int i = p->stages - 1; i >= 0; i--) {
        apply_transposed(p, costate, mapped);
        for (int k = 0; k < CONTROLS; k++)
            found = largest(found, fabs(control_rhs[i][k] + mapped[3 + k]));
        for (int k = 0; k < STATES; k++)
            costate[k] = state_rhs[i][k] + mapped[k];
    }
    return found;
}

static void start_rows(int count, double mu)
{
    for (int r = 0; r < count; r++) {
        double w = weight[r], gap = limit[r] - value[r], slack = largest(gap, START_SLACK);
        if (2.0 * mu < w * slack) {
            y[r] = mu / slack;
            t[r] = slack;
            s[r] = largest(mu / (w - y[r]), slack - gap);
        } else {
            double room = w * gap, root = sqrt(room * room + 4.0 * mu * mu);
            /* Of the two roots of one quadratic the larger first, so that nothing cancels. */
            if (room > 0.0) {
                t[r] = (2.0 * mu + room + root) / (2.0 * w);
                s[r] = (2.0 * mu + 4.0 * mu * mu / (root + room)) / (2.0 * w);
            } else {
                s[r] = (2.0 * mu - room + root) / (2.0 * w);
                t[r] = (2.0 * mu + 4.0 * mu * mu / (root - room)) / (2.0 * w);
            }
            y[r] = mu / t[r];
        }
    }
}

/* H plus the rows' D g g' of every stage. */
static void assemble_curvature(const struct program *p)
{
    int r = 0;
    memset(curvature, 0, sizeof curvature);
    for (int i = 1; i <= p->stages; i++) {
        double (*h)[STATES] = curvature[i];
        if (i == p->stages)
            memcpy(h, p->terminal_hessian, sizeof p->terminal_hessian);
        else
            for (int k = 0; k < STATES; k++)
                h[k][k] = p->state_hessian[k];
        for (int n = 0; n < p->plane_count[i]; n++, r++)
            for (int j = 0; j < 3; j++) {
                double scaled = row_curvature[r] * p->normals[i][n][j];
                for (int k = 0; k < 3; k++)
                    h[j][k] += scaled * p->normals[i][n][k];
            }
        for (int b = 0; b < p->bound_count; b++, r++)
            h[p->components[b]][p->components[b]] += row_curvature[r];
    }
}

/* Riccati recursion: gains and inverses of every stage, for the cost-to-go P. M = A'PA, then the
 * controls' part of M plus their own curvature is inverted. */
static void factor(const struct program *p)
{
    double cost[STATES][STATES], m[STATES][STATES], column[STATES];
    memcpy(cost, curvature[p->stages], sizeof cost);
    for (int i = p->stages - 1; i >= 0; i--) {
        double transposed[STATES][STATES]; /* (P A)' */
        for (int j = 0; j < STATES; j++) {
            apply_transposed(p, cost[j], column);
            for (int k = 0; k < STATES; k++)
                transposed[k][j] = column[k];
        }
        for (int k = 0; k < STATES; k++)
            apply_transposed(p, transposed[k], m[k]); /* symmetric, so rows are columns */

        double d[CONTROLS], (*inverse)[CONTROLS] = inverses[i];
        for (int k = 0; k < CONTROLS; k++)
            d[k] = m[3 + k][3 + k] + (p->control_hessian[k] + box_curvature[CONTROLS * i + k]);
        double d0 = 1.0 / d[0];
        double l10 = m[3][4] * d0, l20 = m[3][5] * d0;
        double d1 = 1.0 / (d[1] - l10 * m[3][4]);
        double e21 = m[4][5] - l20 * m[3][4], l21 = e21 * d1;
        double d2 = 1.0 / (d[2] - l20 * m[3][5] - l21 * e21);
        double r20 = l10 * l21 - l20;
        inverse[0][0] = d0 + l10 * l10 * d1 + r20 * r20 * d2;
        inverse[0][1] = inverse[1][0] = -l10 * d1 - r20 * l21 * d2;
        inverse[0][2] = inverse[2][0] = r20 * d2;
        inverse[1][1] = d1 + l21 * l21 * d2;
        inverse[1][2] = inverse[2][1] = -l21 * d2;
        inverse[2][2] = d2;

        for (int j = 0; j < CONTROLS; j++)
            for (int k = 0; k < STATES; k++)
                gains[i][j][k] = -(inverse[j][0] * m[3][k] + inverse[j][1] * m[4][k]
                                   + inverse[j][2] * m[5][k]);
        for (int j = 0; j < STATES; j++)
            for (int k = j; k < STATES; k++)
                cost[j][k] = cost[k][j] = curvature[i][j][k] + m[j][k] + m[3][j] * gains[i][0][k]
                                          + m[4][j] * gains[i][1][k] + m[5][j] * gains[i][2][k];
    }
}

/* Newton step of states and controls for the gradients that stand in the right-hand sides. */
static void newton_step(const struct program *p)
{
    double costate[STATES], mapped[STATES];
    memcpy(costate, state_rhs[p->stages], sizeof costate);
    for (int i = p->stages - 1; i >= 0; i--) {
        double gradient[CONTROLS];
        apply_transposed(p, costate, mapped);
        for (int k = 0; k < CONTROLS; k++)
            gradient[k] = control_rhs[i][k] + mapped[3 + k];
        for (int j = 0; j < CONTROLS; j++)
            feedforward[i][j] = -(inverses[i][j][0] * gradient[0] + inverses[i][j][1] * gradient[1]
                                  + inverses[i][j][2] * gradient[2]);
        for (int k = 0; k < STATES; k++)
            costate[k] = state_rhs[i][k] + mapped[k] + gains[i][0][k] * gradient[0]
                         + gains[i][1][k] * gradient[1] + gains[i][2][k] * gradient[2];
    }
    memset(dx[0], 0, sizeof dx[0]);
    for (int i = 0; i < p->stages; i++) {
        double pushed[STATES];
        memcpy(pushed, dx[i], sizeof pushed);
        for (int j = 0; j < CONTROLS; j++) {
            du[i][j] = feedforward[i][j];
            for (int k = 0; k < STATES; k++)
                du[i][j] += gains[i][j][k] * dx[i][k];
        }
        for (int j = 0; j < CONTROLS; j++)
            pushed[3 + j] += du[i][j];
        apply(p, pushed, dx[i + 1]);
    }
}

/* Complementarity, summed, after a step of length `alpha`. */
static double complementarity(const struct program *p, int count, double alpha)
{
    double total = 0.0;
    const double *dv = &du[0][0];
    for (int r = 0; r < count; r++) {
        double after = y[r] + alpha * dy[r];
        total += after * (t[r] + alpha * dt[r]) + (weight[r] - after) * (s[r] + alpha * ds[r]);
    }
    for (int c = 0; c < CONTROLS * p->stages; c++) {
        double step = alpha * dv[c];
        total += (upper[c] + alpha * dupper[c]) * (above[c] - step);
        total += (lower[c] + alpha * dlower[c]) * (below[c] + step);
    }
    return total;
}

/* The predictor aims complementarity at zero; returns by how much its full step goes too far. */
static double predict(const struct program *p, int count)
{
    const double *dv = &du[0][0];
    double worst = 0.0;
    for (int r = 0; r < count; r++) {
        double free = weight[r] - y[r];
        row_curvature[r] = y[r] * free / (t[r] * free + s[r] * y[r]);
        push[r] = y[r] + row_curvature[r] * (value[r] - limit[r]);
    }
    for (int c = 0; c < CONTROLS * p->stages; c++) {
        by_above[c] = 1.0 / above[c];
        by_below[c] = 1.0 / below[c];
        box_curvature[c] = upper[c] * by_above[c] + lower[c] * by_below[c];
    }
    assemble_curvature(p);
    factor(p);
    objective_gradient(p);
    scatter(p, push);
    newton_step(p);
    gather(p, dx, moved);
    for (int r = 0; r < count; r++) {
        dy[r] = row_curvature[r] * (moved[r] + value[r] - limit[r]);
        double by_multiplier = dy[r] / y[r], by_free = dy[r] / (weight[r] - y[r]);
        dt[r] = -t[r] - t[r] * by_multiplier;
        ds[r] = -s[r] + s[r] * by_free;
        worst = largest(worst, largest(1.0 + by_multiplier, 1.0 - by_free));
        worst = largest(worst, largest(-by_multiplier, by_free));
    }
    for (int c = 0; c < CONTROLS * p->stages; c++) {
        double to_above = dv[c] * by_above[c], to_below = dv[c] * by_below[c];
        dupper[c] = upper[c] * (to_above - 1.0);
        dlower[c] = -lower[c] * (to_below + 1.0);
        worst = largest(worst, largest(to_above, -to_below));
        worst = largest(worst, largest(1.0 - to_above, 1.0 + to_below));
    }
    return worst;
}

/* The corrector aims at `target`, with the products of the predictor's steps; returns as `predict`. */
static double correct(const struct program *p, int count, double target)
{
    const double *dv = &du[0][0];
    double *rhs = &control_rhs[0][0], worst = 0.0;
    for (int r = 0; r < count; r++) {
        double free = weight[r] - y[r];
        double to_slack = target - y[r] * t[r] - dy[r] * dt[r];
        double to_excess = target - free * s[r] + dy[r] * ds[r];
        double rest = value[r] + t[r] - s[r] - limit[r] + to_slack / y[r] - to_excess / free;
        dt[r] = to_slack;
        ds[r] = to_excess;
        dy[r] = row_curvature[r] * rest;
        push[r] = y[r] + dy[r] - push[r];
    }
    scatter(p, push);
    for (int c = 0; c < CONTROLS * p->stages; c++) {
        double to_upper = target + dupper[c] * dv[c], to_lower = target - dlower[c] * dv[c];
        rhs[c] += to_upper * by_above[c] - to_lower * by_below[c];
        dupper[c] = to_upper * by_above[c] - upper[c];
        dlower[c] = to_lower * by_below[c] - lower[c];
    }
    newton_step(p);
    gather(p, dx, moved);
    for (int r = 0; r < count; r++) {
        double free = weight[r] - y[r];
        dy[r] += row_curvature[r] * moved[r];
        dt[r] = (dt[r] - t[r] * dy[r]) / y[r];
        ds[r] = (ds[r] + s[r] * dy[r]) / free;
        worst = largest(worst, largest(-dt[r] / t[r], -ds[r] / s[r]));
        worst = largest(worst, largest(-dy[r] / y[r], dy[r] / free));
    }
    for (int c = 0; c < CONTROLS * p->stages; c++) {
        double to_above = dv[c] * by_above[c], to_below = dv[c] * by_below[c];
        dupper[c] += upper[c] * to_above;
        dlower[c] -= lower[c] * to_below;
        worst = largest(worst, largest(to_above, -to_below));
        worst = largest(worst, largest(-dupper[c] / upper[c], -dlower[c] / lower[c]));
    }
    return worst;
}

static void take_step(const struct program *p, int count, double alpha)
{
    double *v = &u[0][0];
    const double *dv = &du[0][0];
    for (int r = 0; r < count; r++) {
        t[r] += alpha * dt[r];
        s[r] += alpha * ds[r];
        y[r] += alpha * dy[r];
    }
    for (int c = 0; c < CONTROLS * p->stages; c++) {
        v[c] += alpha * dv[c];
        above[c] -= alpha * dv[c];
        below[c] += alpha * dv[c];
        upper[c] += alpha * dupper[c];
        lower[c] += alpha * dlower[c];
    }
    for (int i = 1; i <= p->stages; i++)
        for (int k = 0; k < STATES; k++)
            x[i][k] += alpha * dx[i][k];
}

void solve(const struct program *p, const double start[STATES], struct solution *found)
{
    memset(u, 0, sizeof u);
    memcpy(x[0], start, sizeof x[0]);
    roll_out(p, x, u);
    int count = list_rows(p);
    double pairs = 2.0 * (count + CONTROLS * p->stages);
    gather(p, x, value);
    objective_gradient(p);
    double scale = largest(largest_control_gradient(p), 1e-300);
    start_rows(count, scale);
    for (int c = 0; c < CONTROLS * p->stages; c++) {
        above[c] = below[c] = 1.0;
        upper[c] = lower[c] = scale;
    }
    double mu = complementarity(p, count, 0.0) / pairs, residual = 1.0;

    found->status = ITERATION_LIMIT;
    for (found->iterations = 0; found->iterations < ITERATIONS; found->iterations++) {
        if (mu <= TOLERANCE * scale && residual <= TOLERANCE) {
            found->status = SOLVED;
            break;
        }
        double worst = predict(p, count);
        double after = complementarity(p, count, worst <= 1.0 ? 1.0 : 1.0 / worst) / pairs;
        worst = correct(p, count, after * (after / mu) * (after / mu));
        double alpha = worst <= BOUNDARY ? 1.0 : BOUNDARY / worst;
        take_step(p, count, alpha);
        gather(p, x, value);
        mu = complementarity(p, count, 0.0) / pairs;
        residual *= 1.0 - alpha;
        if (!(mu < INFINITY)) {
            found->status = NUMERICAL;
            break;
        }
    }
    memcpy(found->controls, u, sizeof u);
}
