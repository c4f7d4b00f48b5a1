"""The ledger of published values and the list of artefacts, checked as they are read."""

import csv
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Self

from smallsat.catalogue import Study
from smallsat.errors import InputError
from smallsat.evidence.printed import LOST, Printed, looks_numeric, parse_printed

VALUE_COLUMNS = (
    "id",
    "locator",
    "quantity",
    "case",
    "component",
    "printed",
    "unit",
    "kind",
    "note",
)
VALUE_KINDS = ("input", "result", "timing")
ARTEFACT_COLUMNS = ("id", "kind", "caption", "class", "target")
ARTEFACT_KINDS = ("table", "figure", "animation")
Row = dict[str, str]


class Ledger:
    """The printed numbers of one document, asked by their ids without the document's name.

    Attributes
    ----------
    rows
        The document's rows of ``values.csv``, in the document's order.
    """

    def __init__(self, rows: Iterable[Row], document: str) -> None:
        self._document = document
        self.rows = list(rows)
        self._literals = {
            row["id"].removeprefix(f"{document}/"): row["printed"] for row in self.rows
        }

    @classmethod
    def read(cls, path: Path | str) -> Self:
        """The ledger of a study from its ``values.csv``; errors as from `read_ledger`."""
        return cls(read_ledger(Path(path)), Path(path).resolve().parent.name)

    def literal(self, identifier: str) -> str:
        """A literal as printed.

        Raises
        ------
        InputError
            If the document has no such row.
        """
        try:
            return self._literals[identifier]
        except KeyError:
            raise InputError(
                f"values.csv: no id '{self._document}/{identifier}'; restore its row"
            ) from None

    def value(self, identifier: str) -> Printed:
        """A printed number and how finely it was printed; an `InputError` where it is none."""
        printed = parse_printed(self.literal(identifier))
        if printed is None:
            raise InputError(
                f"values.csv: '{self._document}/{identifier}': "
                f"{self.literal(identifier)!r} is no number; restore it"
            )
        return printed

    def values(self, place: str) -> list[Printed]:
        """The printed numbers of a vector or list, ``place/x`` or ``place/item-1`` and so on.

        They come in the document's order; an `InputError` where the document has none there.
        """
        found = [name for name in self._literals if name.rpartition("/")[0] == place]
        if not found:
            raise InputError(f"values.csv: no id '{self._document}/{place}/...'; restore its rows")
        return [self.value(name) for name in found]


def read_ledger(path: Path) -> list[Row]:
    """Read a study's ``values.csv``: one row a published number, as text.

    The column ``document`` is the name of the study, which is that of the folder.

    Raises
    ------
    InputError
        On a missing column, a duplicate id, an unknown kind, or a number that does not parse,
        naming the line.
    """
    table = _read(path, VALUE_COLUMNS)
    for line, row in _numbered(table):
        _require(path, line, "kind", row["kind"], VALUE_KINDS)
        printed = row["printed"]
        if not printed:
            raise InputError(f"{path}: line {line}: 'printed' is empty; write {LOST} if lost")
        measured = row["kind"] != "input"
        if measured and looks_numeric(printed) and parse_printed(printed) is None:
            raise InputError(
                f"{path}: line {line}: 'printed' is {printed!r}, which is no number; "
                f"allowed: a decimal, '<' and a decimal, arithmetic, or {LOST}"
            )
    _unique(path, table, ["id"])
    return table


def read_published(published: Path, study: Study) -> tuple[list[Row], list[Row]]:
    """The values and the artefacts of a study, as many as its ``study.yaml`` says.

    Raises
    ------
    InputError
        Naming the file in which rows are missing or have been added, or what else is wrong.
    """
    folder = published / study.name
    values, artefacts = read_ledger(folder / "values.csv"), read_artefacts(folder / "artefacts.csv")
    for name, rows, number in (
        ("values", values, study.values),
        ("artefacts", artefacts, study.artefacts),
    ):
        if len(rows) != number:
            raise InputError(
                f"{folder / name}.csv: {len(rows)} rows, but study.yaml says {name}: {number}; "
                f"restore what is lost, or count what is new there"
            )
    return values, artefacts


def read_artefacts(path: Path) -> list[Row]:
    """Read a study's ``artefacts.csv``: one row a table, figure or animation.

    An empty target means that the artefact's part of the study is not built yet.
    """
    table = _read(path, ARTEFACT_COLUMNS)
    for line, row in _numbered(table):
        _require(path, line, "kind", row["kind"], ARTEFACT_KINDS)
    _unique(path, table, ["id"])
    return table


def _read(path: Path, columns: tuple[str, ...]) -> list[Row]:
    try:
        with Path(path).open(newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file, strict=True)
            missing = [name for name in columns if name not in (reader.fieldnames or ())]
            if missing:
                raise InputError(
                    f"{path}: column '{missing[0]}' is missing; needed: {', '.join(columns)}"
                )
            rows: list[Row] = []
            for row in reader:
                if None in row or None in row.values():
                    raise InputError(
                        f"{path}: line {reader.line_num}: not {len(columns)} fields; restore it"
                    )
                rows.append(row)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file; restore it from the repository") from None
    except (csv.Error, UnicodeDecodeError) as error:
        raise InputError(f"{path}: not a CSV file ({error}); restore it") from None
    document = {"document": Path(path).resolve().parent.name}
    return [document | {name: row[name] for name in columns} for row in rows]


def _numbered(table: list[Row]) -> Iterator[tuple[int, Row]]:
    # Line 1 is the header.
    return enumerate(table, start=2)


def _require(path: Path, line: int, column: str, value: str, allowed: tuple[str, ...]) -> None:
    if value not in allowed:
        raise InputError(
            f"{path}: line {line}: '{column}' is {value!r}; allowed: {', '.join(allowed)}"
        )


def _unique(path: Path, table: list[Row], columns: list[str]) -> None:
    seen: set[str] = set()
    for line, row in _numbered(table):
        name = " ".join(row[column] for column in columns)
        if name in seen:
            raise InputError(f"{path}: line {line}: duplicate id '{name}'; every id occurs once")
        seen.add(name)
