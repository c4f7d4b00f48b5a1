"""What the flight program is given: the law's settings and recorded steps, as C structs.

The programs to replay are those of the study's own closed loop, with the configured set: each case
is one phase with one horizon and sample time, from the thesis's kind of initial conditions
(Sections 6.1.1 to 6.2).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.guidance.law import SETTINGS, Law, in_phase, settings
from smallsat.studies.rendezvous.guidance.phase_programs import empty_program, write_program
from smallsat.studies.rendezvous.methods.qp_solvers import Sample
from smallsat.studies.rendezvous.monte_carlo.cases import base
from smallsat.studies.rendezvous.monte_carlo.initial_states import distribution, initial_states
from smallsat.studies.rendezvous.simulation.closed_loop import simulate

# One recorded step: `struct step` of flight/replay.c.
STEP = np.dtype([("phase", float), ("time", float), ("state", float, (6,))])


@dataclass(frozen=True)
class Case:
    """A phase, 0 to 2, with a horizon and a sample time, s."""

    phase: int
    horizon: int
    sample_time: float

    def law(self, law: Law) -> Law:
        """A law with these in its phase."""
        return law.with_(
            horizons=in_phase(law.horizons, self.phase, self.horizon),
            sample_times=in_phase(law.sample_times, self.phase, self.sample_time),
        )


@dataclass(frozen=True)
class Recording:
    """Steps of the runs of one case: the case, its law, `STEP` records and the run of each."""

    case: Case
    law: Law
    steps: np.ndarray
    runs: np.ndarray


def law_header() -> str:
    """The C struct that a record of `SETTINGS` is, as the text of ``law.h``."""
    assert SETTINGS.fields is not None
    lines = []
    for name, (kind, *_) in SETTINGS.fields.items():
        base_kind, shape = kind.subdtype or (kind, ())
        c_kind = {"i": "int64_t", "f": "double"}[base_kind.kind]
        lines.append(f"    {c_kind} {name}{''.join(f'[{size}]' for size in shape)};\n")
    return (
        "/* Made from SETTINGS of smallsat.studies.rendezvous.guidance.law. */\n"
        "#ifndef LAW_H\n#define LAW_H\n\n#include <stdint.h>\n\n"
        f"struct law {{\n{''.join(lines)}}};\n\n"
        f'_Static_assert(sizeof(struct law) == {SETTINGS.itemsize}, "laid out otherwise");\n\n'
        "#endif\n"
    )


def cases(section: Configuration) -> list[Case]:
    """The cases of Figures 6.3 to 6.7, each once."""
    found: list[Case] = []
    for number, (name, phase) in enumerate(section.phases):
        sweep = getattr(section.flight_computer, name)
        for horizon in sweep.horizons:
            found.append(Case(number, horizon, phase.sample_time_s))
        for sample_time in sweep.sample_times_s:
            found.append(Case(number, phase.horizon, sample_time))
    return list(dict.fromkeys(found))


def recordings(section: Configuration) -> Iterator[Recording]:
    """Fly every case in the linear model; keep the steps in the middles of equal parts of each run.

    A phase begins at an initial state, or where the baseline's phase before it ended.
    """
    law, size = base(section), section.flight_computer
    starts = initial_states(
        size.runs, section.studies.seed, distribution(section.studies), law.mean_motion
    )
    whole = simulate([law], starts)
    for case in cases(section):
        own = case.law(law)
        begin = starts if case.phase == 0 else whole.ends[:, case.phase - 1]
        there = np.flatnonzero(whole.steps[:, case.phase] > 0)
        flown = simulate([own], begin[there], (case.phase,) * 2, with_steps=True)
        steps, runs = [], []
        for m, run in enumerate(there):
            record = flown.record(m)
            count = len(record.time)
            for k in np.unique((count * (np.arange(size.steps) + 0.5) / size.steps).astype(int)):
                steps.append((float(case.phase), record.time[k], record.state[k]))
                runs.append(run)
        yield Recording(case, own, np.array(steps, STEP), np.array(runs))


def samples(recording: Recording) -> list[Sample]:
    """The programs of all recorded steps, as the study writes them."""
    record = settings([recording.law])[0]
    phase, stages = recording.case.phase, recording.case.horizon
    found = []
    for step in recording.steps:
        state = np.ascontiguousarray(step["state"])
        program, _ = write_program(record, phase, state, float(step["time"]), empty_program(stages))
        found.append(Sample("", program, stages, state / record["scales"][phase]))
    return found
