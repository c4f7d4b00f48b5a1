"""Every command of the README and of docs/use.md runs as it stands there, in a fresh copy."""

import re

import pytest

FIGURE = "figures/mars/fig-10.svg"

# Run in full, because they are quick or make what later ones need; the others are planned only.
IN_FULL = (
    ". .venv/bin/activate",
    "echo 'mars: {visibility_deg: 40}' > my.yaml",
    f"snakemake {FIGURE} --configfile my.yaml",
    "snakemake -n",
    "make explain ID=4400-s/full-mission/1",
)


@pytest.fixture(scope="module")
def commands(root):
    """Lines of their shell blocks in order, each once, without their remarks."""
    text = "".join((root / name).read_text() for name in ("README.md", "docs/use.md"))
    blocks = re.findall(r"^```sh\n(.*?)^```", text, re.M | re.S)
    lines = [line.split(" # ")[0].strip() for block in blocks for line in block.splitlines()]
    return list(dict.fromkeys(line for line in lines if line))


def planned(command: str) -> str:
    """The command itself, or its dry run."""
    if command in IN_FULL:
        return command
    assert command.split()[0] in ("make", "snakemake"), f"no dry run of: {command}"
    return f"{command} -n"


def test_every_command_that_is_shown(commands, make_project):
    """No failure and no traceback; a what-if fills a folder of its own and no other."""
    project = make_project()
    assert set(IN_FULL) <= set(commands)
    for command in commands:
        done = project.run(f". .venv/bin/activate && {planned(command)}", timeout=600)
        output = done.stdout + done.stderr
        assert done.returncode == 0, f"{command}\n{output}"
        assert "Traceback" not in output, f"{command}\n{output}"
        assert not re.search("unknown|No rule", output), f"{command}\n{output}"
    # The dry run of the other what-if leaves an empty folder.
    assert len(list((project.folder / "runs").glob(f"*/{FIGURE}"))) == 1
    assert [path.name for path in (project.folder / "figures").iterdir()] == ["README.md"]


def test_targets_are_understood_on_either_side(project):
    """The README puts targets first; after --config and --configfile they mean the same."""
    (project.folder / "my.yaml").write_text("mars: {visibility_deg: 40}\n")
    setting = 'mars={"visibility_deg": 40}'
    planned = [
        frozenset(re.findall(r"^\w+ +\d+$", project.jobs(*words), re.MULTILINE))
        for words in (
            (FIGURE, "--configfile", "my.yaml"),
            ("--configfile", "my.yaml", FIGURE),
            (FIGURE, "--config", setting),
            ("--config", setting, FIGURE),
            ("--config", setting, "--", FIGURE),
        )
    ]
    assert set(planned) == {planned[0]}
    assert any(line.startswith("mars_mission ") for line in planned[0])
