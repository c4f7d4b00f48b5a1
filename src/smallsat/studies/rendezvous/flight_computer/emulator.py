"""The flight program cross-built, and run on an emulated board without an operating system.

Sources and what each of them is for: the folder ``flight``. Flags are fixed, so that the same
tools give the same instructions; what the compiler calls to copy memory is built with them too.
"""

import json
import os
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.errors import InputError
from smallsat.studies.rendezvous.flight_computer.provenance import FOLDER
from smallsat.studies.rendezvous.flight_computer.recording import Recording, law_header
from smallsat.studies.rendezvous.guidance.law import DOCKING, RENDEZVOUS, settings

GENERATOR = FOLDER / ".venv/bin/python"
OWN, GENERATED = "stage-wise", "generated"
SOLVERS = (OWN, GENERATED)
MEASURING = (
    "arm-none-eabi-gcc",
    "arm-none-eabi-ar",
    "arm-none-eabi-size",
    "qemu-system-arm",
    "gcc",
)

FLAGS = [
    "-std=gnu11",
    "-O2",
    "-mfpu=vfpv3",
    "-mfloat-abi=hard",
    "-marm",
    "-ffp-contract=off",
    "-fno-tree-loop-distribute-patterns",
    "-ffunction-sections",
    "-fdata-sections",
]
LINKED = [
    "--specs=rdimon.specs",
    "-Wl,--gc-sections",
    "-Wl,--wrap=malloc",
    "-Wl,--wrap=calloc",
    "-Wl,-e,boot",
]
# A partial link keeps what a solver needs of itself and nothing else.
ALONE = ["-r", "-nostdlib", "-Wl,--gc-sections", "-Wl,-u,solve", "-Wl,-u,prepare", "-Wl,-e,solve"]
BOARD = [
    "-m",
    "128",
    "-nographic",
    "-monitor",
    "none",
    "-serial",
    "none",
    "-semihosting-config",
    "enable=on,target=native",
    "-icount",
    "shift=0,sleep=off",
    "-d",
    "plugin",
]


@dataclass(frozen=True)
class Processor:
    """What is emulated.

    Attributes
    ----------
    cpu, machine, load_at
        The compiler's name of the processor, QEMU's of a board that has it, and where its memory
        begins, leaving room for what starts there.
    line_bytes
        A line of its first-level caches.
    """

    cpu: str
    machine: str
    load_at: int
    line_bytes: int


PROCESSORS = {
    "Cortex-A8": Processor("cortex-a8", "realview-pb-a8", 0x0001_0000, 64),
    "Cortex-A9": Processor("cortex-a9", "vexpress-a9", 0x6001_0000, 32),
}


@dataclass(frozen=True)
class Answers:
    """What the flight program answered to M recorded steps.

    Attributes
    ----------
    status, iterations
        As `riccati_interior_point.Solution` has them, (M,).
    stack, heap
        Bytes of stack in each solve, and of heap asked for until then, (M,).
    controls
        Scaled, (M, N, 3).
    """

    status: np.ndarray
    iterations: np.ndarray
    stack: np.ndarray
    heap: np.ndarray
    controls: np.ndarray


def missing(*commands: str) -> list[str]:
    """Which of some commands are not there."""
    return [command for command in commands if shutil.which(command) is None]


