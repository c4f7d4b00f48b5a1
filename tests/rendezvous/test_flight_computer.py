"""The flight program: its C against the study's Python, on an emulator, and over a socket.

What needs a compiler or an emulator is skipped where that is not there; the tracked tables of what
was counted are tested everywhere.
"""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from smallsat.errors import InputError
from smallsat.optimal_control.riccati_interior_point import SOLVED, solve, workspace
from smallsat.results import read_table
from smallsat.studies.rendezvous.flight_computer import cycles, emulator, link, measurement
from smallsat.studies.rendezvous.flight_computer.provenance import FOLDER, fingerprint
from smallsat.studies.rendezvous.flight_computer.recording import (
    cases,
    law_header,
    recordings,
    samples,
)
from smallsat.studies.rendezvous.guidance.controller import ITERATION_LIMIT, TOLERANCE
from smallsat.studies.rendezvous.guidance.law import PHASES, settings

# What a solver leaves on the table, of what there is to save; and its first control, in bounds, in
# half of the programs. In single ones the optimum is flat: one leaves 3e-3 of a bound open, and
# costs 4e-11 more, so that the largest error of a control says nothing.
COST_ERROR = {emulator.OWN: 1e-9, emulator.GENERATED: 1e-6}
MEDIAN_CONTROL_ERROR = {emulator.OWN: 1e-9, emulator.GENERATED: 1e-5}


def needs(*commands):
    lacking = emulator.missing(*commands)
    return pytest.mark.skipif(bool(lacking), reason=f"not there: {', '.join(lacking)}")


@pytest.fixture(scope="module")
def small(section, changed):
    """One run of two steps of one case of each phase."""
    few = section
    for key, value in (
        ("runs", 1), ("generated_runs", 1), ("steps", 2),
        ("far.horizons", (15,)), ("mid.horizons", (5,)), ("final.horizons", (5,)),
        ("far.sample_times_s", (30.0,)), ("mid.sample_times_s", (20.0,)),
    ):  # fmt: skip
        few = changed(few, f"flight_computer.{key}", value)
    return few


@pytest.fixture(scope="module")
def recorded(small):
    """The recordings at the small horizons."""
    horizons = (15, 5, 5)
    return [r for r in recordings(small) if r.case.horizon == horizons[r.case.phase]]


def reference(recording):
    """The study's own controls for each recorded step."""
    found = []
    for one in samples(recording):
        work = workspace(one.stages, one.program.normals.shape[1], len(one.program.components))
        solution = solve(one.program, one.stages, one.start, work, TOLERANCE, ITERATION_LIMIT)
        found.append(solution.controls.copy())
    return np.array(found)


@needs("gcc")
def test_c_writes_and_solves_the_same_programs(recorded, tmp_path):
    """Built for this machine: the same first controls as the study's, and as many iterations."""
    for recording in recorded:
        (tmp_path / "law.h").write_text(law_header())
        (tmp_path / "law.bin").write_bytes(settings([recording.law]).tobytes())
        (tmp_path / "steps.bin").write_bytes(recording.steps.tobytes())
        sources = [FOLDER / f"{name}.c" for name in ("replay", "guidance", "interior_point")]
        options = [
            "-std=gnu11",
            "-O2",
            "-ffp-contract=off",
            "-Wl,--wrap=malloc",
            "-Wl,--wrap=calloc",
        ]
        options += [f"-DSTAGES={recording.case.horizon}", f"-I{tmp_path}", f"-I{FOLDER}"]
        emulator.run(["gcc", *options, "-o", "replay", *sources, "-lm"], tmp_path)
        emulator.run([tmp_path / "replay"], tmp_path)
        rows = np.fromfile(tmp_path / "answers.bin").reshape(len(recording.steps), -1)
        controls = rows[:, 4:].reshape(len(rows), recording.case.horizon, 3)
        assert (rows[:, 0] == SOLVED).all()
        assert np.abs(controls[:, 0] - reference(recording)[:, 0]).max() < 1e-4


