"""What the searches found, put together: misses, profiles, readings, sets worth keeping."""

from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from smallsat.config import lookup
from smallsat.dynamics.units import MINUTE
from smallsat.evidence.ledger import Ledger
from smallsat.studies.rendezvous.configuration import Cases, LinearProgram
from smallsat.studies.rendezvous.evidence.case_tables import total_cells
from smallsat.studies.rendezvous.inference.axes import axes
from smallsat.studies.rendezvous.inference.misfit import KINDS, residuals, simulate_sets
from smallsat.studies.rendezvous.inference.parameter_set import FITTED, OPTIONS
from smallsat.studies.rendezvous.simulation.delta_v import READINGS

# Bins over a parameter's bounds, of the lower envelope of the misfit.
BINS = 12
# Shares of its bounds that an identified parameter's acceptable values fill at most.
IDENTIFIED, LOOSE = 0.25, 0.6
COUPLED = 0.7
# How much of a part of the misfit is allowed, where the rest is looked at.
ALLOWED = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0)
LP_SET_POINTS = ("none", "as the quadratic program's")
LP_CONTROL = (1e2, 1e3, 1e4)
LP_TERMINAL = (1.0, 1e2, 1e4, 1e5)


def configured_residuals(section: Cases, starts: np.ndarray, ledger: Ledger) -> pd.DataFrame:
    """What the configured set misses: a row a printed cell, phase, preference and axis."""
    reading = section.inferred.readings.delta_v
    table = pd.concat(
        [
            residuals([section], simulate_sets([section]), ledger),
            axes(section, starts, ledger),
        ],
        ignore_index=True,
    )
    return pd.DataFrame(
        {
            "kind": table["kind"],
            "cell": table["cell"],
            "printed": table["printed"],
            "computed": table[f"computed {reading}"],
            "residual": table[f"residual {reading}"],
        }
    )


def constraints(section: Cases, entries: list[dict[str, str]]) -> pd.DataFrame:
    """What the document says of what it does not print, with our value: a row an entry.

    ``entries`` are those of ``constraints.yaml``.
    """
    return pd.DataFrame(
        {
            "locator": entry["locator"],
            "says": entry["says"],
            "narrows": entry["narrows"],
            "strength": entry["strength"],
            "ours": str(lookup(section, entry["key"])) if "key" in entry else "",
        }
        for entry in entries
    )


def acceptable(section: Cases, evaluated: pd.DataFrame) -> pd.DataFrame:
    """Evaluated sets whose misfit is within the configured factor of the best one, best first."""
    limit = section.inference.acceptable * evaluated["misfit"].min()
    chosen = evaluated[evaluated["misfit"] <= limit].drop_duplicates([*FITTED, *OPTIONS])
    return chosen.sort_values("misfit", kind="stable", ignore_index=True)


def identified(section: Cases, evaluated: pd.DataFrame) -> pd.DataFrame:
    """For each parameter: bounds, configured value, acceptable range, and what that makes of it.

    ``share`` is the part of the bounds that acceptable values span; ``with`` names the parameter
    that it goes together with most, and ``correlation`` how closely (Spearman's).
    """
    good = acceptable(section, evaluated)
    ranks = (
        good[FITTED].rank().corr()
        if len(good) > 2
        else pd.DataFrame(np.eye(len(FITTED)), FITTED, FITTED)
    )
    rows = []
    for name in FITTED:
        low, high = section.inference.bounds[name]
        least, most = good[name].min(), good[name].max()
        share = (most - least) / (high - low)
        others = ranks[name].drop(name).abs().fillna(0.0)
        partner = str(others.idxmax())
        correlation = float(others.max())
        if share <= IDENTIFIED:
            verdict = "identified"
        elif correlation >= COUPLED:
            verdict = f"coupled to {partner}"
        else:
            verdict = "loosely identified" if share <= LOOSE else "free"
        rows.append(
            {
                "parameter": name,
                "from": low,
                "to": high,
                "inferred": section.inferred[name],
                "acceptable_from": least,
                "acceptable_to": most,
                "share": share,
                "with": partner,
                "correlation": correlation,
                "verdict": verdict,
            }
        )
    return pd.DataFrame(rows)


def profiles(section: Cases, evaluated: pd.DataFrame) -> pd.DataFrame:
    """Least misfit found in each of `BINS` parts of each parameter's bounds."""
    rows = []
    for name in FITTED:
        low, high = section.inference.bounds[name]
        place = np.clip(((evaluated[name] - low) / (high - low) * BINS).astype(int), 0, BINS - 1)
        least = evaluated.groupby(place)["misfit"].min()
        for part in range(BINS):
            rows.append(
                {
                    "parameter": name,
                    "value": low + (part + 0.5) * (high - low) / BINS,
                    "misfit": float(least.get(part, np.nan)),
                    "sets": int((place == part).sum()),
                }
            )
    return pd.DataFrame(rows)


