"""Proofs of the errata hold, and fail where what they rest on is changed."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from smallsat.results import write_table
from smallsat.studies.racing.evidence import (
    errata,
    own_claims,
    printed_claims,
    race_claims,
    solver_claims,
)
from smallsat.studies.racing.evidence.scores import CUBESATS
from smallsat.studies.racing.methods.races import ANYWHERE, GREEDY, INDIRECT, LISTING, WHOLE
from smallsat.studies.racing.methods.simple_guesses import DIRECT, DIRECTIONS, PREVIOUS

RESULTS = Path("nowhere")


@pytest.mark.parametrize(
    "proof", ["start_covariance", "start_ring_comment", "angle_steps", "costate_transpose"]
)
def test_proofs_without_results_hold(section, proof, grounds):
    """Those that need no solve."""
    assert getattr(errata, proof)(grounds("racing", section, RESULTS)).holds


@pytest.mark.parametrize(
    ("proof", "change"),
    [
        ("start_covariance", ("start.sigma_level", 1.0)),
        ("start_ring_comment", ("start.axis_multiple", 5.0)),
    ],
)
def test_proofs_fail_with_the_printed_number(section, changed, proof, change, grounds):
    """With the printed number in the configuration its proof does not hold."""
    other = changed(section, *change)
    assert not getattr(errata, proof)(grounds("racing", other, RESULTS)).holds


def test_angle_steps_need_the_seeds(section, changed, grounds):
    """Another seed gives neither start."""
    other = changed(section, "scenarios.scenario-2.seed", 739743)
    assert not errata.angle_steps(grounds("racing", other, RESULTS)).holds


def test_costate_proof_can_fail(section, monkeypatch, grounds):
    """If the listing's matrix were the right one, nothing would be proven."""
    right = errata.hamiltonian_drift
    monkeypatch.setattr(errata, "hamiltonian_drift", lambda c, transposed: right(c, True))
    assert not errata.costate_transpose(grounds("racing", section, RESULTS)).holds


def test_adjoint_proof_can_fail(section, monkeypatch, grounds):
    """With the corrected entry printed there would be no erratum."""
    printed = errata.printed_adjoint_transition

    def mended(n, t):
        matrix = printed(n, t)
        matrix[4, 1] = 3.0 * t - 4.0 / n * np.sin(n * t)
        return matrix

    assert errata.adjoint_transition(grounds("racing", section, RESULTS)).holds
    monkeypatch.setattr(errata, "printed_adjoint_transition", mended)
    assert not errata.adjoint_transition(grounds("racing", section, RESULTS)).holds


def test_ring_size_and_axial_thrust(section, monkeypatch, grounds):
    """Both hold; the law's proof fails where no component lies in the deadzone."""
    assert errata.ring_size(grounds("racing", section, RESULTS)).holds
    assert errata.axial_thrust(grounds("racing", section, RESULTS)).holds
    monkeypatch.setattr(errata, "PRIMER", np.array([2.0, 2.0, -3.0]))
    assert not errata.axial_thrust(grounds("racing", section, RESULTS)).holds


def test_options_without_effect(section, grounds):
    """Both hold for sqp; with the algorithm that they belong to they would do something."""
    assert errata.options_without_effect(grounds("racing", section, RESULTS)).holds
    other = {"listing-c-c-solvetrajectory-m/fmincon-algorithm": "interior-point"}
    assert not errata.options_without_effect(grounds("racing", section, RESULTS, other)).holds


def test_adjoint_guess(section, monkeypatch, grounds):
    """Text and code differ; did the code carry the adjoints over, nothing would be proven."""
    assert errata.adjoint_guess(grounds("racing", section, RESULTS)).holds
    flown = errata.propagate_segment
    carried = {}

    def remembered(*arguments):
        times, path = flown(*arguments)
        carried["guess"] = path[-1, 6:]
        return times, path

    guess = errata.listing.guess

    def carrying(*arguments):
        unknowns, shortest = guess(*arguments)
        return np.r_[carried.get("guess", unknowns[:6]), unknowns[6]], shortest

    monkeypatch.setattr(errata, "propagate_segment", remembered)
    monkeypatch.setattr(errata.listing, "guess", carrying)
    assert not errata.adjoint_guess(grounds("racing", section, RESULTS)).holds


