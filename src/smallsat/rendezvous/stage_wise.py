"""A stage-wise primal-dual interior-point method for the quadratic programs of the guidance law.

The problem, in scaled units in which every control lies in [-1, 1]:

    minimise    sum_i  x_i' H x_i / 2 + h_i' x_i  +  u_i' R u_i / 2 + v' |u_i|
                + sum over rows  w (g' x_i - b)+          (x_N has its own H)
    subject to  x_{i+1} = A (x_i + [0; u_i]),   -1 <= u_i <= 1

A row with a finite weight is a penalty; one with a large weight is a constraint that gives way only
where nothing else is possible. So every problem has a solution, and the rows that gave way can be
counted. A penalty row has the slack t = b - g'x + s, its excess s and a multiplier y between 0 and
w, with y t = 0 and (w - y) s = 0; both are eliminated in closed form, and what is left is solved by
one Riccati recursion over the stages. Since any s gives a t, the iterates are feasible from the
start; steps are Mehrotra's predictor and corrector (SIAM J. Optim. 2, 1992).
"""

from typing import NamedTuple

import numpy as np

from smallsat.dynamics.compiled import compiled, compiled_arithmetic

SOLVED, ITERATION_LIMIT, NUMERICAL = 0, 1, 2
STATES, CONTROLS = 6, 3
BOUNDARY = 0.995  # share of the way to the boundary that a step may go
START_SLACK = 1.0  # scaled, of a violated row in the first iterate
START_SHARE = 0.9  # a control taken over from the last problem stays this far inside its bounds


class Program(NamedTuple):
    """One quadratic program, scaled; N stages, up to P planes and B bounds a stage.

    Attributes
    ----------
    transition
        A, (6, 6).
    state_hessian, terminal_hessian
        Diagonal of H, (6,), and H of the last stage, (6, 6).
    state_gradient
        h, (N + 1, 6).
    control_hessian, control_norm
        Diagonal of R and the weights v of the absolute values, (3,).
    plane_count, normals, offsets, plane_weights
        Rows on the position: how many at a stage, (N + 1,); g, (N + 1, P, 3); b and w, (N + 1, P).
    components, signs, bounds, bound_weights
        Rows on one component of the state, at every stage: which, (B,); its sign, (B,); b and w,
        (N + 1, B).
    """

    transition: np.ndarray
    state_hessian: np.ndarray
    terminal_hessian: np.ndarray
    state_gradient: np.ndarray
    control_hessian: np.ndarray
    control_norm: np.ndarray
    plane_count: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    plane_weights: np.ndarray
    components: np.ndarray
    signs: np.ndarray
    bounds: np.ndarray
    bound_weights: np.ndarray


class Workspace(NamedTuple):
    """Iterates and factors, for up to N stages and R rows.

    Attributes
    ----------
    states, controls, state_steps, control_steps
        The iterate and its step, (N + 1, 6) and (N, 3).
    boxes
        For each control, flat: room to the upper and lower bound, multipliers of both, steps of
        both multipliers, (6, 3 N).
    rows
        For each row: b, w, g'x, slack t, excess s, multiplier y, steps of t, s and y, curvature D,
        (10, R). Rows on states come first, stage by stage, then those on controls.
    curvature, state_rhs, control_rhs, control_curvature
        What the recursion starts from: H plus the rows' part, (N + 1, 6, 6), gradients and the
        controls' diagonal.
    gains, inverses
        Factors of the recursion: feedback, (N, 3, 6), and inverse of the controls' part, (N, 6).
    feedforward
        (N, 3).
    """

    states: np.ndarray
    controls: np.ndarray
    state_steps: np.ndarray
    control_steps: np.ndarray
    boxes: np.ndarray
    rows: np.ndarray
    curvature: np.ndarray
    state_rhs: np.ndarray
    control_rhs: np.ndarray
    control_curvature: np.ndarray
    gains: np.ndarray
    inverses: np.ndarray
    feedforward: np.ndarray


