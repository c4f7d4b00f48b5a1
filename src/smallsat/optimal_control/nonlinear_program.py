"""A nonlinear program with equality constraints and bounds, and the solvers we give it to."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import casadi as ca
import numpy as np
from scipy.optimize import minimize

# Map values (n,) of the variables to the constraints (m,), and to their Jacobian (m, n).
Numbers = tuple[Callable[[np.ndarray], np.ndarray], Callable[[np.ndarray], np.ndarray]]
# MUMPS permutes a matrix towards a large diagonal before it orders the elimination, which leaves a
# poor order. What it is for, constraints that nearly depend on one another, most programs have not.
UNPERMUTED: dict[str, Any] = {"mumps_permuting_scaling": 0}
# Approximate minimum degree: of chains of stages or segments a better order than MUMPS's choice.
MINIMUM_DEGREE: dict[str, Any] = UNPERMUTED | {"mumps_pivot_order": 0}
# For a guess next to an optimum, with a small first barrier of the caller's (``mu_init``): a large
# one, or a push away from the bounds, would lead away from it.
NEXT_TO_OPTIMUM: dict[str, Any] = {"mu_strategy": "monotone", "warm_start_init_point": "yes"}
# A variable so near a bound counts as on it.
AT_BOUND = 1e-9


@dataclass(frozen=True)
class NonlinearProgram:
    """Minimise ``objective`` subject to ``constraints = 0`` and ``lower <= variables <= upper``.

    Attributes
    ----------
    variables, objective, constraints
        Symbolic expressions: (n,), scalar and (m,).
    lower, upper
        Bounds (n,); may be infinite.
    parameters
        Symbols (p,) that are given a value at each solve, if any.
    jacobian
        That of the constraints, (m, n), where there is a shorter way to it than to differentiate
        all of them by all variables.
    hessian
        Likewise of the Lagrangian, its upper triangle (n, n): a function of the variables, the
        parameters, a factor of the objective and one of each constraint.
    called_back
        What of the expressions calls Python back: CasADi itself does not keep it.
    """

    variables: Any
    objective: Any
    constraints: Any
    lower: np.ndarray
    upper: np.ndarray
    parameters: Any = None
    jacobian: Any = None
    hessian: ca.Function | None = None
    called_back: tuple[ca.Callback, ...] = ()


@dataclass(frozen=True)
class StoppingRule:
    """Tolerances at which a run is stopped, measured as MATLAB's ``fmincon`` measures them.

    Attributes
    ----------
    optimality
        Of the first-order optimality: the largest entry of the Lagrangian's gradient, over the
        variables that are off their bounds, with the multipliers that make its norm least.
    feasibility
        Of the largest absolute constraint error.
    """

    optimality: float
    feasibility: float


@dataclass(frozen=True)
class Solution:
    """What a solver returned, its status read.

    Attributes
    ----------
    variables
        Final iterate (n,).
    objective
        Its objective.
    converged
        Whether the solver says that it converged.
    status
        The solver's own word for how it ended.
    iterations
        Number of major iterations.
    violation
        Largest absolute constraint error.
    seconds
        Wall time of the solve alone, without building the problem.
    multipliers
        One a constraint, (m,), where the solver gives them: the gradient of the objective plus
        multipliers times that of the constraints vanishes where no bound is active.
    path
        Objective, largest constraint error and first-order optimality (iterations, 3) of every
        iterate, where a stopping rule was given.
    """

    variables: np.ndarray
    objective: float
    converged: bool
    status: str
    iterations: int
    violation: float
    seconds: float = field(compare=False)
    multipliers: np.ndarray | None = field(default=None, compare=False)
    path: np.ndarray | None = field(default=None, compare=False)


class _Stopped(Exception):
    """Leaves SLSQP, which asks no callback whether to go on; carries the iterate."""

    def __init__(self, variables: np.ndarray):
        super().__init__()
        self.variables = variables.copy()


class SlsqpSolver:
    """Sequential quadratic programming with SciPy's SLSQP and exact first derivatives.

    The functions are built once; `solve` may be called for many guesses and tolerances.

    Parameters
    ----------
    program
        What is solved.
    numbers
        The program's constraints, where there is a faster way to them than by their symbols.
    """

    def __init__(self, program: NonlinearProgram, numbers: Numbers | None = None):
        x = program.variables
        gradient = ca.Function("df", [x], [ca.gradient(program.objective, x)])
        self._objective = ca.Function("f", [x], [program.objective])
        self._gradient = lambda z: gradient(z).full().ravel()
        self._constraints, self._jacobian = numbers or _numbers_of(program)
        self._bounds = list(zip(program.lower, program.upper, strict=True))

    def solve(self, guess: np.ndarray, tolerance: float, iterations: int = 1000) -> Solution:
        """Solve from a guess (n,); ``tolerance`` is SLSQP's ``ftol``."""
        return self._solve(guess, tolerance, iterations, None)

    def solve_until(
        self, guess: np.ndarray, rule: StoppingRule, tolerance: float, iterations: int = 1000
    ) -> Solution:
        """Solve from a guess (n,) until an iterate meets a rule, or SLSQP ends by itself.

        It has not converged where SLSQP ended first, whatever it says.
        """
        path: list[tuple[float, float, float]] = []

        def watch(z: np.ndarray) -> None:
            violation, optimality = self._first_order(z)
            path.append((float(self._objective(z)), violation, optimality))
            if optimality <= rule.optimality and violation <= rule.feasibility:
                raise _Stopped(z)

        began = time.perf_counter()
        try:
            ended = self._solve(guess, tolerance, iterations, watch)
            return replace(ended, converged=False, path=np.reshape(path, (-1, 3)))
        except _Stopped as stop:
            objective, violation, optimality = path[-1]
            return Solution(
                variables=stop.variables,
                objective=objective,
                converged=True,
                status=f"first-order optimality {optimality:.1e}, constraints {violation:.1e}",
                iterations=len(path),
                violation=violation,
                seconds=time.perf_counter() - began,
                path=np.array(path),
            )

    def _first_order(self, z: np.ndarray) -> tuple[float, float]:
        """Largest constraint error and first-order optimality at an iterate (n,)."""
        lower, upper = np.transpose(self._bounds)
        free = (z > lower + AT_BOUND) & (z < upper - AT_BOUND)
        gradient, jacobian = self._gradient(z)[free], self._jacobian(z)[:, free]
        multipliers = np.linalg.lstsq(jacobian.T, -gradient, rcond=None)[0]
        violation = np.max(np.abs(self._constraints(z)))
        return float(violation), float(np.max(np.abs(gradient + jacobian.T @ multipliers)))

    def _solve(
        self,
        guess: np.ndarray,
        tolerance: float,
        iterations: int,
        watch: Callable[[np.ndarray], None] | None,
    ) -> Solution:
        began = time.perf_counter()
        result = minimize(
            lambda z: float(self._objective(z)),
            guess,
            jac=self._gradient,
            bounds=self._bounds,
            constraints={"type": "eq", "fun": self._constraints, "jac": self._jacobian},
            method="SLSQP",
            options={"ftol": tolerance, "maxiter": iterations},
            callback=watch,
        )
        seconds = time.perf_counter() - began
        violation = float(np.max(np.abs(self._constraints(result.x))))
        return Solution(
            variables=result.x,
            objective=float(result.fun),
            converged=bool(result.success),
            status=str(result.message),
            iterations=int(result.nit),
            violation=violation,
            seconds=seconds,
        )


