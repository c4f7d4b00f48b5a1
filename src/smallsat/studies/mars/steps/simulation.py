"""The document's runs, the Mars day, and what is computed for every published value."""

import numpy as np
import pandas as pd

from smallsat.evidence.not_converged import NotConverged, not_converged_table
from smallsat.evidence.observation import observations_table
from smallsat.step import Step, Tables
from smallsat.studies.mars.configuration import Configuration
from smallsat.studies.mars.evidence.observations import observations
from smallsat.studies.mars.methods.simulation import as_table, day_run, document_runs, finite
from smallsat.studies.mars.model.modes import shares, timeline
from smallsat.studies.mars.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Simulate every pointing mode, the mission and the day."""
    section, parameters = step.section, Parameters.from_section(step.section)
    runs = document_runs(section, parameters)
    day_record = day_run(section, parameters)
    unsolved = [
        _overflow(name, record, section.step_s)
        for name, record in [*runs.items(), ("day", day_record)]
        if not finite(record)
    ]
    trajectories = [as_table(record).assign(run=name) for name, record in runs.items()]
    day = as_table(day_record)
    intervals = timeline(day["time_s"].to_numpy(), day["mode"].to_numpy())
    return {
        "trajectories.parquet": pd.concat(trajectories, ignore_index=True),
        "day.parquet": day[["time_s", "sigma_1", "sigma_2", "sigma_3", "mode"]],
        "modes.csv": intervals,
        "mode-shares.csv": shares(intervals),
        # From the records with all their digits, for results that are printed as exact fractions.
        "observations.csv": observations_table(observations(section, parameters, runs)),
        "simulation-not-converged.csv": not_converged_table(unsolved),
    }


def _overflow(name: str, record: np.ndarray, step: float) -> NotConverged:
    """The run as a case without a solution; what it recorded before is worth nothing."""
    time = record[np.flatnonzero(~np.isfinite(record[:, 1:7]).all(axis=1))[0], 0]
    record[:, 1:16] = np.nan
    return NotConverged(
        case=f"the run '{name}'",
        status=f"no number from {time:g} s on: the motion is too fast for the step, or the "
        "reference frame is undefined there",
        tried=f"classical Runge-Kutta steps of {step:g} s, the torque held over a step",
    )
