"""What a study says of a published value: the same id with what it computed."""

import inspect
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from math import nan

import pandas as pd

OBSERVATION_COLUMNS = ("id", "run", "computed", "low", "high", "residual", "note", "source")


def _maker() -> str:
    """The function of a study that makes an observation, as ``package.module:function``.

    Read from the call stack, so that no study says it of each of its values: the first private
    function on the way down from the study's own entry, or else that one. Empty outside of the
    studies.
    """
    found = ""
    frame = inspect.currentframe()
    while frame is not None:
        module = str(frame.f_globals.get("__name__", ""))
        function = frame.f_code.co_qualname.partition(".")[0]
        if module.startswith("smallsat.studies.") and (function.startswith("_") or not found):
            found = f"{module}:{function}"
        frame = frame.f_back
    return found


@dataclass(frozen=True)
class Observation:
    """A computed value for one row of the ledger, in the unit of that row.

    Attributes
    ----------
    id
        Identifier of the row in ``values.csv``.
    computed
        The value, in the printed unit.
    run
        Which computation it comes from, e.g. ``as published`` or ``converged``; a row may have one
        observation a run.
    residual
        Largest error of the constraints, found by a check that is independent of the solver; needed
        where a better optimum is claimed.
    note
        What a reader must know of this value, such as a solver that did not converge.
    low, high
        Ends of the interval in which the printed value must lie to agree with this run, where the
        run is a sample or rests on inferred parameters; of the sum, where the rule judges several
        values jointly.
    source
        The function that makes it; nobody gives it.
    """

    id: str
    computed: float
    run: str = ""
    residual: float = nan
    note: str = ""
    low: float = nan
    high: float = nan
    source: str = field(default_factory=_maker)


def observations_table(observations: Iterable[Observation]) -> pd.DataFrame:
    """Tidy table of observations, one a row."""
    rows = [asdict(observation) for observation in observations]
    return pd.DataFrame(rows, columns=list(OBSERVATION_COLUMNS))