def test_start_of_meeny(section, changed, grounds):
    """One coordinate of eight; none with it printed as it rounds, and many with another seed."""
    assert errata.start_of_meeny(grounds("racing", section, RESULTS)).holds
    right = {"table-3/initial-position/scenario-2-meeny/x": "-300.0"}
    assert not errata.start_of_meeny(grounds("racing", section, RESULTS, right)).holds
    other = changed(section, "scenarios.scenario-2.seed", 739743)
    assert not errata.start_of_meeny(grounds("racing", other, RESULTS)).holds


TIME, COST, MISS, LEAST = (
    "time-taken-to-complete-course",
    "final-overall-cost",
    "ring-accuracy",
    "minimum-possible-cost",
)


@pytest.mark.parametrize(
    ("claim", "digits"),
    [
        ("faster_with_thrust", {f"table-2/{TIME}/scenario-1-miny": "1874.768"}),
        ("lower_minimum_cost", {f"table-2/{LEAST}/scenario-1-mo": "400.442"}),
        ("most_accurate_in_between", {f"table-2/{MISS}/scenario-1-miny": "1.299"}),
        ("mo_missed_rings", {f"table-2/{MISS}/scenario-1-mo": "3.692"}),
        ("mo_slower_than_meeny", {f"table-2/{TIME}/scenario-1-mo": "1235.305"}),
        (
            "follows_the_course",
            {f"table-2/{MISS}/scenario-1-{name}": "965.755" for name in ("eeny", "meeny", "miny")},
        ),
        ("accuracies_vary", {f"table-4/{MISS}/scenario-2-meeny": "147.883"}),
        ("eeny_first_meeny_wins", {f"table-4/{TIME}/scenario-2-mo": "918.303"}),
        (
            "results_differ_by_start",
            {f"table-4/{COST}/scenario-2-{name}": "1133.655" for name in ("eeny", "miny", "mo")},
        ),
        ("mo_moved_fastest", {f"table-4/{LEAST}/scenario-2-mo": "576.700"}),
        ("thousand_times", {"section-v/accelerations-used-in-this-project/max": "0.9"}),
        ("cost_is_time_plus_accuracy", {f"table-2/{COST}/scenario-1-mo": "2129.008"}),
        ("printed_runs_missed", {f"table-2/{MISS}/scenario-1-miny": "91.299"}),
    ],
)
def test_printed_claims_fail_with_other_digits(section, grounds, claim, digits):
    """Each holds as printed, and fails where a digit that it rests on is another."""
    predicate = getattr(printed_claims, claim)
    assert predicate(grounds("racing", section, RESULTS)).outcome == "holds"
    assert predicate(grounds("racing", section, RESULTS, digits)).outcome == "fails"


def test_five_printed_runs_missed(section, grounds):
    """Eeny and Mo of Scenario 1, Eeny, Miny and Mo of Scenario 2."""
    judgement = printed_claims.printed_runs_missed(grounds("racing", section, RESULTS))
    for name in ("Eeny 92.1", "Mo 693.7", "Eeny 609.0", "Miny 665.8", "Mo 143.3"):
        assert name in judgement.evidence


def test_the_second_course_loops_as_drawn(section, changed, grounds):
    """In the document's view; with the courses exchanged it does not."""
    assert race_claims.second_course_loops_back(grounds("racing", section, RESULTS)).outcome == (
        "holds"
    )
    seeds = [section.scenarios[name].seed for name in ("scenario-1", "scenario-2")]
    other = changed(section, "scenarios.scenario-1.seed", seeds[1])
    other = changed(other, "scenarios.scenario-2.seed", seeds[0])
    assert (
        race_claims.second_course_loops_back(grounds("racing", other, RESULTS)).outcome == "fails"
    )


def _races(folder, solution=WHOLE, **columns):
    """A table of the races with equal numbers but for those given, by CubeSat or for all."""
    rows = [
        {"scenario": scenario, "cubesat": name, "solution": solution, "time_s": 1000.0 + 10.0 * k,
         "cost": 1000.0, "accuracy_m": 0.0, "missed": 0, "off_axis": 0, "rings": 22, "segments": 23,
         "not_converged": 0, "residual": 1e-9}
        for scenario in ("scenario-1", "scenario-2") for k, name in enumerate(CUBESATS)
    ]  # fmt: skip
    write_table(pd.DataFrame(rows).assign(**columns), folder / "races.csv")


