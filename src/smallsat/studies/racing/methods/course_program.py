"""Minimum time through rings as one nonlinear program with a phase a segment.

The control is held over equal pieces of a segment, and the segment is flown in closed form, so that
the program's trajectory is exact and any integrator can fly it anew. A ring is crossed at its
centre along its normal by construction: the state there is the centre, and the normal times a
speed, which is a variable. Units are scaled: lengths by the power of ten below the longest way,
100 m on the document's courses, times by sqrt(length / thrust).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import casadi as ca
import numpy as np

from smallsat.dynamics.orbits.clohessy_wiltshire import held_input_rows, transition, transition_rows
from smallsat.optimal_control.nonlinear_program import (
    MINIMUM_DEGREE,
    NEXT_TO_OPTIMUM,
    IpoptSolver,
    NonlinearProgram,
    Solution,
)
from smallsat.studies.racing.model.cubesat import CubeSat

# Lowest ring speed, scaled: the direction of a velocity of zero is undefined.
LEAST_SPEED = 1e-3
# Segments last between these, in units of the time of free acceleration over their length.
SHORTEST, LONGEST = 1e-4, 20.0
# Squared norm of a scaled control: of a ball, and of a box, where it is never reached.
BALL, BOX = 1.0, 4.0
GUESS_THRUST = 0.9


def length_unit(places: np.ndarray, speed: float = 0.0, thrust: float = 1.0) -> float:
    """Power of ten below the longest way of a leg, m.

    That is the largest distance between neighbours of its places (k, 3), m, or the way in which a
    thrust, m/s^2, brings a speed, m/s, to rest: who comes fast to a near ring has far to go.
    """
    gaps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    return float(10.0 ** np.floor(np.log10(max(gaps.max(), speed**2 / (2.0 * thrust)))))


Finish = Literal["ring", "state", "rest anywhere"]


@dataclass(frozen=True)
class Leg:
    """What is to be flown: from a state through rings to a finish. SI units.

    Attributes
    ----------
    position, velocity
        At the start, (3,).
    centres, normals
        Centres and normals of the rings to cross, (l, 3).
    end_position, end_velocity
        Where to finish, (3,); of a finish "rest anywhere" only the position is used, as a guess.
    weight
        What a metre off a ring's centre costs, s/m, where the program lets rings be missed; the
        document's own if nothing is said (Eq. 6).
    """

    position: np.ndarray
    velocity: np.ndarray
    centres: np.ndarray
    normals: np.ndarray
    end_position: np.ndarray
    end_velocity: np.ndarray
    weight: float = 1.0


@dataclass(frozen=True)
class Arcs:
    """A first guess: ring speeds and durations over a distance of 1, scaled; numbers or arrays."""

    speed: Any = 0.6
    time: Any = 2.2


@dataclass(frozen=True)
class Symbols:
    """What a kind of program makes its nodes of, scaled CasADi expressions.

    Attributes
    ----------
    times, speeds
        Durations of the segments (m,) and speeds at the rings (l,).
    own
        Variables (d, l) of the rings that this kind of program alone has.
    centres, normals, end
        Of the rings (3, l), and the state at a given finish (6,).
    mean_motion, weight
        Of the orbit, and of a miss.
    """

    times: Any
    speeds: Any
    own: Any
    centres: Any
    normals: Any
    end: Any
    mean_motion: Any
    weight: Any


@dataclass(frozen=True)
class Plan:
    """A solution in SI units.

    Attributes
    ----------
    durations
        Durations of the segments, (m,), s.
    starts
        State at the start of each segment (m, 6).
    controls
        Held accelerations (m, N, 3), m/s^2.
    costates
        At the start of each segment (m, 6): the rate of the least time with the state there, s/m
        and s/(m/s).
    final
        State at the end (6,).
    solution
        What the solver says.
    tried
        The ways to it that were tried, in order, where there were several.
    """

    durations: np.ndarray
    starts: np.ndarray
    controls: np.ndarray
    costates: np.ndarray
    final: np.ndarray
    solution: Solution
    tried: tuple[str, ...] = ()

    @property
    def time(self) -> float:
        """Total time, s."""
        return float(self.durations.sum())

    @property
    def delta_v(self) -> float:
        """What the thrust adds up to, m/s."""
        pieces = self.durations / self.controls.shape[1]
        return float(pieces @ np.linalg.norm(self.controls, axis=2).sum(axis=1))

    @property
    def converged(self) -> bool:
        """Whether the solver says so."""
        return self.solution.converged

    @property
    def ends(self) -> np.ndarray:
        """State at the end of each segment (m, 6)."""
        return np.vstack([self.starts[1:], self.final])


class CourseProgram:
    """The program for a number of rings, with the course and the CubeSat as parameters.

    Parameters
    ----------
    rings
        Number of rings to cross.
    finish
        ``ring``: the last ring is the finish. ``state``: a segment more, to a given state, such as
        rest at the end ring. ``rest anywhere``: a segment more, to rest at a free place.
    intervals
        Held controls in a segment.

    Another kind of program says how many variables of its own a ring has (``own_variables``), where
    they begin, what states they make with the others, what they cost, and what has to vanish.
    """

    own_variables = 0

    def __init__(self, rings: int, finish: Finish, intervals: int):
        self.rings, self.finish, self.intervals = rings, finish, intervals
        self.segments = rings + (finish != "ring")

    def nodes(self, of: Symbols) -> list[Any]:
        """States (6,) at the rings, and at a finish that is given."""
        rings = [
            ca.vertcat(of.centres[:, k], of.speeds[k] * of.normals[:, k]) for k in range(self.rings)
        ]
        return [*rings, of.end] if self.finish == "state" else rings

    def cost(self, of: Symbols) -> Any:
        """What is minimised, scaled: the time."""
        return ca.sum1(of.times)

    def own_guess(self, durations: np.ndarray, offsets: np.ndarray) -> np.ndarray:
        """First guess (l, d) of them, from durations (m,) and offsets (l, 3) of a guess, scaled."""
        return np.empty((self.rings, 0))

    def restrictions(self, of: Symbols) -> Any:
        """What has to vanish beside the gaps between segments: nothing."""
        return ca.MX(0, 1)

    def solve(
        self,
        leg: Leg,
        cubesat: CubeSat,
        mean_motion: float,
        guess: Plan | None = None,
        arcs: Arcs | None = None,
    ) -> Plan:
        """Solve for a leg; without a guess from smooth arcs through the ring centres.

        A CubeSat with thrust limits axis by axis is solved within the ball inside its box first.
        """
        limits = np.array(cubesat.axis_thrust) if cubesat.axis_thrust else None
        if limits is not None and guess is None:
            guess = self._solve(leg, np.full(3, limits.min()), BALL, mean_motion, None, arcs)
        if limits is not None:
            return self._solve(leg, limits, BOX, mean_motion, guess, arcs)
        return self._solve(leg, np.full(3, cubesat.thrust), BALL, mean_motion, guess, arcs)

    def refine(self, leg: Leg, cubesat: CubeSat, mean_motion: float, coarser: Plan) -> Plan:
        """Solve for a leg from the optimum of a coarser mesh, close to this one's."""
        box = cubesat.axis_thrust
        limits = np.array(box) if box else np.full(3, cubesat.thrust)
        bound = BOX if box else BALL
        return self._solve(leg, limits, bound, mean_motion, coarser, None, self._refining_solver)

    def _solve(
        self,
        leg: Leg,
        limits: np.ndarray,
        bound: float,
        mean_motion: float,
        guess: Plan | None,
        arcs: Arcs | None,
        solver: IpoptSolver | None = None,
    ) -> Plan:
        thrust = float(limits.max())
        places = np.vstack([leg.position, leg.centres, leg.end_position])[: self.segments + 1]
        speed = max(float(np.linalg.norm(v)) for v in (leg.velocity, leg.end_velocity))
        unit = _Units(thrust, mean_motion, length_unit(places, speed, thrust))
        scaled = unit.leg(leg)
        parameters = np.concatenate(
            [
                scaled.position,
                scaled.velocity,
                scaled.centres.ravel(),
                scaled.normals.ravel(),
                scaled.end_position,
                scaled.end_velocity,
                limits / thrust,
                [unit.mean_motion, bound],
                [unit.weight(leg.weight)],
            ]
        )
        durations, speeds, controls, final, offsets = (
            self._smooth(scaled, arcs or Arcs())
            if guess is None
            else self._restart(guess, scaled, limits, unit)
        )
        slack = np.maximum(bound - np.sum(controls**2, axis=2), 0.0)
        free = final if self.finish == "rest anywhere" else np.empty(0)
        own = self.own_guess(durations, offsets)
        parts = (durations, speeds, controls, slack, own, free)
        variables = np.concatenate([np.ravel(part) for part in parts])
        solution = (solver or self._solver).solve(variables, parameters.tolist())
        return self._plan(solution, parameters, limits, unit)

    @cached_property
    def _solver(self) -> IpoptSolver:
        return self._ipopt(mu_strategy="adaptive")

    @cached_property
    def _refining_solver(self) -> IpoptSolver:
        return self._ipopt(mu_init=1e-6, **NEXT_TO_OPTIMUM)

    def _ipopt(self, **barrier: Any) -> IpoptSolver:
        # Steps are refined where their residual asks for it alone.
        linear_algebra = MINIMUM_DEGREE | {"min_refinement_steps": 0}
        return IpoptSolver(
            self._program[0], expand=True, tol=1e-9, max_iter=150, **linear_algebra, **barrier
        )

    @cached_property
    def _program(self) -> tuple[NonlinearProgram, ca.Function]:
        """The program, and the states at its nodes (6, m + 1) by its variables and parameters."""
        m, n, rings = self.segments, self.intervals, self.rings
        speeds, times = ca.MX.sym("speed", rings), ca.MX.sym("T", m)
        controls = ca.MX.sym("U", 3, m * n)
        slack = ca.MX.sym("slack", m * n)
        free = ca.MX.sym("r_f", 3 if self.finish == "rest anywhere" else 0)
        start, centres, normals = (
            ca.MX.sym("x0", 6),
            ca.MX.sym("c", 3, rings),
            ca.MX.sym("n", 3, rings),
        )
        end, limits = ca.MX.sym("x_f", 6), ca.MX.sym("u_max", 3)
        mean_motion, bound = ca.MX.sym("omega"), ca.MX.sym("b")
        others, weight = ca.MX.sym("own", self.own_variables * rings), ca.MX.sym("w")

        by_ring = ca.reshape(others, self.own_variables, rings)
        symbols = Symbols(times, speeds, by_ring, centres, normals, end, mean_motion, weight)
        nodes = [start, *self.nodes(symbols)]
        if self.finish == "rest anywhere":
            nodes.append(ca.vertcat(free, ca.MX.zeros(3)))
        applied = ca.reshape(controls * ca.repmat(limits, 1, m * n), 3 * n, m)
        arrived = _flow(n).map(m)(
            ca.horzcat(*nodes[:-1]), applied, times.T, ca.repmat(mean_motion, 1, m)
        )
        gaps = arrived - ca.horzcat(*nodes[1:])
        ball = ca.sum1(controls**2).T + slack - bound
        variables = ca.vertcat(times, speeds, ca.vec(controls), slack, others, free)
        low = np.concatenate(
            [
                np.full(m, SHORTEST),
                np.full(rings, LEAST_SPEED),
                np.full(3 * m * n, -1.0),
                np.zeros(m * n),
                np.full(others.numel() + free.numel(), -np.inf),
            ]
        )
        high = np.concatenate(
            [
                np.full(m, LONGEST),
                np.full(rings, np.inf),
                np.ones(3 * m * n),
                np.full(m * n + others.numel() + free.numel(), np.inf),
            ]
        )
        parameters = ca.vertcat(
            start, ca.vec(centres), ca.vec(normals), end, limits, mean_motion, bound, weight
        )
        constraints = ca.vertcat(ca.vec(gaps), ball, self.restrictions(symbols))
        states = ca.Function("nodes", [variables, parameters], [ca.horzcat(*nodes)])
        cost = self.cost(symbols)
        return NonlinearProgram(variables, cost, constraints, low, high, parameters), states

    def _smooth(self, leg: Leg, arcs: Arcs) -> tuple[np.ndarray, ...]:
        """Cubic arcs through the ring centres along their normals; their controls are clipped."""
        targets = np.vstack([leg.centres, leg.end_position])[: self.segments]
        before = np.vstack([leg.position, targets[:-1]])
        gaps = np.linalg.norm(targets - before, axis=1)
        speeds = arcs.speed * np.sqrt(gaps[: self.rings])
        velocities = np.vstack([speeds[:, None] * leg.normals[: self.rings], leg.end_velocity])
        after = velocities[: self.segments]
        start = np.vstack([leg.velocity, after[:-1]])
        durations = arcs.time * np.sqrt(gaps)
        s = np.arange(self.intervals + 1) / self.intervals
        middle = 0.5 * (s[1:] + s[:-1])
        t = durations[:, None, None]
        values = (before, start * durations[:, None], targets, after * durations[:, None])
        bend = _bend(middle[None, :, None], *(v[:, None] for v in values))
        controls = bend / t**2
        size = np.linalg.norm(controls, axis=2, keepdims=True)
        controls *= GUESS_THRUST / np.maximum(size, GUESS_THRUST)
        return durations, speeds, controls, leg.end_position, np.zeros((self.rings, 3))

    def _restart(
        self, plan: Plan, leg: Leg, limits: np.ndarray, unit: "_Units"
    ) -> tuple[np.ndarray, ...]:
        """A known plan as a guess, its controls held over shorter pieces where there are more."""
        old = plan.controls.shape[1]
        picked = (np.arange(self.intervals) * old) // self.intervals
        controls = plan.controls[:, picked] / limits
        durations = plan.durations / unit.time
        passed = unit.state(plan.ends)[: self.rings]
        speeds, offsets = np.linalg.norm(passed[:, 3:], axis=1), passed[:, :3] - leg.centres
        return durations, speeds, controls, unit.state(plan.final)[:3], offsets

    def _plan(
        self, solution: Solution, parameters: np.ndarray, limits: np.ndarray, unit: "_Units"
    ) -> Plan:
        m, n, rings = self.segments, self.intervals, self.rings
        z = solution.variables
        durations = z[:m]
        controls = z[m + rings : m + rings + 3 * m * n].reshape(m, n, 3)
        nodes = self._program[1](z, parameters).full().T
        assert solution.multipliers is not None
        # The multiplier of a gap is the costate at the end of its segment.
        ends = solution.multipliers[: 6 * m].reshape(m, 6)
        costates = np.array(
            [transition(unit.mean_motion, durations[k]).T @ ends[k] for k in range(m)]
        )
        return Plan(
            durations=durations * unit.time,
            starts=nodes[:-1] * unit.states,
            controls=controls * limits,
            costates=costates * unit.time / unit.states,
            final=nodes[-1] * unit.states,
            solution=solution,
        )


