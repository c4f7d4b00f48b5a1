"""The cases of chapters 4 and 5 and appendix A, and of what goes beyond them, by group.

A case is the baseline guidance law with some attributes changed, flown over some of the phases. A
case that does not begin with the first phase begins where the baseline ended the phase before.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from smallsat.config import Config
from smallsat.rendezvous.guidance import Law
from smallsat.rendezvous.parameters import law

PHASES = ("rendezvous", "approach", "docking")
BASELINE = "baseline"


@dataclass(frozen=True)
class Case:
    """One case of a study.

    Attributes
    ----------
    name
        Unique within its group.
    law
        The guidance law flown.
    phases
        First and last phase flown, 0 to 2.
    """

    name: str
    law: Law
    phases: tuple[int, int] = (0, 2)


def sweep_case(horizon: int, sample_time: float) -> str:
    """Name of a sweep's case."""
    return f"N {horizon}, Ts {sample_time:g} s"


def in_phase(values: tuple[Any, ...], phase: int, value: Any) -> tuple[Any, ...]:
    """A triple of a law with one phase's entry replaced."""
    return (*values[:phase], value, *values[phase + 1 :])


def sweep_cases(law: Law, settings: Config, phase: int) -> list[Case]:
    """Sections 4.2 to 4.4: horizons and sample times of one phase, that phase alone."""
    return [
        Case(
            sweep_case(horizon, sample_time),
            replace(
                law,
                horizons=in_phase(law.horizons, phase, horizon),
                sample_times=in_phase(law.sample_times, phase, float(sample_time)),
            ),
            (phase, phase),
        )
        for horizon in settings["horizons"]
        for sample_time in settings["sample_times_s"]
    ]


def _domain(section: Config) -> list[Case]:
    """Section 4.1 and the appendix: the whole manoeuvre, and two other far-range costs."""
    return [
        Case(BASELINE, law(section, "v-bar")),
        Case("no set point", law(section, "no-set-point")),
        Case("LP", law(section, "lp")),
    ]


def _weights(section: Config) -> list[Case]:
    """Section 4.5: other weights of the control and of the velocity in each phase."""
    base = law(section)
    found = []
    for phase, name in enumerate(PHASES):
        for factor in section["studies"]["weights"]["factors"]:
            weights = np.array(base.control_weights, dtype=float)
            weights[phase] *= factor
            changed = replace(base, control_weights=weights)
            found.append(Case(f"R of {name} times {factor:g}", changed))
    return found


def _sweep(phase: int) -> Callable[[Config], list[Case]]:
    return lambda section: sweep_cases(law(section), section["studies"][PHASES[phase]], phase)


# Each group is one table of results, flown in shards.
GROUPS: dict[str, Callable[[Config], list[Case]]] = {
    "domain": _domain,
    "rendezvous-sweep": _sweep(0),
    "approach-sweep": _sweep(1),
    "docking-sweep": _sweep(2),
    "weights": _weights,
}


def cases(section: Config, group: str) -> list[Case]:
    """The cases of a group, in the order of its results."""
    return GROUPS[group](section)
