"""What the document never prints, inferred from the tables that it does print.

The misfit of a parameter set compares its manoeuvres with Tables 3.3 to 3.6, cell by cell. Numbers
of steps are whole, so the time at which a phase's end is crossed, in fractions of a step, stands
beside them: it has to lie in the last printed step. All evaluated sets are kept; sets whose misfit
comes near the best one are called acceptable, and what they share is what the tables identify.

An inference explains what it was fitted to. Equal digits are no reproduction, and with nearly as
many parameters and readings as printed cells some agreement is to be had for nothing.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import differential_evolution

from smallsat.dynamics.units import MINUTE
from smallsat.evidence.ledger import Ledger
from smallsat.studies.rendezvous.configuration import Bounds, Cases, Flight, Inference
from smallsat.studies.rendezvous.evidence.case_tables import (
    CASE_TABLES,
    phase_cells,
    total_cells,
)
from smallsat.studies.rendezvous.guidance.law import (
    CONE_ONLY,
    DISTANCE,
    DOCKING,
    PHASES,
    RENDEZVOUS,
    Law,
)
from smallsat.studies.rendezvous.model.geometry import cone_faces
from smallsat.studies.rendezvous.parameters import law, start_state
from smallsat.studies.rendezvous.simulation.closed_loop import Steps, simulate
from smallsat.studies.rendezvous.simulation.delta_v import READINGS, summed

# Numbers that are fitted, in the order of their bounds.
FITTED = list(Bounds.model_fields)
FITTED_CASES = (*CASE_TABLES, "no-set-point")
# Structural readings that the search chooses among, with the R-bar's side one a search.
CHOICES: dict[str, tuple[Any, ...]] = {
    "cone_angle": ("half", "full"),
    "first_switch": ("cone", "distance"),
    "plane_rule": ("shortest", "natural"),
    "set_point_time": ("start", "horizon"),
    "reference_moves": (True, False),
}
SIDES = ("above", "below")
TIME_LIMIT_S = 6000.0
NEAR = 0.03  # spread of the first sets around the configured one, in their bounds
WORST = 10.0  # largest residual of a cell, in its errors: a stall is no worse than a bad miss


def with_values(section: Cases, values: dict[str, float], readings: dict[str, Any]) -> Cases:
    """The section with other inferred values and readings."""
    inferred, chosen = section.inferred, dict(readings)
    if "first_switch" in chosen:
        chosen["switches"] = (chosen.pop("first_switch"), *inferred.readings.switches[1:])
    changed = inferred.with_(**values, readings=inferred.readings.with_(**chosen))
    return section.with_(inferred=changed)


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


def simulate_sets(sections: Sequence[Cases], cases: Sequence[str] = FITTED_CASES) -> pd.DataFrame:
    """Simulate cases with parameter sets: a row a set, case and phase.

    Columns: ``set`` (its place), ``case``, ``phase``, ``ended``, ``steps``, ``crossing`` (steps
    until the end condition, interpolated), ``time_s`` and a delta-v for each of `READINGS`.
    """
    laws = [
        law(section, case).with_(time_limit=TIME_LIMIT_S) for section in sections for case in cases
    ]
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
    kind = law.switches[phase]
    reached = float(np.linalg.norm(offset) if kind == DISTANCE else offset @ axis)
    excess = 0.0 if kind == CONE_ONLY else reached - law.switch_distances[phase]
    if phase == RENDEZVOUS:
        cone_faces(axis, np.tan(law.cone_angles[phase]), faces)
        outside = float(np.max(faces @ state[:3]))
        return outside if kind == CONE_ONLY else max(outside, excess)
    return excess


def residuals(section: Cases, flown: pd.DataFrame, ledger: Ledger) -> pd.DataFrame:
    """Residuals of every printed cell, in assumed errors: a row a set and cell, a column a reading.

    Columns: ``set``, ``cell``, ``printed``, then for each of `READINGS` computed (``computed <r>``)
    and residual (``residual <r>``).
    """
    settings = section.inference
    wanted = printed_steps(section, ledger)
    delta_v: Any = phase_cells(ledger).set_index(["case", "phase"])["delta_v_m_s"].to_dict()
    totals: Any = total_cells(ledger).set_index("case").to_dict("index")
    rows = []

    def add(
        place: int, cell: str, printed: float, computed: dict[str, float], error: float
    ) -> None:
        row: dict[str, Any] = {"set": place, "cell": cell, "printed": printed}
        for reading, value in computed.items():
            missed = WORST if np.isnan(value) else np.clip((value - printed) / error, -WORST, WORST)
            row |= {f"computed {reading}": value, f"residual {reading}": float(missed)}
        rows.append(row)

    for row in flown.to_dict("records"):
        key = (row["case"], row["phase"])
        if key not in wanted:
            continue
        # A crossing within the last printed step is that step.
        late = row["crossing"] - wanted[key]
        miss = np.nan if not row["ended"] else max(late, 0.0) + min(late + 1.0, 0.0)
        add(
            row["set"],
            f"{key[0]} {key[1]} steps",
            wanted[key],
            dict.fromkeys(READINGS, wanted[key] + miss),
            settings.step_error,
        )
        # The whole number is what is shown.
        rows[-1] |= {f"computed {r}": row["steps"] if row["ended"] else np.nan for r in READINGS}
        found = {r: row[r] if row["ended"] else np.nan for r in READINGS}
        printed = delta_v[key]
        add(row["set"], f"{key[0]} {key[1]} delta-v", printed, found, _error(settings, printed))
    groups: Any = flown.groupby(["set", "case"], sort=False)
    for (place, case), part in groups:
        if case in CASE_TABLES or case not in totals:
            continue
        docked = bool(part["ended"].all())
        printed = totals[case]
        minutes = (part["time_s"].sum() - 1.0) / MINUTE if docked else np.nan
        spread = settings.time_share * printed["time_min"]
        add(
            int(place),
            f"{case} time",
            printed["time_min"],
            dict.fromkeys(READINGS, minutes),
            spread,
        )
        found = {r: part[r].sum() if docked else np.nan for r in READINGS}
        add(
            int(place),
            f"{case} delta-v",
            printed["delta_v_m_s"],
            found,
            _error(settings, printed["delta_v_m_s"]),
        )
    return pd.DataFrame(rows)


def _error(settings: Inference, printed: float) -> float:
    return max(settings.delta_v_share * printed, settings.delta_v_error_m_s)


def misfits(section: Cases, flown: pd.DataFrame, ledger: Ledger) -> pd.DataFrame:
    """Sum of squared residuals by set (rows) and reading of delta-v (columns)."""
    table = residuals(section, flown, ledger)
    squares = {r: table[f"residual {r}"] ** 2 for r in READINGS}
    return pd.DataFrame(squares).groupby(table["set"]).sum()


def search(section: Cases, side: str, ledger: Ledger) -> pd.DataFrame:
    """Search all parameters and readings with the R-bar on one side of the target.

    Differential evolution from a spread of sets, the configured one among them, then a chain of
    differential-evolution Monte Carlo from the best ones, which explores what is acceptable. Both
    are seeded, and a generation is one batch of the compiled loop. Returns a row an evaluated set.
    """
    settings = section.inference
    low, high = np.array([settings.bounds[name] for name in FITTED], dtype=float).T
    random = np.random.default_rng([settings.seed, SIDES.index(side)])
    kept: list[pd.DataFrame] = []
    width = len(FITTED)

    def decoded(place: np.ndarray) -> tuple[dict[str, float], dict[str, Any]]:
        values = low + np.clip(place[:width], 0.0, 1.0) * (high - low)
        picks = (np.clip(place[width:], 0.0, 1.0) * 1.999999).astype(int)
        readings = {key: CHOICES[key][pick] for key, pick in zip(CHOICES, picks, strict=True)}
        return dict(zip(FITTED, values.tolist(), strict=True)), {"r_bar": side, **readings}

    def misfit(places: np.ndarray) -> np.ndarray:
        """Misfits (sets,) of a population, shape (parameters, sets) as the optimiser has it."""
        columns = np.atleast_2d(places.T)
        sets = [decoded(place) for place in columns]
        flown = simulate_sets([with_values(section, *one) for one in sets])
        found = misfits(section, flown, ledger)
        table = pd.DataFrame([values | readings for values, readings in sets])
        table["misfit"] = found.min(axis=1).to_numpy()
        table["delta_v"] = found.idxmin(axis=1).to_numpy()
        kept.append(table.assign(**{f"misfit {r}": found[r].to_numpy() for r in READINGS}))
        return table["misfit"].to_numpy()

    count = settings.population
    start = random.random((count, width + len(CHOICES)))
    configured = np.array([section.inferred[name] for name in FITTED])
    start[0, :width] = (configured - low) / (high - low)
    first = section.inferred.readings
    now = dict(first) | {"first_switch": first.switches[0]}
    start[0, width:] = [0.25 + 0.5 * CHOICES[key].index(now[key]) for key in CHOICES]
    # Half of the population around the configured set, half all over the bounds.
    near = count // 2
    start[1:near] = start[0] + NEAR * random.standard_normal((near - 1, start.shape[1]))
    start = np.clip(start, 0.0, 1.0)
    found = differential_evolution(
        misfit, [(0.0, 1.0)] * start.shape[1], init=start, maxiter=settings.generations,
        seed=random, polish=False, vectorized=True, updating="deferred", tol=0.0,
        mutation=(0.4, 0.9), recombination=0.8,
    )  # fmt: skip
    cells = 2 * len(printed_steps(section, ledger)) + 2
    _chain(
        misfit,
        found.population,
        found.population_energies,
        settings.chain,
        cells - width,
        random,
    )
    return pd.concat(kept, ignore_index=True).assign(side=side)


def _chain(
    misfit, population, energies, generations: int, freedom: int, random: np.random.Generator
) -> None:
    """Differential-evolution Monte Carlo (ter Braak 2006) with half the misfit as -log p."""
    walkers, values = population.copy(), energies.copy()
    count, width = walkers.shape
    scale = 2.38 / np.sqrt(2.0 * width)
    # The assumed errors are made as large as the best set needs them to be.
    temperature = max(1.0, values.min() / freedom)
    for _ in range(generations):
        pairs = np.array([random.choice(count, 2, replace=False) for _ in range(count)])
        proposed = walkers + scale * (walkers[pairs[:, 0]] - walkers[pairs[:, 1]])
        proposed = np.clip(proposed + 0.01 * random.standard_normal(walkers.shape), 0.0, 1.0)
        found = misfit(proposed.T)
        taken = np.log(random.random(count)) < 0.5 * (values - found) / temperature
        walkers[taken], values[taken] = proposed[taken], found[taken]
