"""The same programs, sampled from closed loops, solved by all QP solvers."""

from collections.abc import Callable
from functools import partial

import numpy as np
import pandas as pd

from smallsat.studies.rendezvous.guidance.controller import TOLERANCE
from smallsat.studies.rendezvous.guidance.law import PHASES, Law, settings
from smallsat.studies.rendezvous.guidance.phase_programs import empty_program, write_program
from smallsat.studies.rendezvous.methods import qp_solvers
from smallsat.studies.rendezvous.methods.qp_solvers import Answer, Sample
from smallsat.studies.rendezvous.simulation.closed_loop import simulate


def _sparse(solve: Callable[..., Answer], tolerance: float) -> Callable[[Sample], Answer]:
    return lambda sample: solve(qp_solvers.sparse_program(sample), tolerance)


# Each at a tolerance at which it still converges as a rule; OSQP's is its usual one.
QP_SOLVERS: dict[str, Callable[[Sample], Answer]] = {
    "stage-wise": partial(qp_solvers.own, tolerance=TOLERANCE),
    "Clarabel": _sparse(qp_solvers.clarabel, 1e-8),
    "OSQP": _sparse(qp_solvers.osqp, 1e-4),
}


def samples(laws: dict[str, Law], starts: np.ndarray, count: int) -> list[Sample]:
    """Programs at steps spread evenly over the closed loops of each law from all starts.

    Parameters
    ----------
    laws
        By name; a law with a 1-norm cost gives its far range only, as a kind of its own.
    starts
        Relative states, (M, 6), m and m/s.
    count
        Largest number of programs of each kind.
    """
    found = []
    for name, law in laws.items():
        record = settings([law])[0]
        linear = law.norm_weights is not None
        phases = (0, 0) if linear else (0, 2)
        simulated = simulate([law], starts, phases, with_steps=True)
        for phase in range(phases[1] + 1):
            steps = [
                (r.state[k], r.time[k])
                for r in map(simulated.record, range(len(starts)))
                for k in np.flatnonzero(r.phase == phase)
            ]
            # A phase that no manoeuvre comes to has none.
            chosen = np.unique(np.linspace(0, max(len(steps) - 1, 0), count).astype(int))
            chosen = chosen[: len(steps)]
            for state, time in (steps[k] for k in chosen):
                empty = empty_program(int(record["horizons"][phase]))
                program, _ = write_program(record, phase, state, time, empty)
                found.append(
                    Sample(
                        f"{PHASES[phase]} ({name})",
                        program,
                        int(record["horizons"][phase]),
                        state / record["scales"][phase],
                    )
                )
    return found


def compare(programs: list[Sample]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Answers of all QP solvers, one row a program and solver; and their seconds.

    Returns
    -------
    pandas.DataFrame
        ``program``, ``kind``, ``back_end``, ``solved``, ``iterations``; ``cost_error``, by how much
        the cost exceeds the least of the other solvers', as a share of what the best control
        saves; ``control_error``, the first control's largest difference from that one's, in bounds.
    pandas.DataFrame
        ``program``, ``kind``, ``back_end``, ``seconds``.
    """
    rows, seconds = [], []
    if programs:
        QP_SOLVERS["stage-wise"](programs[0])  # compiles
    for number, sample in enumerate(programs):
        answers = {name: solve(sample) for name, solve in QP_SOLVERS.items()}
        costs = {
            name: qp_solvers.cost(sample, answer.controls)
            for name, answer in answers.items()
            if answer.solved
        }
        at_rest = qp_solvers.cost(sample, np.zeros((sample.stages, 3)))
        saved = at_rest - min(costs.values(), default=np.nan)
        for name, answer in answers.items():
            control_error = cost_error = np.nan
            others = [other for other in costs if other != name]
            if answer.solved and others:
                best = min(others, key=costs.__getitem__)
                cost_error = max(costs[name] - costs[best], 0.0) / saved
                difference = answer.controls[0] - answers[best].controls[0]
                control_error = float(np.abs(difference).max())
            key = {"program": number, "kind": sample.kind, "back_end": name}
            rows.append(
                key
                | {
                    "solved": answer.solved,
                    "iterations": answer.iterations,
                    "control_error": control_error,
                    "cost_error": cost_error,
                }
            )
            seconds.append(key | {"seconds": answer.seconds})
    return pd.DataFrame(rows), pd.DataFrame(seconds)


def summary(answers: pd.DataFrame) -> pd.DataFrame:
    """By kind and solver: programs, share solved, iterations and errors of the solved ones."""
    solved = answers[answers["solved"]]
    groups = solved.groupby(["kind", "back_end"], sort=False)
    table = groups.agg(
        iterations_median=("iterations", "median"),
        iterations_most=("iterations", "max"),
        control_error_median=("control_error", "median"),
        control_error_most=("control_error", "max"),
        cost_error_most=("cost_error", "max"),
    )
    every = answers.groupby(["kind", "back_end"], sort=False)["solved"]
    table.insert(0, "programs", every.size())
    table.insert(1, "solved_share", every.mean())
    for column in table.filter(like="_error_"):
        table[column] = [float(f"{value:.1e}") for value in table[column]]
    return table.reset_index()


def seconds_summary(seconds: pd.DataFrame) -> pd.DataFrame:
    """Median and 99th percentile of the seconds by kind and solver."""
    groups = seconds.groupby(["kind", "back_end"], sort=False)["seconds"]
    return (
        groups.quantile(np.array([0.5, 0.99]))
        .unstack()
        .reset_index()
        .set_axis(["kind", "back_end", "median_s", "percentile_99_s"], axis=1)
    )
