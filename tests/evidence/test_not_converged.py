"""Cases without a solution, written and read."""

from math import isnan

from smallsat.evidence.not_converged import NotConverged, not_converged_table, read_not_converged
from smallsat.results import write_table


def test_what_was_written_is_read(tmp_path):
    """With and without an attempt and a residual; no text becomes a missing number."""
    cases = [NotConverged("a, b", "stopped", 2.5, "this; that"), NotConverged("c", "no start")]
    write_table(not_converged_table(cases), tmp_path / "racing/not-converged.csv")
    write_table(not_converged_table([]), tmp_path / "slew/not-converged.csv")
    found = read_not_converged(tmp_path)
    assert found["study"].tolist() == ["racing", "racing"]
    assert found["case"].tolist() == ["a, b", "c"]
    assert found["tried"].tolist() == ["this; that", ""]
    assert found["residual"][0] == 2.5 and isnan(found["residual"][1])
