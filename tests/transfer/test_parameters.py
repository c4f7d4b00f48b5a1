"""What is refused before anything runs: contradictions, and transfers that cannot be."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from smallsat.errors import InputError
from smallsat.studies.transfer.methods.continuation import minimum_time
from smallsat.studies.transfer.model.problem import TransferProblem
from smallsat.studies.transfer.model.units import canonical
from smallsat.studies.transfer.parameters import check


def test_the_document_is_accepted(config):
    """The default is allowed."""
    check(config.transfer)


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("problem.final_radius", 1.0, ("problem.final_radius", "1.0", "initial radius")),
        ("problem.thrust", 15.0, ("problem.thrust", "15.0", "exhaust_speed")),
        ("problem.exhaust_speed", 0.1, ("problem.thrust", "uses up the initial mass")),
        ("problem.initial_mass", 0.01, ("problem.thrust", "0.01")),
        ("guess.interior_state", 6.0, ("guess.interior_state", "6.0", "[-5.0, 5.0]")),
        ("guess.direct_final_time", 12.0, ("direct_final_time", "12.0", "[0.0, 11.0]")),
        ("guess.coefficient", 51.0, ("guess.coefficient", "51.0")),
    ],
)
def test_the_impossible_is_refused_in_one_line(config, changed, key, value, words):
    """Key, value and what to do."""
    with pytest.raises(InputError) as refusal:
        check(changed(config.transfer, key, value))
    line = str(refusal.value)
    assert "\n" not in line
    for word in words:
        assert word in line, line


@pytest.mark.parametrize("thrust", [0.05, 0.5, 2.0])
@pytest.mark.parametrize("radius", [0.6, 0.95, 1.05, 1.5])
def test_nothing_that_can_be_flown_is_refused(config, thrust, radius):
    """Transfers with a solution pass the check, whatever their thrust."""
    problem = config.transfer.problem.with_(thrust=thrust, final_radius=radius)
    found = minimum_time(canonical(TransferProblem.of(problem)))
    assert 0.0 < found.final_mass < 1.0
    check(config.transfer.with_(problem=problem))


@pytest.mark.parametrize("radius", [0.5, 1.5, 4.0])
def test_what_is_refused_has_no_solution_nearby(config, radius):
    """Going down from the thrust that is refused first, the bound is no tighter than the truth.

    No flight at a constant thrust angle, in steps of 15 degrees, strays as far as the orbit.
    """
    for thrust in np.geomspace(1.0, 1e3, 60):
        problem = config.transfer.problem.with_(thrust=float(thrust), final_radius=radius)
        try:
            check(config.transfer.with_(problem=problem))
        except InputError:
            break
    else:
        pytest.fail("no thrust is refused")
    problem = TransferProblem.of(problem)
    for beta in np.linspace(-np.pi, np.pi, 25):
        flight = solve_ivp(
            lambda _, x, beta=beta: problem.state_rate(x, np.sin(beta), np.cos(beta)),
            (0.0, 0.999999 * problem.longest_time),
            problem.initial_state,
            rtol=1e-9,
        )
        strayed = np.max(np.abs(flight.y[0] - problem.initial_radius))
        assert strayed < abs(radius - problem.initial_radius)