def _numbers_of(program: NonlinearProgram) -> Numbers:
    x, jacobian = program.variables, program.jacobian
    if jacobian is None:
        jacobian = ca.jacobian(program.constraints, x)
    g, dg = ca.Function("g", [x], [program.constraints]), ca.Function("dg", [x], [jacobian])
    return lambda z: g(z).full().ravel(), lambda z: dg(z).full()


class IpoptSolver:
    """Interior-point method IPOPT with exact first and second derivatives."""

    def __init__(self, program: NonlinearProgram, *, expand: bool = False, **options: Any):
        self._program = program
        settings: dict[str, Any] = {
            "print_level": 0,
            "sb": "yes",
            "tol": 1e-10,
            "max_iter": 500,
        } | options
        symbols = {"x": program.variables, "f": program.objective, "g": program.constraints}
        if program.parameters is not None:
            symbols["p"] = program.parameters
        ours: dict[str, Any] = {"print_time": False, "expand": expand, "ipopt": settings}
        # Sensitivities by the parameters are not asked for: they would take further derivatives.
        ours |= {"calc_lam_p": False, "no_nlp_grad": True}
        if program.jacobian is not None:
            names = ["x", "p"], ["g", "jac_g_x"]
            inputs = [program.variables, symbols.get("p", ca.SX(0, 1))]
            outputs = [program.constraints, program.jacobian]
            ours["jac_g"] = ca.Function("nlp_jac_g", inputs, outputs, *names)
        if program.hessian is not None:
            ours["hess_lag"] = program.hessian
        self._solver = ca.nlpsol("solver", "ipopt", symbols, ours)

    @property
    def hessian(self) -> ca.Function:
        """The program's `hessian`, for another solver of it to use."""
        return self._solver.get_function("nlp_hess_l")

    def solve(
        self, guess: np.ndarray | Sequence[float], parameters: Sequence[float] = ()
    ) -> Solution:
        """Solve from a guess (n,), for values (p,) of the parameters."""
        began = time.perf_counter()
        result = self._solver(
            x0=guess,
            p=list(parameters),
            lbx=self._program.lower,
            ubx=self._program.upper,
            lbg=0.0,
            ubg=0.0,
        )
        seconds = time.perf_counter() - began
        statistics = self._solver.stats()
        return Solution(
            variables=result["x"].full().ravel(),
            objective=float(result["f"]),
            converged=bool(statistics["success"]),
            status=str(statistics["return_status"]),
            iterations=int(statistics["iter_count"]),
            violation=float(np.max(np.abs(result["g"].full()))),
            seconds=seconds,
            multipliers=result["lam_g"].full().ravel(),
        )
