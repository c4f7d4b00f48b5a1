"""Predicates of which model the document's 180 deg run was flown by."""

import pandas as pd

from smallsat.evidence.claims import Judgement, Outcome
from smallsat.evidence.grounds import Grounds
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.evidence.claims import require_turn_about_z
from smallsat.studies.slew.evidence.torque_claims import MATERIAL, gyroscopic_share
from smallsat.studies.slew.methods.models import LEFT, PEAKS, PRINTED
from smallsat.studies.slew.methods.plan_names import MODELS
from smallsat.studies.slew.parameters import Parameters

# "As the spacecraft nears the endpoint": this last share of the time.
NEAR_THE_END = 0.1


def printed_run_is_eulers(grounds: Grounds[Configuration]) -> Judgement:
    """Our inference: of all plans the nearest to the print are those of Euler's equation alone.

    A model is told from the other where its nearest plan is off by less than half as much, whatever
    the weight of the rate in the miss of the end, and whichever momentum is printed.
    """
    require_turn_about_z(Parameters.from_section(grounds.section), "half")
    nearest = []
    for model in MODELS:
        rows = grounds.rows("models.csv", model=model)
        nearest.append(rows.sort_values("off_printed_pct").iloc[0])
    printed = grounds.rows("models.csv", model=PRINTED).iloc[0]
    texts = "; ".join(
        f"{_momenta(row)} by {row['model']}, read as {row['reading']}, with the rate weighted by "
        f"{row['rate_weight']:g} (off by {row['off_printed_pct']:.1f}; "
        f"pitch left {row['pitch_deg']:.1f} deg)"
        for row in nearest
    )
    wheels, euler = (row["off_printed_pct"] for row in nearest)
    outcome: Outcome = "undecided"
    if 2.0 * min(euler, wheels) < max(euler, wheels):
        outcome = "holds" if euler < wheels else "fails"
    return Judgement(
        outcome,
        f"printed are peaks and momenta left of {_momenta(printed)}, and {printed['pitch_deg']:g} "
        f"deg of pitch; of the plans that miss their end least the nearest have {texts}. An "
        f"inference: the printed iterate is unknown, and the weights were chosen after an "
        f"exploration",
    )


def _momenta(row: pd.Series) -> str:
    peaks, left = (", ".join(f"{row[name]:.3g}" for name in names) for names in (PEAKS, LEFT))
    return f"{peaks} and {left} %"


def gyroscopic_torques_deflect_the_end(grounds: Grounds[Configuration]) -> Judgement:
    """180 deg: gyroscopic torque near the end, in shares of a wheel's torque, by both models."""
    parameters = Parameters.from_section(grounds.section)
    shares = {}
    for model, carried in MODELS.items():
        flown = grounds.rows("models-flights.parquet", flight=model)
        late = flown[flown["time_s"] >= (1.0 - NEAR_THE_END) * parameters.duration]
        shares[model] = gyroscopic_share(late, parameters, carried=carried)
    outcomes = {share >= MATERIAL for share in shares.values()}
    outcome: Outcome = "undecided"
    if len(outcomes) == 1:
        outcome = "holds" if outcomes.pop() else "fails"
    found = ", ".join(f"{100 * share:.2g} % by {model}" for model, share in shares.items())
    return Judgement(
        outcome,
        f"in the last {100 * NEAR_THE_END:g} % of the time the gyroscopic torque of our plans is "
        f"at most, in shares of a wheel's torque: {found}",
    )
