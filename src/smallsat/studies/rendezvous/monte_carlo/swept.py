"""Tables of what is swept beyond the document: impulse bits, rotation rates, elliptic orbits."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from smallsat.dynamics.units import MINUTE
from smallsat.results import read_table
from smallsat.studies.rendezvous.configuration import MonteCarlo
from smallsat.studies.rendezvous.guidance.law import DOCKING, Law
from smallsat.studies.rendezvous.model.columns import STATE
from smallsat.studies.rendezvous.monte_carlo.cases import (
    CLOHESSY_WILTSHIRE,
    EXTENTS,
    PHASES,
    THRUSTS,
    TREATMENTS,
    YAMANAKA_ANKERSEN,
    bit_case,
    cases,
    orbit_case,
    rotation_case,
    rotation_rates,
)
from smallsat.studies.rendezvous.monte_carlo.tables import end_columns, totals

# A variant and value of a sweep, its cases, and what each is compared with from the same starts.
Line = tuple[str, float, Sequence[str], Sequence[str]]

QUANTILES = {"low": 0.05, "median": 0.5, "high": 0.95}
# What is added up: one phase, or all that were flown.
SCOPES = {"docking": PHASES[DOCKING:], "whole": PHASES}


def impulse_bits(section: MonteCarlo, folder: Path) -> pd.DataFrame:
    """Manoeuvres over the minimum impulse bit, mN s, a row a thrust, treatment and bit.

    They are compared with the least bit.
    """
    bits = section.studies.impulse_bits.bits_mN_s
    lines = [
        (
            f"{thrust}, {treatment}",
            bit,
            [bit_case(thrust, treatment, bit)],
            [bit_case(thrust, treatment, min(bits))],
        )
        for thrust in THRUSTS
        for treatment in TREATMENTS
        for bit in bits
    ]
    return _swept(section, folder, "impulse-bits", lines)


def rotation(section: MonteCarlo, folder: Path) -> pd.DataFrame:
    """Manoeuvres over the target's rate, rad/s, a row an extent and rate.

    They are compared with the least rate.
    """
    rates = rotation_rates(section)
    lines = [
        (extent, rate, [rotation_case(extent, rate)], [rotation_case(extent, min(rates))])
        for extent in EXTENTS
        for rate in rates
    ]
    return _swept(section, folder, "rotation", lines)


def orbits(section: MonteCarlo, folder: Path) -> pd.DataFrame:
    """Manoeuvres over the eccentricity, a row a model; beginnings on the orbit are put together.

    They are compared with Yamanaka and Ankersen's prediction on the same orbit.
    """
    settings = section.studies.orbits

    def names(model: str, e: float) -> list[str]:
        return [orbit_case(model, e, anomaly) for anomaly in settings.anomalies_deg]

    lines = [
        (model, e, names(model, e), names(YAMANAKA_ANKERSEN, e))
        for model in (CLOHESSY_WILTSHIRE, YAMANAKA_ANKERSEN)
        for e in settings.eccentricities
    ]
    return _swept(section, folder, "orbits", lines)


def _swept(section: MonteCarlo, folder: Path, group: str, lines: Iterable[Line]) -> pd.DataFrame:
    """A row a line."""
    table = read_table(folder / f"{group}.parquet")
    laws = {case.name: case.law for case in cases(section, group)}
    rows = []
    for variant, value, names, references in lines:
        own, others = (
            pd.concat([table[table["case"] == name] for name in chosen], keys=range(len(chosen)))
            for chosen in (names, references)
        )
        row = _row(own, laws[names[0]])
        for scope, phases in SCOPES.items():
            row[f"{scope}_change_pct"] = _change(own, others, phases)
        rows.append({"variant": variant, "value": value} | row)
    return pd.DataFrame(rows)


def _change(flown: pd.DataFrame, others: pd.DataFrame, phases: Sequence[str]) -> float:
    """Median change of delta-v, per cent, where both dock; their indices begin with the case."""
    spent = []
    for table in (flown, others):
        docked = table[table["completed"]]
        values = totals(docked, "delta_v_m_s", phases)
        values.index = pd.MultiIndex.from_arrays(
            [docked.index.get_level_values(0), docked["sample"], docked["run"]]
        )
        spent.append(values)
    return float(100.0 * (spent[0] / spent[1] - 1.0).median())


def _row(flown: pd.DataFrame, law: Law) -> dict[str, Any]:
    """What came of some manoeuvres; quantiles are of those that docked.

    ``<scope>_unsolvable_pct`` is the share of steps whose program has no solution as stated.
    ``miss_m`` is the median distance from the port at the end of those that began to dock and did
    not.
    """
    docked = flown[flown["completed"]]
    row: dict[str, Any] = {
        "manoeuvres": len(flown),
        "docked_pct": 100.0 * float(flown["completed"].mean()),
        "miss_m": _miss(flown[~flown["completed"] & (flown["docking_steps"] > 0)], law),
    }
    for scope, phases in SCOPES.items():
        steps, softened = (totals(flown, name, phases).sum() for name in ("steps", "softened"))
        row[f"{scope}_unsolvable_pct"] = 100.0 * softened / steps if steps else np.nan
        for quantity, name, unit in (
            ("delta_v", "delta_v_m_s", 1.0),
            ("time", "time_s", MINUTE),
        ):
            values = totals(docked, name, phases) / unit
            suffix = "m_s" if quantity == "delta_v" else "min"
            for label, level in QUANTILES.items():
                row[f"{scope}_{quantity}_{label}_{suffix}"] = float(values.quantile(level))
    return row


def _miss(flown: pd.DataFrame, law: Law) -> float:
    ends = flown[end_columns(PHASES[DOCKING])[: len(STATE) // 2]].to_numpy()
    times = totals(flown, "time_s").to_numpy()
    ports = law.port * np.array([law.axis_at(time) for time in times]).reshape(-1, 3)
    return float(np.median(np.linalg.norm(ends - ports, axis=1))) if len(flown) else np.nan
