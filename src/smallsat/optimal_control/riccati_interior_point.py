"""A primal-dual interior-point method for the guidance law's programs, by a Riccati recursion.

The problem, in scaled units in which every control lies in [-1, 1]:

    minimise    sum_i  x_i' H x_i / 2 + h_i' x_i  +  u_i' R u_i / 2 + v' |u_i|
                + sum over rows  w (g' x_i - b)+          (x_N has its own H)
    subject to  x_{i+1} = A_i (x_i + [0; u_i]),   -1 <= u_i <= 1

A row with a finite weight is a penalty; one with a large weight is a constraint that gives way only
where nothing else is possible. So every problem has a solution, and the rows that gave way can be
counted. A penalty row has the slack t = b - g'x + s, its excess s and a multiplier y between 0 and
w, with y t = 0 and (w - y) s = 0; both are eliminated in closed form, and what is left is solved by
one Riccati recursion over the stages. Since any s gives a t, the iterates are feasible from the
start; steps are Mehrotra's predictor and corrector (SIAM J. Optim. 2, 1992). In 42 669 programs of
closed loops under five laws it took 11 iterations on average and never more than 27, infeasible
programs included.

Every decision but where to stop is taken without a branch, so that the method also solves as many
programs as there are `smallsat.dynamics.lanes` at once, in about 1.4 times the time of one.

Why not a library: a full study solves several million programs, and those that
`smallsat.studies.rendezvous.methods.solver_comparison` measures take many times as long for them.
Two that need no Python around each call were measured once: HPIPM, whose kernels are made for
larger matrices, takes about six times as long, and DAQP knows no penalty of the first power without
further unknowns.
"""

from typing import NamedTuple

import numpy as np

from smallsat.dynamics.compiled import compiled, compiled_arithmetic
from smallsat.dynamics.lanes import as_lanes, at_most, larger, less, root, size, some, where

SOLVED, ITERATION_LIMIT, NUMERICAL = 0, 1, 2
STATES, CONTROLS = 6, 3
BOUNDARY = 0.995  # share of the way to the boundary that a step may go
START_SLACK = 0.5  # scaled, of a violated row in the first iterate

# First index of `Workspace.rows`: b, w and g'x of a row, its slack t, excess s and multiplier y,
# their steps, its curvature D, what it adds to the gradient along g, and the step of g'x.
(
    LIMIT, WEIGHT, VALUE, SLACK, EXCESS, MULTIPLIER, SLACK_STEP, EXCESS_STEP, MULTIPLIER_STEP,
    CURVATURE, PUSH, VALUE_STEP,
) = range(12)  # fmt: skip
# First index of `Workspace.boxes`: a control's room above and below, the multipliers of both
# bounds, their steps, the inverses of the rooms, and the curvature that the bounds add.
(
    ABOVE, BELOW, UPPER, LOWER, UPPER_STEP, LOWER_STEP, BY_ABOVE, BY_BELOW, BOX_CURVATURE,
) = range(9)  # fmt: skip


class Program(NamedTuple):
    """One quadratic program, scaled; N stages, up to P planes and B bounds a stage.

    Attributes
    ----------
    transitions
        A of each stage, (N, 6, 6), or (1, 6, 6) where all have the same.
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

    transitions: np.ndarray
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
        What `ABOVE` to `BOX_CURVATURE` name, of each control, flat, (9, 3 N).
    rows
        What `LIMIT` to `VALUE_STEP` name, of each row, (12, R). Rows on states come first, stage by
        stage, then those on controls.
    curvature, state_rhs, control_rhs, control_curvature
        What the recursion starts from: H plus the rows' part, (N + 1, 6, 6), of which the upper
        triangle is used, gradients and the controls' diagonal.
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


class Solution(NamedTuple):
    """What `solve` found; arrays are views of the workspace, good until its next use.

    Attributes
    ----------
    status, iterations
        `SOLVED`, `ITERATION_LIMIT` or `NUMERICAL`; steps taken.
    controls
        Scaled, (N, 3).
    weights, excesses
        w and s of the rows on states, (R,), stage by stage.
    """

    status: int
    iterations: int
    controls: np.ndarray
    weights: np.ndarray
    excesses: np.ndarray


@compiled
def workspace(stages, planes, bounds):
    """Return the `Workspace` for programs of up to that many stages, planes and bounds a stage."""
    rows = stages * (planes + bounds + CONTROLS)
    return Workspace(
        np.zeros((stages + 1, STATES)),
        np.zeros((stages, CONTROLS)),
        np.zeros((stages + 1, STATES)),
        np.zeros((stages, CONTROLS)),
        np.zeros((BOX_CURVATURE + 1, CONTROLS * stages)),
        np.zeros((VALUE_STEP + 1, rows)),
        np.zeros((stages + 1, STATES, STATES)),
        np.zeros((stages + 1, STATES)),
        np.zeros((stages, CONTROLS)),
        np.zeros((stages, CONTROLS)),
        np.zeros((stages, CONTROLS, STATES)),
        np.zeros((stages, STATES)),
        np.zeros((stages, CONTROLS)),
    )


@compiled_arithmetic
def roll_out(transitions, start, controls, stages, states):
    """States of the controls: x_{i+1} = A_i (x_i + [0; u_i])."""
    for k in range(STATES):
        states[0, k] = start[k]
    for i in range(stages):
        a = transitions[min(i, len(transitions) - 1)]
        for j in range(STATES):
            total = 0.0
            for k in range(3):
                total += a[j, k] * states[i, k]
                total += a[j, 3 + k] * (states[i, 3 + k] + controls[i, k])
            states[i + 1, j] = total


@compiled_arithmetic
def _gather(program, control_rows, stages, states, controls, values):
    """Fill g'x of every row; return the number of rows."""
    normals, components, signs = program.normals, program.components, program.signs
    r = 0
    for i in range(1, stages + 1):
        for p in range(program.plane_count[i]):
            values[r] = (
                normals[i, p, 0] * states[i, 0]
                + normals[i, p, 1] * states[i, 1]
                + normals[i, p, 2] * states[i, 2]
            )
            r += 1
        for b in range(len(components)):
            values[r] = signs[b] * states[i, components[b]]
            r += 1
    for i in range(stages):
        for k in range(control_rows):
            values[r] = controls[i, k]
            r += 1
    return r


