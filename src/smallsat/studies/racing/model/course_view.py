"""A course as the document looks at it."""

import numpy as np

from smallsat.studies.racing.model.course import Course

# The view of the document's courses, degrees, as MATLAB's ``view`` counts them (Listing C.B).
VIEW_AZIMUTH_DEG, VIEW_ELEVATION_DEG = -30.0, 35.0


def crossings(course: Course, azimuth: float, elevation: float) -> int:
    """How often a course, start and end included, crosses its own line as seen from a side.

    Angles in degrees as MATLAB's ``view`` has them: an azimuth of 0 looks along +y.
    """
    path = np.vstack([course.start, course.centres, course.end])
    a, e = np.radians([azimuth, elevation])
    right = np.array([np.cos(a), np.sin(a), 0.0])
    towards = np.array([np.cos(e) * np.sin(a), -np.cos(e) * np.cos(a), np.sin(e)])
    flat = path @ np.array([right, np.cross(towards, right)]).T
    ways = np.diff(flat, axis=0)
    count = 0
    for i in range(len(ways)):
        for j in range(i + 2, len(ways)):
            both = np.column_stack([ways[i], -ways[j]])
            if np.linalg.matrix_rank(both) == 2:
                shares = np.linalg.solve(both, flat[j] - flat[i])
                count += bool(((shares > 0.0) & (shares < 1.0)).all())
    return count
