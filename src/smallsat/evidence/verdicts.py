"""One verdict for each published number, by rules that are fixed before the run they judge."""

from collections.abc import Mapping, Sequence
from math import isnan, nan
from typing import Any

import pandas as pd

from smallsat.config import Config
from smallsat.errors import InputError
from smallsat.evidence.bindings import agrees, binding_name, bound_value
from smallsat.evidence.patterns import match_entries
from smallsat.evidence.printed import LOST, Printed, parse_printed

VERDICTS = (
    "reproduced",
    "consistent",
    "surpassed",
    "erratum",
    "unreproducible",
    "context",
    "mismatch",
)
PENDING = "pending"
VERDICT_COLUMNS = (
    "id",
    "document",
    "locator",
    "quantity",
    "case",
    "component",
    "printed",
    "computed",
    "unit",
    "difference",
    "tolerance",
    "verdict",
    "reason",
)
TEXT_COLUMNS = ("case", "component", "printed", "unit")
RULE_KINDS = (
    "tolerance",
    "truncated",
    "objective",
    "interval",
    "unreproducible",
    "context",
    "pending",
)

Row = Mapping[str, str]
Entry = dict[str, Any]


def judge(
    rows: Sequence[Row],
    observations: pd.DataFrame,
    rules: Sequence[Entry],
    bindings: Sequence[Entry],
    errata: Sequence[Entry],
    proofs: pd.DataFrame,
    config: Config,
) -> pd.DataFrame:
    """Judge every row of one document.

    Parameters
    ----------
    rows
        Rows of the ledger.
    observations
        Table of `smallsat.evidence.observation.Observation`.
    rules, bindings, errata
        Entries of ``rules.yaml``, ``bindings.yaml`` and ``errata.yaml`` for this document.
    proofs
        What the proofs of the errata found (`smallsat.evidence.errata.prove_errata`).
    config
        The configuration, at least its section for this study, which the bindings look into.

    Returns
    -------
    DataFrame
        One row a published number, with the columns `VERDICT_COLUMNS`.
    """
    ids = [row["id"] for row in rows]
    unknown = sorted(set(observations["id"]) - set(ids))
    if unknown:
        raise InputError(f"observation '{unknown[0]}': no such id in values.csv; correct the study")
    for rule in rules:
        if sum(kind in rule for kind in RULE_KINDS) != 1 or "reason" not in rule:
            raise InputError(
                f"rules.yaml: the rule for '{rule['ids'][0]}' needs a reason and one of "
                f"{', '.join(RULE_KINDS)}"
            )
    rule_of = match_entries(rules, ids, "rules.yaml")
    binding_of = match_entries(bindings, ids, "bindings.yaml")
    erratum_of = match_entries([e for e in errata if e.get("ids")], ids, "errata.yaml")
    proof_of = {proof["key"]: proof for proof in _records(proofs)}
    computed_of = {str(key): _records(group) for key, group in observations.groupby("id")}

    judged = []
    for row in rows:
        identifier = row["id"]
        erratum = erratum_of.get(identifier)
        proof = proof_of[erratum["key"]] if erratum else None
        computed = computed_of.get(identifier, [])
        rule = rule_of.get(identifier, {})
        if "pending" in rule:
            outcome = _judge_pending(identifier, computed, rule)
        elif row["kind"] == "input":
            outcome = _judge_input(row, binding_of.get(identifier), proof, config)
        elif row["kind"] == "timing":
            outcome = _judge_timing(row, computed, proof)
        else:
            outcome = _judge_result(row, computed, rule, proof)
        judged.append({name: row.get(name, "") for name in VERDICT_COLUMNS} | outcome)
    return pd.DataFrame(judged, columns=list(VERDICT_COLUMNS))


def _records(table: pd.DataFrame) -> list[dict[str, Any]]:
    return [{str(name): value for name, value in row.items()} for row in table.to_dict("records")]


def _outcome(
    verdict: str,
    reason: str,
    computed: float = nan,
    printed: Printed | None = None,
    tolerance: float = nan,
) -> dict[str, Any]:
    return {
        "verdict": verdict,
        "reason": reason,
        "computed": computed,
        "difference": computed - printed.value if printed else nan,
        "tolerance": tolerance,
    }


def _erratum(proof: Mapping[str, Any], computed: float, printed: Printed | None) -> dict[str, Any]:
    if not proof["holds"]:
        reason = f"listed as erratum '{proof['key']}', but its proof does not hold"
        return _outcome("mismatch", reason, computed, printed)
    return _outcome("erratum", f"{proof['key']}: {proof['statement']}", computed, printed)


def _judge_pending(
    identifier: str, computed: Sequence[Mapping[str, Any]], rule: Mapping[str, Any]
) -> dict[str, Any]:
    if computed:
        # What is computed must be judged: a pending row cannot hide a wrong value.
        reason = "listed as pending, but computed: remove it from the pending rows of rules.yaml"
        return _outcome("mismatch", reason, computed[-1]["computed"])
    return _outcome(PENDING, f"{rule['pending']}: {rule['reason']}")


def _judge_input(
    row: Row, binding: Entry | None, proof: Mapping[str, Any] | None, config: Config
) -> dict[str, Any]:
    if binding is None:
        return _outcome("mismatch", "no binding: add it to bindings.yaml")
    if "not_ours" in binding:
        if proof:
            return _erratum(proof, nan, None)
        return _outcome("context", f"not a parameter of ours: {binding['not_ours']}")
    value = bound_value(row, binding, config)
    name = binding_name(binding)
    if row["printed"] == LOST:
        return _outcome("context", f"lost from the text; {name} is used", value)
    printed = parse_printed(str(binding.get("reading", row["printed"])))
    if agrees(row, binding, value):
        return _outcome("reproduced", f"feeds {name}", value, printed, 0.0)
    if proof:
        return _erratum(proof, value, printed)
    return _outcome("mismatch", f"differs from {name}, which it feeds", value, printed, 0.0)


