"""What a study of many manoeuvres writes: one row a manoeuvre, with an explicit schema."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
import pyarrow as pa

from smallsat.errors import InputError
from smallsat.studies.rendezvous.model.columns import STATE
from smallsat.studies.rendezvous.monte_carlo.cases import PHASES

# What each phase has; a phase that is left out has no steps, no time, and no end.
COUNTS = ("steps", "softened", "outside", "failed", "iterations")
SUMS = ("time_s", "delta_v_m_s", "norm_delta_v_m_s", "axes_delta_v_m_s")
KEY = ("case", "sample", "run")


def column(phase: str, quantity: str) -> str:
    """Name of the column of one quantity of one phase."""
    return f"{phase}_{quantity}"


def end_columns(phase: str) -> list[str]:
    """Columns of the relative state in which a phase ended, in the Hill frame, m and m/s."""
    return [column(phase, f"end_{name}") for name in STATE]


# ``completed``: the last phase asked for met its end within the time limit. ``end_phase`` is the
# number of the phase that the manoeuvre ended in, 1 to 3. Velocity changes are added up three ways:
# ``delta_v`` in the configured reading, ``norm_delta_v`` by Euclidean norms, ``axes_delta_v`` by
# absolute components. Programs are counted in which a hard row had to give way (``softened``),
# whose first state violated one already (``outside``), and that the solver gave up (``failed``); as
# stated, the first two kinds have no solution. ``closest_m`` is the least distance from the target
# at the samples of the first phase.
SCHEMA = pa.schema(
    [
        pa.field("case", pa.large_string(), nullable=False),
        pa.field("sample", pa.int32(), nullable=False),
        pa.field("run", pa.int32(), nullable=False),
        pa.field("completed", pa.bool_(), nullable=False),
        pa.field("end_phase", pa.int8(), nullable=False),
        pa.field("closest_m", pa.float64(), nullable=False),
        *[
            pa.field(name, kind, nullable=False)
            for phase in PHASES
            for name, kind in (
                *((column(phase, count), pa.int32()) for count in COUNTS),
                *((column(phase, total), pa.float64()) for total in SUMS),
                *((name, pa.float64()) for name in end_columns(phase)),
            )
        ],
    ]
)

# What one manoeuvre would have been with other docking distances and time limits.
PASSAGES = pa.schema(
    [
        pa.field("sample", pa.int32(), nullable=False),
        pa.field("run", pa.int32(), nullable=False),
        pa.field("end_distance_m", pa.float64(), nullable=False),
        pa.field("time_limit_min", pa.float64(), nullable=False),
        pa.field("docked", pa.bool_(), nullable=False),
        pa.field("time_s", pa.float64(), nullable=False),
        pa.field("delta_v_m_s", pa.float64(), nullable=False),
    ]
)
PASSAGES_KEY = ("sample", "run", "end_distance_m", "time_limit_min")


def empty_rows(count: int) -> dict[str, np.ndarray]:
    """Columns for ``count`` manoeuvres of which nothing is known yet."""
    columns: dict[str, np.ndarray] = {}
    for entry in SCHEMA:
        if pa.types.is_large_string(entry.type):
            columns[entry.name] = np.full(count, "", dtype=object)
        elif "_end_" in entry.name:
            columns[entry.name] = np.full(count, np.nan)
        else:
            columns[entry.name] = np.zeros(count, dtype=entry.type.to_pandas_dtype())
    return columns


def conforming(table: pd.DataFrame, schema: pa.Schema, path: str) -> pd.DataFrame:
    """The table with the columns of the schema, if they are there and of its types.

    Columns without rows, as of a group that no manoeuvre came to, have no type to speak of.

    Raises
    ------
    InputError
        Naming the file and the first column that differs.
    """
    found = pa.Schema.from_pandas(table, preserve_index=False)
    for expected in schema:
        at = found.get_field_index(expected.name)
        if at < 0 or (len(table) and found.field(at).type != expected.type):
            kind = "missing" if at < 0 else f"of type {found.field(at).type}"
            raise InputError(
                f"{path}: column '{expected.name}' is {kind}; needed: {expected.type}; "
                f"delete the file and run `snakemake` again"
            )
    return table[schema.names] if len(table) else schema.empty_table().to_pandas()


def totals(table: pd.DataFrame, quantity: str, phases: Sequence[str] = PHASES) -> pd.Series:
    """Sum of a quantity over phases, for each manoeuvre."""
    return sum((table[column(phase, quantity)] for phase in phases), pd.Series(0.0, table.index))
