"""No number in the report is typed: prose in the templates and in the extras' texts has no digits.

Numbers come from results and configuration. Allowed in prose are mathematics, code, and references
to places in a document, such as Eq. 12, Table 4, Fig. 5, Section 3.4.1 or Listing A.
"""

import re
from pathlib import Path

import pytest
import yaml

PROJECT = Path(__file__).parents[2]
TEMPLATES = sorted((PROJECT / "report").rglob("*.typ"))
EXTRAS = sorted((PROJECT / "data/published").glob("*/extras.yaml"))

NUMBER = r"[A-Z]?\d+(?:\.\d+)*[a-z]?"
REFERENCE = re.compile(
    rf"\b(?:Eqs?\.|Equations?|Tables?|Figs?\.|Figures?|Sections?|Listings?|Chapters?|Refs?\.)"
    rf"[\s~]*\(?{NUMBER}\)?(?:(?:\s*[,–-]\s*|\s+(?:and|to)\s+){NUMBER})*"
)
# A digit inside a name, as in J2, is no number.
TYPED = re.compile(r"(?<![A-Za-z\d])\d[\d.,]*")
STATEMENTS = ("let", "set", "show", "import", "include", "if", "for", "while", "return", "context")


class Prose:
    """The prose of a Typst source: its markup without mathematics, code, raw text and comments."""

    def __init__(self, source: str):
        self.source = source
        self.found: list[str] = []
        self._markup(0, "")

    @property
    def text(self) -> str:
        """All of it, with a space where something was left out."""
        return "".join(self.found)

    def _markup(self, i: int, end: str) -> int:
        source = self.source
        while i < len(source):
            c = source[i]
            if end and c == end:
                return i + 1
            if (skipped := self._skip(i)) > i:
                i = skipped
                self.found.append(" ")
            elif c == "\\":
                i += 2
            elif c == "#":
                i = self._expression(i + 1)
                self.found.append(" ")
            elif c == "[":
                i = self._markup(i + 1, "]")
            else:
                self.found.append(c)
                i += 1
        return i

    def _skip(self, i: int) -> int:
        """End of a comment, of raw text or of mathematics that begins here; else ``i``."""
        comment = re.compile(
            r"(?<!:)//.*|/\*.*?\*/", re.DOTALL if self.source[i : i + 2] == "/*" else 0
        )
        raw = re.compile(r"(`+).*?\1", re.DOTALL)
        mathematics = re.compile(r"\$(?:\\.|[^$\\])*\$", re.DOTALL)
        for pattern in (comment, raw, mathematics):
            if match := pattern.match(self.source, i):
                return match.end()
        return i

    def _expression(self, i: int) -> int:
        """Code after a hash in markup: a statement to the end of its line, or a call."""
        word = re.compile(r"[\w.-]*\w|").match(self.source, i)
        assert word
        if word[0] in STATEMENTS:
            return self._code(word.end(), "\n")
        i = word.end()
        while i < len(self.source) and self.source[i] in "([{":
            i = self._bracket(i)
            more = re.compile(r"\.[\w.-]*\w").match(self.source, i)
            i = more.end() if more else i
        return i

    def _bracket(self, i: int) -> int:
        if self.source[i] == "[":
            return self._markup(i + 1, "]")
        return self._code(i + 1, {"(": ")", "{": "}"}[self.source[i]])

    def _code(self, i: int, end: str) -> int:
        while i < len(self.source):
            c = self.source[i]
            if c == end or (end == "\n" and c in "])}"):
                return i + (c == end)
            if (skipped := self._skip(i)) > i:
                i = skipped
            elif c == '"':
                string = re.compile(r'"((?:\\.|[^"\\])*)"', re.DOTALL).match(self.source, i)
                assert string
                # A string with spaces is read by someone.
                self.found.append(f" {string[1]} " if " " in string[1] else " ")
                i = string.end()
            elif c in "([{":
                i = self._bracket(i)
            else:
                i += 1
        return i


def typed_numbers(prose: str) -> list[str]:
    return TYPED.findall(REFERENCE.sub(" ", prose))


def typed_in_template(source: str) -> list[str]:
    return typed_numbers(Prose(source).text)


@pytest.mark.parametrize("path", TEMPLATES, ids=lambda path: path.name)
def test_templates_and_chapters_have_no_typed_number(path: Path):
    assert typed_in_template(path.read_text()) == []


@pytest.mark.parametrize("path", EXTRAS, ids=lambda path: path.parent.name)
def test_texts_of_extras_have_no_typed_number(path: Path):
    for entry in yaml.safe_load(path.read_text()) or []:
        assert typed_numbers(entry["title"]) == []
        assert typed_numbers(entry.get("text", "")) == []


@pytest.mark.parametrize(
    ("source", "numbers"),
    [
        ("The transfer takes 3.2469 units.", ["3.2469"]),
        ("= A heading with 12 values", ["12"]),
        ("#strong[All 134 values hold]", ["134"]),
        ("#let note = [Computed in 5 runs]", ["5"]),
        ("#if built [at 3 places] else [at 4]", ["3", "4"]),
        ('#text("within 2 digits")', ["2"]),
        ("- $x = 1$ and 7\n- #f(1)[8] // 9", ["7", "8"]),
        ("#{ let a = 1; [and 6] }", ["6"]),
    ],
)
def test_a_typed_number_is_found(source: str, numbers: list[str]):
    assert typed_in_template(source) == numbers


@pytest.mark.parametrize(
    "source",
    [
        "Eq. 12, Eqs. 3 and 4, Table 4, Figs. 5-8, Section 3.4.1, Listing 10.",
        "$ dot(r) = v_r, quad m(0) = 1 $ and `snakemake -j 2`",
        '#set text(size: 10pt)\n#image("fig-05.svg", width: 50%)',
        '#setting("transfer.degrees.0") intervals // 3 of them',
        'The J2 term, and #computed("transfer/table-1/x").',
        "/* 5 */ #h(3pt) text",
    ],
)
def test_mathematics_code_and_references_pass(source: str):
    assert typed_in_template(source) == []
