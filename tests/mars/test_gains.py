"""Gains from the requirements."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from smallsat.studies.mars.model.gains import damping_ratios, decay_times, gains

moment = st.floats(0.1, 100.0)


@given(st.tuples(moment, moment, moment).map(np.array), st.floats(1.0, 1e4), st.floats(0.1, 3.0))
def test_requirements_are_met_with_equality_on_the_deciding_axes(inertia, decay, damping):
    """Largest decay time and damping ratio equal what is required, to 1e-12."""
    chosen = gains(inertia, decay, damping)
    assert decay_times(inertia, chosen).max() == pytest.approx(decay, rel=1e-12)
    assert damping_ratios(inertia, chosen).max() == pytest.approx(damping, rel=1e-12)


@pytest.mark.parametrize("axis", range(3))
def test_formulas_are_the_linearised_loops(axis):
    """Against the eigenvalues of the axis's oscillator I s'' + P s' + K/4 s, to 1e-6."""
    inertia = np.array([10.0, 5.0, 7.5])
    chosen = gains(inertia, 120.0, 0.9)
    moment = inertia[axis]
    roots = np.roots([moment, chosen.p, chosen.k / 4.0])
    assert -1.0 / roots.real.mean() == pytest.approx(decay_times(inertia, chosen)[axis])
    ratio = -roots.real.mean() / np.sqrt(np.prod(roots).real)
    assert ratio == pytest.approx(damping_ratios(inertia, chosen)[axis], rel=1e-6)
