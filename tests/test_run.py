"""Reading a run: bad input is one line, good input means what it says, equal input is equal."""

import json
from decimal import Decimal, InvalidOperation
from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from smallsat.catalogue import study_module
from smallsat.config import as_json, default_config, overlaid_config
from smallsat.errors import InputError
from smallsat.workflow.run import check, read_run

ROOT = Path(__file__).parents[1]
DEFAULT = default_config(ROOT)
PLAIN = DEFAULT.model_dump()


def test_the_documents_own_values_pass_the_checks_of_every_study():
    """A call of Snakemake checks the sections that a person changes; these are checked here."""
    for study, section in DEFAULT:
        if study != "run":
            study_module(study, "parameters").check(section)


def refusal(*, files=(), entries=()) -> str:
    """The line with which a run is refused."""
    with pytest.raises(InputError) as caught:
        read_run(ROOT, files, entries)
    line = str(caught.value)
    assert "\n" not in line
    return line


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ('transfer={"problm": {"thrust": 0.2}}', ("transfer.problm", "unknown", "'problem'")),
        (
            'transfer={"problem": {"thrust": "much"}}',
            ("transfer.problem.thrust", "'much'", "number"),
        ),
        ('transfer={"problem": {"initial_mass": -1}}', ("initial_mass", "-1", "greater than 0")),
        ('transfer={"degrees": [0]}', ("transfer.degrees.0", "0 is not allowed", "at least 1")),
        ('transfer={"intervals": [3.5]}', ("transfer.intervals.0", "3.5", "integer")),
        ('transfer={"intervals": []}', ("transfer.intervals", "at least 1 items")),
        ('mars={"spacecraft": {"inertia_kg_m2": [10, -5, 7]}}', ("inertia_kg_m2.1", "-5")),
        ('slew={"manoeuvre": {"duration_s": 0}}', ("manoeuvre.duration_s", "greater than 0")),
        ('slew={"manoeuvre": {"half": {"nodes": 2}}}', ("half.nodes", "at least 3")),
        ('slew={"wheels": {"torque_mN_m": 0}}', ("wheels.torque_mN_m", "greater than 0")),
        (
            'slew={"spacecraft": {"inertia_kg_m2": [[1, 0, 0], [0, 1, 0], [0, 0, 3]]}}',
            ("slew.spacecraft.inertia_kg_m2", "of no body"),
        ),
        (
            'slew={"manoeuvre": {"initial_quaternion": [0, 0, 0, 2]}}',
            ("slew.manoeuvre.initial_quaternion", "unit quaternion"),
        ),
        ('racing={"course": {"rings": [0, 0]}}', ("racing.course.rings.0", "at least 1")),
        ('racing={"course": {"semi_major_m": [0, 5]}}', ("semi_major_m.0", "greater than 0")),
        (
            'racing={"course": {"distance_m": [350, 300]}}',
            ("racing.course.distance_m", "must not exceed"),
        ),
        (
            'racing={"scenarios": {"scenario-1": {"cubesats": {"Eeny": {"thrust_m_s2": 0}}}}}',
            ("Eeny.thrust_m_s2", "greater than 0"),
        ),
        (
            'racing={"scenarios": {"scenario-1": {"cubesats": {"Moe": {"thrust_m_s2": 1}}}}}',
            ("cubesats.Moe", "unknown", "Eeny, Meeny, Miny, Mo"),
        ),
        (
            'racing={"dynamic_programming": {"cubesat": "Moe"}}',
            ("dynamic_programming.cubesat", "'Moe'", "Meeny"),
        ),
        (
            'racing={"scenarios": {"scenario-1": {"course_file": "none.csv"}}}',
            ("scenario-1.course_file", "none.csv", "does not exist"),
        ),
        ("vesuvius=1", ("vesuvius", "unknown", "transfer, mars")),
        ("run=../out", ("run", "'../out'")),
        ("run=two\nlines", ("run", "'two\\nlines'")),
        ('transfer={"problem": {"thrust": .nan}}', ("transfer.problem.thrust", "nan", "number")),
        ('transfer={"problem": {"thrust": 12:30}}', ("transfer.problem.thrust", "12:30", "number")),
        ('transfer={"problem": {"thrust": 010}}', ("transfer.problem.thrust", "'010'", "number")),
        ('transfer={"problem": {"thrust": 1e999}}', ("transfer.problem.thrust", "inf", "number")),
        ('mars={"orbits": {"mars_radius_km": 5e99}}', ("mars_radius_km", "5e+99", "in size")),
    ],
)
def test_a_wrong_setting(setting, words):
    """A wrong key or value is refused: the line names the key, the value and what is allowed."""
    line = refusal(entries=[setting])
    for word in words:
        assert word in line, line


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("transfer: [1\n", ("broken.yaml: line 2", "not valid YAML")),
        ("transfer:\n\tdegrees: [2]\n", ("broken.yaml: line 2", "not valid YAML")),
        ("", ("broken.yaml: empty",)),
        ("slew\n", ("broken.yaml: 'slew', which has no keys",)),
        ("run: a\nmars: {}\nrun: b\n", ("broken.yaml: line 3", "'run'", "second time")),
    ],
)
def test_a_wrong_file(tmp_path, content, words):
    """A file that is no YAML, or that says nothing or one thing twice, is refused by its name."""
    path = tmp_path / "broken.yaml"
    path.write_text(content)
    line = refusal(files=[path])
    for word in words:
        assert word in line, line


