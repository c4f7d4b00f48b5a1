"""Predicates of what the document says to cost torque, or to save it."""

import numpy as np
import pandas as pd

from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.evidence.claims import (
    EIGENAXIS,
    OPTIMAL,
    require_turn_about_z,
)
from smallsat.studies.slew.methods.bound import largest_disturbance
from smallsat.studies.slew.methods.flights import controller
from smallsat.studies.slew.methods.one_axis import bang_coast_bang, body_axis, eigenaxis_time
from smallsat.studies.slew.model.simulation import plant, run
from smallsat.studies.slew.parameters import Parameters

# A saving is one from a hundredth on, and a significant one from a tenth on.
MATERIAL, SIGNIFICANT = 0.01, 0.1
TORQUE = [f"u_{axis}" for axis in "xyz"]


def _used(flown: pd.DataFrame) -> float:
    """Integral of the torque's magnitude over a flight, N m s."""
    return float(np.trapezoid(np.linalg.norm(flown[TORQUE], axis=1), flown["time_s"]))


def eigenaxis_fights_environment(grounds: Grounds[Configuration]) -> Judgement:
    """The eigenaxis law must use more torque with gravity gradient and drag than without."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    calm = plant(parameters, gradient=False, drag=0.0)
    more = {}
    for case, name in parameters.names.items():
        command = controller(section.controller, parameters, case)
        alone = run(parameters, calm, command, parameters.duration, section.numerics.step_s)
        flown = grounds.rows("flights.parquet", flight=f"eigenaxis {case}")
        more[name] = _used(flown) / _used(alone) - 1.0
    texts = ", ".join(f"{100 * share:+.1g} % in the turn of {name}" for name, share in more.items())
    return judged(
        all(share > 0.0 for share in more.values()),
        f"gravity gradient and drag change the torque that the law uses by {texts}",
    )


def environment_saves_torque(grounds: Grounds[Configuration]) -> Judgement:
    """90 deg: plans that know the gravity gradient, and that have none, are compared."""
    parameters = Parameters.from_section(grounds.section)
    turn = parameters.names["quarter"]
    with_it, without = (
        float(
            grounds.rows("plans.csv", plan=f"{turn}{part}, segments", held_converged=True)[
                "held_cost_N_m_s"
            ].iloc[0]
        )
        for part in ("", ", no gravity gradient")
    )
    saving = 1.0 - with_it / without
    impulse = largest_disturbance(parameters, parameters.duration)
    return judged(
        saving >= MATERIAL,
        f"our plan of least torque with the gravity gradient, the one outer torque that the "
        f"document's guidance knows, costs {100 * saving:.2f} % less than the one without. At "
        f"the most favourable attitude all the time the gradient gives {1e3 * impulse:.3f} mN m s, "
        f"{100 * impulse / without:.1f} % of the cost",
    ).remarked(_by_either_model(grounds, "saved_by_gradient_pct"))


def _by_either_model(grounds: Grounds[Configuration], column: str) -> str:
    """What is saved of the larger turn in the shortest time that is planned by both models."""
    table = grounds.table("savings.csv").dropna(subset=[column])
    if table.empty:
        raise LookupError("no time in which the turn about the axis alone is possible")
    rows = table[table["duration_s"] == table["duration_s"].min()]
    found = ", ".join(f"{row[column]:.2g} % ({row['model']})" for row in rows.to_dict("records"))
    name = Parameters.from_section(grounds.section).names["half"]
    return f"in the turn of {name} in {rows['duration_s'].iloc[0]:g} s this saves {found}"


def path_saves_torque(grounds: Grounds[Configuration]) -> Judgement:
    """180 deg: plans in longer times are compared with the cheapest turn about the axis alone."""
    parameters = Parameters.from_section(grounds.section)
    axis, moment = body_axis(parameters, "half")
    angle = np.radians(parameters.angle_deg("half"))
    alone = eigenaxis_time(angle, moment, parameters.torque, parameters.momentum)
    plans = grounds.rows("trade-off.csv", converged=True, held_converged=True)
    plans = plans[plans["duration_s"] > alone]
    if plans.empty:
        raise LookupError("no plan in a time that the turn about the axis alone could take")
    row = plans.sort_values("duration_s").iloc[0]
    cost, _ = bang_coast_bang(angle, moment, parameters.torque, row["duration_s"])
    saving = 1.0 - row["held_cost_N_m_s"] / cost
    motion = grounds.rows("trade-off-plans.parquet", plan=row["plan"])
    share = gyroscopic_share(motion, parameters, carried=True)
    return judged(
        saving >= MATERIAL,
        f"in {row['duration_s']:g} s a plan off the eigenaxis costs {100 * saving:.1f} % less than "
        f"full torque, coast, full torque about {axis} alone, which takes {alone:.1f} s at the "
        f"least. In this model, where the wheels carry the momentum, the gyroscopic torque stays "
        f"below {100 * share:.2g} % of a wheel's limit: what saves is the path",
    ).remarked(_by_either_model(grounds, "saved_off_axis_pct"))


def gyroscopic_share(motion: pd.DataFrame, parameters: Parameters, *, carried: bool) -> float:
    """Largest component of the gyroscopic torque of a motion, in shares of a wheel's torque."""
    rates, given = (motion[[f"{name}_{a}" for a in "xyz"]].to_numpy() for name in ("omega", "h"))
    momentum = rates @ parameters.inertia - carried * given
    return float(np.abs(np.cross(rates, momentum)).max() / parameters.torque)


