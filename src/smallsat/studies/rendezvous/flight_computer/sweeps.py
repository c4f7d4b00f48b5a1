"""What the counted cases of a phase vary: the horizon, or the sample time, and nothing else.

They are counted at the document's own values. The sweeps are read from the tables themselves, so
that they are the same in a run whose configuration has other phases.
"""

import pandas as pd

OTHER = {"horizon": "sample_time_s", "sample_time_s": "horizon"}


def swept(counted: pd.DataFrame, phase: str, varied: str) -> pd.DataFrame:
    """Rows of a phase that differ in what is varied alone.

    Parameters
    ----------
    counted
        ``flight/runs.csv``, ``flight/cycles.csv`` or rows of them.
    phase
        ``far``, ``mid`` or ``final``.
    varied
        ``horizon`` or ``sample_time_s``; the other has the value at which most of these were
        counted.
    """
    own, other = counted[counted["phase"] == phase], OTHER[varied]
    return own[own[other] == own.groupby(other)[varied].nunique().idxmax()]