def _judge_timing(
    row: Row, computed: Sequence[Mapping[str, Any]], proof: Mapping[str, Any] | None
) -> dict[str, Any]:
    value = computed[0]["computed"] if computed else nan
    printed = parse_printed(row["printed"])
    if proof:
        return _erratum(proof, value, printed)
    return _outcome("context", "depends on the machine and the solver: shown, not judged", value)


def _judge_result(
    row: Row,
    computed: Sequence[Mapping[str, Any]],
    rule: Mapping[str, Any],
    proof: Mapping[str, Any] | None,
) -> dict[str, Any]:
    # The last run is the best one a study has; it is shown unless another one decides.
    last = computed[-1] if computed else None
    value = last["computed"] if last else nan
    printed = parse_printed(row["printed"])
    if row["printed"] == LOST:
        return _outcome("context", "lost from the text: nothing to compare with", value)
    if "context" in rule:
        return _outcome("context", rule["reason"], value, printed)
    if proof:
        # Of several runs the one that comes nearest is what the printed value is compared with.
        if printed and computed:
            value = min((one["computed"] for one in computed), key=lambda c: abs(c - printed.value))
        if printed and last and printed.matches(value):
            reason = f"listed as erratum '{proof['key']}', but the printed value reproduces"
            return _outcome("mismatch", reason, value, printed, printed.half_unit)
        return _erratum(proof, value, printed)
    # A solve that failed is nobody's result: no rule excuses it.
    note = last["note"] if last and isinstance(last["note"], str) else ""
    computed = [one for one in computed if not isnan(one["computed"])]
    if not computed or printed is None:
        return _outcome("mismatch", note or "no computed value", value, printed)

    half_unit = printed.half_unit
    if "interval" in rule:
        return _judge_interval(printed, computed, rule)
    if "tolerance" not in rule or not _is_stricter(rule["tolerance"], printed):
        for one in computed:
            if printed.matches(one["computed"]):
                return _outcome(
                    "reproduced",
                    _with_run("equal to the printed digits", one),
                    one["computed"],
                    printed,
                    half_unit,
                )
    if "tolerance" in rule:
        tolerance = float(rule["tolerance"])
        for one in computed:
            if abs(one["computed"] - printed.value) <= tolerance:
                return _outcome(
                    "consistent",
                    _with_run(rule["reason"], one),
                    one["computed"],
                    printed,
                    tolerance,
                )
    if "truncated" in rule:
        for one in computed:
            if printed.truncates(one["computed"]):
                return _outcome(
                    "consistent",
                    _with_run(rule["reason"], one),
                    one["computed"],
                    printed,
                    2 * half_unit,
                )
    if "objective" in rule:
        sign = {"minimise": 1.0, "maximise": -1.0}[rule["objective"]]
        better = [
            one
            for one in computed
            if sign * (printed.value - one["computed"]) > half_unit
            and one["residual"] <= rule["feasible_to"]
        ]
        if better:
            best = min(better, key=lambda one: sign * one["computed"])
            reason = _with_run(
                f"{rule['reason']}; constraints met to {best['residual']:.0e} in an independent "
                f"re-integration (needed: {rule['feasible_to']:.0e})",
                best,
            )
            return _outcome("surpassed", reason, best["computed"], printed, half_unit)
    if "unreproducible" in rule:
        reason = f"{rule['reason']}; missing: {rule['unreproducible']}"
        return _outcome("unreproducible", reason, value, printed, half_unit)
    return _outcome("mismatch", note or "not explained", value, printed, half_unit)


def _judge_interval(
    printed: Printed, computed: Sequence[Mapping[str, Any]], rule: Mapping[str, Any]
) -> dict[str, Any]:
    """Consistent or unreproducible: agreement with a sample, or under inferred parameters.

    Equal digits are no reproduction here: another sample or inference would give others.
    """
    for one in computed:
        low, high = _interval(one)
        if low - printed.half_unit <= printed.value <= high + printed.half_unit:
            reason = _with_run(f"{rule['reason']}; {_interval_text(one)}", one)
            return _outcome("consistent", reason, one["computed"], printed)
    nearest = min(computed, key=lambda one: abs(one["computed"] - printed.value))
    reason = _with_run(f"{rule['reason']}; {_interval_text(nearest)}", nearest)
    reason += f"; missing: {rule['interval']}"
    return _outcome("unreproducible", reason, nearest["computed"], printed)


def _interval(one: Mapping[str, Any]) -> tuple[float, float]:
    low, high = (one["computed"] if isnan(one[end]) else one[end] for end in ("low", "high"))
    return low, high


def _interval_text(one: Mapping[str, Any]) -> str:
    low, high = _interval(one)
    if low == high:
        return "compared to the printed digits"
    return f"interval {low:.4g} to {high:.4g}"


def _is_stricter(tolerance: float, printed: Printed) -> bool:
    """A tolerance below half a printed unit replaces the digits: an exact 0 or 1, for example."""
    return float(tolerance) < printed.half_unit


def _with_run(reason: str, observation: Mapping[str, Any]) -> str:
    run = observation["run"]
    return f"{reason} ({run})" if isinstance(run, str) and run else reason
