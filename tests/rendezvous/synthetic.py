"""Tables of made-up manoeuvres with known effects, for claims and figures."""

import numpy as np
import pandas as pd

from smallsat.studies.rendezvous.monte_carlo.cases import PHASES, sweep_case
from smallsat.studies.rendezvous.monte_carlo.tables import SCHEMA, column, empty_rows


def states(count: int, seed: int = 1) -> pd.DataFrame:
    """Initial states around the target."""
    random = np.random.default_rng(seed)
    distance = random.uniform(150.0, 2500.0, count)
    angle = random.uniform(0.0, 2.0 * np.pi, count)
    x, y = distance * np.cos(angle), distance * np.sin(angle)
    quadrant = np.select([(x > 0) & (y > 0), (x <= 0) & (y > 0), (x <= 0) & (y <= 0)], [1, 2, 3], 4)
    return pd.DataFrame(
        {"sample": np.arange(count, dtype=np.int32), "x_m": x, "y_m": y, "z_m": 0.0,
         "vx_m_s": 0.0, "vy_m_s": 0.0, "vz_m_s": 0.0,
         "distance_m": distance, "quadrant": quadrant.astype(np.int8)}
    )  # fmt: skip


def manoeuvres(case: str, count: int, run: int = 0, **columns) -> pd.DataFrame:
    """Rows of one case; columns not given are those of a phase not flown."""
    rows = empty_rows(count)
    rows["case"][:] = case
    rows["sample"] = np.arange(count, dtype=np.int32)
    rows["run"][:] = run
    rows["completed"][:] = True
    rows["end_phase"][:] = 3
    for name, values in columns.items():
        rows[name][:] = values
    return pd.DataFrame(rows)[SCHEMA.names]


def sweep(phase: str, horizons, sample_times, count: int, delta_v, time, seed=2) -> pd.DataFrame:
    """A sweep with given laws ``delta_v(n, t)`` in m/s and ``time(n, t)`` in s, times a scatter."""
    random = np.random.default_rng(seed)
    own = np.exp(0.3 * random.standard_normal(count))
    parts = []
    for n in horizons:
        for t in sample_times:
            noise = np.exp(0.02 * random.standard_normal((2, count)))
            duration = np.ceil(time(n, t) * own * noise[1] / t) * t
            parts.append(
                manoeuvres(
                    sweep_case(n, t),
                    count,
                    **{
                        column(phase, "delta_v_m_s"): delta_v(n, t) * own * noise[0],
                        column(phase, "time_s"): duration,
                        column(phase, "steps"): (duration / t).astype(np.int32),
                    },
                )
            )
    return pd.concat(parts, ignore_index=True)


def domain(given: pd.DataFrame, case: str = "baseline") -> pd.DataFrame:
    """Manoeuvres that cost more from afar and from behind."""
    count = len(given)
    random = np.random.default_rng(3)
    behind = given["quadrant"].isin([3, 4]).to_numpy()
    away = given["distance_m"].to_numpy() / 1e3
    columns = {}
    for phase, scale in zip(PHASES, (8.0, 2.5, 0.2), strict=True):
        noise = np.exp(0.2 * random.standard_normal(count))
        columns[column(phase, "delta_v_m_s")] = scale * (0.5 + 0.4 * away + 0.2 * behind) * noise
        columns[column(phase, "time_s")] = 120.0 * scale * (1.0 + away + behind) * noise
        columns[column(phase, "steps")] = 10
    return manoeuvres(case, count, **columns)