@compiled
def workspace(stages, planes, bounds):
    """Room for programs of up to that many stages, planes and bounds a stage."""
    rows = stages * (planes + bounds + CONTROLS)
    return Workspace(
        np.zeros((stages + 1, STATES)),
        np.zeros((stages, CONTROLS)),
        np.zeros((stages + 1, STATES)),
        np.zeros((stages, CONTROLS)),
        np.zeros((6, CONTROLS * stages)),
        np.zeros((10, rows)),
        np.zeros((stages + 1, STATES, STATES)),
        np.zeros((stages + 1, STATES)),
        np.zeros((stages, CONTROLS)),
        np.zeros((stages, CONTROLS)),
        np.zeros((stages, CONTROLS, STATES)),
        np.zeros((stages, STATES)),
        np.zeros((stages, CONTROLS)),
    )


@compiled_arithmetic
def roll_out(transition, start, controls, stages, states):
    """States of the controls: x_{i+1} = A (x_i + [0; u_i])."""
    for k in range(STATES):
        states[0, k] = start[k]
    for i in range(stages):
        for j in range(STATES):
            total = 0.0
            for k in range(3):
                total += transition[j, k] * states[i, k]
                total += transition[j, 3 + k] * (states[i, 3 + k] + controls[i, k])
            states[i + 1, j] = total


@compiled_arithmetic
def _gather(program, stages, states, controls, values):
    """g'x of every row; the number of rows."""
    r = 0
    bounds = len(program.components)
    for i in range(1, stages + 1):
        for p in range(program.plane_count[i]):
            values[r] = (
                program.normals[i, p, 0] * states[i, 0]
                + program.normals[i, p, 1] * states[i, 1]
                + program.normals[i, p, 2] * states[i, 2]
            )
            r += 1
        for b in range(bounds):
            values[r] = program.signs[b] * states[i, program.components[b]]
            r += 1
    if program.control_norm[0] > 0.0:
        for i in range(stages):
            for k in range(CONTROLS):
                values[r] = controls[i, k]
                r += 1
    return r


@compiled_arithmetic
def _list_rows(program, stages, limits, weights):
    """b and w of every row."""
    r = 0
    bounds = len(program.components)
    for i in range(1, stages + 1):
        for p in range(program.plane_count[i]):
            limits[r] = program.offsets[i, p]
            weights[r] = program.plane_weights[i, p]
            r += 1
        for b in range(bounds):
            limits[r] = program.bounds[i, b]
            weights[r] = program.bound_weights[i, b]
            r += 1
    if program.control_norm[0] > 0.0:
        for _ in range(stages):
            for k in range(CONTROLS):
                limits[r] = 0.0
                weights[r] = 2.0 * program.control_norm[k]
                r += 1


@compiled_arithmetic
def _start_rows(count, rows, mu):
    """Slack, excess and multiplier of every row: complementary at `mu`.

    A row that is violated starts with the slack `START_SLACK` all the same if its weight allows
    for a multiplier that fits; the steps then remove the difference. Otherwise the row starts on
    its central path, where t - s = b - g'x and y t = (w - y) s.
    """
    limits, weights, values = rows[0], rows[1], rows[2]
    slacks, excesses, multipliers = rows[3], rows[4], rows[5]
    for r in range(count):
        w = weights[r]
        slack = max(limits[r] - values[r], START_SLACK)
        if 2.0 * mu < w * slack:
            multiplier = mu / slack
            excess = mu / (w - multiplier)
        else:
            room = w * (limits[r] - values[r])
            root = np.sqrt(room * room + 4.0 * mu * mu)
            # of the two roots of one quadratic, the larger first, so that nothing cancels
            if room > 0.0:
                slack = (2.0 * mu + room + root) / (2.0 * w)
                excess = (2.0 * mu + 4.0 * mu * mu / (root + room)) / (2.0 * w)
            else:
                excess = (2.0 * mu - room + root) / (2.0 * w)
                slack = (2.0 * mu + 4.0 * mu * mu / (root - room)) / (2.0 * w)
            multiplier = mu / slack
        slacks[r] = slack
        excesses[r] = excess
        multipliers[r] = multiplier


