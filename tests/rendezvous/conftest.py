import sys
from pathlib import Path

import pytest
from hypothesis import settings

from smallsat.rendezvous.environment import environment, target_state

# Made-up tables, which several test files use.
sys.path.insert(0, str(Path(__file__).parent))

# The first call of a compiled function compiles it.
settings.register_profile("compiled", deadline=None)
settings.load_profile("compiled")

MEAN_MOTION = 0.00114
MASS = 14.0
TRUTH = {
    "gravity_degree": 8,
    "gravity_order": 8,
    "density_factor": 1.0,
    "drag_coefficient": {"target": 2.0, "chaser": 1.4},
    "body_size_m": {"radial": 0.2, "along": 0.3, "normal": 0.1},
    "inclination_deg": 51.6,
    "raan_deg": 20.0,
    "latitude_angle_deg": 30.0,
    "earth_angle_deg": 40.0,
    "step_s": 30.0,
}


@pytest.fixture(scope="session")
def surroundings():
    """Environment with another mean motion or some settings changed."""

    def make(mean_motion=MEAN_MOTION, **changes):
        return environment({**TRUTH, **changes}, mean_motion, MASS)

    return make


@pytest.fixture(scope="session")
def target():
    """Inertial state of the target."""
    return target_state(TRUTH, MEAN_MOTION)


@pytest.fixture
def mean_motion():
    return MEAN_MOTION
