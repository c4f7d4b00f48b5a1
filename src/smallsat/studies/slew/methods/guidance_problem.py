"""The guidance problem: from rest to rest in least time, or with least torque in a given time.

Solved in units in which the numbers are of order one: time in units of the manoeuvre's duration T,
torque of the limit, momentum of limit times T. The state is the quaternion (4), the body rate times
T (3) and the momentum given by the wheels (3).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np

from smallsat.dynamics.attitude.quaternions import error_quaternion, product
from smallsat.dynamics.orbits.kepler_orbits import perifocal_frame
from smallsat.optimal_control.gauss_pseudospectral import (
    GaussPseudospectral,
    Mesh,
    OptimalControlProblem,
    Plan,
)
from smallsat.optimal_control.nonlinear_program import (
    MINIMUM_DEGREE,
    NEXT_TO_OPTIMUM,
    IpoptSolver,
    Solution,
)
from smallsat.studies.slew.parameters import Parameters

CONTROLS = 3
# Kepler's equation is solved by repeated substitution to this, rad: each step gains a factor e.
KEPLER_ERROR = 1e-13
# Of IPOPT, where a solution with more smoothing is the guess.
FOLLOWING = NEXT_TO_OPTIMUM | {"mu_init": 1e-5}


@dataclass(frozen=True)
class Model:
    """What the guidance knows of the spacecraft.

    Attributes
    ----------
    inertia
        Tensor, shape (3, 3), kg m^2.
    torque, momentum
        Limits of each wheel, N m and N m s.
    unit
        Unit of time, s.
    carried
        Whether the wheels' momentum takes part in the gyroscopic torque.
    parameters
        The orbit for the gravity gradient; without it there is none.
    stored
        Momentum that each wheel holds at the start, in shares of its limit.
    working
        Share of its torque that each wheel has: nil of one that failed.
    """

    inertia: np.ndarray
    torque: float
    momentum: float
    unit: float
    carried: bool = True
    parameters: Parameters | None = None
    stored: tuple[float, float, float] = (0.0, 0.0, 0.0)
    working: tuple[float, float, float] = (1.0, 1.0, 1.0)

    @property
    def start(self) -> np.ndarray:
        """Body rate and momentum given by the wheels at the start, scaled, shape (6,).

        What a wheel holds it has not given: it counts as given the other way.
        """
        limit = self.momentum / self.momentum_unit
        return np.r_[np.zeros(3), -limit * np.array(self.stored)]

    @property
    def momentum_unit(self) -> float:
        """N m s."""
        return self.torque * self.unit

    def rate(self, x: Any, u: Any, t: Any) -> Any:
        """Rate of the scaled state, symbolic."""
        q, w, h = x[:4], x[4:7], x[7:10]
        scaled = self.inertia / (self.torque * self.unit**2)
        momentum = ca.mtimes(ca.DM(scaled), w)
        if self.carried:
            momentum = momentum - h
        torque = u - ca.cross(w, momentum)
        if self.parameters is not None:
            torque = torque + self._gradient(q, t) / self.torque
        vector = 0.5 * (q[3] * w - ca.cross(w, q[:3]))
        acceleration = ca.mtimes(ca.DM(np.linalg.inv(scaled)), torque)
        return ca.vertcat(vector, -0.5 * ca.dot(w, q[:3]), acceleration, u)

    def in_body(self, q: Any, r: Any) -> Any:
        """Body components of an inertial vector, symbolic."""
        v, w = q[:3], q[3]
        return (w * w - ca.dot(v, v)) * r + 2.0 * ca.dot(v, r) * v - 2.0 * w * ca.cross(v, r)

    def _gradient(self, q: Any, t: Any) -> Any:
        """Gravity-gradient torque, N m, on the two-body orbit at a scaled time."""
        assert self.parameters is not None
        orbit, mu = self.parameters.orbit, self.parameters.gravity.mu
        a, e = orbit.semi_major_axis, orbit.eccentricity
        at_start = 2.0 * np.arctan(
            np.sqrt((1.0 - e) / (1.0 + e)) * np.tan(orbit.true_anomaly / 2.0)
        )
        mean = at_start - e * np.sin(at_start) + np.sqrt(mu / a**3) * self.unit * t
        anomaly = mean
        for _ in range(kepler_steps(e)):
            anomaly = mean + e * ca.sin(anomaly)
        frame = perifocal_frame(orbit)
        r = (ca.cos(anomaly) - e) * ca.DM(frame[0]) + np.sqrt(1.0 - e * e) * ca.sin(
            anomaly
        ) * ca.DM(frame[1])
        body = self.in_body(q, r)
        length = a * (1.0 - e * ca.cos(anomaly))
        factor = 3.0 * mu / length**3 / ca.dot(r, r)
        return factor * ca.cross(body, ca.mtimes(ca.DM(self.inertia), body))


def kepler_steps(eccentricity: float) -> int:
    """Substitutions that solve Kepler's equation to `KEPLER_ERROR`."""
    steps, error = 0, eccentricity
    while error > KEPLER_ERROR:
        steps, error = steps + 1, error * eccentricity
    return steps


