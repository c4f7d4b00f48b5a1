"""Each published value gets exactly one verdict; each way to each of the seven is shown here."""

from math import isnan, nan

import pandas as pd
import pytest

from smallsat.errors import InputError
from smallsat.evidence.errata import ERRATA_COLUMNS
from smallsat.evidence.observation import Observation, observations_table
from smallsat.evidence.verdicts import PENDING, VERDICT_COLUMNS, VERDICTS, judge
from smallsat.quantities import Part

ID = "transfer/table-1/time"


class Made(Part):
    """A section of a study."""

    radius: float = 1.5


RULE = {"ids": [ID], "reason": "because"}


def row(printed="3.24694", kind="result", **more):
    blank = dict.fromkeys(VERDICT_COLUMNS, "") | {"note": ""}
    return blank | {"id": ID, "document": "transfer", "printed": printed, "kind": kind} | more


def proven(holds=True, key="wrong-time"):
    proof = dict.fromkeys(ERRATA_COLUMNS, "") | {"statement": "computed both ways"}
    return pd.DataFrame([proof | {"key": key, "holds": holds}])


def verdict(
    *computed, printed="3.24694", kind="result", rule=None, binding=None, erratum=False, holds=True
):
    """Judge one row; a number stands for an observation with that value."""
    observations = [
        one if isinstance(one, Observation) else Observation(ID, one) for one in computed
    ]
    table = judge(
        [row(printed, kind)],
        observations_table(observations),
        [RULE | rule] if rule else [],
        [{"ids": [ID]} | binding] if binding else [],
        [{"ids": [ID], "key": "wrong-time"}] if erratum else [],
        proven(holds),
        Made(),
    )
    assert list(table.columns) == list(VERDICT_COLUMNS)
    (outcome,) = table.itertuples()
    assert outcome.verdict in (*VERDICTS, PENDING)
    assert outcome.reason
    return outcome


def test_reproduced_is_half_a_unit_of_the_last_digit():
    outcome = verdict(3.246944)
    assert outcome.verdict == "reproduced"
    assert outcome.difference == pytest.approx(4e-6)
    assert outcome.tolerance == pytest.approx(5e-6)
    assert verdict(3.246946).verdict == "mismatch"


def test_any_run_may_reproduce_and_the_reason_names_it():
    runs = [Observation(ID, 3.24694, run="as published"), Observation(ID, 3.2460, run="converged")]
    outcome = verdict(*runs)
    assert outcome.verdict == "reproduced"
    assert outcome.computed == 3.24694
    assert "(as published)" in outcome.reason


def test_consistent_is_inside_a_tolerance_with_its_reason():
    outcome = verdict(3.2475, rule={"tolerance": 1e-3})
    assert (outcome.verdict, outcome.tolerance) == ("consistent", 1e-3)
    assert outcome.reason == "because"
    assert verdict(3.2485, rule={"tolerance": 1e-3}).verdict == "mismatch"


def test_a_tolerance_wider_than_the_digits_leaves_reproduced_reproduced():
    assert verdict(3.24694, rule={"tolerance": 1e-3}).verdict == "reproduced"


def test_a_tolerance_stricter_than_the_digits_replaces_them():
    """A printed bare 0 or 1 that is exact: half a unit would let 0.4 pass."""
    assert verdict(0.4, printed="0").verdict == "reproduced"
    assert verdict(0.4, printed="0", rule={"tolerance": 1e-12}).verdict == "mismatch"
    assert verdict(1e-4, printed="0", rule={"tolerance": 1e-3}).verdict == "consistent"


def test_an_exact_literal_is_reproduced_to_rounding():
    """What a rule calls exact is the stricter question, and a yes to it no weaker verdict."""
    outcome = verdict(1e-15, printed="0", rule={"exact": 1e-12})
    assert (outcome.verdict, outcome.reason) == ("reproduced", "because")
    assert outcome.tolerance == 1e-12
    assert verdict(0.4, printed="0", rule={"exact": 1e-12}).verdict == "mismatch"


def test_truncated_digits_are_consistent():
    assert verdict(3.246949, rule={"truncated": True}).verdict == "consistent"
    assert verdict(3.24695, rule={"truncated": True}).verdict == "mismatch"


