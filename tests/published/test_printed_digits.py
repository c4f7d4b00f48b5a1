"""The verdicts recomputed by hand: a bug in the judge, or in its reading of digits, shows here.

Nothing of `smallsat.evidence.printed` or of the judge is used to recompute. Literals are read as
decimal numbers, so that half a unit is exact; the computed value is the text in the table.
"""

from decimal import ROUND_DOWN, Decimal
from fnmatch import fnmatchcase
from pathlib import Path

import pytest

import smallsat.evidence.verdicts as judging
from smallsat.catalogue import read_catalogue
from smallsat.evidence.ledger import read_ledger
from smallsat.evidence.printed import Printed
from smallsat.evidence.summary import value_kinds
from smallsat.results import read_table, write_table
from smallsat.strict_yaml import read_yaml

# Literals that are no decimal numbers, worked out by hand.
EXACT = {
    "1/6": Decimal(1) / 6,
    "20/120 = 1/6": Decimal(1) / 6,
    "1/180": Decimal(1) / 180,
    "(1/36)/(3/5)": Decimal(5) / 108,
    "sqrt(2)/2": Decimal(2).sqrt() / 2,
}
# A results file has twelve significant digits.
DIGITS = 12
PUBLISHED = Path(__file__).parents[2] / "data/published"
STUDIES = [study.name for study in read_catalogue(PUBLISHED)]


def unit(number):
    """Place of the last digit of a decimal as it is written: 0.01 for 3.20."""
    return Decimal(1).scaleb(number.as_tuple().exponent)


def equal(literal, computed):
    """Whether a computed value, as written in a results file, has the printed digits."""
    # What the file's own rounding may have taken from or added to it.
    lost = Decimal(1).scaleb(computed.adjusted() - DIGITS + 1) / 2
    if literal.startswith("<"):
        return abs(computed) < Decimal(literal[1:])
    if literal in EXACT:
        return abs(computed - EXACT[literal]) <= lost
    printed = Decimal(literal)
    return abs(computed - printed) <= unit(printed) / 2 + lost


def cut(literal, computed):
    """Whether the printed digits are those of the computed value, the rest cut off."""
    printed = Decimal(literal)
    return computed.quantize(unit(printed), rounding=ROUND_DOWN) == printed


def better(literal, computed, sense):
    """Whether a value is better than the printed one, by more than the print could hide."""
    printed = Decimal(literal)
    gain = printed - computed if sense == "minimise" else computed - printed
    return gain > unit(printed) / 2


def rule_of(identifier, rules):
    """The first rule of a study that names an id."""
    named = (r for r in rules if any(fnmatchcase(identifier, pattern) for pattern in r["ids"]))
    return next(named, {})


def judged_wrongly(verdicts, kinds, rules):
    """Ids of results whose verdict does not follow from the digits.

    Parameters
    ----------
    verdicts
        Table with the columns id, printed, computed (text) and verdict.
    kinds
        Kind of each id, from the ledger.
    rules
        Entries of ``rules.yaml``.
    """
    wrong = []
    for row in verdicts.to_dict("records"):
        literal, verdict = row["printed"], row["verdict"]
        if kinds[row["id"]] != "result" or not isinstance(row["computed"], str):
            continue
        computed, rule = Decimal(row["computed"]), rule_of(row["id"], rules)
        if verdict == "reproduced":
            right = equal(literal, computed)
            if "exact" in rule:
                right = abs(computed - Decimal(literal)) <= Decimal(str(rule["exact"]))
        elif verdict == "consistent" and "tolerance" in rule:
            exact = EXACT[literal] if literal in EXACT else Decimal(literal)
            right = abs(computed - exact) <= Decimal(str(rule["tolerance"]))
        elif verdict == "consistent" and "truncated" in rule:
            right = cut(literal, computed)
        elif verdict == "surpassed":
            right = better(literal, computed, rule["objective"])
        elif verdict in ("erratum", "unreproducible", "mismatch"):
            # None of these is said of a value that has the printed digits, but where equal digits
            # prove nothing: a sample, or parameters that were inferred from them.
            right = "interval" in rule or not equal(literal, computed)
        else:
            continue
        if not right:
            wrong.append(row["id"])
    return wrong


def text_table(path):
    return read_table(path, ("case", "component", "printed", "unit", "computed"))


@pytest.fixture(scope="module")
def kinds():
    return value_kinds(PUBLISHED).to_dict()


@pytest.mark.parametrize("study", STUDIES)
def test_verdicts_follow_from_the_digits(root, tested_run, kinds, study):
    """Every result that has a computed value, from the two columns alone."""
    verdicts = text_table(tested_run / f"data/results/{study}/verdicts.csv")
    rules = read_yaml(root / f"data/published/{study}/rules.yaml")
    assert judged_wrongly(verdicts, kinds, rules) == []


class _Wide(Printed):
    """A judge that is generous by a factor of two."""

    def matches(self, computed):
        return abs(computed - self.value) <= 2 * self.half_unit


class _Narrow(Printed):
    """A judge that is strict: half a unit is a tenth too small."""

    def matches(self, computed):
        return abs(computed - self.value) <= 0.9 * self.half_unit


def _parsing(printed_as, shift=0):
    right = judging.parse_printed

    def parse(literal):
        found = right(literal)
        return found and printed_as(found.value, found.half_unit * 10.0**shift, found.bound)

    return parse


@pytest.mark.parametrize(
    ("study", "broken"),
    [
        ("transfer", lambda: _parsing(_Wide)),
        ("transfer", lambda: _parsing(Printed, shift=1)),
        ("mars", lambda: _parsing(_Narrow)),
    ],
    ids=["twice the half unit", "a digit too few", "nine tenths of the half unit"],
)
def test_a_broken_judge_is_found(root, tested_run, kinds, config, tmp_path, monkeypatch, study,
                                 broken):  # fmt: skip
    """The same observations, judged with a mistake: some verdict does not follow."""
    results = tested_run / f"data/results/{study}"
    entries = {
        name: read_yaml(root / f"data/published/{study}/{name}.yaml")
        for name in ("rules", "bindings", "errata")
    }
    rows = read_ledger(root / f"data/published/{study}/values.csv")
    monkeypatch.setattr(judging, "parse_printed", broken())
    table = judging.judge(
        rows,
        read_table(results / "observations.csv"),
        entries["rules"],
        entries["bindings"],
        entries["errata"],
        read_table(results / "errata.csv"),
        config[study],
    )
    write_table(table, tmp_path / "verdicts.csv")
    assert judged_wrongly(text_table(tmp_path / "verdicts.csv"), kinds, entries["rules"])
