"""Tables made from the manoeuvres of the studies: what a variant changes, and what r3 decides."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.dynamics.units import MINUTE
from smallsat.results import read_table
from smallsat.studies.rendezvous.configuration import MonteCarlo
from smallsat.studies.rendezvous.monte_carlo.cases import (
    BASELINE,
    CLOHESSY_WILTSHIRE,
    PHASES,
    SCHWEIGHART_SEDWICK,
    UNDISTURBED,
    delay_case,
    prediction_case,
    sweep_case,
    weight_case,
    weighted_sweep_case,
)
from smallsat.studies.rendezvous.monte_carlo.tables import column, totals

QUANTILES = {"low": 0.05, "median": 0.5, "high": 0.95}
QUANTITIES = {"delta_v": "delta_v_m_s", "time": "time_s"}


def variants(section: MonteCarlo, folder: Path) -> pd.DataFrame:
    """Change that each variant makes, over initial states: median, 5 and 95 % quantile, per cent.

    A state's value is the mean of its runs; ``completed_pct`` counts all runs of the variant. Only
    states from which both complete a run are compared.
    """
    rows = []
    for topic, name, reference, variant in _compared(section, folder):
        a, b = _by_state(reference), _by_state(variant)
        both = a.index.intersection(b.index)
        row: dict[str, object] = {
            "topic": topic,
            "variant": name,
            "states": len(both),
            "completed_pct": 100.0 * float(variant["completed"].mean()),
        }
        for short in QUANTITIES:
            change = 100.0 * (b.loc[both, short] / a.loc[both, short] - 1.0)
            for label, level in QUANTILES.items():
                row[f"{short}_{label}_pct"] = float(change.quantile(level)) if len(both) else np.nan
        rows.append(row)
    return pd.DataFrame(rows)


def _compared(
    section: MonteCarlo, folder: Path
) -> Iterator[tuple[str, str, pd.DataFrame, pd.DataFrame]]:
    """Topic, name, rows of the reference and rows of the variant."""
    studies = section.studies
    groups = ("domain", "rendezvous-sweep", "weights", "delay", "prediction", "robustness")
    tables = {name: read_table(folder / f"{name}.parquet") for name in groups}

    def rows(group: str, case: str) -> pd.DataFrame:
        return tables[group][tables[group]["case"] == case]

    baseline = rows("domain", BASELINE)
    for phase in PHASES:
        for factor in studies.weights.factors:
            name = weight_case(factor, phase)
            yield "weights", name, baseline, rows("weights", name)
    times = studies.rendezvous.sample_times_s
    first, last = times[0], times[-1]
    change = f"Ts {first:g} to {last:g} s"
    horizon = section.phases.far.horizon
    if horizon in studies.rendezvous.horizons:
        yield (
            "weights",
            f"{change}, rendezvous phase",
            rows("rendezvous-sweep", sweep_case(horizon, first)),
            rows("rendezvous-sweep", sweep_case(horizon, last)),
        )
    factors = studies.weights.factors
    for factor in (factors[0], factors[-1]):
        yield (
            "weights",
            f"{change}, R times {factor:g}",
            rows("weights", weighted_sweep_case(factor, first)),
            rows("weights", weighted_sweep_case(factor, last)),
        )
    for delay in studies.delay.delays_s:
        for known in (False, True):
            name = delay_case(delay, known)
            yield "delay", name, baseline, rows("delay", name)
    for inclination in studies.prediction.inclinations_deg:
        yield (
            "prediction",
            f"J2 predicted, {inclination:g} deg",
            rows("prediction", prediction_case(CLOHESSY_WILTSHIRE, inclination)),
            rows("prediction", prediction_case(SCHWEIGHART_SEDWICK, inclination)),
        )
    calm = rows("robustness", UNDISTURBED)
    for name in dict.fromkeys(tables["robustness"]["case"]):
        if name != UNDISTURBED:
            yield "disturbances", str(name), calm, rows("robustness", str(name))


def _by_state(rows: pd.DataFrame) -> pd.DataFrame:
    done = rows[rows["completed"]]
    frame = pd.DataFrame({"sample": done["sample"]})
    for short, quantity in QUANTITIES.items():
        frame[short] = totals(done, quantity)
    return frame.groupby("sample").mean()


def bounce(folder: Path) -> pd.DataFrame:
    """Mean deviations over runs, by docking distance and time limit; and the share that docks."""
    table = read_table(folder / "passages.parquet")
    grid = ["end_distance_m", "time_limit_min"]
    spread = table.groupby([*grid, "sample"])[["delta_v_m_s", "time_s"]].std().groupby(grid).mean()
    found = pd.DataFrame(
        {
            "deviation_delta_v_m_s": spread["delta_v_m_s"],
            "deviation_time_min": spread["time_s"] / MINUTE,
            "mean_delta_v_m_s": table.groupby(grid)["delta_v_m_s"].mean(),
            "mean_time_min": table.groupby(grid)["time_s"].mean() / MINUTE,
            "docked_share": table.groupby(grid)["docked"].mean(),
        }
    )
    return found.reset_index()


def deviations(folder: Path) -> pd.DataFrame:
    """Mean over states of the deviation over runs, each case and phase, m/s and min."""
    table = read_table(folder / "robustness.parquet")
    rows = []
    for case in dict.fromkeys(table["case"]):
        if case == UNDISTURBED:
            continue
        one = table[table["case"] == case]
        for name, phases in [*((phase, [phase]) for phase in PHASES), ("all", list(PHASES))]:
            values = pd.DataFrame(
                {short: totals(one, quantity, phases) for short, quantity in QUANTITIES.items()}
            ).assign(sample=one["sample"])
            grouped = values.groupby("sample")
            spread, mean = grouped.std().mean(), grouped.mean().mean()
            rows.append(
                {
                    "case": case,
                    "phase": name,
                    "mean_delta_v_m_s": mean["delta_v"],
                    "mean_time_min": mean["time"] / MINUTE,
                    "deviation_delta_v_m_s": spread["delta_v"],
                    "deviation_time_min": spread["time"] / MINUTE,
                    "completed_pct": 100.0 * float(one["completed"].mean()),
                }
            )
    return pd.DataFrame(rows)


def infeasible(folder: Path) -> pd.DataFrame:
    """Counts of manoeuvres and programs by what went wrong, each case of chapter 4."""
    rows = []
    for group in ("domain", *(f"{phase}-sweep" for phase in PHASES)):
        table = read_table(folder / f"{group}.parquet")
        for case in dict.fromkeys(table["case"]):
            one = table[table["case"] == case]
            counts = {
                kind: sum(int(one[column(phase, kind)].sum()) for phase in PHASES)
                for kind in ("steps", "softened", "outside", "failed")
            }
            rows.append(
                {
                    "group": group,
                    "case": case,
                    "manoeuvres": len(one),
                    "out_of_time": int((~one["completed"]).sum()),
                    "programs": counts["steps"],
                    "softened": counts["softened"],
                    "outside": counts["outside"],
                    "failed": counts["failed"],
                }
            )
    return pd.DataFrame(rows)