def _bend(s, a, da, b, db):
    """Second derivative by s of a cubic between values with given slopes."""
    return 2.0 * (3.0 * (b - a) - 2.0 * da - db) + 6.0 * s * (2.0 * (a - b) + da + db)


def _flow(intervals: int) -> ca.Function:
    """State at the end of a segment: (x, all u of it, its duration, mean motion).

    What a push held over a piece does is what it does when held to the end from the start of the
    piece, less what it does from the end of the piece.
    """
    x, u = ca.SX.sym("x", 6), ca.SX.sym("u", 3, intervals)
    duration, mean_motion = ca.SX.sym("T"), ca.SX.sym("n")

    def matrix(entries: Any, t: Any) -> ca.SX:
        return ca.vertcat(*(ca.horzcat(*row) for row in entries(mean_motion, t, ca)))

    end = matrix(transition_rows, duration) @ x
    shorter = ca.SX(6, 3)
    for i in reversed(range(intervals)):
        held = matrix(held_input_rows, duration * (intervals - i) / intervals)
        end += (held - shorter) @ u[:, i]
        shorter = held
    return ca.Function("flow", [x, ca.vec(u), duration, mean_motion], [end])


class _Units:
    """Scaling by a length and the thrust."""

    def __init__(self, thrust: float, mean_motion: float, length: float):
        self.length = length
        self.time = float(np.sqrt(length / thrust))
        self.mean_motion = mean_motion * self.time
        self.states = np.repeat([length, length / self.time], 3)

    def state(self, state: np.ndarray) -> np.ndarray:
        return state / self.states

    def weight(self, weight: float) -> float:
        return weight * self.length / self.time

    def leg(self, leg: Leg) -> Leg:
        speed = self.length / self.time
        return Leg(
            leg.position / self.length,
            leg.velocity / speed,
            leg.centres / self.length,
            leg.normals,
            leg.end_position / self.length,
            leg.end_velocity / speed,
        )
