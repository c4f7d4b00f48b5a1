"""How far a parameter set is from what the document prints: cells, feasibility, text and axes.

Every miss is in assumed errors, and the misfit is the sum of their squares:

- the 20 cells of Tables 3.3 to 3.6 (kind ``cell``). Numbers of steps are whole, so the time at
  which a phase's end is crossed, in fractions of a step, stands for them: it has to lie in the last
  printed step;
- the share of steps whose program (3.7), (3.10) or (3.14) has no solution as stated, in each phase
  of the four manoeuvres (kind ``feasibility``). The document's solver has no soft rows;
- what the text prefers (kind ``text``): set point 1 on or near the zone's boundary (3.1.1), set
  point 2 just behind its switching distance (3.2.1), the zone within the nearest start (4).

The axes of Figures 4.7 and 4.10 are looked at in `smallsat.studies.rendezvous.inference.axes`.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from smallsat.dynamics.units import KM, MINUTE
from smallsat.evidence.ledger import Ledger
from smallsat.studies.rendezvous.configuration import Cases, Flight, Inference
from smallsat.studies.rendezvous.evidence.case_tables import CASE_TABLES, phase_cells, total_cells
from smallsat.studies.rendezvous.guidance.law import DISTANCE, DOCKING, PHASES, RENDEZVOUS, Law
from smallsat.studies.rendezvous.model.geometry import cone_faces
from smallsat.studies.rendezvous.parameters import law, start_state
from smallsat.studies.rendezvous.simulation.closed_loop import Steps, simulate
from smallsat.studies.rendezvous.simulation.delta_v import READINGS, summed

# Parts of the misfit.
KINDS = ("cell", "feasibility", "text", "axes")
FITTED_CASES = (*CASE_TABLES, "no-set-point")
# Where a manoeuvre that takes this long is given up, s: far beyond the largest miss that counts.
TIME_LIMITS_S = {"no-set-point": 5600.0}
TIME_LIMIT_S = 2600.0
WORST = 10.0  # largest miss of a cell, in its errors: a stall is no worse than a bad miss
WORST_SHARE = 5.0  # largest miss of a phase's feasibility
STARTS = "chapter-4-introduction/initial-relative-distance-range-uniform/sensitivity-study"


def printed_steps(section: Flight, ledger: Ledger) -> dict[tuple[str, str], int]:
    """Whole steps of each phase that the printed times stand for (the far range less 1 s)."""
    cells = phase_cells(ledger)
    cells = cells[cells["phase"].isin(PHASES)]
    return {
        (row["case"], row["phase"]): round(
            (row["time_s"] + (row["phase"] == "far")) / section.phases[row["phase"]].sample_time_s
        )
        for row in cells.to_dict("records")
    }


def simulate_sets(
    sections: Sequence[Flight], cases: Sequence[str] = FITTED_CASES, patient: bool = False
) -> pd.DataFrame:
    """Simulate cases with parameter sets: a row a set, case and phase.

    Columns: ``set`` (its place), ``case``, ``phase``, ``ended``, ``steps``, ``crossing`` (steps
    until the end condition, interpolated), ``infeasible`` (steps whose program had no solution as
    stated), ``time_s`` and a delta-v for each of `READINGS`. A ``patient`` one gives no manoeuvre
    up before the law's own time limit.
    """
    laws = [law(section, case) for section in sections for case in cases]
    if not patient:
        limits = [TIME_LIMITS_S.get(case, TIME_LIMIT_S) for case in cases] * len(sections)
        laws = [one.with_(time_limit=limit) for one, limit in zip(laws, limits, strict=True)]
    starts = np.array([start_state(section) for section in sections for _ in cases])
    flown = simulate(laws, starts, with_steps=True)
    rows = []
    for number in range(len(laws)):
        steps = flown.record(number)
        for phase, name in enumerate(PHASES):
            own = steps.phase == phase
            ended = bool(flown.docked[number] if phase == 2 else (steps.phase > phase).any())
            rows.append(
                {
                    "set": number // len(cases),
                    "case": cases[number % len(cases)],
                    "phase": name,
                    "ended": ended,
                    "steps": int(own.sum()),
                    "crossing": crossing(laws[number], steps, phase, flown.ends[number, phase])
                    if ended
                    else np.nan,
                    "infeasible": int((steps.softened[own] > 0).sum()),
                    "time_s": float(own.sum() * laws[number].sample_times[phase]),
                    **{reading: summed(steps.impulse[own], reading) for reading in READINGS},
                }
            )
    return pd.DataFrame(rows)


def crossing(law: Law, steps: Steps, phase: int, end: np.ndarray) -> float:
    """Steps of a phase until its end condition is met, interpolated within the last one."""
    own = np.flatnonzero(steps.phase == phase)
    last = own[-1]
    before = _excess(law, phase, steps.state[last], steps.time[last])
    after = _excess(law, phase, end, steps.time[last] + law.sample_times[phase])
    share = before / (before - after) if before > 0.0 > after else 1.0
    return float(len(own) - 1 + min(share, 1.0))


def _excess(law: Law, phase: int, state: np.ndarray, time: float) -> float:
    """How far a state is from ending a phase, m; not positive where it ends it."""
    axis, faces = law.axis_at(time), np.empty((4, 3))
    offset = state[:3] - (law.port * axis if phase == DOCKING else 0.0)
    distance = law.switches[phase] == DISTANCE
    reached = float(np.linalg.norm(offset) if distance else offset @ axis)
    excess = reached - law.switch_distances[phase]
    if phase == RENDEZVOUS:
        cone_faces(axis, np.tan(law.cone_angles[phase]), faces)
        return max(float(np.max(faces @ state[:3])), excess)
    return excess


def residuals(sections: Sequence[Cases], flown: pd.DataFrame, ledger: Ledger) -> pd.DataFrame:
    """Every miss of the sets that were flown, a row a set and what was missed.

    Columns: ``set``, ``kind``, ``cell``, ``printed``, and for each of `READINGS` what was computed
    (``computed <r>``) and the miss in assumed errors (``residual <r>``).
    """
    section = sections[0]
    assumed = section.inference
    wanted = printed_steps(section, ledger)
    delta_v: Any = phase_cells(ledger).set_index(["case", "phase"])["delta_v_m_s"].to_dict()
    totals: Any = total_cells(ledger).set_index("case").to_dict("index")
    rows = []
    for row in flown.to_dict("records"):
        key, ended = (row["case"], row["phase"]), row["ended"]
        place, name = row["set"], " ".join(key)
        if key in wanted:
            # A crossing within the last printed step is that step; the whole number is shown.
            late = row["crossing"] - wanted[key]
            miss = max(late, 0.0) + min(late + 1.0, 0.0) if ended else np.nan
            steps = row["steps"] if ended else np.nan
            miss /= assumed.step_error
            rows.append(_row(place, "cell", f"{name} steps", wanted[key], steps, miss))
            found = {r: row[r] if ended else np.nan for r in READINGS}
            rows.append(_delta_v(place, f"{name} delta-v", delta_v[key], found, assumed))
        share = row["infeasible"] / row["steps"] if row["steps"] else 0.0
        miss = min(share / assumed.infeasible_share, WORST_SHARE)
        rows.append(_row(place, "feasibility", f"{name} without solution", 0.0, share, miss))
    groups: Any = flown[~flown["case"].isin(CASE_TABLES)].groupby(["set", "case"], sort=False)
    for (place, case), part in groups:
        if case not in totals:
            continue
        docked, printed = bool(part["ended"].all()), totals[case]
        minutes = (part["time_s"].sum() - 1.0) / MINUTE if docked else np.nan
        miss = (minutes / printed["time_min"] - 1.0) / assumed.time_share
        rows.append(_row(place, "cell", f"{case} time", printed["time_min"], minutes, miss))
        found = {r: part[r].sum() if docked else np.nan for r in READINGS}
        rows.append(_delta_v(place, f"{case} delta-v", printed["delta_v_m_s"], found, assumed))
    for place in flown["set"].unique():
        rows += _text(place, sections[place], ledger)
    return pd.DataFrame(rows)


def _row(place: Any, kind: str, name: str, printed: float, computed: float, miss: float) -> dict:
    """A miss that does not depend on how delta-v is summed; not a number is the worst one."""
    bounded = WORST if np.isnan(miss) else float(np.clip(miss, -WORST, WORST))
    row = {"set": int(place), "kind": kind, "cell": name, "printed": printed}
    return row | {
        f"{column} {reading}": value
        for reading in READINGS
        for column, value in (("computed", computed), ("residual", bounded))
    }


def _delta_v(
    place: Any, name: str, printed: float, found: dict[str, float], assumed: Inference
) -> dict:
    error = max(assumed.delta_v_share * printed, assumed.delta_v_error_m_s)
    row = _row(place, "cell", name, printed, np.nan, np.nan)
    for reading, value in found.items():
        if not np.isnan(value):
            miss = float(np.clip((value - printed) / error, -WORST, WORST))
            row |= {f"computed {reading}": value, f"residual {reading}": miss}
    return row


def _text(place: Any, section: Cases, ledger: Ledger) -> list[dict]:
    """What the text prefers of set points and zone."""
    inferred, assumed = section.inferred, section.inference
    nearest, farthest = (ledger.value(f"{STARTS}/{end}").value * KM for end in ("min", "max"))
    inside = max(inferred.keep_out_m - nearest, 0.0) / (farthest - nearest)
    behind = 1.0 - inferred.set_point_2 / inferred.switch_2
    point = inferred.set_point_1 - 1.0
    return [
        _row(place, "text", "set point 1 / r1", 1.0, 1.0 + point, point / assumed.on_boundary),
        _row(
            place, "text", "set point 2 / switch 2", 1.0, 1.0 - behind, behind / assumed.just_behind
        ),
        _row(
            place, "text", "starts inside the zone", 0.0, inside, inside / assumed.infeasible_share
        ),
    ]


def misfits(table: pd.DataFrame) -> pd.DataFrame:
    """Sum of squared misses by set (rows) and reading of delta-v (columns)."""
    squares = {r: table[f"residual {r}"] ** 2 for r in READINGS}
    return pd.DataFrame(squares).groupby(table["set"]).sum()