@compiled_arithmetic
def _list_rows(program, control_rows, stages, limits, weights):
    """Fill b and w of every row; return the number of rows on states."""
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
    on_states = r
    for _ in range(stages):
        for k in range(control_rows):
            limits[r] = 0.0
            weights[r] = 2.0 * program.control_norm[k]
            r += 1
    return on_states


@compiled_arithmetic
def _start_rows(count, rows, mu):
    """Slack, excess and multiplier of every row to start from, with y t = `mu`.

    A row that is violated starts with the slack `START_SLACK` and the excess that this takes, if
    its weight allows for a multiplier that fits. Otherwise the row starts on its central path,
    where t - s = b - g'x and y t = (w - y) s. (The other choice for a violated row, an excess that
    fits `mu`, needs twice the iterations and more where the program is infeasible.)
    """
    limits, weights, values = rows[LIMIT], rows[WEIGHT], rows[VALUE]
    slacks, excesses, multipliers = rows[SLACK], rows[EXCESS], rows[MULTIPLIER]
    for r in range(count):
        w, gap = weights[r], limits[r] - values[r]
        # with a slack that is given, where the multiplier fits the weight
        given = larger(gap, START_SLACK)
        fits = less(2.0 * mu, w * given)
        excess = larger(mu / (w - mu / given), given - gap)
        # on the central path: of the two roots of one quadratic, the larger first, so that nothing
        # cancels
        room = w * gap
        total = root(room * room + 4.0 * mu * mu)
        inside = less(0.0, room)
        product = 4.0 * mu * mu / where(inside, total + room, total - room)
        slack = where(inside, 2.0 * mu + room + total, 2.0 * mu + product) / (2.0 * w)
        other = where(inside, 2.0 * mu + product, 2.0 * mu - room + total) / (2.0 * w)
        slacks[r] = where(fits, given, slack)
        excesses[r] = where(fits, excess, other)
        multipliers[r] = mu / slacks[r]


@compiled_arithmetic
def _objective_gradient(program, stages, work):
    """Gradient of the cost at the iterate, without the rows."""
    states, controls = work.states, work.controls
    rhs, control_rhs = work.state_rhs, work.control_rhs
    own, gradient, last = program.state_hessian, program.state_gradient, program.terminal_hessian
    for i in range(1, stages):
        for k in range(STATES):
            rhs[i, k] = own[k] * states[i, k] + gradient[i, k]
    for j in range(STATES):
        total = gradient[stages, j]
        for k in range(STATES):
            total += last[j, k] * states[stages, k]
        rhs[stages, j] = total
    hessian, norm = program.control_hessian, program.control_norm
    for i in range(stages):
        for k in range(CONTROLS):
            control_rhs[i, k] = hessian[k] * controls[i, k] - norm[k]