def run(command: Sequence[str | Path], folder: Path) -> str:
    """Run a command in a folder and return what it prints; an InputError where it fails."""
    # The order in which the generator writes its variables, so where they lie, follows the seed.
    environment = os.environ | {"QEMU_AUDIO_DRV": "none", "PYTHONHASHSEED": "0"}
    done = subprocess.run(
        [str(word) for word in command],
        cwd=folder, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if done.returncode:
        said = (done.stderr or done.stdout).strip().splitlines()
        raise InputError(f"{command[0]} failed in {folder}: {said[-1] if said else 'no word'}")
    return done.stdout


def build_plugin(folder: Path) -> Path:
    """Build the counting plugin of QEMU in a folder and return it."""
    plugin = folder / "count.so"
    run(["gcc", "-O2", "-shared", "-fPIC", "-o", plugin, FOLDER / "plugin/count.c"], folder)
    return plugin


def description(recording: Recording) -> dict[str, object]:
    """What ``describe.py`` is told of a case's programs."""
    record, phase = settings([recording.law])[0], recording.case.phase
    hard = {"penalty": False, "weight": 0.0}
    cone = hard if phase == DOCKING else {"penalty": True, "weight": record["penalties"][phase]}
    last = [hard, *[cone] * 4] if phase == RENDEZVOUS else [cone] * 4 + [hard] * (phase != DOCKING)
    return {
        "stages": recording.case.horizon,
        "transition": record["transitions"][phase].tolist(),
        "state_hessian": record["state_hessians"][phase].tolist(),
        "terminal_hessian": record["terminal_hessians"][phase].tolist(),
        "control_hessian": record["control_hessians"][phase].tolist(),
        "inner": [hard] if phase == RENDEZVOUS else last,
        "last": last,
        "speed_bound": record["speed_bound"] / record["scales"][phase, 3]
        if phase == DOCKING
        else None,
    }


def generate(recording: Recording, folder: Path) -> Path:
    """Have a case's solver written, in a folder, if it is not there yet; return its code."""
    code = folder / "generated"
    if not code.exists():
        described = folder / "program.json"
        described.write_text(json.dumps(description(recording)))
        run([GENERATOR, FOLDER / "describe.py", described, code], folder)
    return code / "c"


def solver_parts(
    solver: str, compiler: list[str | Path], recording: Recording, folder: Path
) -> list[str | Path]:
    """Sources and libraries of a solver, with the compiler's options for them.

    The part of the generated code that is the same in all cases is compiled once, in the folder
    above.
    """
    if solver == OWN:
        return [FOLDER / "interior_point.c"]
    code = generate(recording, folder)
    qoco = code / "solver_code"
    places = ("include", "algebra", "algebra/builtin", "lib/amd", "lib/qdldl/include")
    headers = [FOLDER / "port", code / "include", *(qoco / place for place in places)]
    options = ["-w", "-DNTIMER", *(f"-I{header}" for header in headers)]
    library = folder.parent / f"qoco{compiler[-1]}.a"
    if not library.exists():
        parts = [qoco / name for name in ("src", "algebra/builtin", "lib/amd", "lib/qdldl/src")]
        sources = sorted(p for part in parts for p in part.glob("*.c") if "timer" not in p.name)
        objects = folder / library.stem
        objects.mkdir()
        run([*compiler, *options, "-c", *sources, FOLDER / "port/no_clock.c"], objects)
        run(["arm-none-eabi-ar", "rcsD", library, *sorted(objects.glob("*.o"))], objects)
    rows = 4 if recording.case.phase == DOCKING else 5
    own = [code / "src/cpg_solve.c", code / "src/cpg_workspace.c", FOLDER / "generated_solver.c"]
    return [*options, f"-DROWS_A_STAGE={rows}", *own, library]


def build(solver: str, processor: Processor, recording: Recording, folder: Path) -> dict[str, int]:
    """Build ``replay.elf`` for a recording in a folder; return the solver's bytes by section."""
    (folder / "law.h").write_text(law_header())
    compiler: list[str | Path] = ["arm-none-eabi-gcc", *FLAGS, f"-mcpu={processor.cpu}"]
    parts = solver_parts(solver, compiler, recording, folder)
    compiler += [f"-DSTAGES={recording.case.horizon}", f"-I{folder}", f"-I{FOLDER}"]
    run([*compiler, *ALONE, "-o", "solver.o", *parts], folder)
    around = [FOLDER / name for name in ("start.S", "replay.c", "guidance.c", "memory.c")]
    place = f"-Wl,-Ttext-segment={processor.load_at:#x}"
    run([*compiler, *LINKED, place, "-o", "replay.elf", *around, "solver.o", "-lm"], folder)
    sizes = run(["arm-none-eabi-size", "solver.o"], folder).splitlines()[1].split()
    return dict(zip(("text", "data", "bss"), map(int, sizes), strict=False))


def replay(
    processor: Processor, recording: Recording, folder: Path, plugin: Path, caches: bool = False
) -> tuple[Answers, pd.DataFrame]:
    """Replay a recording with ``replay.elf``: answers, and what was counted in each solve.

    With `caches` the misses of the first-level caches are counted too, which takes far longer.
    """
    (folder / "law.bin").write_bytes(settings([recording.law]).tobytes())
    (folder / "steps.bin").write_bytes(recording.steps.tobytes())
    counting = f"{plugin},out=counts.csv" + (f",line={processor.line_bytes}" if caches else "")
    emulator = ["qemu-system-arm", "-M", processor.machine, *BOARD]
    run([*emulator, "-plugin", counting, "-kernel", "replay.elf"], folder)
    rows = np.fromfile(folder / "answers.bin").reshape(len(recording.steps), -1)
    status, iterations, stack, heap = rows[:, :4].astype(int).T
    controls = rows[:, 4:].reshape(len(rows), recording.case.horizon, 3)
    return Answers(status, iterations, stack, heap, controls), pd.read_csv(folder / "counts.csv")


def versions() -> dict[str, str]:
    """First lines of what the tools say of themselves."""
    words: dict[str, list[str | Path]] = {
        "arm-none-eabi-gcc": ["arm-none-eabi-gcc", "--version"],
        "qemu-system-arm": ["qemu-system-arm", "--version"],
        "generator": [GENERATOR, "-m", "pip", "list", "--format=freeze"],
    }
    said = {name: run(command, FOLDER).splitlines() for name, command in words.items()}
    wanted = [line for line in said["generator"] if line.startswith(("cvxpygen=", "cvxpy="))]
    return {
        "compiler": said["arm-none-eabi-gcc"][0],
        "emulator": said["qemu-system-arm"][0],
        "generator": ", ".join(sorted(wanted)),
    }