def better(value, residual):
    rule = {"objective": "minimise", "feasible_to": 1e-8}
    return verdict(Observation(ID, value, residual=residual), rule=rule)


def test_surpassed_needs_a_better_value_that_is_feasible():
    outcome = better(3.2460, 1e-11)
    assert outcome.verdict == "surpassed"
    assert "1e-11" in outcome.reason
    assert better(3.2460, 1e-6).verdict == "mismatch"
    assert better(3.2460, nan).verdict == "mismatch"
    assert better(3.2480, 1e-11).verdict == "mismatch"


def test_surpassed_takes_the_best_feasible_run_and_the_sense_of_the_objective():
    rule = {"objective": "maximise", "feasible_to": 1e-8}
    runs = [
        Observation(ID, value, run=run, residual=residual)
        for value, run, residual in (
            (3.3, "one", 1e-10),
            (3.4, "two", 1e-10),
            (3.5, "infeasible", 1e-2),
        )
    ]
    outcome = verdict(*runs, rule=rule)
    assert (outcome.verdict, outcome.computed) == ("surpassed", 3.4)
    assert verdict(*runs, rule=rule | {"objective": "minimise"}).verdict == "mismatch"


def test_erratum_needs_a_proof_that_holds():
    outcome = verdict(3.2, erratum=True)
    assert outcome.verdict == "erratum"
    assert outcome.reason == "wrong-time: computed both ways"


def test_a_failing_proof_is_a_mismatch():
    outcome = verdict(3.2, erratum=True, holds=False)
    assert outcome.verdict == "mismatch"
    assert "proof does not hold" in outcome.reason


def test_a_stale_erratum_is_a_mismatch():
    """The printed value reproduces, so that the erratum accuses the document wrongly."""
    outcome = verdict(3.24694, erratum=True)
    assert outcome.verdict == "mismatch"
    assert "the printed value reproduces" in outcome.reason


def test_unreproducible_says_what_is_missing_and_shows_the_nearest():
    outcome = verdict(3.3, rule={"unreproducible": "the seed"})
    assert outcome.verdict == "unreproducible"
    assert outcome.reason == "because; missing: the seed"
    assert outcome.computed == 3.3
    assert verdict(3.24694, rule={"unreproducible": "the seed"}).verdict == "reproduced"


@pytest.mark.parametrize("kind", ["input", "result", "timing"])
def test_a_part_not_built_yet_is_pending_until_something_is_computed(kind):
    rule = {"pending": "chapter 4"}
    outcome = verdict(kind=kind, rule=rule)
    assert (outcome.verdict, outcome.reason) == (PENDING, "chapter 4: because")
    assert verdict(3.24694, kind=kind, rule=rule).verdict == "mismatch"


def test_context_by_rule_and_for_lost_values():
    assert verdict(5.0, rule={"context": True}).verdict == "context"
    lost = verdict(5.0, printed="(illegible)")
    assert (lost.verdict, lost.computed) == ("context", 5.0)


def test_timings_are_shown_not_judged():
    assert verdict(99.0, printed="0.156104", kind="timing").verdict == "context"
    assert isnan(verdict(printed="0.156104", kind="timing").computed)


def test_a_timing_can_be_an_erratum():
    assert verdict(printed="0.156104", kind="timing", erratum=True).verdict == "erratum"


def test_mismatch_without_a_computed_value_or_for_words():
    assert verdict().reason == "no computed value"
    assert verdict(1.0, printed="Twenty").verdict == "mismatch"
    assert verdict(nan).verdict == "mismatch"


def test_mismatch_gives_the_note_of_the_last_run():
    assert verdict(3.3).reason == "not explained"
    assert verdict(Observation(ID, 3.3, note="did not converge")).reason == "did not converge"


def test_an_upper_bound_is_kept_by_anything_below():
    assert verdict(0.004, printed="<0.01").verdict == "reproduced"
    assert verdict(0.02, printed="<0.01").verdict == "mismatch"


def test_an_upper_bound_is_consistent_with_an_interval_below_it():
    """Both ends must keep it; and equal digits are no reproduction under such a rule."""
    rule = {"interval": "the printed plan"}
    assert verdict(0.0, printed="<0.01", rule=rule).verdict == "consistent"
    wide = Observation(ID, 0.004, low=-0.02, high=0.005)
    assert verdict(wide, printed="<0.01", rule=rule).verdict == "unreproducible"