@compiled_arithmetic
def _scatter(program, control_rows, stages, coefficients, state_rhs, control_rhs):
    """Add each row's coefficient times g to the gradients."""
    normals, components, signs = program.normals, program.components, program.signs
    r = 0
    for i in range(1, stages + 1):
        for p in range(program.plane_count[i]):
            c = coefficients[r]
            state_rhs[i, 0] += c * normals[i, p, 0]
            state_rhs[i, 1] += c * normals[i, p, 1]
            state_rhs[i, 2] += c * normals[i, p, 2]
            r += 1
        for b in range(len(components)):
            state_rhs[i, components[b]] += coefficients[r] * signs[b]
            r += 1
    for i in range(stages):
        for k in range(control_rows):
            control_rhs[i, k] += coefficients[r]
            r += 1


@compiled_arithmetic
def _assemble_curvature(program, control_rows, stages, work):
    """H plus the rows' D g g' for every stage, its upper triangle, and the controls' diagonal."""
    curvatures, boxes = work.rows[CURVATURE], work.boxes[BOX_CURVATURE]
    h, diagonal = work.curvature, work.control_curvature
    normals, components = program.normals, program.components
    own, last = program.state_hessian, program.terminal_hessian
    r = 0
    for i in range(1, stages + 1):
        for j in range(STATES):
            for k in range(j, STATES):
                h[i, j, k] = last[j, k] if i == stages else own[j] if j == k else 0.0
        for p in range(program.plane_count[i]):
            d = curvatures[r]
            for j in range(3):
                dg = d * normals[i, p, j]
                for k in range(j, 3):
                    h[i, j, k] += dg * normals[i, p, k]
            r += 1
        for b in range(len(components)):
            h[i, components[b], components[b]] += curvatures[r]
            r += 1
    for i in range(stages):
        for k in range(CONTROLS):
            diagonal[i, k] = program.control_hessian[k] + boxes[CONTROLS * i + k]
        for k in range(control_rows):
            diagonal[i, k] += curvatures[r]
            r += 1


@compiled_arithmetic
def _model(transitions, i):
    """The entries of A of a stage that are not zero: in the orbit's plane, then out of it."""
    a = transitions[min(i, len(transitions) - 1)]
    return (
        a[0, 0], a[0, 1], a[0, 3], a[0, 4],
        a[1, 0], a[1, 1], a[1, 3], a[1, 4],
        a[3, 0], a[3, 1], a[3, 3], a[3, 4],
        a[4, 0], a[4, 1], a[4, 3], a[4, 4],
        a[2, 2], a[2, 5], a[5, 2], a[5, 5],
    )  # fmt: skip