@needs(*emulator.MEASURING, str(emulator.GENERATOR))
def test_counts_are_the_same_every_time(small, recorded, monkeypatch):
    """The docking case by both solvers, counted twice: equal tables, and answers as they should."""
    monkeypatch.setattr(measurement, "recordings", lambda _: recorded[-1:])
    first, second = (measurement.measure(small) for _ in range(2))
    for name, table in first.items():
        pd.testing.assert_frame_equal(table, second[name])
    check_answers(first["answers.csv"])
    check_memory(first["memory.csv"])
    counted = first["classes.csv"]
    assert (counted["fp_multiply_add"] > 0).all() and (counted["other"] == 0).all()


def has_unicorn():
    """Whether the environment of the folder ``flight`` has it; `flight/install` makes that."""
    python = [str(emulator.GENERATOR), "-c", "import unicorn"]
    return (
        emulator.GENERATOR.exists() and subprocess.run(python, capture_output=True).returncode == 0
    )


@needs(*emulator.MEASURING)
@pytest.mark.skipif(not has_unicorn(), reason="not there: Unicorn in flight/.venv (flight/install)")
@pytest.mark.parametrize("name", emulator.PROCESSORS)
def test_unicorn_counts_the_same(recorded, tmp_path, name):
    """Two docking programs on another emulator without the plugin: as many instructions each.

    Loader, board, semihosting and the counting are others; Unicorn's translator comes from QEMU.
    """
    processor, recording = emulator.PROCESSORS[name], recorded[-1]
    plugin = emulator.build_plugin(tmp_path)
    emulator.build(emulator.OWN, processor, recording, tmp_path)
    answers, counts = emulator.replay(processor, recording, tmp_path, plugin)
    (tmp_path / "answers.bin").unlink()
    counter = Path(__file__).with_name("unicorn_count.py")
    said = emulator.run([emulator.GENERATOR, counter, "replay.elf", processor.cpu], tmp_path)
    total = counts.drop(columns=cycles.MISSES).sum(axis=1)
    assert len(total) == len(recording.steps) > 1
    assert [int(number) for number in said.split()] == total.tolist()
    again = np.fromfile(tmp_path / "answers.bin").reshape(len(total), -1)
    assert again[:, 1].tolist() == answers.iterations.tolist()
    assert again[:, 4:].tolist() == answers.controls.reshape(len(total), -1).tolist()


@needs(*link.FLYING)
def test_a_rendezvous_over_the_socket(section, tmp_path):
    """It docks, and as the native guidance does."""
    row = link.fly(section, tmp_path).iloc[0]
    assert row["steps"] == row["native_steps"] and row["position_m"] <= row["tolerance_m"]


def test_a_lost_client_ends_the_simulation_with_a_line(law, chaser, tmp_path):
    """A client that answers one report and goes: the server says after how many steps."""
    program = (
        "import socket, sys; s = socket.create_connection(('127.0.0.1', int(sys.argv[1])));"
        "s.recv(56, socket.MSG_WAITALL); s.sendall(bytes(40)); s.recv(56, socket.MSG_WAITALL)"
    )
    with (
        pytest.raises(InputError, match="connection to the flight program lost after 1 steps"),
        link.client([sys.executable, "-c", program], tmp_path) as flying,
    ):
        link.serve(flying.connection, law, chaser, None)


@needs("gcc")
def test_a_lost_simulation_ends_the_client_with_a_line(law, tmp_path, monkeypatch):
    """Built for this machine: its word is on the standard error stream, and its status is 1."""
    monkeypatch.setattr(link, "COMPILER", "gcc")
    monkeypatch.setattr(link, "FLAGS", ["-std=gnu11", "-O2"])
    _, *_, program = link.build_client(law, tmp_path)
    with link.client([program], tmp_path / "law.bin") as (connection, process):
        connection.sendall(np.zeros(7).tobytes())
        connection.recv(40)
        connection.close()
        assert process.wait(timeout=10) == 1
        assert process.stderr.read() == "flight program: connection lost after 1 steps\n"


