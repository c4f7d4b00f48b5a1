"""The rendezvous flown over a socket (Figure 6.1): simulation as server, flight program as client.

The server moves both bodies; the client, cross-built and run by an emulator of its processor, knows
the law and is told relative states. Records are doubles: (time, state) one way and (phase, status,
command) the other, s, m and m/s.
"""

import socket
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from smallsat.errors import InputError
from smallsat.statistics.random_streams import stream
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.flight_computer.emulator import run
from smallsat.studies.rendezvous.flight_computer.provenance import FOLDER
from smallsat.studies.rendezvous.flight_computer.recording import law_header
from smallsat.studies.rendezvous.guidance.law import DOCKING, Law, settings
from smallsat.studies.rendezvous.parameters import law, start_state
from smallsat.studies.rendezvous.simulation.closed_loop import simulate
from smallsat.studies.rendezvous.simulation.disturbances import nonlinear_motion
from smallsat.studies.rendezvous.simulation.motion import (
    COMMANDED,
    NonlinearMotion,
    begin,
    coast,
    push,
    relative,
)

PROCESSOR = "Cortex-A8"
COMPILER = "arm-linux-gnueabihf-gcc"
EMULATOR = "qemu-arm"
FLYING = (COMPILER, EMULATOR)
FLAGS = ["-std=gnu11", "-O2", "-static", "-mcpu=cortex-a8", "-mfpu=vfpv3", "-ffp-contract=off"]
DOCKED = DOCKING + 1
PATIENCE = 60.0  # s that either side waits for the other
# The solver's tolerance leaves this much of a far control open, over a sample time, and no more.
TOLERANCE_M = 0.01


class Way(NamedTuple):
    """Steps flown: time, s, and phase, (K,); relative state before each, (K, 6), m and m/s."""

    time: np.ndarray
    phase: np.ndarray
    state: np.ndarray


def build_client(law: Law, folder: Path) -> list[str]:
    """Build the client and write its law in a folder; return the command but for the port."""
    (folder / "law.h").write_text(law_header())
    (folder / "law.bin").write_bytes(settings([law]).tobytes())
    sources = [FOLDER / n for n in ("client/client.c", "guidance.c", "interior_point.c")]
    room = [f"-DSTAGES={max(law.horizons)}", f"-I{folder}", f"-I{FOLDER}"]
    run([COMPILER, *FLAGS, *room, "-o", "client", *sources, "-lm"], folder)
    return [EMULATOR, "-cpu", "cortex-a8", str(folder / "client")]


class Client(NamedTuple):
    """A client that has come: the connection, and its process."""

    connection: socket.socket
    process: subprocess.Popen[str]


@contextmanager
def client(command: list[str], law_file: Path) -> Iterator[Client]:
    """Listen on the loopback, start a client there and yield it; it is ended with the block.

    Raises
    ------
    InputError
        If the client does not come.
    """
    with socket.create_server(("127.0.0.1", 0)) as listener:
        listener.settimeout(PATIENCE)
        words = [*command, str(listener.getsockname()[1]), str(law_file)]
        with subprocess.Popen(words, stderr=subprocess.PIPE, text=True) as process:
            try:
                try:
                    connection, _ = listener.accept()
                except TimeoutError:
                    raise InputError(
                        f"{command[0]}: the flight program did not connect within {PATIENCE:g} s"
                    ) from None
                with connection:
                    connection.settimeout(PATIENCE)
                    yield Client(connection, process)
            finally:
                process.terminate()


def serve(
    connection: socket.socket, law: Law, start: np.ndarray, motion: NonlinearMotion | None
) -> Way:
    """Move the chaser as the client commands until it says that it has docked.

    Raises
    ------
    InputError
        If the connection is lost, or the time limit of the law passes.
    """
    record = settings([law])[0]
    burn, on_times, idle, applied = (np.zeros(3) for _ in range(4))
    pair, time = begin(motion, start), 0.0
    state = relative(motion, pair)
    flown: list[tuple[float, int, np.ndarray]] = []
    while time <= law.time_limit:
        order = _exchange(connection, np.array([time, *state]), len(flown))
        phase, command = int(order[0]), np.array(order[2:])
        if phase == DOCKED:
            return Way(*(np.array(part) for part in zip(*flown, strict=True)))
        flown.append((time, phase, state))
        duration = law.sample_times[phase]
        coast(motion, pair, record["drifts_before"][phase], time, 0.0, burn, idle)
        push(record, motion, pair, command, 0.0, duration, burn, on_times, applied)
        coast(motion, pair, record["drifts_after"][phase], time, duration, burn, on_times)
        time += duration
        state = relative(motion, pair)
    raise InputError(f"the flight program has not docked within {law.time_limit:g} s")


def _exchange(connection: socket.socket, report: np.ndarray, steps: int) -> np.ndarray:
    """Send a report and return the order that answers it."""
    answer = b""
    try:
        connection.sendall(report.tobytes())
        while len(answer) < 40 and (part := connection.recv(40 - len(answer))):
            answer += part
    except OSError:
        pass
    if len(answer) < 40:
        raise InputError(f"simulation: connection to the flight program lost after {steps} steps")
    return np.frombuffer(answer)


def fly(section: Configuration, folder: Path) -> pd.DataFrame:
    """Fly Case 1 over the socket in the nonlinear model, and natively; one row that compares them.

    ``position_m`` is the largest difference of positions over the steps that both have.
    """
    given, start = law(section), start_state(section)
    motion = nonlinear_motion(section, given, COMMANDED)
    # The motion asks for random numbers, none of which act.
    native = simulate([given], start, motion=motion, generators=[stream(0, 0)], with_steps=True)
    own = native.record(0)
    with client(build_client(given, folder), folder / "law.bin") as flying:
        way = serve(flying.connection, given, start, motion)
    common = min(len(way.time), len(own.time))
    apart = np.linalg.norm((way.state - own.state[: len(way.state)])[:common, :3], axis=1)
    return pd.DataFrame(
        [
            {
                "processor": PROCESSOR,
                "steps": len(way.time),
                "native_steps": len(own.time),
                "docked": True,
                "position_m": float(f"{apart.max():.1e}"),
                "tolerance_m": TOLERANCE_M,
            }
        ]
    )
