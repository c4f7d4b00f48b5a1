"""The torque-optimal quarter turn: our pseudospectral solve, yapss, and dymos.

All three have the document's 20 points, the same bounds, end conditions and stages of less and less
smoothing, and the same first guess. What is judged is not what they say of themselves but the
torque that they found, flown anew.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from contender import Contender, Problem

from smallsat.config import default_config
from smallsat.dynamics.orbits.kepler_orbits import perifocal_frame
from smallsat.optimal_control.gauss_pseudospectral import Mesh
from smallsat.studies.slew.methods.flown import miss, propagate_held
from smallsat.studies.slew.methods.guidance_problem import FOLLOWING, Guidance, Model, kepler_steps
from smallsat.studies.slew.methods.plans import Slew, guidance_model, hold, slew_of
from smallsat.studies.slew.parameters import Parameters

ROOT = Path(__file__).parents[2]
SECTION = default_config(ROOT).slew
PARAMETERS = Parameters.from_section(SECTION)
NODES = SECTION.manoeuvre.quarter.nodes
MESH = Mesh(1, NODES)
# All but the last, in which yapss does not converge in 400 iterations.
SMOOTHING = SECTION.numerics.smoothing[:-1]
# Off the eigenaxis, where the optimum is.
TILT = (0.2, 0.0)
# A per cent of the cost, and 0.6 deg at the target, which a tracking law takes out.
REQUIRED = 1e-2
# Pieces in which a found torque is flown: its line between two points in 25 of them.
PIECES = 500
# Of the reference: with twice as many the cost falls by 1e-5.
HELD = 400
# Quaternion, body rate and momentum given by the wheels.
PARTS = {"q": 4, "w": 3, "h": 3}
STATES, CONTROLS = 10, 3

Torque = tuple[np.ndarray, np.ndarray]


def problem() -> Problem:
    """The quarter turn of the document."""
    slew = _slew()
    reference = _reference()

    def error(found: Torque) -> float:
        """The larger of the miss, rad, and of the relative difference of the costs."""
        times, torques = found
        at = (np.arange(PIECES) + 0.5) / PIECES
        held = np.column_stack([np.interp(at, times, axis) for axis in torques.T])
        start = slew.stated().initial
        flown = propagate_held(slew.model, start, np.full(PIECES, 1.0 / PIECES), held)
        cost = np.linalg.norm(held, axis=1).mean() * slew.model.momentum_unit
        return max(miss(slew.model, flown[-1], slew.target)[0], abs(cost / reference - 1.0))

    return Problem(
        "slew: the quarter turn of least torque, 20 points",
        "miss in rad of the torque flown by DOP853, or relative error of its cost against 400 held "
        "pieces, whichever is larger",
        REQUIRED,
        error,
        (
            Contender("Gauss pseudospectral, IPOPT", "smallsat", _ours),
            Contender("yapss, IPOPT", "yapss", _yapss),
            Contender("dymos Radau, SLSQP", "dymos", _dymos),
        ),
        3,
    )


def _slew(mesh: Mesh = MESH) -> Slew:
    return slew_of(guidance_model(PARAMETERS), PARAMETERS, "quarter", mesh)


def _reference() -> float:
    """Cost, N m s, of a control that is held over short pieces and reaches the target exactly."""
    turn = SECTION.manoeuvre.quarter
    slew = _slew(Mesh(turn.segments, turn.segment_nodes))
    plan = Guidance(slew.model, slew.stated(), slew.mesh).solve(slew.guess(TILT), SMOOTHING)
    found = hold(slew, plan, SECTION.numerics.model_copy(update={"held_intervals": HELD}))
    assert found.solution.converged and found.attitude_miss < REQUIRED / 1e3
    return found.cost


def _ours():
    slew = _slew()
    guidance = Guidance(slew.model, slew.stated(), slew.mesh)

    def solve() -> Torque:
        found = guidance.solve(slew.guess(TILT), SMOOTHING)
        assert found.solution.converged
        return found.plan.times, found.plan.controls

    return solve


def _yapss():
    from yapss import Problem as Stated

    slew = _slew()
    stated = slew.stated()
    end, state, control = slew.guess(TILT)
    ocp = Stated(name="slew", nx=[STATES], nu=[CONTROLS], nq=[1])
    stage = [SMOOTHING[0]]

    def objective(arg):
        arg.objective = arg.phase[0].integral[0]

    def continuous(arg):
        phase = arg.phase[0]
        phase.dynamics[:] = rate(slew.model, phase.state, phase.control, phase.time)
        phase.integrand[0] = smoothed(phase.control, stage[0])

    ocp.functions.objective, ocp.functions.continuous = objective, continuous
    bounds = ocp.bounds.phase[0]
    bounds.initial_time.lower = bounds.initial_time.upper = 0.0
    bounds.final_time.lower = bounds.final_time.upper = end
    bounds.initial_state.lower[:] = bounds.initial_state.upper[:] = stated.initial
    bounds.state.lower[:], bounds.state.upper[:] = stated.state_bounds
    # The scalar part follows from the other three.
    bounds.final_state.lower[:3] = bounds.final_state.upper[:3] = slew.target[:3]
    bounds.final_state.lower[4:7] = bounds.final_state.upper[4:7] = 0.0
    bounds.control.lower[:], bounds.control.upper[:] = stated.control_bounds
    ocp.mesh.phase[0].collocation_points = [NODES]
    ocp.mesh.phase[0].fraction = [1.0]
    ocp.spectral_method = "lg"
    ocp.derivatives.method, ocp.derivatives.order = "auto", "second"
    options = ocp.ipopt_options
    # As ours, but for the barrier: where it adapts, the last stage does not converge.
    options.print_level, options.tol, options.max_iter = 0, 1e-9, 400
    options.mu_strategy = "monotone"

    def solve() -> Torque:
        guess, times = ocp.guess.phase[0], np.linspace(0.0, end, 4 * NODES)
        guess.time = times
        guess.state = np.column_stack([state(t) for t in times])
        guess.control = np.column_stack([control(t) for t in times])
        for stage[0] in SMOOTHING:
            # As ours, a later stage begins next to the optimum of the one before; 0.1 is IPOPT's.
            options.mu_init = 0.1 if stage[0] == SMOOTHING[0] else FOLLOWING["mu_init"]
            solution = ocp.solve()
            assert solution.nlp_info.ipopt_status == 0
            phase = solution.phase[0]
            guess.time, guess.state = phase.time, phase.state
            guess.control = np.array(
                [np.interp(phase.time, phase.time_c, u) for u in phase.control]
            )
        return phase.time_c, phase.control.T

    return solve


def _dymos():
    import dymos
    import openmdao.api as om

    slew = _slew()
    end, state, control = slew.guess(TILT)
    limit = slew.model.momentum / slew.model.momentum_unit

    class Spacecraft(om.ExplicitComponent):
        """Rates at all points at once; their derivatives by complex steps, a colour at a time."""

        def initialize(self):
            self.options.declare("num_nodes", types=int)

        def setup(self):
            n = self.options["num_nodes"]
            for name, size in {**PARTS, "u": CONTROLS}.items():
                self.add_input(name, shape=(n, size))
            for name, size in PARTS.items():
                self.add_output(f"{name}_rate", shape=(n, size))
            self.add_input("t", shape=(n,))
            self.add_input("smoothing", shape=(1,))
            self.add_output("cost_rate", shape=(n,))
            self.declare_coloring([*PARTS, "u"], method="cs", show_summary=False)

        def compute(self, inputs, outputs):
            x, u = np.hstack([inputs[name] for name in PARTS]).T, inputs["u"].T
            rates = np.array(rate(slew.model, x, u, inputs["t"])).T
            for name, part in _parted(rates).items():
                outputs[f"{name}_rate"] = part
            outputs["cost_rate"] = smoothed(u, inputs["smoothing"])

    program = om.Problem(reports=False, work_dir=str(ROOT / ".cache/bench"))
    program.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-9, maxiter=400, disp=False)
    program.driver.declare_coloring(show_summary=False)
    transcription = dymos.Radau(num_segments=1, order=NODES, compressed=False)
    phase = dymos.Phase(ode_class=Spacecraft, transcription=transcription)
    trajectory = program.model.add_subsystem("trajectory", dymos.Trajectory())
    trajectory.add_phase("phase", phase)
    phase.set_time_options(units=None, fix_initial=True, fix_duration=True, targets=["t"])
    bounds = {"h": {"lower": -limit, "upper": limit}}
    for name in PARTS:
        phase.add_state(
            name,
            rate_source=f"{name}_rate",
            targets=[name],
            fix_initial=True,
            **bounds.get(name, {}),
        )
    phase.add_state("cost", rate_source="cost_rate", fix_initial=True)
    phase.add_control(
        "u", targets=["u"], lower=-1.0, upper=1.0, continuity=False, rate_continuity=False
    )
    phase.add_parameter("smoothing", targets=["smoothing"], opt=False, static_target=True)
    # The scalar part follows from the other three.
    phase.add_boundary_constraint("q", loc="final", indices=[0, 1, 2], equals=slew.target[:3])
    phase.add_boundary_constraint("w", loc="final", equals=np.zeros(3))
    phase.add_objective("cost", loc="final")
    program.setup(force_alloc_complex=True)

    def solve() -> Torque:
        times = np.linspace(0.0, end, 4 * NODES)
        phase.set_time_val(0.0, end)
        # The tilted guess turns already at the start, where dymos keeps what it is given.
        states = np.vstack([slew.stated().initial, *(state(t) for t in times[1:])])
        for name, part in _parted(states).items():
            phase.set_state_val(name, part, times)
        phase.set_state_val("cost", [0.0, 0.5])
        phase.set_control_val("u", np.array([control(t) for t in times]), times)
        for smoothing in SMOOTHING:
            phase.set_parameter_val("smoothing", smoothing)
            assert program.run_driver().success
        found = (program.get_val(f"trajectory.phase.timeseries.{name}") for name in ("time", "u"))
        # Its torque at the end is extrapolated, beyond the bounds.
        times, torques = (rows[:-1] for rows in found)
        return times.ravel(), torques

    return solve


def _parted(states: np.ndarray) -> dict[str, np.ndarray]:
    cuts = np.cumsum(list(PARTS.values()))[:-1]
    return dict(zip(PARTS, np.split(states, cuts, axis=1), strict=True))


def rate(model: Model, x: Sequence[Any], u: Sequence[Any], t: Any) -> list[Any]:
    """Rates of the ten states, as `Model.rate`, of whatever NumPy's functions take."""
    q, w, h = list(x[:3]), list(x[4:7]), list(x[7:10])
    scalar = x[3]
    scaled = model.inertia / (model.torque * model.unit**2)
    momentum = [a - b for a, b in zip(_times(scaled, w), h, strict=True)]
    orbit = model.parameters.orbit
    mu, e, a = model.parameters.gravity.mu, orbit.eccentricity, orbit.semi_major_axis
    start = 2.0 * np.arctan(np.sqrt((1.0 - e) / (1.0 + e)) * np.tan(orbit.true_anomaly / 2.0))
    mean = start - e * np.sin(start) + np.sqrt(mu / a**3) * model.unit * t
    anomaly = mean
    for _ in range(kepler_steps(e)):
        anomaly = mean + e * np.sin(anomaly)
    # The direction of the Earth, turned into the body.
    c, s = np.cos(anomaly), np.sin(anomaly)
    along, across, _ = perifocal_frame(orbit)
    length = 1.0 - e * c
    r = [
        ((c - e) * p + np.sqrt(1.0 - e * e) * s * p2) / length
        for p, p2 in zip(along, across, strict=True)
    ]
    square, dot = scalar * scalar - _dot(q, q), 2.0 * _dot(q, r)
    body = [
        square * r[i] + dot * q[i] - 2.0 * scalar * turned for i, turned in enumerate(_cross(q, r))
    ]
    factor = 3.0 * mu / (a * length) ** 3 / model.torque
    pull = _cross(body, _times(model.inertia, body))
    gyroscopic = _cross(w, momentum)
    torque = [u[i] - gyroscopic[i] + factor * pull[i] for i in range(3)]
    vector = [0.5 * (scalar * w[i] - turned) for i, turned in enumerate(_cross(w, q))]
    return [*vector, -0.5 * _dot(w, q), *_times(np.linalg.inv(scaled), torque), *u]


def smoothed(u: Sequence[Any], smoothing: Any) -> Any:
    """The integrand of the cost, which nears |u|."""
    return np.sqrt(_dot(u, u) + smoothing**2) - smoothing


def _dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def _times(matrix: np.ndarray, vector: Sequence[Any]) -> list[Any]:
    return [_dot(row.tolist(), vector) for row in matrix]
