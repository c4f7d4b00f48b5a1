"""Race courses: rings in the Hill frame, by the document's generator and by its rules."""

from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np
import pandas as pd

from smallsat.errors import InputError

# Draws for a ring: semi-major axis, semi-minor axis, distance, azimuth step, elevation step.
DRAWS = 5
COINCIDENT = 1e-6  # m


class Uniform(Protocol):
    """A source of uniform numbers in [0, 1)."""

    def random(self, size: Any = None) -> Any:
        """One number, or several."""
        ...


@dataclass(frozen=True)
class Ranges:
    """What the generator draws from: (least, largest) of each, SI units and radians."""

    semi_major: tuple[float, float]
    semi_minor: tuple[float, float]
    distance: tuple[float, float]
    azimuth: tuple[float, float]
    elevation: tuple[float, float]
    rings: tuple[int, int]


@dataclass(frozen=True)
class Course:
    """Rings in the order of the race.

    Attributes
    ----------
    start
        Centre (3,) of the start, m, Hill frame with its origin at the mean of all ring centres.
    centres, normals
        Centres and normals of the rings, (l, 3); a CubeSat crosses along the normal.
    semi_axes
        Semi-major and semi-minor axis as drawn, (l, 2), m; either may be the larger.
    end
        Centre (3,) of the end ring, m.
    """

    start: np.ndarray
    centres: np.ndarray
    normals: np.ndarray
    semi_axes: np.ndarray
    end: np.ndarray

    @property
    def rings(self) -> int:
        """Number of rings, start and end not counted."""
        return len(self.centres)

    @property
    def sizes(self) -> np.ndarray:
        """The smaller axis of each ring (l,), m: the largest miss that counts as a passage."""
        return self.semi_axes.min(axis=1)

    @property
    def axes(self) -> np.ndarray:
        """Unit vectors (l, 2, 3) that span each ring's plane: level, and upward or nearly so.

        The generator of a ring is not printed; how its ellipse lies in the plane is our choice and
        matters to drawings only.
        """
        azimuth = np.arctan2(self.normals[:, 1], self.normals[:, 0])
        level = np.column_stack([-np.sin(azimuth), np.cos(azimuth), np.zeros(self.rings)])
        return np.stack([level, np.cross(self.normals, level)], axis=1)

    def shifted(self, by: np.ndarray) -> "Course":
        """The same course elsewhere."""
        return replace(self, start=self.start + by, centres=self.centres + by, end=self.end + by)


def generate(
    draw: Uniform,
    ranges: Ranges,
    rings: int | None = None,
    halved: bool = True,
) -> Course:
    """One random course.

    Parameters
    ----------
    draw
        Source of uniform numbers in [0, 1): one for the number of rings, then five a ring.
    ranges
        Ranges of everything that is drawn.
    rings
        Number of rings, where it is given and not drawn.
    halved
        As the generator does, though the text does not say it: up to half of the rings the steps of
        both angles come from the lower half of their ranges, later from the upper half. False takes
        the whole range every time.
    """
    first = float(draw.random())
    low, high = ranges.rings
    if rings is None:
        rings = low + int(np.floor((high - low + 1) * first))
    azimuth, elevation = np.pi / 2.0, 0.0
    centre, distance = np.zeros(3), ranges.distance[1]
    centres, normals, axes = [], [], []
    normal = _direction(azimuth, elevation)
    for k in range(1, rings + 1):
        u = draw.random(DRAWS)
        major, minor, gap = (
            lo + (hi - lo) * x
            for (lo, hi), x in zip(
                (ranges.semi_major, ranges.semi_minor, ranges.distance), u[:3], strict=True
            )
        )
        steps = []
        for (lo, hi), x in zip((ranges.azimuth, ranges.elevation), u[3:], strict=True):
            middle = 0.5 * (lo + hi)
            if halved:
                lo, hi = (lo, middle) if k <= rings / 2 else (middle, hi)
            steps.append(lo + (hi - lo) * x)
        if k == 1:
            # The first ring is fixed: the largest, along +y; its draws are spent all the same.
            major, minor = ranges.semi_major[1], ranges.semi_minor[1]
        else:
            centre = centre + gap * normal
            azimuth, elevation = azimuth + steps[0], elevation + steps[1]
            normal = _direction(azimuth, elevation)
        centres.append(centre)
        normals.append(normal)
        axes.append((major, minor))
    end = centre + ranges.distance[0] * normal
    start = centres[0] - distance * normals[0]
    origin = np.mean([*centres, end], axis=0)
    course = Course(start, np.array(centres), np.array(normals), np.array(axes), end)
    return course.shifted(-origin)


def _direction(azimuth: float, elevation: float) -> np.ndarray:
    flat = np.cos(elevation)
    return np.array([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)])


def check_course(course: Course, name: str) -> None:
    """Refuse a course that cannot be flown.

    Raises
    ------
    InputError
        If it has no ring, a ring of no size, or two consecutive centres that coincide.
    """
    if course.rings == 0:
        raise InputError(f"{name}: no ring; a course needs at least 1, add one")
    for k, size in enumerate(course.sizes, start=1):
        if not size > 0.0:
            raise InputError(
                f"{name}: ring {k} has a semi-axis of {size:g} m; must be greater than 0"
            )
    path = np.vstack([course.start, course.centres, course.end])
    gaps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    for k, gap in enumerate(gaps):
        if gap < COINCIDENT:
            names = ["the start", *(f"ring {i}" for i in range(1, course.rings + 1)), "the end"]
            raise InputError(
                f"{name}: {names[k]} and {names[k + 1]} have the same centre; move one of them"
            )


def course_table(course: Course) -> pd.DataFrame:
    """Tidy table of a course: start, rings in order, end."""
    rows = np.column_stack([course.centres, course.normals, course.semi_axes])
    names = ["x_m", "y_m", "z_m", "nx", "ny", "nz", "semi_major_m", "semi_minor_m"]
    first = [*course.start, *course.normals[0], np.nan, np.nan]
    last = [*course.end, *course.normals[-1], np.nan, np.nan]
    table = pd.DataFrame([first, *rows, last], columns=names)
    table.insert(0, "ring", ["start", *(str(k) for k in range(1, course.rings + 1)), "end"])
    return table


def course_of(table: pd.DataFrame, name: str) -> Course:
    """The course of a table written by `course_table`, checked."""
    spots = table[["x_m", "y_m", "z_m"]].to_numpy(dtype=float)
    rings = table.iloc[1:-1]
    course = Course(
        start=spots[0],
        centres=spots[1:-1],
        normals=rings[["nx", "ny", "nz"]].to_numpy(dtype=float),
        semi_axes=rings[["semi_major_m", "semi_minor_m"]].to_numpy(dtype=float),
        end=spots[-1],
    )
    check_course(course, name)
    return course
