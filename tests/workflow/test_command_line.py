"""The command ``snakemake`` of the environment, beside what the README's commands show."""

from snakemake import cli

from smallsat.workflow.command_line import unlimited


def test_jobs_have_no_limit_a_timespan_unless_one_is_given():
    """Snakemake's own limit costs more processor time the more jobs there are."""
    parser = unlimited(cli.get_argument_parser)()
    assert parser.parse_args([]).max_jobs_per_timespan is None
    given = parser.parse_args(["--max-jobs-per-timespan", "5/1s"])
    assert given.max_jobs_per_timespan.max_jobs == 5


def test_to_compare_parameters_loads_no_pandas(project):
    """They are text; Snakemake would load it, a fifth of a second at each call."""
    made = project.snakemake("racing_courses")
    assert made.returncode == 0, made.stderr
    call = "python -X importtime -m smallsat.workflow.command_line --cores=2 -n racing_courses"
    done = project.run(f".venv/bin/{call}")
    assert done.returncode == 0, done.stderr
    assert "Nothing to be done" in done.stdout + done.stderr
    assert "| snakemake.persistence\n" in done.stderr.replace("  ", "")
    assert "pandas" not in done.stderr