def attitude_error(q: Any, target: np.ndarray) -> Any:
    """Vector part (3,) of the turn from the target to q, symbolic."""
    reverse = ca.DM(-np.asarray(target[:3]))
    return target[3] * q[:3] + q[3] * reverse + ca.cross(reverse, q[:3])


def _smoothed(u: Any, smoothing: Any) -> Any:
    return ca.sqrt(ca.dot(u, u) + smoothing**2) - smoothing


def problem(
    model: Model,
    initial: np.ndarray,
    target: np.ndarray,
    final_time: tuple[float, float],
    *,
    least_time: bool = False,
    soft: bool = False,
) -> OptimalControlProblem:
    """Least time, least torque, or (``soft``) the least miss of the end conditions.

    Parameters
    ----------
    model
        The spacecraft.
    initial, target
        Quaternions; both ends at rest.
    final_time
        Bounds, s; equal for a fixed time.
    least_time
        Minimise the final time instead of the integral of |u|.
    soft
        Minimise the squared attitude error, rad^2, plus the squared rate in units of 1/T, and leave
        the end free.

    Notes
    -----
    The one parameter is the smoothing s of |u|, which becomes sqrt(u'u + s^2) - s; of the least
    miss it is the factor of the rate in its sum, before it is squared.
    """
    limit = model.momentum / model.momentum_unit

    def terminal(x: Any, _: Any) -> Any:
        return ca.DM(0, 1) if soft else ca.vertcat(attitude_error(x[:4], target), x[4:7])

    def end_cost(x: Any, final: Any, p: Any) -> Any:
        if soft:
            # Four times the squared vector part is the squared angle of a small turn; with the
            # squared cosine it stays a measure of large ones.
            error = attitude_error(x[:4], target)
            return 4.0 * ca.dot(error, error) + p[0] ** 2 * ca.dot(x[4:7], x[4:7])
        return final if least_time else 0.0

    def running_cost(x: Any, u: Any, t: Any, p: Any) -> Any:
        if soft:
            return 1e-6 * ca.dot(u, u)
        return ca.SX(0.0) if least_time else _smoothed(u, p[0])

    free = np.full(7, np.inf)
    return OptimalControlProblem(
        initial=np.r_[initial, model.start],
        controls=CONTROLS,
        rate=lambda x, u, t, p: model.rate(x, u, t),
        running_cost=running_cost,
        terminal=terminal,
        end_cost=end_cost,
        state_bounds=np.array([np.r_[-free, np.full(3, -limit)], np.r_[free, np.full(3, limit)]]),
        control_bounds=np.array([-np.array(model.working), np.array(model.working)]),
        final_time=(final_time[0] / model.unit, final_time[1] / model.unit),
        parameters=1,
    )


Guess = tuple[float, Callable[[float], np.ndarray], Callable[[float], np.ndarray]]