def z_torque_significantly_less(grounds: Grounds[Configuration]) -> Judgement:
    """180 deg: torque about z of our plans, and what the printed peak takes, against the law's."""
    parameters = Parameters.from_section(grounds.section)
    require_turn_about_z(parameters, "half")
    where = f"{OPTIMAL}/{{}}-angular-momentum-usage/180-deg-torque-optimal/z"
    peak, left = (grounds.ledger.value(where.format(name)).value for name in ("maximum", "final"))
    # The wheel takes up the peak and gives back all but what is left.
    least = (2.0 * peak - left) / 100.0 * parameters.momentum
    law = _about_z(grounds.rows("flights.parquet", flight="eigenaxis half"))
    plans = grounds.rows("models-flights.parquet").groupby(["flight", "rate_weight"])
    ours = min(_about_z(flown) for _, flown in plans)
    return judged(
        1.0 - min(least, ours) / law >= SIGNIFICANT,
        f"the eigenaxis law uses {1e3 * law:.2f} mN m s about z, our plans of either model "
        f"{1e3 * ours:.2f} at the least. To reach the printed peak and come back to what is left "
        f"takes {1e3 * least:.2f} at the least, {100 * (1.0 - least / law):.0f} % less than the "
        f"law, if what is printed is what the wheel's torque adds up to",
    )


def _about_z(flown: pd.DataFrame) -> float:
    """Integral of the torque's size about z over a flight, N m s."""
    return float(np.trapezoid(flown["u_z"].abs(), flown["time_s"]))


def better_in_both_respects(grounds: Grounds) -> Judgement:
    """180 deg: yaw errors, largest peaks and momenta left are compared as printed."""
    ledger = grounds.ledger
    yaw = ledger.value(f"{OPTIMAL}/yaw-pointing-error/180-deg-torque-optimal").value
    law_yaw = ledger.value(f"{EIGENAXIS}/yaw-undershoot/180-deg-eigenaxis").value
    used = {
        name: np.array(
            ledger.values(f"{OPTIMAL}/{name}-angular-momentum-usage/180-deg-torque-optimal"), float
        )
        for name in ("maximum", "final")
    }
    law = {
        name: ledger.value(f"{EIGENAXIS}/{name}-angular-momentum-usage/180-deg-eigenaxis/z").value
        for name in used
    }
    x, y, z = used["maximum"]
    return judged(
        yaw < law_yaw and all(used[name].max() < law[name] for name in used),
        f"printed compared with printed: yaw error {yaw:g} against {law_yaw:g} deg, largest peak "
        f"{z:g} against {law['maximum']:g} %, left at most {used['final'].max():g} against "
        f"{law['final']:g} %. The wheels about x and y, at rest under the eigenaxis law, reach "
        f"{x:g} and {y:g} %, and neither run reaches its target",
    )