@compiled_arithmetic
def _factor(transitions, stages, work):
    """Riccati recursion: gains and inverses of every stage.

    Written out in scalars, which stay in registers: motion in the orbit's plane (x, y, vx, vy) and
    out of it (z, vz) do not mix in A, but do in the cost-to-go P. For each stage M = A'PA, then
    the controls' part of M plus their own curvature is inverted.
    """
    curvature, curved = work.curvature, work.control_curvature
    inverses, gains = work.inverses, work.gains
    pxx, pxy, pxz = curvature[stages, 0, 0], curvature[stages, 0, 1], curvature[stages, 0, 2]
    pxu, pxv, pxw = curvature[stages, 0, 3], curvature[stages, 0, 4], curvature[stages, 0, 5]
    pyy, pyz, pyu = curvature[stages, 1, 1], curvature[stages, 1, 2], curvature[stages, 1, 3]
    pyv, pyw, pzz = curvature[stages, 1, 4], curvature[stages, 1, 5], curvature[stages, 2, 2]
    pzu, pzv, pzw = curvature[stages, 2, 3], curvature[stages, 2, 4], curvature[stages, 2, 5]
    puu, puv, puw = curvature[stages, 3, 3], curvature[stages, 3, 4], curvature[stages, 3, 5]
    pvv, pvw, pww = curvature[stages, 4, 4], curvature[stages, 4, 5], curvature[stages, 5, 5]
    for i in range(stages - 1, -1, -1):
        (
            axx, axy, axu, axv, ayx, ayy, ayu, ayv, aux, auy, auu, auv, avx, avy, avu, avv,
            azz, azw, awz, aww,
        ) = _model(transitions, i)  # fmt: skip
        # W = P A, row by row, for the columns that M's upper triangle needs
        wxx = pxx * axx + pxy * ayx + pxu * aux + pxv * avx
        wyx = pxy * axx + pyy * ayx + pyu * aux + pyv * avx
        wux = pxu * axx + pyu * ayx + puu * aux + puv * avx
        wvx = pxv * axx + pyv * ayx + puv * aux + pvv * avx
        wxy = pxx * axy + pxy * ayy + pxu * auy + pxv * avy
        wyy = pxy * axy + pyy * ayy + pyu * auy + pyv * avy
        wuy = pxu * axy + pyu * ayy + puu * auy + puv * avy
        wvy = pxv * axy + pyv * ayy + puv * auy + pvv * avy
        wxu = pxx * axu + pxy * ayu + pxu * auu + pxv * avu
        wyu = pxy * axu + pyy * ayu + pyu * auu + pyv * avu
        wuu = pxu * axu + pyu * ayu + puu * auu + puv * avu
        wvu = pxv * axu + pyv * ayu + puv * auu + pvv * avu
        wxv = pxx * axv + pxy * ayv + pxu * auv + pxv * avv
        wyv = pxy * axv + pyy * ayv + pyu * auv + pyv * avv
        wuv = pxu * axv + pyu * ayv + puu * auv + puv * avv
        wvv = pxv * axv + pyv * ayv + puv * auv + pvv * avv
        wxz, wxw = pxz * azz + pxw * awz, pxz * azw + pxw * aww
        wyz, wyw = pyz * azz + pyw * awz, pyz * azw + pyw * aww
        wuz, wuw = pzu * azz + puw * awz, pzu * azw + puw * aww
        wvz, wvw = pzv * azz + pvw * awz, pzv * azw + pvw * aww
        wzz, wzw = pzz * azz + pzw * awz, pzz * azw + pzw * aww
        wwz, www = pzw * azz + pww * awz, pzw * azw + pww * aww
        # M = A' W
        mxx = axx * wxx + ayx * wyx + aux * wux + avx * wvx
        mxy = axx * wxy + ayx * wyy + aux * wuy + avx * wvy
        mxz = axx * wxz + ayx * wyz + aux * wuz + avx * wvz
        mxu = axx * wxu + ayx * wyu + aux * wuu + avx * wvu
        mxv = axx * wxv + ayx * wyv + aux * wuv + avx * wvv
        mxw = axx * wxw + ayx * wyw + aux * wuw + avx * wvw
        myy = axy * wxy + ayy * wyy + auy * wuy + avy * wvy
        myz = axy * wxz + ayy * wyz + auy * wuz + avy * wvz
        myu = axy * wxu + ayy * wyu + auy * wuu + avy * wvu
        myv = axy * wxv + ayy * wyv + auy * wuv + avy * wvv
        myw = axy * wxw + ayy * wyw + auy * wuw + avy * wvw
        mzz = azz * wzz + awz * wwz
        muz = axu * wxz + ayu * wyz + auu * wuz + avu * wvz
        mvz = axv * wxz + ayv * wyz + auv * wuz + avv * wvz
        mzw = azz * wzw + awz * www
        muu = axu * wxu + ayu * wyu + auu * wuu + avu * wvu
        muv = axu * wxv + ayu * wyv + auu * wuv + avu * wvv
        muw = axu * wxw + ayu * wyw + auu * wuw + avu * wvw
        mvv = axv * wxv + ayv * wyv + auv * wuv + avv * wvv
        mvw = axv * wxw + ayv * wyw + auv * wuw + avv * wvw
        mww = azw * wzw + aww * www
        # inverse of the controls' part through its factors L D L'
        d0 = 1.0 / (muu + curved[i, 0])
        l10, l20 = muv * d0, muw * d0
        d1 = 1.0 / (mvv + curved[i, 1] - l10 * muv)
        e21 = mvw - l20 * muv
        l21 = e21 * d1
        d2 = 1.0 / (mww + curved[i, 2] - l20 * muw - l21 * e21)
        r20 = l10 * l21 - l20
        i00 = d0 + l10 * l10 * d1 + r20 * r20 * d2
        i01 = -l10 * d1 - r20 * l21 * d2
        i02 = r20 * d2
        i11 = d1 + l21 * l21 * d2
        i12 = -l21 * d2
        inverses[i, 0], inverses[i, 1], inverses[i, 2] = i00, i01, i02
        inverses[i, 3], inverses[i, 4], inverses[i, 5] = i11, i12, d2
        kux, kvx, kwx = _column(i00, i01, i02, i11, i12, d2, mxu, mxv, mxw)
        kuy, kvy, kwy = _column(i00, i01, i02, i11, i12, d2, myu, myv, myw)
        kuz, kvz, kwz = _column(i00, i01, i02, i11, i12, d2, muz, mvz, mzw)
        kuu, kvu, kwu = _column(i00, i01, i02, i11, i12, d2, muu, muv, muw)
        kuv, kvv, kwv = _column(i00, i01, i02, i11, i12, d2, muv, mvv, mvw)
        kuw, kvw, kww = _column(i00, i01, i02, i11, i12, d2, muw, mvw, mww)
        gains[i, 0, 0], gains[i, 0, 1], gains[i, 0, 2] = kux, kuy, kuz
        gains[i, 0, 3], gains[i, 0, 4], gains[i, 0, 5] = kuu, kuv, kuw
        gains[i, 1, 0], gains[i, 1, 1], gains[i, 1, 2] = kvx, kvy, kvz
        gains[i, 1, 3], gains[i, 1, 4], gains[i, 1, 5] = kvu, kvv, kvw
        gains[i, 2, 0], gains[i, 2, 1], gains[i, 2, 2] = kwx, kwy, kwz
        gains[i, 2, 3], gains[i, 2, 4], gains[i, 2, 5] = kwu, kwv, kww
        # P of the stage: its own curvature, M and what the controls take off
        pxx = curvature[i, 0, 0] + mxx + mxu * kux + mxv * kvx + mxw * kwx
        pxy = curvature[i, 0, 1] + mxy + mxu * kuy + mxv * kvy + mxw * kwy
        pxz = curvature[i, 0, 2] + mxz + mxu * kuz + mxv * kvz + mxw * kwz
        pxu = curvature[i, 0, 3] + mxu + mxu * kuu + mxv * kvu + mxw * kwu
        pxv = curvature[i, 0, 4] + mxv + mxu * kuv + mxv * kvv + mxw * kwv
        pxw = curvature[i, 0, 5] + mxw + mxu * kuw + mxv * kvw + mxw * kww
        pyy = curvature[i, 1, 1] + myy + myu * kuy + myv * kvy + myw * kwy
        pyz = curvature[i, 1, 2] + myz + myu * kuz + myv * kvz + myw * kwz
        pyu = curvature[i, 1, 3] + myu + myu * kuu + myv * kvu + myw * kwu
        pyv = curvature[i, 1, 4] + myv + myu * kuv + myv * kvv + myw * kwv
        pyw = curvature[i, 1, 5] + myw + myu * kuw + myv * kvw + myw * kww
        pzz = curvature[i, 2, 2] + mzz + muz * kuz + mvz * kvz + mzw * kwz
        pzu = curvature[i, 2, 3] + muz + muz * kuu + mvz * kvu + mzw * kwu
        pzv = curvature[i, 2, 4] + mvz + muz * kuv + mvz * kvv + mzw * kwv
        pzw = curvature[i, 2, 5] + mzw + muz * kuw + mvz * kvw + mzw * kww
        puu = curvature[i, 3, 3] + muu + muu * kuu + muv * kvu + muw * kwu
        puv = curvature[i, 3, 4] + muv + muu * kuv + muv * kvv + muw * kwv
        puw = curvature[i, 3, 5] + muw + muu * kuw + muv * kvw + muw * kww
        pvv = curvature[i, 4, 4] + mvv + muv * kuv + mvv * kvv + mvw * kwv
        pvw = curvature[i, 4, 5] + mvw + muv * kuw + mvv * kvw + mvw * kww
        pww = curvature[i, 5, 5] + mww + muw * kuw + mvw * kvw + mww * kww