@compiled_arithmetic
def _objective_gradient(program, stages, work):
    """Gradient of the cost at the iterate, without the rows."""
    states, controls, rhs = work.states, work.controls, work.state_rhs
    for i in range(1, stages):
        for k in range(STATES):
            rhs[i, k] = program.state_hessian[k] * states[i, k] + program.state_gradient[i, k]
    for j in range(STATES):
        total = program.state_gradient[stages, j]
        for k in range(STATES):
            total += program.terminal_hessian[j, k] * states[stages, k]
        rhs[stages, j] = total
    for i in range(stages):
        for k in range(CONTROLS):
            work.control_rhs[i, k] = (
                program.control_hessian[k] * controls[i, k] - program.control_norm[k]
            )


@compiled_arithmetic
def _scatter(program, stages, coefficients, state_rhs, control_rhs):
    """Add each row's coefficient times g to the gradients."""
    r = 0
    bounds = len(program.components)
    for i in range(1, stages + 1):
        for p in range(program.plane_count[i]):
            c = coefficients[r]
            state_rhs[i, 0] += c * program.normals[i, p, 0]
            state_rhs[i, 1] += c * program.normals[i, p, 1]
            state_rhs[i, 2] += c * program.normals[i, p, 2]
            r += 1
        for b in range(bounds):
            state_rhs[i, program.components[b]] += coefficients[r] * program.signs[b]
            r += 1
    if program.control_norm[0] > 0.0:
        for i in range(stages):
            for k in range(CONTROLS):
                control_rhs[i, k] += coefficients[r]
                r += 1


@compiled_arithmetic
def _assemble_curvature(program, stages, work):
    """H plus the rows' D g g' for every stage, and the controls' diagonal."""
    curvatures, boxes = work.rows[9], work.boxes
    bounds = len(program.components)
    r = 0
    for i in range(1, stages + 1):
        h = work.curvature[i]
        if i < stages:
            for j in range(STATES):
                for k in range(STATES):
                    h[j, k] = 0.0
                h[j, j] = program.state_hessian[j]
        else:
            for j in range(STATES):
                for k in range(STATES):
                    h[j, k] = program.terminal_hessian[j, k]
        for p in range(program.plane_count[i]):
            d = curvatures[r]
            for j in range(3):
                dg = d * program.normals[i, p, j]
                for k in range(3):
                    h[j, k] += dg * program.normals[i, p, k]
            r += 1
        for b in range(bounds):
            h[program.components[b], program.components[b]] += curvatures[r]
            r += 1
    for i in range(stages):
        for k in range(CONTROLS):
            c = CONTROLS * i + k
            work.control_curvature[i, k] = (
                program.control_hessian[k] + boxes[2, c] / boxes[0, c] + boxes[3, c] / boxes[1, c]
            )
    if program.control_norm[0] > 0.0:
        for i in range(stages):
            for k in range(CONTROLS):
                work.control_curvature[i, k] += curvatures[r]
                r += 1


