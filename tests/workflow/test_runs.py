"""The workflow itself: one figure, a changed source, a what-if run, a kill, a damaged file."""

import os
import re
import shutil
import signal
import subprocess
import time

import pytest

# Two of the document's cases, one long flight: enough to exercise shards, and quick to solve.
SMALL = 'transfer={"degrees": [2, 3], "intervals": [2, 4], "numerics": {"thrust_shares": [0.5]}}'


def test_dry_run_of_everything_is_tens_of_jobs(project):
    """A full build from nothing is planned without error, in tens of jobs a study."""
    done = project.jobs()
    total = next(line for line in done.splitlines() if line.startswith("total"))
    studies = len(list((project.folder / "data/published").glob("*/study.yaml")))
    assert 10 * studies < int(total.split()[1]) < 60 * studies


@pytest.fixture(scope="module")
def built(make_project):
    """A project with one figure of each study built."""
    project = make_project()
    done = project.snakemake("figures/transfer/fig-05.svg", "data/results/mars/modes.csv")
    assert done.returncode == 0, done.stdout + done.stderr
    total = len(re.findall(r"^\[\d+/\d+\] .* \(.*\)", done.stderr, re.MULTILINE))
    last = done.stderr.splitlines()[-1]
    assert re.search(rf"^{total} jobs on 2 cores, ", done.stderr, re.MULTILINE), done.stderr
    assert last.startswith(f"[{total}/{total}] "), done.stderr
    return project


def test_one_figure(built):
    """Asking for one figure makes its three formats and data, and nothing of other cases."""
    folder = built.folder / "figures/transfer"
    made = sorted(path.name for path in folder.iterdir())
    assert made == sorted(
        f"fig-{n}.{suffix}" for n in ("05", "06") for suffix in ("csv", "pdf", "png", "svg")
    )
    assert (built.folder / "data/results/transfer/notebooks/figures-indirect-n0-k1.ipynb").exists()
    assert not (built.folder / "data/results/transfer/converged.csv").exists()


def test_nothing_to_do_twice(built):
    """A second call finds everything up to date."""
    assert "Nothing to be done" in built.jobs("figures/transfer/fig-05.svg")


@pytest.mark.parametrize(
    "setting",
    [
        'transfer={"problem": {"initial_mass": 1}}',
        'transfer={"problem": {"initial_radius": 1, "mu": 1e0}, "degrees": [2, 3.0, 4, 5, 6]}',
        "run=named",
    ],
)
def test_a_configuration_equal_to_the_default_reruns_nothing(built, setting):
    """1 for 1.0, a default written out, a name for the reproduction."""
    assert "Nothing to be done" in built.jobs("figures/transfer/fig-05.svg", "--config", setting)


@pytest.mark.parametrize(
    ("module", "reruns", "keeps"),
    [
        ("studies/transfer/methods/indirect.py", "transfer_indirect", "mars_simulation"),
        (
            "studies/transfer/figures/cases.py",
            "transfer_figures_indirect_n0_k1",
            "transfer_indirect",
        ),
        ("dynamics/orbits/circular_orbits.py", "mars_simulation", "transfer_indirect"),
    ],
)
def test_a_changed_source_reruns_what_imports_it(built, module, reruns, keeps):
    """Touching an imported module reruns the rules that use it, and only those."""
    path = built.folder / "src/smallsat" / module
    before = path.stat()
    os.utime(path)
    try:
        jobs = built.jobs("figures/transfer/fig-05.svg", "data/results/mars/modes.csv")
    finally:
        os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert reruns in jobs
    assert keeps not in jobs