@compiled_arithmetic
def _column(i00, i01, i02, i11, i12, i22, x, y, z):
    """Minus the symmetric inverse times one column."""
    return (
        -(i00 * x + i01 * y + i02 * z),
        -(i01 * x + i11 * y + i12 * z),
        -(i02 * x + i12 * y + i22 * z),
    )


@compiled_arithmetic
def _step(transitions, stages, work):
    """Newton step of states and controls for the gradients in the workspace."""
    rhs, control_rhs, feedforward = work.state_rhs, work.control_rhs, work.feedforward
    inverses, gains = work.inverses, work.gains
    px, py, pz = rhs[stages, 0], rhs[stages, 1], rhs[stages, 2]
    pu, pv, pw = rhs[stages, 3], rhs[stages, 4], rhs[stages, 5]
    for i in range(stages - 1, -1, -1):
        (
            axx, axy, axu, axv, ayx, ayy, ayu, ayv, aux, auy, auu, auv, avx, avy, avu, avv,
            azz, azw, awz, aww,
        ) = _model(transitions, i)  # fmt: skip
        mx = axx * px + ayx * py + aux * pu + avx * pv
        my = axy * px + ayy * py + auy * pu + avy * pv
        mu = axu * px + ayu * py + auu * pu + avu * pv
        mv = axv * px + ayv * py + auv * pu + avv * pv
        mz, mw = azz * pz + awz * pw, azw * pz + aww * pw
        x, y, z = control_rhs[i, 0] + mu, control_rhs[i, 1] + mv, control_rhs[i, 2] + mw
        feedforward[i, 0] = -(inverses[i, 0] * x + inverses[i, 1] * y + inverses[i, 2] * z)
        feedforward[i, 1] = -(inverses[i, 1] * x + inverses[i, 3] * y + inverses[i, 4] * z)
        feedforward[i, 2] = -(inverses[i, 2] * x + inverses[i, 4] * y + inverses[i, 5] * z)
        px = rhs[i, 0] + mx + gains[i, 0, 0] * x + gains[i, 1, 0] * y + gains[i, 2, 0] * z
        py = rhs[i, 1] + my + gains[i, 0, 1] * x + gains[i, 1, 1] * y + gains[i, 2, 1] * z
        pz = rhs[i, 2] + mz + gains[i, 0, 2] * x + gains[i, 1, 2] * y + gains[i, 2, 2] * z
        pu = rhs[i, 3] + mu + gains[i, 0, 3] * x + gains[i, 1, 3] * y + gains[i, 2, 3] * z
        pv = rhs[i, 4] + mv + gains[i, 0, 4] * x + gains[i, 1, 4] * y + gains[i, 2, 4] * z
        pw = rhs[i, 5] + mw + gains[i, 0, 5] * x + gains[i, 1, 5] * y + gains[i, 2, 5] * z
    dx, du = work.state_steps, work.control_steps
    x, y, z, u, v, w = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(stages):
        for j in range(CONTROLS):
            du[i, j] = (
                feedforward[i, j]
                + (gains[i, j, 0] * x + gains[i, j, 1] * y + gains[i, j, 2] * z)
                + (gains[i, j, 3] * u + gains[i, j, 4] * v + gains[i, j, 5] * w)
            )
        u += du[i, 0]
        v += du[i, 1]
        w += du[i, 2]
        (
            axx, axy, axu, axv, ayx, ayy, ayu, ayv, aux, auy, auu, auv, avx, avy, avu, avv,
            azz, azw, awz, aww,
        ) = _model(transitions, i)  # fmt: skip
        nx = axx * x + axy * y + axu * u + axv * v
        ny = ayx * x + ayy * y + ayu * u + ayv * v
        nu = aux * x + auy * y + auu * u + auv * v
        nv = avx * x + avy * y + avu * u + avv * v
        z, w = azz * z + azw * w, awz * z + aww * w
        x, y, u, v = nx, ny, nu, nv
        dx[i + 1, 0], dx[i + 1, 1], dx[i + 1, 2] = x, y, z
        dx[i + 1, 3], dx[i + 1, 4], dx[i + 1, 5] = u, v, w