def _outcome(claim, section, folder, grounds):
    return claim(grounds("racing", section, folder)).outcome


@pytest.mark.parametrize(("off", "outcome"), [(20, "holds"), (11, "fails")])
def test_direction_is_the_trouble_of_most_crossings(section, tmp_path, grounds, off, outcome):
    """More than half of them, or not."""
    _races(tmp_path, LISTING, off_axis=off)
    assert _outcome(solver_claims.direction_is_the_trouble, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("failed", "outcome"), [(0, "holds"), (1, "fails")])
def test_seven_numbers_need_every_segment(section, tmp_path, grounds, failed, outcome):
    """One segment without a root, and they do not suffice."""
    _races(tmp_path, INDIRECT, not_converged=failed)
    assert _outcome(solver_claims.seven_numbers_suffice, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("missed", "outcome"), [(0, "fails"), (1, "holds")])
def test_attitude_control_is_critical_only_where_rings_are_missed(
    section, tmp_path, grounds, missed, outcome
):
    """A ring that Mo could not pass would bear the claim out."""
    _races(tmp_path, missed=missed)
    assert _outcome(race_claims.mo_can_pass, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("times", "outcome"), [([30.0, 20.0], "holds"), ([20.0, 30.0], "fails")])
def test_faster_with_thrust_looks_at_what_was_solved(section, tmp_path, grounds, times, outcome):
    """A thrust without a plan is said and passed over."""
    table = pd.DataFrame(
        {"thrust_m_s2": [0.0005, 0.1, 0.2], f"{WHOLE} (s)": [np.nan, *times]}
    )  # fmt: skip
    write_table(table, tmp_path / "thrust-sweep.csv")
    judgement = race_claims.faster_with_thrust(grounds("racing", section, tmp_path))
    assert judgement.outcome == outcome
    assert "with 0.0005 m/s^2 no plan" in judgement.evidence


@pytest.mark.parametrize(("missed", "outcome"), [(0, "holds"), (1, "fails")])
def test_racing_is_viable_where_plans_pass(section, tmp_path, grounds, missed, outcome):
    """With a ring missed it would not be."""
    _races(tmp_path, missed=missed)
    shares = {
        f"{kind}_{unit}": [1.0, 2.0]
        for kind in ("cold_gas", "monopropellant", "field_emission") for unit in ("pct", "w_kg")
    }  # fmt: skip
    table = pd.DataFrame(
        {"cubesat": ["Eeny", "any"], "thrust_m_s2": 0.1, "time_s": 1e3, "delta_v_m_s": 1e2} | shares
    )
    write_table(table, tmp_path / "propellant.csv")
    assert _outcome(race_claims.racing_is_viable, section, tmp_path, grounds) == outcome


def _variants(folder, failed=23, misses=(100.0, 300.0), **columns):
    """Each variant of our solve of the listing on five flights; their counts differ by 4."""
    names = ["as listed", "both", "guess from the direct method"]
    names += ["both, guess from the direct method"]
    table = pd.DataFrame(
        {"variant": np.repeat(names, 5), "tolerance": [1e-11, 7e-12, 5e-12, 3e-12, 1e-12] * 4,
         "off_axis": [12, 13, 14, 15, 16] * 4, "iterations": [12, 13, 14, 15, 16] * 4,
         "rings": 22, "segments": 23, "not_converged": failed, "time_s": 900.0,
         "accuracy_m": [*misses, *[misses[0]] * 3, *[1.0] * 15]} | columns
    )  # fmt: skip
    write_table(table, folder / "variants.csv")