@compiled_arithmetic
def _factor(transition, stages, work, cost, product, mapped):
    """Riccati recursion: gains and inverses of every stage."""
    for j in range(STATES):
        for k in range(STATES):
            cost[j, k] = work.curvature[stages, j, k]
    for i in range(stages - 1, -1, -1):
        for j in range(STATES):
            for k in range(STATES):
                total = 0.0
                for m in range(STATES):
                    total += cost[j, m] * transition[m, k]
                product[j, k] = total
        for j in range(STATES):
            for k in range(j, STATES):
                total = 0.0
                for m in range(STATES):
                    total += transition[m, j] * product[m, k]
                mapped[j, k] = total
                mapped[k, j] = total
        a = mapped[3, 3] + work.control_curvature[i, 0]
        b = mapped[3, 4]
        c = mapped[3, 5]
        d = mapped[4, 4] + work.control_curvature[i, 1]
        e = mapped[4, 5]
        f = mapped[5, 5] + work.control_curvature[i, 2]
        # inverse through its Cholesky factor
        la = 1.0 / np.sqrt(a)
        lb = b * la
        lc = c * la
        ld = 1.0 / np.sqrt(d - lb * lb)
        le = (e - lc * lb) * ld
        lf = 1.0 / np.sqrt(f - lc * lc - le * le)
        ba = -lb * la * ld
        ca = -(lc * la + le * ba) * lf
        cb = -le * ld * lf
        inv = work.inverses[i]
        inv[0] = la * la + ba * ba + ca * ca
        inv[1] = ba * ld + ca * cb
        inv[2] = ca * lf
        inv[3] = ld * ld + cb * cb
        inv[4] = cb * lf
        inv[5] = lf * lf
        gain = work.gains[i]
        for k in range(STATES):
            x, y, z = mapped[3, k], mapped[4, k], mapped[5, k]
            gain[0, k] = -(inv[0] * x + inv[1] * y + inv[2] * z)
            gain[1, k] = -(inv[1] * x + inv[3] * y + inv[4] * z)
            gain[2, k] = -(inv[2] * x + inv[4] * y + inv[5] * z)
        if i > 0:
            for j in range(STATES):
                for k in range(j, STATES):
                    total = work.curvature[i, j, k] + mapped[j, k]
                    total += mapped[3, j] * gain[0, k]
                    total += mapped[4, j] * gain[1, k]
                    total += mapped[5, j] * gain[2, k]
                    cost[j, k] = total
                    cost[k, j] = total


@compiled_arithmetic
def _step(transition, stages, work, costate, mapped):
    """Newton step of states and controls for the gradients in the workspace."""
    for j in range(STATES):
        costate[j] = work.state_rhs[stages, j]
    for i in range(stages - 1, -1, -1):
        for k in range(STATES):
            total = 0.0
            for m in range(STATES):
                total += transition[m, k] * costate[m]
            mapped[k] = total
        x = work.control_rhs[i, 0] + mapped[3]
        y = work.control_rhs[i, 1] + mapped[4]
        z = work.control_rhs[i, 2] + mapped[5]
        inv = work.inverses[i]
        gain = work.gains[i]
        work.feedforward[i, 0] = -(inv[0] * x + inv[1] * y + inv[2] * z)
        work.feedforward[i, 1] = -(inv[1] * x + inv[3] * y + inv[4] * z)
        work.feedforward[i, 2] = -(inv[2] * x + inv[4] * y + inv[5] * z)
        for k in range(STATES):
            costate[k] = (
                work.state_rhs[i, k]
                + mapped[k]
                + gain[0, k] * x
                + gain[1, k] * y
                + gain[2, k] * z
            )
    dx, du = work.state_steps, work.control_steps
    for k in range(STATES):
        dx[0, k] = 0.0
    for i in range(stages):
        for j in range(CONTROLS):
            total = work.feedforward[i, j]
            for k in range(STATES):
                total += work.gains[i, j, k] * dx[i, k]
            du[i, j] = total
        for j in range(STATES):
            total = 0.0
            for k in range(3):
                total += transition[j, k] * dx[i, k]
                total += transition[j, 3 + k] * (dx[i, 3 + k] + du[i, k])
            dx[i + 1, j] = total


@compiled_arithmetic
def _largest_control_gradient(transition, stages, work):
    """Largest component of the gradient in the controls, for the gradients in the workspace."""
    costate = work.state_rhs[stages].copy()
    mapped = np.zeros(STATES)
    largest = 0.0
    for i in range(stages - 1, -1, -1):
        for k in range(STATES):
            total = 0.0
            for m in range(STATES):
                total += transition[m, k] * costate[m]
            mapped[k] = total
        for k in range(CONTROLS):
            largest = max(largest, abs(work.control_rhs[i, k] + mapped[3 + k]))
        for k in range(STATES):
            costate[k] = work.state_rhs[i, k] + mapped[k]
    return largest


