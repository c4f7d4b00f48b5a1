"""The cases of chapters 4 and 5 and appendix A, and of what goes beyond them, by group.

A case is the baseline with some keys of the configuration changed, flown over some of the phases.
"""

from dataclasses import dataclass, field

from smallsat.config import Config

PHASES = ("rendezvous", "approach", "docking")


@dataclass(frozen=True)
class Case:
    """One case of a study.

    Attributes
    ----------
    name
        Unique within its group.
    changes
        Keys of the section ``rendezvous`` that differ from the baseline, nested as there.
    phases
        First and last phase flown. A case that does not begin with the first phase starts where
        the baseline of the domain study ended the phase before.
    """

    name: str
    changes: Config = field(default_factory=dict)
    phases: tuple[str, str] = ("rendezvous", "docking")


def sweep_case(horizon: int, sample_time: float) -> str:
    """Name of a sweep's case."""
    return f"N {horizon}, Ts {sample_time:g} s"
