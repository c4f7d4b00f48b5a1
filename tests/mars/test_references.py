"""The attitude runs against Basilisk's (`tests/references`): tolerances set before the comparison.

Where both integrate finely, in the independent check, what may differ is an error of either
integrator; the study's own runs take the document's steps of 1 s, whose error is larger. Half a
unit of a printed MRP's last digit is 2e-3 rad.
"""

import numpy as np
import pytest

from smallsat.results import read_table
from smallsat.studies.mars.methods import laws
from smallsat.studies.mars.methods.closed_loop import as_table as loop_table
from smallsat.studies.mars.methods.closed_loop import simulate
from smallsat.studies.mars.methods.independent_check import attitude_angle
from smallsat.studies.mars.methods.simulation import NADIR, SUN, as_table

SIGMA, OMEGA = ([f"{name}_{axis}" for axis in "123"] for name in ("sigma", "omega"))


@pytest.fixture(scope="module")
def reference(root):
    return read_table(root / "tests/references/basilisk-attitude.csv")


def apart(reference, name, table, until=np.inf):
    """Largest difference of attitude, rad, and of rate, rad/s, at the reference's times."""
    expected = reference[(reference["run"] == name) & (reference["time_s"] <= until)]
    found = table.set_index("time_s").loc[expected["time_s"]]
    assert len(found) > 2
    angles = attitude_angle(expected[SIGMA].to_numpy(), found[SIGMA].to_numpy())
    rates = np.abs(expected[OMEGA].to_numpy() - found[OMEGA].to_numpy())
    return float(angles.max()), float(rates.max())


def test_independent_check(reference, tested_run):
    """All of it by quaternions and order 8: to 1e-6 rad and 1e-8 rad/s, 1e-5 under the torque."""
    checked = read_table(tested_run / "data/results/mars/independent.parquet")
    for name in ("no torque", "fixed torque", "sun", "nadir", "mission"):
        angle, rate = apart(reference, name, checked[checked["run"] == name])
        spins = name == "fixed torque"
        assert angle < (1e-5 if spins else 1e-6), name
        assert rate < (1e-5 if spins else 1e-8), name


@pytest.mark.parametrize("name", ["no torque", "sun", "nadir", "mission"])
def test_runs_of_the_document(reference, runs, name):
    """Steps of 1 s: to 1e-5 rad and 1e-6 rad/s, in every mode and over all switches."""
    angle, rate = apart(reference, name, as_table(runs[name]))
    assert angle < 1e-5
    assert rate < 1e-6


def test_fixed_torque(reference, runs):
    """Up to the time for which the document prints its attitude: to 1e-3 rad."""
    angle, _ = apart(reference, "fixed torque", as_table(runs["fixed torque"]), until=100.0)
    assert angle < 1e-3


@pytest.fixture(scope="module")
def loop(section, parameters):
    """A closed loop of the beyond, of a law, in a mode, without gravity gradient if not told."""
    known, place = laws.laws(section, parameters), laws.setting(section, parameters)

    def flown(law, command, kind=laws.IDEAL, mu=0.0, **changes):
        record = simulate(
            known[law]._replace(**changes),
            laws.actuators(section)[kind]._replace(torque=np.inf, momentum=np.inf),
            place._replace(mu=mu),
            parameters.initial_state,
            parameters.inertia,
            command,
            round(section.durations_s.response / section.step_s),
        )
        return loop_table(record)

    return flown


@pytest.mark.parametrize(
    ("name", "law", "command", "kind"),
    [
        ("nadir with feed-forward", "feed-forward", NADIR, laws.IDEAL),
        ("nadir with integral", "integral", NADIR, laws.IDEAL),
        ("sun by wheels", "PD", SUN, laws.WHEELS),
    ],
)
def test_closed_loops(reference, loop, name, law, command, kind):
    """Feed-forward, integral and wheels: to 1e-5 rad, and 1e-2 rad away from the document's law."""
    angle, rate = apart(reference, name, loop(law, command, kind))
    assert angle < 1e-5
    assert rate < 1e-6
    assert apart(reference, name, loop("PD", command))[0] > 1e-2


def test_gravity_gradient(reference, section, parameters, loop):
    """The tumbling body without control: to 1e-5 rad, and 1e-3 away from the run without it."""
    mu = laws.setting(section, parameters).mu
    angle, _ = apart(reference, "gravity gradient", loop("PD", SUN, mu=mu, k=0.0, p=0.0))
    assert angle < 1e-5
    assert apart(reference, "gravity gradient", loop("PD", SUN, k=0.0, p=0.0))[0] > 1e-3