@compiled_arithmetic
def _largest_control_gradient(transitions, stages, work):
    """Largest component of the gradient in the controls, for the gradients in the workspace."""
    costate, mapped = work.state_steps[0], work.state_steps[1]  # written before they are read
    for k in range(STATES):
        costate[k] = work.state_rhs[stages, k]
    largest = 0.0
    for i in range(stages - 1, -1, -1):
        a = transitions[min(i, len(transitions) - 1)]
        for k in range(STATES):
            total = 0.0
            for m in range(STATES):
                total += a[m, k] * costate[m]
            mapped[k] = total
        for k in range(CONTROLS):
            largest = larger(largest, size(work.control_rhs[i, k] + mapped[3 + k]))
        for k in range(STATES):
            costate[k] = work.state_rhs[i, k] + mapped[k]
    return largest


@compiled
def solve(program, stages, start, work, tolerance, iteration_limit):
    """Solve one program.

    Parameters
    ----------
    program, stages, start
        The problem, its number of stages and the state that it starts from, (6,).
    work
        Memory of the method, see `workspace`; nothing in it is read before it is written.
    tolerance
        Tolerance of the complementarity and of the stationarity, relative to the largest gradient
        in a control where no control acts.
    iteration_limit
        Largest number of steps.

    Returns
    -------
    Solution
    """
    control_rows = CONTROLS if program.control_norm[0] > 0.0 else 0
    status, iterations, rows = _solve(
        program, control_rows, stages, start, work, tolerance, iteration_limit
    )
    return Solution(
        int(status),
        int(iterations),
        work.controls[:stages],
        work.rows[WEIGHT, :rows],
        work.rows[EXCESS, :rows],
    )


