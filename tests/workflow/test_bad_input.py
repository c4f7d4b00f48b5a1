"""Bad input: one line that names the key or file, the value, what is allowed and what to do."""

import pytest


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
        ('racing={"course": {"distance_m": [350, 300]}}', ("racing.course.distance_m", "no range")),
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
    ],
)
def test_configuration(project, setting, words):
    """A wrong key or value is refused before anything runs."""
    line = project.refusal("--config", setting)
    for word in words:
        assert word in line, line


def test_configuration_file_that_is_no_yaml(project):
    """Snakemake itself reads the file, and says what is wrong without a traceback."""
    path = project.folder / "broken.yaml"
    path.write_text("transfer: [1\n")
    done = project.snakemake("--dry-run", "--configfile", "broken.yaml")
    assert done.returncode != 0
    assert "not valid JSON or YAML" in done.stdout + done.stderr
    assert "Traceback" not in done.stdout + done.stderr


@pytest.mark.parametrize(
    ("target", "words"),
    [
        ("trasnfer", ("trasnfer", "transfer, mars")),
        ("figures/transfer/fig-99.svg", ("fig-99", "fig-01.svg")),
        ("data/results/transfer/tables/table-9.csv", ("table-9", "table-4.csv")),
    ],
)
def test_unknown_target(project, target, words):
    """A study, figure or table that does not exist is answered with what does."""
    line = project.refusal(target)
    for word in words:
        assert word in line, line


def _damaged(text: str, damage: str) -> str:
    lines = text.splitlines(keepends=True)
    if damage == "duplicate id":
        return "".join([*lines, lines[5]])
    if damage == "missing column":
        return text.replace("printed", "value", 1)
    # The first result row whose printed value is a plain decimal.
    place = next(i for i, line in enumerate(lines) if ",3.24694," in line)
    lines[place] = lines[place].replace("3.24694", "3.24x94")
    return "".join(lines)


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        ("duplicate id", ("duplicate id", "line 1716")),
        ("missing column", ("column 'printed' is missing",)),
        ("unparsable number", ("'3.24x94'", "no number")),
    ],
)
def test_damaged_ledger(project, damage, words):
    """The ledger is checked before anything runs; nothing is lost by it."""
    path = project.folder / "data/published/values.csv"
    intact = path.read_text()
    path.write_text(_damaged(intact, damage))
    try:
        line = project.refusal()
    finally:
        path.write_text(intact)
    assert "values.csv" in line
    for word in words:
        assert word in line, line
