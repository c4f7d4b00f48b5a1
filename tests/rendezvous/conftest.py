import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from smallsat.studies.rendezvous.configuration import Truth
from smallsat.studies.rendezvous.guidance.law import Law
from smallsat.studies.rendezvous.model.environment import environment, target_state

# Made-up tables, which several test files use.
sys.path.insert(0, str(Path(__file__).parent))

# The first call of a compiled function compiles it.
settings.register_profile("compiled", deadline=None)
settings.load_profile("compiled")

MEAN_MOTION = 0.00114
MASS = 14.0
TRUTH = Truth(
    gravity_degree=8,
    gravity_order=8,
    density_factor=1.0,
    drag_coefficient={"target": 2.0, "chaser": 1.4},
    body_size_m={"radial": 0.2, "along": 0.3, "normal": 0.1},
    inclination_deg=51.6,
    raan_deg=20.0,
    argument_of_latitude_deg=30.0,
    earth_angle_deg=40.0,
    step_s=30.0,
)


@pytest.fixture(scope="session")
def section(config):
    return config.rendezvous


@pytest.fixture(scope="session")
def surroundings():
    """Environment with another mean motion or some settings changed."""

    def make(mean_motion=MEAN_MOTION, **changes):
        return environment(TRUTH.with_(**changes), mean_motion, MASS)

    return make


@pytest.fixture(scope="session")
def target():
    """Inertial state of the target."""
    return target_state(TRUTH, MEAN_MOTION)


@pytest.fixture
def mean_motion():
    return MEAN_MOTION


@pytest.fixture(scope="session")
def law():
    """A V-bar law of the document's tables with round numbers for what it does not print."""
    return Law(
        mean_motion=MEAN_MOTION,
        sample_times=(30.0, 20.0, 5.0),
        horizons=(30, 15, 12),
        state_weights=np.array([[1, 1, 100, 1, 1, 10], [1] * 6, [20] * 6], dtype=float),
        control_weights=np.array([[1e3] * 3, [1e3] * 3, [1e6] * 3]),
        penalties=(10.0, 10.0, 0.0),
        cone_angles=tuple(np.radians([15.0, 15.0, 8.0])),
        control_bounds=(0.1786, 0.1786, 0.0357),
        keep_out=190.0,
        overshoot=8.0,
        set_points=(170.0, 7.5),
        switch_distances=(200.0, 8.3, 0.1),
        speed_bound=0.03,
        axis=(0.0, 1.0, 0.0),
    )


@pytest.fixture(scope="session")
def laws(law):
    """Laws of every kind of program: axes, rotation, no set point, 1-norm, oblateness, delay."""
    return {
        "v-bar": law,
        "r-bar": law.with_(axis=(-1.0, 0.0, 0.0)),
        "rotating": law.with_(rotation_rate=0.002),
        "no set point": law.with_(set_points=(0.0, 7.5)),
        "1-norm": law.with_(
            norm_weights=np.array([1.0, 1, 100, 1, 1, 10]),
            norm_terminal_weights=np.array([10.0, 10, 1000, 10, 10, 100]),
            norm_control_weights=np.full(3, 1e3),
        ),
    }


@pytest.fixture(scope="session")
def chaser():
    """Relative state at the start of Table 3.2."""
    return np.array([140.0, -1580.0, 60.0, -0.90, -0.32, 0.0])


@pytest.fixture(scope="session")
def chasers():
    """Twelve states around the target, near the velocity of a stable ellipse."""
    random = np.random.default_rng(7)
    position = random.normal(size=(12, 3))
    position *= (
        random.uniform(250.0, 2500.0, 12)[:, None] / np.linalg.norm(position, axis=1)[:, None]
    )
    velocity = random.normal(0.0, 0.5, (12, 3))
    velocity[:, 0] += MEAN_MOTION * position[:, 1] / 2
    velocity[:, 1] -= 2 * MEAN_MOTION * position[:, 0]
    return np.hstack([position, velocity])