def turning_guess(
    model: Model,
    initial: np.ndarray,
    target: np.ndarray,
    final_time: float,
    tilt: tuple[float, float] = (0.0, 0.0),
) -> Guess:
    """A smooth turn about the eigenaxis, s(t) = t^2 (3 - 2 t), tilted off it on the way.

    ``tilt`` holds the vector parts along the two axes normal to the eigenaxis, at half time.
    """
    start = tuple(initial)
    turn = np.array(error_quaternion(tuple(target), start))
    turn = turn if turn[3] >= 0 else -turn
    angle = 2.0 * np.arctan2(np.linalg.norm(turn[:3]), turn[3])
    axis = turn[:3] / np.linalg.norm(turn[:3])
    first = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    first /= np.linalg.norm(first)
    second = np.cross(axis, first)
    end = final_time / model.unit

    def attitude(t: float) -> tuple[float, ...]:
        s = t / end
        part = angle * s * s * (3.0 - 2.0 * s)
        along = (*(np.sin(part / 2) * axis), np.cos(part / 2))
        aside = np.sin(np.pi * s) * (tilt[0] * first + tilt[1] * second)
        size = np.sqrt(aside @ aside + 1.0)
        return product(product(start, (*(aside / size), 1.0 / size)), along)

    def state(t: float) -> np.ndarray:
        d = 1e-5 * end
        before, after = attitude(max(t - d, 0.0)), attitude(min(t + d, end))
        change = np.array(error_quaternion(after, before))
        rate = 2.0 * change[:3] / (min(t + d, end) - max(t - d, 0.0))
        scaled = model.inertia / (model.torque * model.unit**2)
        limit = model.momentum / model.momentum_unit
        return np.array([*attitude(t), *rate, *np.clip(scaled @ rate, -limit, limit)])

    def control(t: float) -> np.ndarray:
        d = 1e-3 * end
        low, high = max(t - d, 0.0), min(t + d, end)
        slope = (state(high)[7:] - state(low)[7:]) / (high - low)
        return np.clip(slope, -1.0, 1.0)

    return end, state, control


def tilts(starts: int, seed: int) -> list[tuple[float, float]]:
    """The eigenaxis itself, four turns off it, and random ones."""
    fixed = [(0.0, 0.0), (0.2, 0.0), (-0.2, 0.0), (0.0, 0.2), (0.0, -0.2)]
    random = np.random.default_rng(seed).uniform(-0.6, 0.6, size=(max(starts - len(fixed), 0), 2))
    return [*fixed, *[(float(a), float(b)) for a, b in random]][:starts]


@dataclass(frozen=True)
class Result:
    """One optimisation from one start.

    Attributes
    ----------
    plan
        In scaled units.
    solution
        Solution of the last stage; its status is that of the whole.
    seconds, iterations
        Sums over all stages.
    cost
        Integral of |u|, N m s, by the method's quadrature, without smoothing.
    duration
        s.
    hamiltonian
        At the points, scaled.
    """

    plan: Plan
    solution: Solution
    seconds: float
    iterations: int
    cost: float
    duration: float
    hamiltonian: np.ndarray


class Guidance:
    """A transcribed problem and its solver, for many starts."""

    def __init__(self, model: Model, stated: OptimalControlProblem, mesh: Mesh, **options: Any):
        self.model, self.method = model, GaussPseudospectral(stated, mesh)
        settings: dict[str, Any] = {
            "tol": 1e-9,
            "max_iter": 400,
            "mu_strategy": "adaptive",
            **MINIMUM_DEGREE,
        } | options
        self._settings = settings
        self._solver = IpoptSolver(self.method.program, **settings)

    @cached_property
    def _following_solver(self) -> IpoptSolver:
        program = replace(self.method.program, hessian=self._solver.hessian)
        settings: dict[str, Any] = self._settings | FOLLOWING
        return IpoptSolver(program, **settings)

    def solve(self, guess: Guess | np.ndarray, smoothing: Sequence[float]) -> Result:
        """Solve with ever less smoothing; each stage begins where the last one ended.

        ``smoothing`` holds the values of the problem's one parameter.
        """
        z = guess if isinstance(guess, np.ndarray) else self.method.guess(*guess)
        seconds, iterations = 0.0, 0
        for stage, value in enumerate(smoothing):
            # Where the shorter way leads nowhere, the usual one is gone.
            solvers = [self._following_solver, self._solver] if stage else [self._solver]
            for solver in solvers:
                solution = solver.solve(z, [value])
                seconds += solution.seconds
                iterations += solution.iterations
                if solution.converged:
                    break
            z = solution.variables
        plan = self.method.plan(z, solution.multipliers)
        weights = np.polynomial.legendre.leggauss(self.method.mesh.nodes)[1] / 2.0
        size = np.linalg.norm(plan.controls, axis=1).reshape(self.method.mesh.segments, -1)
        cost = float(np.sum(size @ weights)) / self.method.mesh.segments * plan.final_time
        return Result(
            plan=plan,
            solution=solution,
            seconds=seconds,
            iterations=iterations,
            cost=cost * self.model.momentum_unit,
            duration=plan.final_time * self.model.unit,
            hamiltonian=self.method.hamiltonian(plan, np.array([smoothing[-1]])),
        )
