"""A course file of a person's own: read to the letter, or refused with file, line and column."""

import csv
import re
from pathlib import Path

import numpy as np

from smallsat.errors import InputError
from smallsat.studies.racing.model.course import COINCIDENT, Course

PLACE, NORMAL = ("x_m", "y_m", "z_m"), ("nx", "ny", "nz")
AXES = ("semi_major_m", "semi_minor_m")
COLUMNS = ("ring", *PLACE, *NORMAL, *AXES)
# The largest number of rings of the generator, too.
MOST_RINGS = 100
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")

Row = tuple[int, dict[str, str]]


def read_course_file(path: Path) -> Course:
    """The course of a CSV file: a row ``start``, the rings from 1 on in order, a row ``end``.

    Columns may stand in any order, parted by commas or by semicolons. Of the rows ``start`` and
    ``end`` only the place counts; their other cells may be empty. A normal of another length than
    1 is a direction all the same, and is made a unit vector.

    Raises
    ------
    InputError
        If anything else stands there than what is asked for: one line with the file's name and,
        where there is one, the line, the column, the value, and what is allowed.
    """
    path = Path(path)
    rows = _rows(path)
    _check_order(path, rows)
    rings = rows[1:-1]
    course = Course(
        start=_vector(path, rows[0], PLACE),
        centres=np.array([_vector(path, row, PLACE) for row in rings]),
        normals=np.array([_unit(path, row) for row in rings]),
        semi_axes=np.array([_semi_axes(path, row) for row in rings]),
        end=_vector(path, rows[-1], PLACE),
    )
    for row in (rows[0], rows[-1]):
        for column in (*NORMAL, *AXES):
            if row[1][column]:
                _number(path, row, column)
    _check_gaps(path, rows, course)
    return course


def _rows(path: Path) -> list[Row]:
    """The lines below the header, by column, each with its number; empty ones are passed over."""
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise InputError(f"{path}, line {line}: not UTF-8 text; save the file as UTF-8") from None
    except OSError as error:
        raise InputError(
            f"{path}: cannot be read as a file ({error.strerror}); give a CSV file"
        ) from None
    lines = text.splitlines()
    first = lines[0] if lines else ""
    reader = csv.reader(lines, delimiter=";" if first.count(";") else ",", strict=True)
    rows: list[Row] = []
    header: list[str] = []
    try:
        for cells in reader:
            line, cells = reader.line_num, [cell.strip() for cell in cells]
            if not any(cells):
                continue
            if not header:
                header = _header(path, line, cells)
            elif len(cells) == len(header):
                rows.append((line, dict(zip(header, cells, strict=True))))
            else:
                raise InputError(
                    f"{path}, line {line}: {len(cells)} cells; must be {len(header)}, as many as "
                    f"columns, with decimal points and no decimal commas"
                )
    except csv.Error as error:
        raise InputError(
            f"{path}, line {reader.line_num}: not a line of a CSV file ({error}); correct it"
        ) from None
    if not header:
        raise InputError(f"{path}: empty; needed are columns {', '.join(COLUMNS)}")
    return rows


def _header(path: Path, line: int, names: list[str]) -> list[str]:
    where = f"{path}, line {line}"
    for name in names:
        if name not in COLUMNS:
            raise InputError(
                f"{where}: column '{name}' is unknown; allowed are {', '.join(COLUMNS)}"
            )
        if names.count(name) > 1:
            raise InputError(f"{where}: column '{name}' stands there twice; remove one of them")
    for name in COLUMNS:
        if name not in names:
            raise InputError(
                f"{where}: column '{name}' is missing; needed are {', '.join(COLUMNS)}"
            )
    return names


def _check_order(path: Path, rows: list[Row]) -> None:
    if len(rows) < 3:
        raise InputError(
            f"{path}: {len(rows)} rows; needed are 'start', at least one ring and 'end'"
        )
    if len(rows) - 2 > MOST_RINGS:
        raise InputError(f"{path}: {len(rows) - 2} rings; at most {MOST_RINGS} are allowed")
    names = ["start", *map(str, range(1, len(rows) - 1)), "end"]
    for (line, row), name in zip(rows, names, strict=True):
        if row["ring"] != name:
            raise _wrong(path, line, "ring", row["ring"], f"must be '{name}' in this row")


def _wrong(path: Path, line: int, column: str, value: str, allowed: str) -> InputError:
    return InputError(
        f"{path}, line {line}, column '{column}': '{value}' is not allowed; {allowed}"
    )


def _number(path: Path, row: Row, column: str) -> float:
    line, cells = row
    text = cells[column]
    if not NUMBER.fullmatch(text) or not np.isfinite(float(text)):
        hint = ", with a decimal point" if "," in text else ""
        raise _wrong(path, line, column, text, f"must be a finite number{hint}")
    return float(text)


def _vector(path: Path, row: Row, columns: tuple[str, ...]) -> np.ndarray:
    return np.array([_number(path, row, column) for column in columns])


def _unit(path: Path, row: Row) -> np.ndarray:
    """The normal of a ring with length 1."""
    normal = _vector(path, row, NORMAL)
    largest = float(np.abs(normal).max())
    if largest == 0.0:
        text = ", ".join(row[1][column] for column in NORMAL)
        raise _wrong(path, row[0], "nx, ny, nz", text, "a normal must not be zero")
    # First by its largest component, whose square might be no number of the machine.
    normal = normal / largest
    return normal / np.linalg.norm(normal)


def _semi_axes(path: Path, row: Row) -> np.ndarray:
    axes = _vector(path, row, AXES)
    for column, value in zip(AXES, axes, strict=True):
        if not value > 0.0:
            raise _wrong(path, row[0], column, row[1][column], "must be greater than 0")
    return axes


def _check_gaps(path: Path, rows: list[Row], course: Course) -> None:
    places = np.vstack([course.start, course.centres, course.end])
    for (_, before), (line, after), gap in zip(
        rows[:-1], rows[1:], np.linalg.norm(np.diff(places, axis=0), axis=1), strict=True
    ):
        if gap < COINCIDENT:
            text = ", ".join(after[column] for column in PLACE)
            allowed = (
                f"{_called(before)} and {_called(after)} have the same centre, move one of them"
            )
            raise _wrong(path, line, ", ".join(PLACE), text, allowed)


def _called(cells: dict[str, str]) -> str:
    return f"ring {cells['ring']}" if cells["ring"].isdecimal() else f"the {cells['ring']}"