def readings(evaluated: pd.DataFrame) -> pd.DataFrame:
    """Least misfit with each option of each reading, whatever the others are, and its parts."""
    rows: list[dict[str, Any]] = []

    def add(question: str, option: str, own: pd.DataFrame, misfit: pd.Series) -> None:
        best: Any = own.to_dict("records")[int(misfit.to_numpy().argmin())]
        rows.append(
            {
                "question": question,
                "reading": option,
                "misfit": float(misfit.min()),
                **{kind: best[kind] for kind in KINDS},
                "sets": len(own),
            }
        )

    for reading in READINGS:
        add("delta_v", reading, evaluated, evaluated[f"misfit {reading}"] + evaluated["axes"])
    for question, options in OPTIONS.items():
        for option in options:
            own = evaluated[evaluated[question] == str(option)]
            add(question, str(option), own, own["misfit"])
    return pd.DataFrame(rows)


def trade_offs(evaluated: pd.DataFrame) -> pd.DataFrame:
    """What the rest of the misfit has to be where feasibility, or the axes, are nearly held.

    A row a part of the misfit and a bound of it: the best set within the bound, and how many are.
    """
    rows: list[dict[str, Any]] = []
    for kind in ("feasibility", "axes"):
        for most in ALLOWED:
            own = evaluated[evaluated[kind] <= most]
            best: Any = own.nsmallest(1, "misfit").to_dict("records")
            values = best[0] if best else {}
            rows.append(
                {"held": kind, "at_most": most, "sets": len(own), "misfit": values.get("misfit")}
                | {one: values.get(one) for one in KINDS}
            )
    return pd.DataFrame(rows)


def kept(section: Cases, evaluated: pd.DataFrame) -> pd.DataFrame:
    """Sets worth keeping: the ensemble first, then the best set of each option.

    The ensemble spans the readings: the best set, then in turn the best acceptable set of each
    option that is not in it yet, then acceptable sets spread over their misfits, up to the
    configured number. ``acceptable`` says which sets are.
    """
    good = acceptable(section, evaluated)
    chosen = [0]
    for question, options in OPTIONS.items():
        for option in options:
            own = good.index[good[question] == str(option)]
            if len(own) and not set(own) & set(chosen):
                chosen.append(int(own[0]))
    spread = np.unique(np.linspace(0, len(good) - 1, section.inference.ensemble.sets).astype(int))
    chosen += [int(place) for place in spread if place not in chosen]
    ensemble = good.loc[chosen[: section.inference.ensemble.sets]]
    best = [
        evaluated[evaluated[question] == str(option)].nsmallest(1, "misfit")
        for question, options in OPTIONS.items()
        for option in options
    ]
    table = pd.concat([ensemble, *best]).drop_duplicates([*FITTED, *OPTIONS])
    limit = section.inference.acceptable * evaluated["misfit"].min()
    table["acceptable"] = table["misfit"] <= limit
    columns = [*FITTED, *OPTIONS, "delta_v", "misfit", *KINDS, "acceptable"]
    return table[columns].reset_index(drop=True)


def linear_programs(section: Cases, ledger: Ledger) -> pd.DataFrame:
    """The LP case with many weights, with the set point and without: one row a variant."""
    sections: list[Cases] = []
    rows: list[dict[str, Any]] = []
    for point, control, terminal in product(LP_SET_POINTS, LP_CONTROL, LP_TERMINAL):
        lp = LinearProgram(
            set_point=point == LP_SET_POINTS[1],
            state_weight=1.0,
            control_weight=control,
            terminal_weight=terminal,
        )
        sections.append(section.with_(inferred=section.inferred.with_(lp=lp)))
        rows.append({"set_point": point, "control_weight": control, "terminal_weight": terminal})
    flown = simulate_sets(sections, ("lp",), patient=True)
    reading = section.inferred.readings.delta_v
    printed: Any = total_cells(ledger).set_index("case").loc["lp"]
    groups: Any = flown.groupby("set")
    for place, part in groups:
        docked = bool(part["ended"].all())
        minutes = (part["time_s"].sum() - 1.0) / MINUTE
        rows[int(place)] |= {
            "docked": docked,
            "time_min": minutes if docked else np.nan,
            "delta_v_m_s": part[reading].sum() if docked else np.nan,
            "time_miss_min": minutes - printed["time_min"] if docked else np.nan,
            "delta_v_miss_m_s": part[reading].sum() - printed["delta_v_m_s"] if docked else np.nan,
        }
    return pd.DataFrame(rows)