def test_cycles_are_bounded(section):
    """A solve of one instruction of a class costs its bounds, and a miss what the memory does."""
    kinds = cycles.CYCLES["Cortex-A9"]
    key = {"processor": "Cortex-A9", "solver": "", "phase": "far", "horizon": 1,
           "sample_time_s": 1.0, "solve": "mean", **dict.fromkeys(cycles.MISSES, 0)}  # fmt: skip
    rows = [key | dict.fromkeys(kinds, 0) | {kind: 1} for kind in kinds]
    rows.append(key | dict.fromkeys(kinds, 0) | {"data_misses": 1})
    found = cycles.bounded(pd.DataFrame(rows), section.flight_computer)
    expected = [*kinds.values(), section.flight_computer.miss_cycles]
    assert found[["cycles_low", "cycles_high"]].to_numpy().tolist() == [list(e) for e in expected]
    assert (found["cycles_low"] <= found["cycles_high"]).all()


# The tracked tables.
@pytest.fixture(scope="module")
def tracked(root):
    folder = root / "data/accepted/rendezvous/flight"
    return {path.name: read_table(path) for path in sorted(folder.glob("*.csv"))}


def check_answers(table):
    """Every program that has a solution as stated is solved, and as the study solves it."""
    assert (table["solved_of_feasible"] == table["feasible"]).all()
    for solver, rows in table.groupby("solver"):
        assert (rows["cost_error_most"] < COST_ERROR[solver]).all()
        assert (rows["control_error_median"] < MEDIAN_CONTROL_ERROR[solver]).all()


def check_memory(table):
    """No memory after the start; the stage-wise solver has no heap at all."""
    assert (table["heap_after_start_bytes"] == 0).all()
    assert (table.loc[table["solver"] == emulator.OWN, "heap_bytes"] == 0).all()


def test_tracked_tables_are_of_these_sources(section, tracked):
    """Sources or configuration have changed since they were counted: run `make flight`."""
    rows = tracked["provenance.csv"].set_index("item")["value"]
    assert fingerprint(section) == {key: rows[key] for key in ("sources", "configuration")}


def test_tracked_tables_are_whole(section, tracked):
    """Every case with both solvers on both processors, as many runs as configured."""
    size = section.flight_computer
    runs = {emulator.OWN: size.runs, emulator.GENERATED: size.generated_runs}
    expected = {(PHASES[c.phase], c.horizon, c.sample_time) for c in cases(section)}
    keys = ["phase", "horizon", "sample_time_s"]
    groups = tracked["runs.csv"].groupby(["processor", "solver"])
    assert len(groups) == len(emulator.PROCESSORS) * len(emulator.SOLVERS)
    for (_, solver), table in groups:
        assert set(table[keys].itertuples(index=False, name=None)) == expected
        assert (table.groupby(keys)["run"].nunique() == runs[solver]).all()
    assert len(tracked["classes.csv"]) == 2 * len(groups) * len(expected)
    assert (tracked["classes.csv"]["other"] == 0).all()


def test_tracked_answers_and_memory(tracked):
    check_answers(tracked["answers.csv"])
    check_memory(tracked["memory.csv"])
    row = tracked["link.csv"].iloc[0]
    assert row["docked"] and row["steps"] == row["native_steps"]


@needs(*emulator.MEASURING)
def test_tracked_counts_come_again(section, tracked, tmp_path):
    """One run of a tracked case counted again: the same to the last instruction.

    With another compiler than that of the provenance there is nothing to compare.
    """
    rows = tracked["provenance.csv"].set_index("item")["value"]
    version = emulator.run(["arm-none-eabi-gcc", "--version"], tmp_path).splitlines()[0]
    if version != rows["compiler"]:
        pytest.skip(f"another compiler: {version}")
    plugin = emulator.build_plugin(tmp_path)
    recording = next(r for r in recordings(section) if r.case.phase == 2)
    emulator.build(emulator.OWN, emulator.PROCESSORS["Cortex-A9"], recording, tmp_path)
    _, counts = emulator.replay(emulator.PROCESSORS["Cortex-A9"], recording, tmp_path, plugin)
    runs = tracked["runs.csv"]
    own = runs[
        (runs["processor"] == "Cortex-A9") & (runs["solver"] == emulator.OWN)
        & (runs["phase"] == "final") & (runs["horizon"] == recording.case.horizon)
    ]  # fmt: skip
    total = counts.drop(columns=cycles.MISSES).sum(axis=1)
    again = total.groupby(recording.runs).mean().round(1)
    assert again.tolist() == own["instructions"].tolist()
