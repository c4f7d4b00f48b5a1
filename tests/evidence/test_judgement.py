"""What a judgement of a claim says."""

from smallsat.evidence.claims import Judgement


def test_a_remark_stands_after_the_evidence_and_changes_no_outcome():
    """As the claims of several studies have it."""
    found = Judgement("undecided", "a share of 3 %").remarked("few samples")
    assert found == Judgement("undecided", "a share of 3 %; few samples")