@pytest.mark.parametrize(
    ("after", "outcome"),
    [
        ((7, 8, 9, 10, 11), "holds"),
        ((8, 9, 10, 11, 14), "undecided"),
        ((12, 13, 14, 15, 16), "fails"),
        ((17, 18, 19, 20, 21), "fails"),
    ],
)
@pytest.mark.parametrize(
    ("claim", "place", "column"),
    [
        (solver_claims.guess_alone_is_a_cause, 2, "off_axis"),
        (solver_claims.guess_is_a_cause, 3, "off_axis"),
        (solver_claims.guess_explains_run_time, 2, "iterations"),
    ],
)
def test_a_better_guess_must_help_by_more_than_rounding(
    section, tmp_path, grounds, after, outcome, claim, place, column
):
    """By the ranks of all flights, or nothing is told; a median that is no lower is no help."""
    numbers = [12, 13, 14, 15, 16] * 4
    numbers[5 * place : 5 * place + 5] = after
    _races(tmp_path, INDIRECT)
    _variants(tmp_path, **{column: numbers})
    assert _outcome(claim, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(
    ("failed", "misses", "outcome"),
    [(23, (100.0, 300.0), "holds"), (0, (100.0, 300.0), "fails"), (23, (100.0, 101.0), "fails")],
)
def test_the_listing_stays_unconverged(section, tmp_path, grounds, failed, misses, outcome):
    """Unconverged and ending elsewhere; converged; or ending at the same place."""
    _variants(tmp_path, failed=failed, misses=misses)
    assert _outcome(solver_claims.listing_stays_unconverged, section, tmp_path, grounds) == outcome


def _guesses(folder, directions, previous, sizes=(0.01, 5.0), angles=(10.0, 120.0)):
    rows = [
        (kind, converged, sizes[k % 2], angles[k % 2])
        for kind, share in ((DIRECT, 1.0), (DIRECTIONS, directions), (PREVIOUS, previous))
        for k, converged in enumerate(np.arange(10) < 10 * share)
    ]
    columns = ["guess", "converged", "size_against_right", "angle_to_right_deg"]
    write_table(pd.DataFrame(rows, columns=columns), folder / "simple-guesses.csv")


@pytest.mark.parametrize(
    ("shares", "outcome"), [((0.2, 0.1), "holds"), ((0.8, 0.1), "fails"), ((0.2, 0.5), "fails")]
)
def test_no_easy_guess(section, tmp_path, grounds, shares, outcome):
    """A simple guess that solves half of the segments is an easy one."""
    _guesses(tmp_path, *shares)
    assert _outcome(solver_claims.no_easy_guess, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(
    ("sizes", "angles", "outcome"),
    [((0.01, 5.0), (10.0, 120.0), "holds"), ((0.5, 2.0), (10.0, 120.0), "fails"),
     ((0.01, 5.0), (10.0, 20.0), "fails")],
)  # fmt: skip
def test_previous_adjoints(section, tmp_path, grounds, sizes, angles, outcome):
    """Orders of magnitude off and turned about, or only one of it."""
    _guesses(tmp_path, 0.0, 0.0, sizes, angles)
    claim = solver_claims.previous_adjoints_are_far_off
    assert _outcome(claim, section, tmp_path, grounds) == outcome


def test_the_time_guess_is_the_texts_with_a_multiple_of_one(section, changed, grounds):
    """As the text has it; the listing takes ten times as much."""
    claim = solver_claims.guess_is_ten_times_that
    assert _outcome(claim, section, RESULTS, grounds) == "fails"
    other = changed(section, "listing.duration_multiple", 1.0)
    assert _outcome(claim, other, RESULTS, grounds) == "holds"


def test_redundancy_can_fail(section, monkeypatch, grounds):
    """Were the twelve rows of rank five, nothing would be redundant beyond the fixed ones."""
    monkeypatch.setattr(solver_claims, "equality_ranks", lambda *_, **__: (5, 5, 3))
    claim = solver_claims.equalities_are_redundant
    assert _outcome(claim, section, RESULTS, grounds) == "fails"


TRACE = ["time_s", "x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s", "ux_m_s2", "uy_m_s2",
         "uz_m_s2", "px", "py", "pz", "pvx", "pvy", "pvz"]  # fmt: skip


def _listing_paths(parameters, folder, swing=1.0, kick=0.0):
    """Paths of the listing's law for two segments of Mo, made by the exponential of its matrix."""
    from scipy.linalg import expm

    from smallsat.studies.racing.model.shooting import costate_matrix

    matrix = costate_matrix(parameters.mean_motion, transposed=False)
    rows = []
    for segment in range(2):
        first = np.array([0.01, -0.02, 0.01, 1.0, 2.0, -1.0])
        for k in range(11):
            costates = expm(matrix * 10.0 * k) @ first + kick * (k == 5)
            sign = swing * (-1.0) ** k
            row = [100.0 * segment + 10.0 * k, *np.zeros(6), *(0.1 * sign * np.ones(3))]
            rows.append([LISTING, "Mo", segment, *row, *costates])
    table = pd.DataFrame(rows, columns=["solution", "cubesat", "segment", *TRACE])
    write_table(table, folder / "listing-scenario-1-trajectories.parquet")


@pytest.mark.parametrize(("kick", "outcome"), [(0.0, "holds"), (0.1, "fails")])
def test_adjoints_are_smooth(section, parameters, tmp_path, grounds, kick, outcome):
    """The exponential of their matrix is; with a kick they are not."""
    _listing_paths(parameters, tmp_path, kick=kick)
    assert _outcome(solver_claims.adjoints_are_smooth, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("swing", "outcome"), [(1.0, "holds"), (0.01, "fails")])
def test_control_varies_wildly(section, parameters, tmp_path, grounds, swing, outcome):
    """From limit to limit in each segment, or hardly."""
    _listing_paths(parameters, tmp_path, swing=swing)
    assert _outcome(solver_claims.control_varies_wildly, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("idle", "outcome"), [([0.0, 2.5], "holds"), ([0.0, 0.0], "fails")])
def test_thrust_is_forced_to_zero(section, tmp_path, grounds, idle, outcome):
    """Where it vanishes in one solve, or in none."""
    table = pd.DataFrame(
        {"scenario": "scenario-1", "cubesat": "Mo", "tolerance": [1e-11, 1e-12], "segments": 23,
         "segments_without_thrust": 0, "without_thrust_s": idle}
    )  # fmt: skip
    write_table(table, tmp_path / "without-thrust.csv")
    assert _outcome(solver_claims.thrust_is_forced_to_zero, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("last", "outcome"), [(1e-6, "holds"), (0.5, "fails")])
def test_position_adjoints_vanish_at_rest(section, tmp_path, grounds, last, outcome):
    """Zero at the end, or not."""
    table = pd.DataFrame(
        {"solution": ANYWHERE, "cubesat": "Eeny", "segment": [0, 1], "px": [1.0, last], "py": 0.0,
         "pz": 0.0}
    )  # fmt: skip
    write_table(table, tmp_path / "optima-scenario-1-trajectories.parquet")
    claim = solver_claims.position_adjoints_vanish_at_rest
    assert _outcome(claim, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("theirs", "outcome"), [(0.9, "holds"), (0.0, "fails")])
def test_transversality_left_to_the_cost(section, tmp_path, monkeypatch, grounds, theirs, outcome):
    """A primer along the normal in the listing's solve, or none."""
    shares = {GREEDY: 1e-5, LISTING: theirs}
    monkeypatch.setattr(solver_claims, "primer_at_rings", lambda _, __, name: shares[name])
    claim = solver_claims.transversality_left_to_the_cost
    assert _outcome(claim, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("multiplier", "outcome"), [(0.3, "holds"), (1.2, "fails")])
def test_the_penalty_is_exact_below_its_weight(section, tmp_path, grounds, multiplier, outcome):
    """A multiplier above one would pay for a miss."""
    table = pd.DataFrame(
        {"cubesat": CUBESATS, "intervals": 20, "time_s": 1.0,
         "largest_ring_multiplier_s_m": multiplier}
    )  # fmt: skip
    write_table(table, tmp_path / "meshes.csv")
    assert _outcome(own_claims.penalty_is_exact, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("multiplier", "outcome"), [(0.4, "fails"), (1.2, "holds")])
def test_accuracy_is_compared_over_the_documents_thrusts(
    section, tmp_path, grounds, multiplier, outcome
):
    """A multiplier above one among them would make a miss pay; below them it is only said."""
    table = pd.DataFrame(
        {"thrust_m_s2": [0.001, 0.1, 0.5], f"{WHOLE} (s)": 1.0, f"{WHOLE}, residual": 1e-9,
         "largest_ring_multiplier_s_m": [7.0, multiplier, 0.1]}
    )  # fmt: skip
    write_table(table, tmp_path / "thrust-sweep.csv")
    judgement = race_claims.no_thrust_is_best_for_accuracy(grounds("racing", section, tmp_path))
    assert judgement.outcome == outcome
    assert "m/s^2 or less it would save more" in judgement.evidence


@pytest.mark.parametrize(("times", "outcome"), [((1.0, 2.0), "holds"), ((2.0, 1.0), "fails")])
def test_mo_is_slower_in_the_race(section, tmp_path, grounds, times, outcome):
    """By the optimal times of Meeny and Mo."""
    by_cubesat = [1.0, times[0], 1.0, times[1]] * 2
    _races(tmp_path, time_s=by_cubesat)
    assert _outcome(race_claims.mo_slower_than_meeny, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("first", "outcome"), [(3, "holds"), (0, "fails")])
def test_mo_has_the_potential_where_it_is_fastest(section, tmp_path, grounds, first, outcome):
    """By the optimal times of Scenario 2."""
    times = [1.0 if k == first else 2.0 for k in range(4)]
    _races(tmp_path, time_s=times * 2)
    assert _outcome(race_claims.potential_is_equal, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("spread", "outcome"), [(0.01, "fails"), (300.0, "holds")])
def test_start_positions_matter_where_times_differ(section, tmp_path, grounds, spread, outcome):
    """By a tenth of the time, or hardly."""
    write_table(
        pd.DataFrame({"time_s": [1000.0, 1000.0 + spread]}), tmp_path / "random-positions.csv"
    )
    claim = race_claims.start_positions_hardly_matter
    assert _outcome(claim, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("miss", "outcome"), [(1e-9, "fails"), (1.0, "holds")])
def test_the_problem_is_smooth_away_from_its_kink(section, tmp_path, grounds, miss, outcome):
    """An optimum off the centres would not lie in the kink of the miss."""
    _races(tmp_path, accuracy_m=miss)
    assert _outcome(race_claims.not_smooth, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("jump", "outcome"), [(0.3, "holds"), (0.0, "fails")])
def test_adjoints_jump(section, tmp_path, grounds, jump, outcome):
    """Where a ring has a multiplier, or none has."""
    meshes = pd.DataFrame(
        {"intervals": [20], "time_s": 1.0, "largest_ring_multiplier_s_m": jump}
    )  # fmt: skip
    write_table(meshes, tmp_path / "meshes.csv")
    segments = pd.DataFrame(
        {"solution": [WHOLE], "cubesat": "Meeny", "px": 1.0, "py": 0.0, "pz": 0.0}
    )
    write_table(segments, tmp_path / "optima-scenario-1-segments.csv")
    assert _outcome(race_claims.adjoints_jump, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("fine", "outcome"), [(0.001, "holds"), (0.2, "fails")])
def test_the_hamiltonian_comes_nearer(section, tmp_path, grounds, fine, outcome):
    """On a finer mesh its error must be less."""
    table = pd.DataFrame(
        {"intervals": [20, 80], "time_s": 1.0, "hamiltonian_error": [0.1, fine],
         "hamiltonian_median_error": [0.01, fine]}
    )  # fmt: skip
    write_table(table, tmp_path / "meshes.csv")
    assert _outcome(race_claims.hamiltonian_is_minus_one, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("angle", "outcome"), [(0.01, "holds"), (20.0, "fails")])
def test_thrust_against_the_primer(section, tmp_path, grounds, angle, outcome):
    """Turned by degrees it would not be against it."""
    table = pd.DataFrame(
        {"intervals": 20, "time_s": 1.0, "full_thrust_share": 0.99,
         "primer_angle_median_deg": [angle, np.nan], "primer_angle_largest_deg": [angle, np.nan],
         "sign_share": [np.nan, 1.0]}
    )  # fmt: skip
    write_table(table, tmp_path / "meshes.csv")
    assert _outcome(race_claims.full_thrust_against_primer, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("whole", "outcome"), [(900.0, "holds"), (1100.0, "fails")])
def test_several_rings_remedy_where_they_are_faster(section, tmp_path, grounds, whole, outcome):
    """The whole course against its segments."""
    _races(tmp_path, GREEDY, time_s=1000.0)
    greedy = pd.read_csv(tmp_path / "races.csv")
    _races(tmp_path, time_s=whole)
    write_table(pd.concat([greedy, pd.read_csv(tmp_path / "races.csv")]), tmp_path / "races.csv")
    assert _outcome(race_claims.whole_course_remedies, section, tmp_path, grounds) == outcome


@pytest.mark.parametrize(("late", "outcome"), [(500.0, "holds"), (5000.0, "fails")])
def test_printed_times_among_random_courses(section, tmp_path, grounds, late, outcome):
    """Courses that take longer than the printed times would turn it about."""
    _races(tmp_path)
    table = pd.DataFrame({"rule": "generator", "time_s": [late, late + 1.0, late + 2.0]})
    write_table(table, tmp_path / "random-courses.csv")
    assert _outcome(own_claims.published_among_random, section, tmp_path, grounds) == outcome
