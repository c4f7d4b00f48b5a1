"""Reading and writing result tables: whole files or none, and a clear word about damaged ones."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from smallsat.errors import InputError

# Finer than any difference that is spoken of, and coarser than the last bits, which may differ
# from build to build where a library lays out its memory differently.
CSV_DIGITS = 12


def write_table(table: pd.DataFrame, path: Path) -> None:
    """Write a tidy table as Parquet or CSV (by suffix), atomically.

    A killed run leaves either the old file or the new one, never half of one.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.partial")
    if path.suffix == ".parquet":
        table.to_parquet(partial, index=False, compression="zstd")
    else:
        table.to_csv(partial, index=False, float_format=f"%.{CSV_DIGITS}g", lineterminator="\n")
    partial.replace(path)


def read_table(path: Path, text: Sequence[str] = ()) -> pd.DataFrame:
    """Read a table written by `write_table`.

    Columns named in ``text`` stay text even where all their entries are numbers: a printed
    ``0.75550`` keeps its zeros.

    Raises
    ------
    InputError
        If the file is missing, truncated or not a table.
    """
    path = Path(path)
    try:
        if path.suffix == ".parquet":
            # Opened by Python, so that a record of opened files has it.
            with path.open("rb") as file:
                return pd.read_parquet(file)
        return pd.read_csv(
            path, keep_default_na=False, na_values=[""], dtype=dict.fromkeys(text, str)
        )
    except FileNotFoundError:
        raise InputError(f"{path}: no such results file; run `snakemake {path}`") from None
    except (ValueError, OSError, pd.errors.ParserError) as error:
        raise InputError(
            f"{path}: damaged results file ({str(error).splitlines()[0]}); "
            f"delete it and run `snakemake` again"
        ) from None


def write_json(data: Any, path: Path) -> None:
    """Write JSON with sorted keys, atomically."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.partial")
    partial.write_text(json.dumps(data, indent=1, sort_keys=True, ensure_ascii=False) + "\n")
    partial.replace(path)
