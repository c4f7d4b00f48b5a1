"""Chapter 6 measured: every case replayed with both solvers on both processors.

The counts are of instructions, which are the same every time. What they are in cycles is bounded in
`smallsat.studies.rendezvous.flight_computer.cycles`.
"""

import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from smallsat.optimal_control.riccati_interior_point import SOLVED, solve, workspace
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.flight_computer import emulator
from smallsat.studies.rendezvous.flight_computer.emulator import PROCESSORS, SOLVERS, Answers
from smallsat.studies.rendezvous.flight_computer.provenance import fingerprint
from smallsat.studies.rendezvous.flight_computer.recording import Recording, recordings, samples
from smallsat.studies.rendezvous.guidance.controller import ITERATION_LIMIT, SOFTENED, TOLERANCE
from smallsat.studies.rendezvous.guidance.law import PHASES
from smallsat.studies.rendezvous.methods.qp_solvers import Sample, cost

MISSES = ["instruction_misses", "data_misses"]
# Solves of a case whose cache misses are counted; the first finds the caches empty.
WITH_CACHES = 1


def measure(section: Configuration) -> dict[str, pd.DataFrame]:
    """All tables of the chapter, by file name; needs the tools of `emulator.MEASURING`.

    Returns
    -------
    dict
        ``runs.csv``: mean and most of the instructions, and mean iterations, of each run's solves.
        ``classes.csv``: mean and worst solve of each case by class of instruction, and misses.
        ``memory.csv``: bytes of each solver. ``answers.csv``: its answers against the reference.
        ``provenance.csv``: what measured.
    """
    rows: dict[str, list[dict[str, object]]] = {
        name: [] for name in ("runs", "classes", "memory", "answers")
    }
    with tempfile.TemporaryDirectory() as temporary:
        plugin = emulator.build_plugin(Path(temporary))
        for number, recording in enumerate(recordings(section)):
            references, few = _references(recording), _few(recording)
            for solver in SOLVERS:
                folder = Path(temporary) / f"{number}-{solver}"
                folder.mkdir()
                for name, processor in PROCESSORS.items():
                    key = {"processor": name, "solver": solver, **_key(recording)}
                    sizes = emulator.build(solver, processor, recording, folder)
                    answers, counts = emulator.replay(processor, recording, folder, plugin)
                    _, misses = emulator.replay(processor, few, folder, plugin, caches=True)
                    rows["runs"] += _runs(key, recording, answers, counts)
                    rows["classes"] += _classes(key, counts, misses)
                    rows["memory"].append(key | _memory(sizes, answers))
                    rows["answers"].append(key | _compared(answers, references))
                    print(key, file=sys.stderr, flush=True)
    tables = {f"{name}.csv": pd.DataFrame(found) for name, found in rows.items()}
    return tables | {"provenance.csv": _provenance(section)}


def _key(recording: Recording) -> dict[str, object]:
    case = recording.case
    return {
        "phase": PHASES[case.phase],
        "horizon": case.horizon,
        "sample_time_s": case.sample_time,
    }


def _few(recording: Recording) -> Recording:
    """A few steps of a recording, spread evenly."""
    chosen = np.linspace(0, len(recording.steps) - 1, WITH_CACHES).astype(int)
    return replace(recording, steps=recording.steps[chosen], runs=recording.runs[chosen])


def _runs(
    key: dict[str, object], recording: Recording, answers: Answers, counts: pd.DataFrame
) -> list[dict[str, object]]:
    solves = pd.DataFrame(
        {
            "run": recording.runs,
            "iterations": answers.iterations,
            "instructions": counts.drop(columns=MISSES).sum(axis=1),
            "solved": answers.status == SOLVED,
        }
    )
    table = solves.groupby("run").agg(
        solves=("solved", "size"),
        solved=("solved", "sum"),
        iterations=("iterations", "mean"),
        instructions=("instructions", "mean"),
        most_instructions=("instructions", "max"),
    )
    rows: Any = table.round(1).reset_index().to_dict("records")
    return [key | row for row in rows]


def _classes(
    key: dict[str, object], counts: pd.DataFrame, misses: pd.DataFrame
) -> list[dict[str, object]]:
    """The mean solve and the worst one; misses are in proportion to those of the few."""
    total = misses.drop(columns=MISSES).sum().sum()
    shares = misses[MISSES].sum() / total
    found = []
    own = counts.drop(columns=MISSES)
    worst = int(own.sum(axis=1).to_numpy().argmax())
    for name, row in (("mean", own.mean()), ("most", own.iloc[worst])):
        missed = row.sum() * shares
        found.append(key | {"solve": name, **pd.concat([row, missed]).round(1).to_dict()})
    return found


def _memory(sizes: dict[str, int], answers: Answers) -> dict[str, object]:
    return {
        "code_bytes": sizes["text"],
        "static_bytes": sizes["data"] + sizes["bss"],
        "heap_bytes": int(answers.heap[0]),
        "heap_after_start_bytes": int(answers.heap[-1] - answers.heap[0]),
        "stack_bytes": int(answers.stack.max()),
    }


@dataclass(frozen=True)
class Reference:
    """The study's own answer to a program: its controls, (N, 3), their cost, and that of none.

    ``feasible`` says whether no hard row gave way: the program has a solution as it is stated.
    """

    program: Sample
    controls: np.ndarray
    cost: float
    cost_at_rest: float
    feasible: bool


def _references(recording: Recording) -> list[Reference]:
    found = []
    for one in samples(recording):
        work = workspace(one.stages, one.program.normals.shape[1], len(one.program.components))
        solution = solve(one.program, one.stages, one.start, work, TOLERANCE, ITERATION_LIMIT)
        assert solution.status == SOLVED
        hard = solution.weights == solution.weights.max()
        feasible = not bool((solution.excesses[hard] > SOFTENED).any())
        controls = solution.controls.copy()
        rest = cost(one, np.zeros_like(controls))
        found.append(Reference(one, controls, cost(one, controls), rest, feasible))
    return found


def _compared(answers: Answers, references: Sequence[Reference]) -> dict[str, object]:
    """Errors where a solver answers and the program has a solution as it is stated."""
    feasible = np.array([one.feasible for one in references])
    solved = answers.status == SOLVED
    controls, costs = [], []
    for number in map(int, np.flatnonzero(feasible & solved)):
        one = references[number]
        controls.append(np.abs(answers.controls[number, 0] - one.controls[0]).max())
        more = cost(one.program, answers.controls[number]) - one.cost
        costs.append(abs(more) / (one.cost_at_rest - one.cost))
    return {
        "programs": len(feasible),
        "feasible": int(feasible.sum()),
        "solved": int(solved.sum()),
        "solved_of_feasible": int((feasible & solved).sum()),
        "iterations_most": int(answers.iterations.max()),
        "control_error_median": float(f"{np.median(controls):.1e}"),
        "control_error_most": float(f"{np.max(controls):.1e}"),
        "cost_error_most": float(f"{np.max(costs):.1e}"),
    }


def _provenance(section: Configuration) -> pd.DataFrame:
    said = emulator.versions() | fingerprint(section)
    said |= {
        "flags": " ".join([*emulator.FLAGS, *emulator.LINKED]),
        "board": " ".join(emulator.BOARD),
        "command": "make flight",
    }
    return pd.DataFrame({"item": list(said), "value": list(said.values())})