@compiled_arithmetic
def solve(program, stages, start, work, warm, tolerance, iteration_limit):
    """Solve one program.

    Parameters
    ----------
    program, stages, start
        The problem, its number of stages and the state that it starts from, (6,).
    work
        Receives states and controls; with `warm` above zero its controls are the first iterate.
    warm
        Barrier parameter of the first iterate, as a share of the cost's largest gradient in a
        control; zero starts from no control at all.
    tolerance
        Of the complementarity and the gradient, relative to that gradient.
    iteration_limit
        Most steps.

    Returns
    -------
    int, int, float
        `SOLVED`, `ITERATION_LIMIT` or `NUMERICAL`; steps taken; largest row excess is left to
        the caller, the third is the final barrier parameter relative to the gradient.
    """
    transition = program.transition
    x, u, dx, du = work.states, work.controls, work.state_steps, work.control_steps
    rows, boxes = work.rows, work.boxes
    limits, weights, values = rows[0], rows[1], rows[2]
    t, s, y = rows[3], rows[4], rows[5]
    dt, ds, dy, curvature = rows[6], rows[7], rows[8], rows[9]
    above, below, upper, lower = boxes[0], boxes[1], boxes[2], boxes[3]
    dupper, dlower = boxes[4], boxes[5]
    cost, product = np.empty((STATES, STATES)), np.empty((STATES, STATES))
    mapped, costate, mapped_costate = np.empty((STATES, STATES)), np.empty(STATES), np.empty(STATES)

    if warm <= 0.0:
        for i in range(stages):
            for k in range(CONTROLS):
                u[i, k] = 0.0
        share = 1.0
    else:
        for i in range(stages):
            for k in range(CONTROLS):
                u[i, k] = min(max(u[i, k], -START_SHARE), START_SHARE)
        share = warm
    roll_out(transition, start, u, stages, x)
    _list_rows(program, stages, limits, weights)
    count = _gather(program, stages, x, u, values)
    _objective_gradient(program, stages, work)
    scale = max(_largest_control_gradient(transition, stages, work), 1e-300)
    mu = share * scale
    _start_rows(count, rows, mu)
    controls = CONTROLS * stages
    for i in range(stages):
        for k in range(CONTROLS):
            c = CONTROLS * i + k
            above[c] = 1.0 - u[i, k]
            below[c] = 1.0 + u[i, k]
            upper[c] = mu / above[c]
            lower[c] = mu / below[c]
    pairs = 2.0 * (count + controls)
    residual = 1.0

    for iteration in range(iteration_limit):
        if mu <= tolerance * scale and residual <= tolerance:
            return SOLVED, iteration, mu / scale
        # predictor
        for r in range(count):
            free = weights[r] - y[r]
            d = y[r] * free / (t[r] * free + s[r] * y[r])
            curvature[r] = d
            dy[r] = y[r] + d * (values[r] - limits[r])
        _assemble_curvature(program, stages, work)
        _factor(transition, stages, work, cost, product, mapped)
        _objective_gradient(program, stages, work)
        _scatter(program, stages, dy, work.state_rhs, work.control_rhs)
        _step(transition, stages, work, costate, mapped_costate)
        _gather(program, stages, dx, du, dt)
        worst = 0.0
        for r in range(count):
            free = weights[r] - y[r]
            dy[r] = curvature[r] * (dt[r] + values[r] - limits[r])
            dt[r] = -t[r] - t[r] / y[r] * dy[r]
            ds[r] = -s[r] + s[r] / free * dy[r]
            worst = max(worst, -dt[r] / t[r], -ds[r] / s[r])
            worst = max(worst, -dy[r] / y[r], dy[r] / free)
        for i in range(stages):
            for k in range(CONTROLS):
                c = CONTROLS * i + k
                step = du[i, k]
                dupper[c] = -upper[c] + upper[c] / above[c] * step
                dlower[c] = -lower[c] - lower[c] / below[c] * step
                worst = max(worst, step / above[c], -step / below[c])
                worst = max(worst, -dupper[c] / upper[c], -dlower[c] / lower[c])
        alpha = 1.0 if worst <= 1.0 else 1.0 / worst
        after = 0.0
        for r in range(count):
            yn = y[r] + alpha * dy[r]
            after += yn * (t[r] + alpha * dt[r]) + (weights[r] - yn) * (s[r] + alpha * ds[r])
        for i in range(stages):
            for k in range(CONTROLS):
                c = CONTROLS * i + k
                step = alpha * du[i, k]
                after += (upper[c] + alpha * dupper[c]) * (above[c] - step)
                after += (lower[c] + alpha * dlower[c]) * (below[c] + step)
        after /= pairs
        target = after * (after / mu) * (after / mu)

        # corrector: the products of the predictor's steps and the target are taken in
        _objective_gradient(program, stages, work)
        for r in range(count):
            free = weights[r] - y[r]
            ct = target - y[r] * t[r] - dy[r] * dt[r]
            cs = target - free * s[r] + dy[r] * ds[r]
            rest = values[r] + t[r] - s[r] - limits[r] + ct / y[r] - cs / free
            dt[r] = ct
            ds[r] = cs
            dy[r] = y[r] + curvature[r] * rest
        _scatter(program, stages, dy, work.state_rhs, work.control_rhs)
        for i in range(stages):
            for k in range(CONTROLS):
                c = CONTROLS * i + k
                cu = target + dupper[c] * du[i, k]
                cl = target - dlower[c] * du[i, k]
                work.control_rhs[i, k] += cu / above[c] - cl / below[c]
                dupper[c] = cu - upper[c] * above[c]
                dlower[c] = cl - lower[c] * below[c]
        _step(transition, stages, work, costate, mapped_costate)
        _gather(program, stages, dx, du, rows[9])
        worst = 0.0
        for r in range(count):
            free = weights[r] - y[r]
            d = y[r] * free / (t[r] * free + s[r] * y[r])
            rest = values[r] + t[r] - s[r] - limits[r] + dt[r] / y[r] - ds[r] / free
            step = d * (curvature[r] + rest)
            dy[r] = step
            dt[r] = (dt[r] - t[r] * step) / y[r]
            ds[r] = (ds[r] + s[r] * step) / free
            worst = max(worst, -dt[r] / t[r], -ds[r] / s[r])
            worst = max(worst, -step / y[r], step / free)
        for i in range(stages):
            for k in range(CONTROLS):
                c = CONTROLS * i + k
                step = du[i, k]
                dupper[c] = (dupper[c] + upper[c] * step) / above[c]
                dlower[c] = (dlower[c] - lower[c] * step) / below[c]
                worst = max(worst, step / above[c], -step / below[c])
                worst = max(worst, -dupper[c] / upper[c], -dlower[c] / lower[c])
        alpha = 1.0 if worst <= BOUNDARY else BOUNDARY / worst
        mu = 0.0
        for r in range(count):
            t[r] += alpha * dt[r]
            s[r] += alpha * ds[r]
            y[r] += alpha * dy[r]
            mu += y[r] * t[r] + (weights[r] - y[r]) * s[r]
        for i in range(stages):
            for k in range(CONTROLS):
                c = CONTROLS * i + k
                step = alpha * du[i, k]
                u[i, k] += step
                above[c] -= step
                below[c] += step
                upper[c] += alpha * dupper[c]
                lower[c] += alpha * dlower[c]
                mu += upper[c] * above[c] + lower[c] * below[c]
        mu /= pairs
        for i in range(1, stages + 1):
            for k in range(STATES):
                x[i, k] += alpha * dx[i, k]
        _gather(program, stages, x, u, values)
        residual *= 1.0 - alpha
        if not mu < np.inf:
            return NUMERICAL, iteration + 1, mu / scale
    return ITERATION_LIMIT, iteration_limit, mu / scale
