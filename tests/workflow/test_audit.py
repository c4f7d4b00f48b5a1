"""What `make audit` makes of the answers of pip-audit: silence is no good news."""

import importlib.util

import pytest


@pytest.fixture(scope="module")
def audited(root):
    place = importlib.util.spec_from_file_location("audit", root / "tests/audit/run.py")
    module = importlib.util.module_from_spec(place)
    place.loader.exec_module(module)
    return module.audited


CLEAN = {"name": "clean", "version": "1", "vulns": []}
SKIPPED = {"name": "unknown", "skip_reason": "Dependency not found on PyPI"}
FLAW = {"id": "PYSEC-1", "fix_versions": ["2"]}
VULNERABLE = {"name": "old", "version": "1", "vulns": [FLAW]}


@pytest.mark.parametrize(
    ("answers", "status", "outcome"),
    [
        ([CLEAN, CLEAN], 0, "no known vulnerability"),
        ([CLEAN, VULNERABLE], 1, "1 known vulnerabilities"),
        ([SKIPPED, VULNERABLE], 1, "1 known vulnerabilities"),
        ([CLEAN, SKIPPED], 3, "1 packages could not be looked up"),
        ([CLEAN], 3, "1 packages could not be looked up"),
        ([SKIPPED, SKIPPED], 3, "nothing could be looked up"),
    ],
)
def test_only_a_full_answer_is_a_good_one(audited, answers, status, outcome):
    audit = audited(2, {"dependencies": answers})
    assert (audit.status, audit.outcome) == (status, outcome)


def test_no_answer_at_all_is_said(audited):
    """As without a network."""
    assert audited(2, {}).outcome == "nothing could be looked up"
    assert audited(2, {}).status == 3


def test_a_vulnerability_is_named_with_its_cure(audited):
    assert audited(1, {"dependencies": [VULNERABLE]}).found == ["old 1: PYSEC-1, mended in 2"]
