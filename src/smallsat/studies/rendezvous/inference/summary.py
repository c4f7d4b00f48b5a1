"""What the searches found, put together: residuals, profiles, readings, acceptable sets."""

from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from smallsat.dynamics.units import MINUTE
from smallsat.evidence.ledger import Ledger
from smallsat.studies.rendezvous.configuration import Cases, LinearProgram
from smallsat.studies.rendezvous.evidence.case_tables import total_cells
from smallsat.studies.rendezvous.inference.search import (
    CHOICES,
    FITTED,
    SIDES,
    residuals,
    simulate_sets,
    with_values,
)
from smallsat.studies.rendezvous.parameters import CASES
from smallsat.studies.rendezvous.simulation.delta_v import READINGS

# Bins over a parameter's bounds, of the lower envelope of the misfit.
BINS = 12
# Readings as the tables call them: the searches' choices, the side, and the sum of delta-v.
STRUCTURES = ("side", "delta_v", *CHOICES)
# Shares of its bounds that an identified parameter's acceptable values fill at most.
IDENTIFIED, LOOSE = 0.25, 0.6
COUPLED = 0.7
LP_SET_POINTS = (0.0, 0.5, 1.0)
LP_CONTROL = (1e2, 1e3, 1e4)
LP_TERMINAL = (1.0, 1e2, 1e4, 1e5)


def configured_residuals(section: Cases, ledger: Ledger) -> pd.DataFrame:
    """Residuals of every fitted cell with the configured set, one row a cell."""
    reading = section.inferred.readings.delta_v
    table = residuals(section, simulate_sets([section]), ledger)
    return pd.DataFrame(
        {
            "cell": table["cell"],
            "printed": table["printed"],
            "computed": table[f"computed {reading}"],
            "residual": table[f"residual {reading}"],
        }
    )


def acceptable(section: Cases, evaluated: pd.DataFrame) -> pd.DataFrame:
    """Evaluated sets whose misfit is within the configured factor of the best one, best first."""
    limit = section.inference.acceptable * evaluated["misfit"].min()
    chosen = evaluated[evaluated["misfit"] <= limit].drop_duplicates()
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
    """Least misfit with each structural reading, whatever the others are."""
    rows: list[dict[str, Any]] = []
    for reading in READINGS:
        rows.append(
            {
                "question": "delta_v",
                "reading": reading,
                "misfit": evaluated[f"misfit {reading}"].min(),
                "sets": len(evaluated),
            }
        )
    for question, options in {"side": SIDES, **CHOICES}.items():
        for option in options:
            own = evaluated[evaluated[question] == option]
            rows.append(
                {
                    "question": question,
                    "reading": str(option),
                    "misfit": own["misfit"].min(),
                    "sets": len(own),
                }
            )
    return pd.DataFrame(rows)


def ensemble(section: Cases, evaluated: pd.DataFrame) -> pd.DataFrame:
    """All five cases with acceptable sets spread over their misfits; a row a set, case, phase.

    Delta-v is summed by each set's own best reading, in column ``delta_v_m_s``.
    """
    good = acceptable(section, evaluated)
    count = min(section.inference.flown, len(good))
    chosen = good.iloc[np.unique(np.linspace(0, len(good) - 1, count).astype(int))]
    sections = []
    for row in chosen.to_dict("records"):
        structure = {"r_bar": row["side"], **{key: row[key] for key in CHOICES}}
        sections.append(with_values(section, {name: row[name] for name in FITTED}, structure))
    flown = simulate_sets(sections, CASES)
    best = chosen["delta_v"].to_list()
    flown["delta_v_m_s"] = [row[best[row["set"]]] for row in flown.to_dict("records")]
    flown["misfit"] = flown["set"].map(dict(enumerate(chosen["misfit"])))
    return flown[["set", "misfit", "case", "phase", "ended", "steps", "time_s", "delta_v_m_s"]]


def linear_programs(section: Cases, ledger: Ledger) -> pd.DataFrame:
    """The LP case with many weights, with and without set point: one row a variant."""
    sections: list[Cases] = []
    rows: list[dict[str, Any]] = []
    for point, control, terminal in product(LP_SET_POINTS, LP_CONTROL, LP_TERMINAL):
        lp = LinearProgram(
            set_point=point, state_weight=1.0, control_weight=control, terminal_weight=terminal
        )
        sections.append(section.with_(inferred=section.inferred.with_(lp=lp)))
        rows.append({"set_point": point, "control_weight": control, "terminal_weight": terminal})
    flown = simulate_sets(sections, ("lp",))
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
