"""Between which bounds the cycles of counted instructions lie.

An emulator tells instructions and not cycles. Each class of instruction has a least cost, where it
is issued beside others and its result is not waited for, and a largest, where everything waits for
it. Sources: Cortex-A8 technical reference manual (Arm DDI 0344), chapter 16, table 16.25 for its
floating-point unit, which is not pipelined; Cortex-A9 manual (DDI 0407) and that of its
floating-point unit (DDI 0408), throughput and latency of double precision. Where a manual gives no
range (an instruction that loads or stores several registers, a wrong prediction of a branch), the
bounds are ours and wide. A miss of a first-level cache costs between what the second level and what
the memory takes, which the configuration says.
"""

import numpy as np
import pandas as pd

from smallsat.studies.rendezvous.configuration import FlightComputer

# Cycles an instruction, least and most.
CYCLES = {
    "Cortex-A8": {
        "integer": (0.5, 2.0),
        "multiply": (1.0, 6.0),
        "load": (0.5, 9.0),
        "store": (0.5, 9.0),
        "branch": (0.5, 14.0),
        "fp_add": (9.0, 10.0),
        "fp_multiply": (11.0, 17.0),
        "fp_multiply_add": (19.0, 26.0),
        "fp_divide": (29.0, 65.0),
        "fp_root": (29.0, 60.0),
        "fp_load": (1.0, 17.0),
        "fp_store": (1.0, 17.0),
        "fp_move": (1.0, 24.0),
        "other": (1.0, 24.0),
    },
    "Cortex-A9": {
        "integer": (0.5, 2.0),
        "multiply": (1.0, 5.0),
        "load": (0.5, 9.0),
        "store": (0.5, 9.0),
        "branch": (0.5, 11.0),
        "fp_add": (1.0, 4.0),
        "fp_multiply": (2.0, 6.0),
        "fp_multiply_add": (2.0, 9.0),
        "fp_divide": (20.0, 25.0),
        "fp_root": (28.0, 32.0),
        "fp_load": (1.0, 17.0),
        "fp_store": (1.0, 17.0),
        "fp_move": (1.0, 11.0),
        "other": (1.0, 24.0),
    },
}
MISSES = ["instruction_misses", "data_misses"]
KEY = ["processor", "solver", "phase", "horizon", "sample_time_s", "solve"]


def bounded(classes: pd.DataFrame, settings: FlightComputer) -> pd.DataFrame:
    """Cycles, and ms at the configured clock, of the mean and the worst solve of each case.

    Parameters
    ----------
    classes
        ``classes.csv`` of `smallsat.studies.rendezvous.flight_computer.measurement.measure`.
    settings
        Whose ``miss_cycles`` and ``clock_MHz`` are used.

    Returns
    -------
    pandas.DataFrame
        `KEY`, ``instructions``, ``misses``, ``cycles_low``, ``cycles_high``, ``ms_low``,
        ``ms_high``; one row a row of ``classes``.
    """
    table = classes[KEY].copy()
    misses = classes[MISSES].sum(axis=1)
    table["instructions"] = classes[list(CYCLES["Cortex-A8"])].sum(axis=1)
    table["misses"] = misses
    for end, name in enumerate(("low", "high")):
        costs = pd.DataFrame(
            {cpu: {kind: both[end] for kind, both in own.items()} for cpu, own in CYCLES.items()}
        )
        weights = costs.T.loc[classes["processor"]].to_numpy()
        counted = np.einsum("ij,ij->i", classes[list(costs.index)].to_numpy(float), weights)
        table[f"cycles_{name}"] = counted + settings.miss_cycles[end] * misses
        table[f"ms_{name}"] = table[f"cycles_{name}"] / (1e3 * settings.clock_MHz)
    return table.round(3)
