"""Corrections that are numbers: each is held to what its proof computes."""

import re

import pytest

from smallsat.evidence.errata import prove_errata
from smallsat.strict_yaml import read_yaml

NUMBERS = {
    "transfer": (
        "exhaust-speed", "final-radius", "mass-n4-k16", "mass-n4-prose", "mass-n6-prose",
        "effect-of-degree", "time-n4-prose", "increase-in-time",
    ),
    "mars": ("table-8-sigma-1", "nadir-frame-sign", "gain-fraction"),
    "slew": (
        "table-3-time-optimal", "table-3-eigenaxis", "table-2-velocity-sign", "guidance-share",
    ),
    "racing": ("start-covariance", "start-ring-comment", "start-of-meeny"),
    "rendezvous": ("initial-distance",),
}  # fmt: skip


def with_another_digit(correct):
    """A correction with the last digit of its first number changed."""
    number = re.search(r"\d+(\.\d+)?", str(correct))
    digit = str((int(number[0][-1]) + 5) % 10)
    return str(correct)[: number.end() - 1] + digit + str(correct)[number.end() :]


@pytest.mark.parametrize("document", NUMBERS)
def test_a_wrong_correction_is_found(root, tested_run, config, grounds, document):
    """As it is each erratum holds; with another digit it does not, and says why."""
    entries = read_yaml(root / f"data/published/{document}/errata.yaml")
    chosen = [entry for entry in entries if entry["key"] in NUMBERS[document]]
    assert len(chosen) == len(NUMBERS[document])
    given = grounds(document, config[document], tested_run / "data/results" / document)
    assert prove_errata(chosen, given, "errata.yaml")["holds"].all()
    wrong = [entry | {"correct": with_another_digit(entry["correct"])} for entry in chosen]
    found = prove_errata(wrong, given, "errata.yaml")
    assert not found["holds"].any()
    assert found["statement"].str.contains("is not what the proof finds").all()