@compiled_arithmetic
def solve_together(program, stages, starts, work, tolerance, iteration_limit, ends):
    """Solve as many programs as there are lanes, each to the bit as `solve` would alone.

    They have the stages and kinds of rows in common.

    Parameters
    ----------
    program, starts, work
        As for `solve`, every array of floats with a last axis more, of the programs.
    ends
        Filled with status and iterations, (2, LANES).

    Returns
    -------
    int
        Number of rows on states.
    """
    control_rows = CONTROLS if program.control_norm[0, 0] > 0.0 else 0
    status, iterations, rows = _solve(
        Program(
            as_lanes(program.transitions),
            as_lanes(program.state_hessian),
            as_lanes(program.terminal_hessian),
            as_lanes(program.state_gradient),
            as_lanes(program.control_hessian),
            as_lanes(program.control_norm),
            program.plane_count,
            as_lanes(program.normals),
            as_lanes(program.offsets),
            as_lanes(program.plane_weights),
            program.components,
            program.signs,
            as_lanes(program.bounds),
            as_lanes(program.bound_weights),
        ),
        control_rows,
        stages,
        as_lanes(starts),
        Workspace(
            as_lanes(work.states),
            as_lanes(work.controls),
            as_lanes(work.state_steps),
            as_lanes(work.control_steps),
            as_lanes(work.boxes),
            as_lanes(work.rows),
            as_lanes(work.curvature),
            as_lanes(work.state_rhs),
            as_lanes(work.control_rhs),
            as_lanes(work.control_curvature),
            as_lanes(work.gains),
            as_lanes(work.inverses),
            as_lanes(work.feedforward),
        ),
        tolerance,
        iteration_limit,
    )
    found = as_lanes(ends)
    found[0], found[1] = status, iterations
    return rows