@pytest.mark.parametrize("content", [b"\xff\xfe\x00", b"run: \x07", b"\x80abc", b"[" * 5000])
def test_a_file_that_is_no_text(tmp_path, content):
    path = tmp_path / "binary.yaml"
    path.write_bytes(content)
    assert "binary.yaml" in refusal(files=[path])


@pytest.mark.parametrize(
    ("entry", "name"),
    [("run=2024", "2024"), ("run=007", "007"), ("run=1e3", "1e3"), ("run=x", "x")],
)
def test_a_run_is_named_as_typed(entry, name):
    run = read_run(ROOT, [], [entry, 'transfer={"problem": {"initial_mass": 1.05}}'])
    assert run.folder == f"runs/{name}"


def test_a_run_may_have_a_number_for_a_name_in_a_file(tmp_path):
    path = tmp_path / "my.yaml"
    path.write_text("run: 2024\nmars: {visibility_deg: 40}\n")
    assert read_run(ROOT, [path], []).folder == "runs/2024"


def test_a_number_without_a_point_is_a_number():
    """``1e-3`` is a text to YAML 1.1."""
    run = read_run(ROOT, [], ['transfer={"numerics": {"as_published_tolerance": 1e-3}}'])
    assert run.config.transfer.numerics.as_published_tolerance == 1e-3


@pytest.mark.parametrize(
    "entries",
    [
        ['transfer={"problem": {"initial_mass": 1}}'],
        ['transfer={"degrees": [2.0, 3, 4, 5, 6]}'],
        ['slew={"beyond": {"inertia_error_pct": 10}, "resampling_hz": 1e1}'],
        [f"mars={json.dumps(dict(reversed(PLAIN['mars'].items())))}"],
        [f"{study}={json.dumps(PLAIN[study])}" for study in PLAIN if study != "run"],
        ["run=named"],
    ],
)
def test_what_equals_the_default_is_the_reproduction(entries):
    """1 for 1.0, another order of keys, the default written out: the same to the letter."""
    run = read_run(ROOT, [], entries)
    assert run.folder == "."
    assert as_json(run.config.with_(run="")) == as_json(DEFAULT)


def test_later_files_win_and_settings_win_over_files(tmp_path):
    first, second = tmp_path / "a.yaml", tmp_path / "b.yaml"
    first.write_text("run: a\ntransfer: {problem: {thrust: 0.15, initial_mass: 1.1}}\n")
    second.write_text("transfer: {problem: {thrust: 0.16}}\n")
    problem = read_run(ROOT, [first, second], []).config.transfer.problem
    assert (problem.thrust, problem.initial_mass) == (0.16, 1.1)
    run = read_run(ROOT, [first, second], ["run=c", 'transfer={"problem": {"thrust": 0.17}}'])
    assert run.folder == "runs/c"
    assert run.config.transfer.problem.thrust == 0.17
    assert run.config.transfer.problem.mu == DEFAULT.transfer.problem.mu