def test_what_if_has_its_own_folder(built):
    """A changed parameter runs in runs/<name>/ and leaves the reproduction untouched."""
    original = (built.folder / "data/results/transfer/indirect.csv").read_bytes()
    settings = ("--config", "run=heavier", 'transfer={"problem": {"initial_mass": 1.05}}')
    done = built.snakemake("figures/transfer/fig-05.svg", *settings)
    assert done.returncode == 0, done.stdout + done.stderr
    folder = built.folder / "runs/heavier"
    assert (folder / "figures/transfer/fig-05.svg").exists()
    assert (folder / "data/results/transfer/indirect.csv").read_bytes() != original
    assert (built.folder / "data/results/transfer/indirect.csv").read_bytes() == original


def test_a_truncated_results_file_is_made_anew(built):
    """The build says so in one line, and ends with the same bytes."""
    path = built.folder / "data/results/transfer/indirect.parquet"
    figure = built.folder / "figures/transfer/fig-05.svg"
    intact, drawn = path.read_bytes(), figure.read_bytes()
    path.write_bytes(intact[: len(intact) // 2])
    done = built.snakemake("figures/transfer/fig-05.svg")
    output = done.stdout + done.stderr
    assert done.returncode == 0, output
    (line,) = [line for line in output.splitlines() if line.startswith("smallsat: ")]
    assert line.startswith("smallsat: data/results/transfer/indirect.parquet: changed after")
    assert (path.read_bytes(), figure.read_bytes()) == (intact, drawn)


def test_a_truncated_results_file_that_is_not_known_is_named(built):
    """Of the date that Snakemake noted, without a digest: one line names it, nothing is lost."""
    path = built.folder / "data/results/transfer/indirect.parquet"
    intact, before = path.read_bytes(), path.stat()
    shutil.rmtree(built.folder / ".snakemake/digests")
    path.write_bytes(intact[: len(intact) // 2])
    os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
    (built.folder / "figures/transfer/fig-05.svg").unlink()
    try:
        done = built.snakemake("figures/transfer/fig-05.svg")
    finally:
        path.write_bytes(intact)
        os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
    output = done.stdout + done.stderr
    assert done.returncode != 0
    assert "smallsat: data/results/transfer/indirect.parquet: damaged results file" in output
    assert "Traceback" not in output
    assert output.count("smallsat: ") == 1
    assert "FAILED transfer: draw figures-indirect-n0-k1\n" in output
    (retry,) = re.findall("^    retry: (.*)$", output, re.MULTILINE)
    assert retry == "snakemake transfer_figures_indirect_n0_k1"
    assert "Nothing to be done" not in built.jobs(*retry.split()[1:])
    assert (built.folder / "data/results/transfer/indirect.csv").exists()


def _shards(project, run):
    """Files of the shards that Snakemake has taken note of, and when they were written."""
    shards = [
        [f"data/results/transfer/as-published-k{k}{end}" for end in (".csv", ".parquet")]
        for k in (1, 2, 4)
    ]
    paths = [
        project.folder / "runs" / run / name
        for names in shards
        if project.noted(run, *names)
        for name in names
    ]
    return {path: path.stat().st_mtime_ns for path in paths}


def test_a_killed_run_resumes(make_project):
    """SIGKILL to Snakemake and its jobs: noted shards stay, the rest comes out the same."""
    project = make_project()
    target = "data/results/transfer/as-published.csv"
    undisturbed = project.folder / "runs/undisturbed"
    killed = project.folder / "runs/killed"
    whole = project.snakemake(target, "--config", "run=undisturbed", SMALL)
    assert whole.returncode == 0, whole.stdout + whole.stderr

    process = subprocess.Popen(
        project.command(target, "--config", "run=killed", SMALL),
        cwd=project.folder,
        env=project.environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    deadline = time.monotonic() + 120
    while not _shards(project, "killed") and time.monotonic() < deadline:
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    kept = _shards(project, "killed")
    assert kept and not (killed / target).exists()

    resumed = project.snakemake(target, "--config", "run=killed", SMALL)
    assert resumed.returncode == 0, resumed.stdout + resumed.stderr
    assert {path: path.stat().st_mtime_ns for path in kept} == kept
    assert (killed / target).read_bytes() == (undisturbed / target).read_bytes()