@compiled_arithmetic
def _solve(program, control_rows, stages, start, work, tolerance, iteration_limit):
    """Solve a program, or one in each lane; return status, iterations, number of rows on states."""
    transitions = program.transitions
    x, u, dx, du = work.states, work.controls, work.state_steps, work.control_steps
    rows, boxes = work.rows, work.boxes
    limits, weights, values = rows[LIMIT], rows[WEIGHT], rows[VALUE]
    t, s, y = rows[SLACK], rows[EXCESS], rows[MULTIPLIER]
    dt, ds, dy = rows[SLACK_STEP], rows[EXCESS_STEP], rows[MULTIPLIER_STEP]
    curvature, push, moved = rows[CURVATURE], rows[PUSH], rows[VALUE_STEP]
    above, below, upper, lower = boxes[ABOVE], boxes[BELOW], boxes[UPPER], boxes[LOWER]
    dupper, dlower = boxes[UPPER_STEP], boxes[LOWER_STEP]
    by_above, by_below, curved = boxes[BY_ABOVE], boxes[BY_BELOW], boxes[BOX_CURVATURE]
    v, dv, push_control = u.reshape(-1), du.reshape(-1), work.control_rhs.reshape(-1)

    controls = CONTROLS * stages
    for j in range(controls):
        v[j] = 0.0
    roll_out(transitions, start, u, stages, x)
    on_states = _list_rows(program, control_rows, stages, limits, weights)
    count = _gather(program, control_rows, stages, x, u, values)
    _objective_gradient(program, stages, work)
    scale = larger(_largest_control_gradient(transitions, stages, work), 1e-300)
    mu = scale
    _start_rows(count, rows, mu)
    for c in range(controls):
        above[c], below[c] = 1.0, 1.0
        upper[c], lower[c] = mu, mu
    pairs = 2.0 * (count + controls)
    mu *= 2.0 * controls
    for r in range(count):
        mu += y[r] * t[r] + (weights[r] - y[r]) * s[r]
    mu /= pairs
    residual = 1.0

    goes, status, iterations = 1.0, 1.0 * ITERATION_LIMIT, 0.0
    for _ in range(iteration_limit):
        solved = goes * at_most(mu, tolerance * scale) * at_most(residual, tolerance)
        status = where(solved, SOLVED, status)
        goes = goes - solved
        if not some(goes):
            break
        iterations += goes
        # predictor: complementarity is aimed at zero
        for r in range(count):
            free = weights[r] - y[r]
            d = y[r] * free / (t[r] * free + s[r] * y[r])
            curvature[r] = d
            push[r] = y[r] + d * (values[r] - limits[r])
        for c in range(controls):
            by_above[c] = 1.0 / above[c]
            by_below[c] = 1.0 / below[c]
            curved[c] = upper[c] * by_above[c] + lower[c] * by_below[c]
        _assemble_curvature(program, control_rows, stages, work)
        _factor(transitions, stages, work)
        _objective_gradient(program, stages, work)
        _scatter(program, control_rows, stages, push, work.state_rhs, work.control_rhs)
        _step(transitions, stages, work)
        _gather(program, control_rows, stages, dx, du, moved)
        # four maxima side by side, none of which waits for another
        first, second, third, fourth = 0.0, 0.0, 0.0, 0.0
        for r in range(count):
            step = curvature[r] * (moved[r] + values[r] - limits[r])
            by_multiplier, by_free = step / y[r], step / (weights[r] - y[r])
            dy[r] = step
            dt[r] = -t[r] - t[r] * by_multiplier
            ds[r] = -s[r] + s[r] * by_free
            first, second = larger(first, 1.0 + by_multiplier), larger(second, 1.0 - by_free)
            third, fourth = larger(third, -by_multiplier), larger(fourth, by_free)
        for c in range(controls):
            to_above, to_below = dv[c] * by_above[c], dv[c] * by_below[c]
            dupper[c] = upper[c] * (to_above - 1.0)
            dlower[c] = -lower[c] * (to_below + 1.0)
            first, second = larger(first, to_above), larger(second, -to_below)
            third, fourth = larger(third, 1.0 - to_above), larger(fourth, 1.0 + to_below)
        worst = larger(larger(first, second), larger(third, fourth))
        alpha = where(at_most(worst, 1.0), 1.0, 1.0 / worst)
        after = 0.0
        for r in range(count):
            yn = y[r] + alpha * dy[r]
            after += yn * (t[r] + alpha * dt[r]) + (weights[r] - yn) * (s[r] + alpha * ds[r])
        for c in range(controls):
            step = alpha * dv[c]
            after += (upper[c] + alpha * dupper[c]) * (above[c] - step)
            after += (lower[c] + alpha * dlower[c]) * (below[c] + step)
        after /= pairs
        target = after * (after / mu) * (after / mu)

        # corrector: aimed at the target, with the products of the predictor's steps
        for r in range(count):
            free = weights[r] - y[r]
            ct = target - y[r] * t[r] - dy[r] * dt[r]
            cs = target - free * s[r] + dy[r] * ds[r]
            rest = values[r] + t[r] - s[r] - limits[r] + ct / y[r] - cs / free
            dt[r] = ct
            ds[r] = cs
            dy[r] = curvature[r] * rest
            push[r] = y[r] + dy[r] - push[r]
        _scatter(program, control_rows, stages, push, work.state_rhs, work.control_rhs)
        for c in range(controls):
            cu = target + dupper[c] * dv[c]
            cl = target - dlower[c] * dv[c]
            push_control[c] += cu * by_above[c] - cl * by_below[c]
            dupper[c] = cu * by_above[c] - upper[c]
            dlower[c] = cl * by_below[c] - lower[c]
        _step(transitions, stages, work)
        _gather(program, control_rows, stages, dx, du, moved)
        first, second, third, fourth = 0.0, 0.0, 0.0, 0.0
        for r in range(count):
            step = dy[r] + curvature[r] * moved[r]
            by_multiplier, by_free = 1.0 / y[r], 1.0 / (weights[r] - y[r])
            dy[r] = step
            dt[r] = (dt[r] - t[r] * step) * by_multiplier
            ds[r] = (ds[r] + s[r] * step) * by_free
            first, second = larger(first, -dt[r] / t[r]), larger(second, -ds[r] / s[r])
            third, fourth = larger(third, -step * by_multiplier), larger(fourth, step * by_free)
        for c in range(controls):
            to_above, to_below = dv[c] * by_above[c], dv[c] * by_below[c]
            dupper[c] += upper[c] * to_above
            dlower[c] -= lower[c] * to_below
            first, second = larger(first, to_above), larger(second, -to_below)
            third, fourth = (
                larger(third, -dupper[c] / upper[c]),
                larger(fourth, -dlower[c] / lower[c]),
            )
        worst = larger(larger(first, second), larger(third, fourth))
        alpha = where(at_most(worst, BOUNDARY), 1.0, BOUNDARY / worst)
        # what is done stays where it is, whatever its step would be
        mu = 0.0
        for r in range(count):
            t[r] += where(goes, alpha * dt[r], 0.0)
            s[r] += where(goes, alpha * ds[r], 0.0)
            y[r] += where(goes, alpha * dy[r], 0.0)
            mu += y[r] * t[r] + (weights[r] - y[r]) * s[r]
        for c in range(controls):
            step = where(goes, alpha * dv[c], 0.0)
            v[c] += step
            above[c] -= step
            below[c] += step
            upper[c] += where(goes, alpha * dupper[c], 0.0)
            lower[c] += where(goes, alpha * dlower[c], 0.0)
            mu += upper[c] * above[c] + lower[c] * below[c]
        mu /= pairs
        for i in range(1, stages + 1):
            for k in range(STATES):
                x[i, k] += where(goes, alpha * dx[i, k], 0.0)
        _gather(program, control_rows, stages, x, u, values)
        residual *= 1.0 - alpha
        finite = less(mu, np.inf)
        status = where(goes * (1.0 - finite), NUMERICAL, status)
        goes = goes * finite
    return status, iterations, on_states
