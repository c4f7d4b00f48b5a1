"""Predicates of what the document says of its formulation and of what it costs to compute."""

import numpy as np

from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.evidence.claims import EIGENAXIS, OPTIMAL
from smallsat.studies.slew.evidence.observations import printed_end
from smallsat.studies.slew.methods.attitude_steps import CLOSED_FORM
from smallsat.studies.slew.methods.node_sweep import ALL, HALF

# "Several orders of magnitude": from two on.
ORDERS = 100.0
# Table 4 by the turn and the number of its nodes, and by the processor.
PROCESSORS = ("i7-2700k", "core2duo-t7700")


def gauss_and_radau_beat_lobatto(grounds: Grounds) -> Judgement:
    """On the problem of the cited comparison: errors of state and control on as many points."""
    table = grounds.rows("collocation.csv", converged=True)
    # A count that one of the schemes did not solve compares nothing.
    solved = table.groupby("points").filter(lambda rows: len(rows) == table["scheme"].nunique())
    if solved.empty:
        raise LookupError("no number of points that all three schemes solve")
    points = solved["points"].max()
    rows = solved[solved["points"] == points].set_index("scheme")[["state", "control", "costate"]]
    gains = rows.loc["Lobatto"] / rows.drop("Lobatto").max()
    return judged(
        bool((gains[["state", "control"]] >= ORDERS).all()),
        f"on {points} points of the problem of the cited comparison, whose solution is known, the "
        f"state of the Lobatto scheme is {gains['state']:.0e} times as far off as the worse of the "
        f"other two, its control {gains['control']:.0e} times. Its costate is off by "
        f"{rows.loc['Lobatto', 'costate']:.0e}, theirs by at most "
        f"{rows.drop('Lobatto')['costate'].max():.0e}",
    )


def transition_is_cheaper(grounds: Grounds[Configuration]) -> Judgement:
    """At the printed step no other method may be as accurate with as few operations."""
    step = grounds.section.onboard.step_s
    table = grounds.table("attitude-steps.csv")
    own = table[(table["method"] == CLOSED_FORM) & (table["step_s"] == step)]
    if own.empty:
        raise LookupError("no step of the closed form")
    others = table[table["method"] != CLOSED_FORM].merge(own, on="flight", suffixes=("", "_own"))
    as_good = others["error_deg"] <= others["error_deg_own"]
    at_step = others[as_good & (others["step_s"] == step)]
    beaten = at_step[at_step["operations"] <= at_step["operations_own"]]
    cheapest = others[others["step_s"] == step].groupby("method")["operations"].first()
    longer = others[as_good & (others["operations_per_s"] < others["operations_per_s_own"])]
    rest = "".join(
        f". On '{row['flight']}' {row['method']} with a step of {row['step_s']:g} s is as accurate "
        f"with {row['operations_per_s']:g} a second"
        for row in longer.to_dict("records")
    )
    return judged(
        beaten.empty,
        f"a step of the closed form takes {own['operations'].iloc[0]} operations, sine and cosine "
        f"as one each, against "
        f"{', '.join(f'{count} ({name})' for name, count in cheapest.items())}; with the printed "
        f"step the cheaper ones are less accurate{rest}",
    )


def transition_is_singular_at_rest(grounds: Grounds) -> Judgement:
    """Eq. 25 as it stands, without any rotation, must give no number."""
    rows = grounds.rows("attitude-steps.csv", method=CLOSED_FORM)
    return judged(
        not rows["at_rest"].any(),
        "Eq. 25 divides nil by nil there, and gives no number. The singularity can be removed: "
        "the limit is the identity, which the document assigns, and the series of the sine "
        "continues it",
    )


def euler_angles_diverge(grounds: Grounds) -> Judgement:
    """From the same starts fewer solves must converge with Euler angles than otherwise."""
    table = grounds.table("gradient-forms.csv")
    forms = {
        str(name): (int(rows["converged"].sum()), len(rows), int(rows["iterations"].sum()))
        for name, rows in table.groupby("form", sort=False)
    }
    texts = "; ".join(
        f"{name}: {done} of {all_} converge, in {steps} steps of the solver in all"
        for name, (done, all_, steps) in forms.items()
    )
    (quaternion, _, _), (angles, _, _) = forms["quaternion"], forms["Euler angles"]
    return judged(
        angles < quaternion,
        f"{texts}. By another solver, with exact derivatives, from our own starts: of the "
        f"document's own attempts it says nothing",
    )


def nodes_are_needed(grounds: Grounds[Configuration]) -> Judgement:
    """90 deg: the document's nodes must give a valid plan, and half of them none.

    A plan is valid if it converges and, flown in open loop, ends nearer to its target than the
    printed run does.
    """
    table = grounds.table("nodes.csv").set_index("share")
    roll, pitch = (
        grounds.ledger.value(f"{OPTIMAL}/final-{name}-angle/90-deg-torque-optimal").value
        for name in ("roll", "pitch")
    )
    short, _ = printed_end(grounds.ledger, "quarter")
    printed = float(np.sqrt(roll**2 + pitch**2 + short**2))
    valid = table["converged"] & (table["miss_deg"] <= printed)
    texts = ", ".join(
        f"{row['nodes']} {_way(bool(row['converged']))}, {row['miss_deg']:.2f} deg off"
        for row in table.to_dict("records")
    )
    return judged(
        bool(valid[ALL] and not valid[HALF]),
        f"points, and the end when flown in open loop: {texts}; the printed run is "
        f"{printed:.2f} deg off. With our solver more points buy accuracy between them, not "
        f"stability",
    )


def _way(converged: bool) -> str:
    return "converge" if converged else "do not converge"


def propagator_ignores_nodes(grounds: Grounds) -> Judgement:
    """The printed seconds of the propagator must be the same for both numbers of nodes."""
    seconds = {
        processor: [
            grounds.ledger.value(f"table-4/propagator-run-time/{turn}-{processor}").value
            for turn in ("90-deg", "180-deg")
        ]
        for processor in PROCESSORS
    }
    texts = "; ".join(f"{first:g} and {second:g} s" for first, second in seconds.values())
    return judged(
        all(first == second for first, second in seconds.values()),
        f"printed compared with printed, for the two numbers of nodes on each processor: {texts}. "
        f"That they grow with the duration follows from the fixed step of Table 1",
    )


def moderate_momentum(grounds: Grounds) -> Judgement:
    """180 deg: peaks about x and y between what the document calls minimal and significant."""
    more, minimal = (
        np.array(
            [
                grounds.ledger.value(
                    f"{OPTIMAL}/maximum-angular-momentum-usage/{turn}-torque-optimal/{axis}"
                ).value
                for axis in "xy"
            ]
        )
        for turn in ("180-deg", "90-deg")
    )
    name = f"{EIGENAXIS}/maximum-angular-momentum-usage/180-deg-eigenaxis/z"
    significant = grounds.ledger.value(name).value
    x, y = more
    return judged(
        bool(minimal.max() < more.min() and more.max() < significant),
        f"printed compared with printed: {x:g} and {y:g} %, between the {minimal.max():g} % that "
        f"it calls minimal in the smaller turn and the {significant:g} % about z that it calls "
        f"significant by the eigenaxis law. By its own words moderate; about y it is "
        f"{100.0 * y / significant:.0f} % of the latter",
    )