@pytest.mark.parametrize(
    ("printed", "binding", "erratum", "expected"),
    [
        ("1.5", {"config": "transfer.radius"}, False, "reproduced"),
        ("1.6", {"config": "transfer.radius"}, False, "mismatch"),
        ("1.6", {"config": "transfer.radius"}, True, "erratum"),
        ("three halves", {"config": "transfer.radius", "reading": 1.5}, False, "reproduced"),
        ("(illegible)", {"config": "transfer.radius"}, False, "context"),
        ("1e5", {"not_ours": "an option of a solver"}, False, "context"),
        ("1e5", {"not_ours": "an option of a solver"}, True, "erratum"),
        ("1.5", None, False, "mismatch"),
    ],
)
def test_inputs_are_judged_by_what_they_feed(printed, binding, erratum, expected):
    outcome = verdict(printed=printed, kind="input", binding=binding, erratum=erratum)
    assert outcome.verdict == expected


def judge_with(rules=(), observations=(), errata=()):
    table = observations_table(observations)
    return judge([row()], table, list(rules), [], list(errata), proven(), Made())


def test_an_observation_of_an_unknown_id_is_an_error():
    with pytest.raises(InputError, match="observation 'transfer/typo': no such id"):
        judge_with(observations=[Observation("transfer/typo", 1.0)])


@pytest.mark.parametrize(
    "rule",
    [
        {"ids": [ID], "reason": "because"},
        {"ids": [ID], "tolerance": 1e-3},
        {"ids": [ID], "tolerance": 1e-3, "truncated": True, "reason": "because"},
    ],
)
def test_a_rule_needs_a_reason_and_exactly_one_kind(rule):
    with pytest.raises(InputError, match=f"the rule for '{ID}' needs a reason and one of"):
        judge_with(rules=[rule])


def test_a_value_with_two_rules_or_two_errata_is_an_error():
    rule = RULE | {"tolerance": 1e-3}
    with pytest.raises(InputError, match=r"rules.yaml: .* matched by two entries"):
        judge_with(rules=[rule, dict(rule)])
    erratum = {"ids": [ID], "key": "wrong-time"}
    with pytest.raises(InputError, match=r"errata.yaml: .* matched by two entries"):
        judge_with(errata=[erratum, dict(erratum)])


def test_an_erratum_of_a_formula_needs_no_ids():
    assert list(judge_with(errata=[{"key": "sign-of-eq"}])["verdict"]) == ["mismatch"]


def test_a_solve_that_failed_is_no_result():
    """A value that no solver reached is a difference with its reason, whatever the rule excuses."""
    failed = Observation(ID, nan, note="not converged: residual 1e-3")
    for rule in ({"unreproducible": "the guess"}, {"tolerance": 9.0}, {"interval": "a seed"}):
        outcome = verdict(failed, rule=rule)
        assert (outcome.verdict, outcome.reason) == ("mismatch", failed.note)


def test_counts_that_a_rule_judges_jointly_have_the_verdict_of_their_sum():
    """Each is within the interval by itself; their sum, half a unit a number aside, is not."""
    rows = [row(count) | {"id": f"transfer/{count}"} for count in ("2", "1", "6")]
    ids = [one["id"] for one in rows]

    def verdicts(high, jointly):
        rule = {"ids": ids, "interval": "the states", "reason": "a sample", "jointly": jointly}
        found = [Observation(name, 0.0, low=0.0, high=high) for name in ids]
        judged = judge(rows, observations_table(found), [rule], [], [], proven(), Made())
        return list(judged["verdict"]), judged["reason"].iloc[0]

    assert verdicts(6.0, jointly=False)[0] == ["consistent"] * 3
    joint, reason = verdicts(6.0, jointly=True)
    assert joint == ["unreproducible"] * 3
    assert "printed are 9 in all; interval 0 to 6" in reason
    assert verdicts(8.0, jointly=True)[0] == ["consistent"] * 3


def test_a_verdict_says_of_which_document_and_each_thing_once():
    assert {"id", "document", "printed", "computed", "unit"} <= set(VERDICT_COLUMNS)
    assert len(set(VERDICT_COLUMNS)) == len(VERDICT_COLUMNS)
