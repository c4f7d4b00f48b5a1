"""Printed numbers are asked of the ledger; none is typed again in the code that judges them."""

import ast
import re
from pathlib import Path

import pytest

from smallsat.catalogue import read_catalogue
from smallsat.evidence.printed import parse_printed
from smallsat.strict_yaml import read_yaml

STUDIES = [s.name for s in read_catalogue(Path(__file__).parents[2] / "data/published")]
# Digits from which a number is told from a round one that stands in any code.
DIGITS = 3
# Where solves of other problems begin: the document's problem and its solution.
START = "the start of a solve"
EXCEPTIONS = {
    "transfer": {0.1405: START, 1.8658344: START, 3.24694: START},
    "slew": {0.126: START, 10.3: START},
    "mars": {88620.0: "tells a figure when to speak of a day", 1.75: "a place in a schematic"},
}


def significant_digits(literal: str) -> int:
    """Digits of a decimal without the zeros around them, which code need not repeat."""
    mantissa = re.split("[eE]", literal.strip().lstrip("+-<"))[0]
    return len(re.sub("[.,]", "", mantissa).strip("0"))


def printed_numbers(ledger):
    """Sizes of the numbers of a document that are printed with enough digits."""
    return {
        abs(number.value)
        for row in ledger.rows
        if (number := parse_printed(row["printed"]))
        and number.value != 0.0
        and number.half_unit > 0.0
        and significant_digits(row["printed"]) >= DIGITS
    }


def typed_numbers(source: str, judged: set[str]):
    """Line and value of every number in code, but those of constants that a binding judges."""
    tree = ast.parse(source)
    apart = {
        id(node)
        for statement in tree.body
        if isinstance(statement, ast.Assign)
        and any(getattr(target, "id", "") in judged for target in statement.targets)
        for node in ast.walk(statement)
    }
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Constant)
            and isinstance(node.value, int | float)
            and not isinstance(node.value, bool)
            and id(node) not in apart
        ):
            yield node.lineno, float(node.value)


def retyped(path: Path, printed: set[float], judged: set[str]):
    """Numbers of a file that its document prints."""
    found = typed_numbers(path.read_text(), judged)
    return [f"{path.name}, line {line}: {value:g}" for line, value in found if value in printed]


def judged_constants(root, document):
    """Names of the constants that the bindings of a document hold to its rows."""
    bindings = read_yaml(root / f"data/published/{document}/bindings.yaml")
    return {entry["constant"].partition(":")[2] for entry in bindings if "constant" in entry}


@pytest.mark.parametrize("document", STUDIES)
def test_no_printed_number_is_typed_in_code(root, ledger, document):
    """What a binding names is judged by its row; all else is looked at."""
    printed = printed_numbers(ledger(document)) - EXCEPTIONS.get(document, {}).keys()
    folder = root / "src/smallsat/studies" / document
    paths = sorted(folder.rglob("*.py"))
    judged = judged_constants(root, document)
    assert not [text for path in paths for text in retyped(path, printed, judged)]


def test_a_planted_number_is_found(ledger, tmp_path):
    """In an expression, with its sign turned, and in a constant that no binding names."""
    path = tmp_path / "planted.py"
    path.write_text("PEAK = 38.9\nEXAMPLE = 52.80\ndef f(x):\n    return x - -179.1 + 1.0\n")
    found = retyped(path, printed_numbers(ledger("slew")), {"EXAMPLE"})
    assert found == ["planted.py, line 1: 38.9", "planted.py, line 4: 179.1"]


@pytest.mark.parametrize(
    ("literal", "digits"),
    [("0.00938", 3), ("52.80", 3), ("500", 1), ("-1.533E-3", 4)],
)
def test_significant_digits(literal, digits):
    assert significant_digits(literal) == digits