# --- thousands of malformed overlays --------------------------------------------------------------


def leaves(value, path=()):
    """Paths of all values of the configuration that are no section."""
    if isinstance(value, dict):
        return [found for key, below in value.items() for found in leaves(below, (*path, key))]
    return [path]


# Texts that other readers of YAML take for numbers, truths or nothing, and plain mistakes.
ODD = [
    *(".nan", "-.inf", ".inf", "NaN", "Infinity", "12:30", "1:2:3", "010", "0o17", "0x1F", "0b11"),
    *(
        "1_000",
        "1e999",
        "-1e999",
        "1e-3",
        "1E5",
        "+3",
        ".5",
        "5.",
        "yes",
        "No",
        "on",
        "OFF",
        "true",
    ),
    *("False", "~", "null", "2024-01-01", "1,5", "1.2.3", "--", "?", "!", "%", "@", "`", "&", "*"),
    *(
        "[",
        "{",
        "]",
        "}",
        "':",
        "-",
        "!",
        "! 5",
        "!!str 5",
        '!!int "5"',
        "!!int",
        "!!float x",
        "!!python/object:os.system",
        "<<:",
        "&a",
    ),
    *("*a", "[1, 2", "{a: 1, a: 2}", "{1: 2}", "\t", "", "a: b: c", "|\n x", "[[]]", "9" * 5000),
]
fragments = st.one_of(
    st.sampled_from(ODD),
    st.floats().map(repr),
    st.integers().map(str),
    st.text(max_size=12),
    st.recursive(
        st.none() | st.booleans() | st.integers(-3, 3) | st.floats(width=16) | st.text(max_size=3),
        lambda inner: (
            st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=4), inner, max_size=3)
        ),
        max_leaves=8,
    ).map(json.dumps),
)


@settings(
    max_examples=3000, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(path=st.sampled_from(leaves(PLAIN)), up=st.integers(0, 2), fragment=fragments)
@example(path=("run",), up=0, fragment="!")
@example(path=("transfer", "numerics", "seed"), up=0, fragment="! 5")
def test_whatever_a_file_says_is_taken_as_it_stands_or_refused(tmp_path, path, up, fragment):
    """An odd text at any place of the configuration: never another error, never another meaning."""
    # Sometimes in place of the section that the value stands in.
    path = path[: max(1, len(path) - up)]
    file = tmp_path / "odd.yaml"
    lines = [f"{'  ' * depth}{key}:" for depth, key in enumerate(path)]
    file.write_bytes(("\n".join(lines) + f" {fragment}\n").encode("utf-8", "surrogatepass"))
    try:
        config = overlaid_config(DEFAULT, [file], [])
        check(config, DEFAULT)
    except InputError as error:
        assert len(str(error).splitlines()) == 1, str(error)
        return
    value = config.model_dump(mode="json")
    for key in path:
        value = value[key]
    assert means(value, fragment.strip()), (value, fragment)


def means(value, text: str) -> bool:
    """Whether a value that was accepted is what its text says to a person."""
    if isinstance(value, bool):
        return text.lower() == str(value).lower()
    if isinstance(value, int | float):
        try:
            return float(value) == float(Decimal(text))
        except InvalidOperation:
            return False
    if isinstance(value, str) and value == text.strip("'"):
        return True
    return within(json.loads(text or '""'), value)


def within(said, value) -> bool:
    """Whether all that was said is so; of a section some keys may be left unsaid."""
    if isinstance(said, dict):
        return all(within(below, value[key]) for key, below in said.items())
    return said == value


@settings(max_examples=500, deadline=None)
@given(entry=st.text(max_size=20) | st.builds("{}={}".format, st.sampled_from([*PLAIN]), fragments))
def test_whatever_stands_after_config_is_taken_or_refused(entry):
    """The same for a setting on the command line."""
    try:
        check(overlaid_config(DEFAULT, [], [entry]), DEFAULT)
    except InputError as error:
        assert len(str(error).splitlines()) == 1, str(error)
