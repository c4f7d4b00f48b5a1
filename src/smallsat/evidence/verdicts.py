"""One verdict for each published number, by rules that are fixed before the run they judge."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isnan, nan
from typing import Any

import pandas as pd

from smallsat.errors import InputError
from smallsat.evidence.bindings import agrees, binding_name, bound_value
from smallsat.evidence.patterns import match_entries
from smallsat.evidence.printed import LOST, Printed, parse_printed
from smallsat.quantities import Part

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
FOUND = ("difference", "tolerance", "verdict", "reason")
NAMED = ("id", "document", "locator", "quantity", "case", "component")
VERDICT_COLUMNS = (*NAMED, "printed", "computed", "unit", *FOUND, "source")
TEXT_COLUMNS = ("case", "component", "printed", "unit")
# Kinds of rules; each rule is of one of them.
RULE_KINDS = (
    "exact",
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
Run = Mapping[str, Any]
Outcome = dict[str, Any]


@dataclass(frozen=True)
class Case:
    """One printed number, and what there is to judge it by.

    Attributes
    ----------
    row
        Its row of the ledger.
    printed
        The literal as a number; not a number for a text.
    runs
        What was computed for it, one entry a run; the last run is the best one that a study has.
    rule, binding
        The entries of ``rules.yaml`` and ``bindings.yaml`` that name it; empty where none does.
    proof
        What the proof of its erratum found; empty where it is not listed as one.
    section
        The study's section of the configuration, which the bindings look into.
    compared
        What must lie in the interval of a rule: the printed number, or the sum of all numbers that
        the rule judges jointly.
    """

    row: Row
    printed: Printed
    runs: Sequence[Run]
    rule: Entry
    binding: Entry
    proof: Entry
    section: Part
    compared: Printed

    @property
    def shown(self) -> float:
        """The value that is shown unless another run decides: the last one."""
        return self.runs[-1]["computed"] if self.runs else nan

    @property
    def solved(self) -> list[Run]:
        """The runs that have a number; a solve that failed is nobody's result."""
        return [run for run in self.runs if not isnan(run["computed"])]

    def outcome(
        self, verdict: str, reason: str, computed: float, tolerance: float = nan
    ) -> Outcome:
        """The columns that a judge fills, with the difference from the printed number."""
        return {
            "verdict": verdict,
            "reason": reason,
            "computed": computed,
            "difference": computed - self.printed.value,
            "tolerance": tolerance,
        }

    def decided(self, verdict: str, reason: str, run: Run, tolerance: float = nan) -> Outcome:
        """The outcome that one run decides, which the reason names."""
        name = run["run"]
        named = f"{reason} ({name})" if isinstance(name, str) and name else reason
        return self.outcome(verdict, named, run["computed"], tolerance)


def judge(
    rows: Sequence[Row],
    observations: pd.DataFrame,
    rules: Sequence[Entry],
    bindings: Sequence[Entry],
    errata: Sequence[Entry],
    proofs: pd.DataFrame,
    section: Part,
) -> pd.DataFrame:
    """Judge every row of one document: the first of `JUDGES` that answers decides.

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
    section
        The study's section of the configuration, which the bindings look into.

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
    runs_of = {str(key): _records(group) for key, group in observations.groupby("id")}

    printed_of = {row["id"]: _number(row["printed"]) for row in rows}

    judged = []
    for row in rows:
        identifier = row["id"]
        erratum = erratum_of.get(identifier)
        rule = rule_of.get(identifier, {})
        case = Case(
            row=row,
            printed=printed_of[identifier],
            runs=runs_of.get(identifier, []),
            rule=rule,
            binding=binding_of.get(identifier, {}),
            proof=proof_of[erratum["key"]] if erratum else {},
            section=section,
            compared=_sum([printed_of[other] for other in ids if rule_of.get(other) is rule])
            if rule.get("jointly")
            else printed_of[identifier],
        )
        outcome = next(found for ask in JUDGES if (found := ask(case)))
        source = {"source": case.runs[-1]["source"] if case.runs else ""}
        judged.append({name: row.get(name, "") for name in VERDICT_COLUMNS} | outcome | source)
    return pd.DataFrame(judged, columns=list(VERDICT_COLUMNS))


def _number(literal: str) -> Printed:
    """A literal as a number; not a number for a text."""
    return parse_printed(literal) or Printed(nan, nan)


def _sum(numbers: Sequence[Printed]) -> Printed:
    """The sum of printed numbers, as fine as their roundings leave it."""
    return Printed(sum(one.value for one in numbers), sum(one.half_unit for one in numbers))


def _records(table: pd.DataFrame) -> list[dict[str, Any]]:
    return [{str(name): value for name, value in row.items()} for row in table.to_dict("records")]


def _pending(case: Case) -> Outcome | None:
    """Pending: the part of the study is not built. A pending row cannot hide a wrong value."""
    if "pending" not in case.rule:
        return None
    if case.runs:
        reason = "listed as pending, but computed: remove it from the pending rows of rules.yaml"
        return case.outcome("mismatch", reason, case.shown)
    return case.outcome(PENDING, f"{case.rule['pending']}: {case.rule['reason']}", nan)


def _input(case: Case) -> Outcome | None:
    """An input is reproduced if it equals the value of ours that its binding says it feeds."""
    if case.row["kind"] != "input":
        return None
    binding = case.binding
    if not binding:
        return case.outcome("mismatch", "no binding: add it to bindings.yaml", nan)
    if "not_ours" in binding:
        if case.proof:
            return _proven(case, nan)
        return case.outcome("context", f"not a parameter of ours: {binding['not_ours']}", nan)
    value, name = bound_value(case.row, binding, case.section), binding_name(binding)
    if case.row["printed"] == LOST:
        return case.outcome("context", f"lost from the text; {name} is used", value)
    if "reading" in binding:
        case = replace(case, printed=_number(str(binding["reading"])))
    if agrees(case.row, binding, value):
        return case.outcome("reproduced", f"feeds {name}", value, 0.0)
    if case.proof:
        return _proven(case, value)
    return case.outcome("mismatch", f"differs from {name}, which it feeds", value, 0.0)


def _timing(case: Case) -> Outcome | None:
    """Seconds are context: they depend on the machine and the solver, so no difference counts."""
    if case.row["kind"] != "timing":
        return None
    value = case.runs[0]["computed"] if case.runs else nan
    if case.proof:
        return _proven(case, value)
    reason = "depends on the machine and the solver: shown, not judged"
    return case.outcome("context", reason, value) | {"difference": nan}


def _lost(case: Case) -> Outcome | None:
    """A literal that the text has lost is context: there is nothing to compare with."""
    if case.row["printed"] != LOST:
        return None
    return case.outcome("context", "lost from the text: nothing to compare with", case.shown)


def _context(case: Case) -> Outcome | None:
    """What a rule calls context is shown and not judged."""
    if "context" not in case.rule:
        return None
    return case.outcome("context", case.rule["reason"], case.shown)


def _erratum(case: Case) -> Outcome | None:
    """An erratum needs a proof that holds, and a printed value that no run reproduces."""
    if not case.proof:
        return None
    value = case.shown
    if case.runs and not isnan(case.printed.value):
        # The printed value is compared with the nearest of several runs.
        found = (run["computed"] for run in case.runs)
        value = min(found, key=lambda one: abs(one - case.printed.value))
        if case.printed.matches(value):
            reason = f"listed as erratum '{case.proof['key']}', but the printed value reproduces"
            return case.outcome("mismatch", reason, value, case.printed.half_unit)
    return _proven(case, value)


def _proven(case: Case, value: float) -> Outcome:
    key = case.proof["key"]
    if not case.proof["holds"]:
        return case.outcome(
            "mismatch", f"listed as erratum '{key}', but its proof does not hold", value
        )
    return case.outcome("erratum", f"{key}: {case.proof['statement']}", value)


def _not_computed(case: Case) -> Outcome | None:
    """Without a number of ours, or a printed one, there is a mismatch that no rule excuses."""
    if case.solved and not isnan(case.printed.value):
        return None
    return case.outcome("mismatch", _note(case) or "no computed value", case.shown)


def _interval(case: Case) -> Outcome | None:
    """Consistent or unreproducible: agreement with a sample, or under inferred parameters.

    Equal digits are no reproduction here: another sample or inference would give others. Where
    a rule judges its numbers jointly, each has the verdict of their sum, whose interval a run has.
    A printed upper bound must lie above the whole interval.
    """
    if "interval" not in case.rule:
        return None
    compared, half_unit, reason = case.compared.value, case.compared.half_unit, case.rule["reason"]
    if case.rule.get("jointly"):
        reason = f"{reason}; printed are {compared:g} in all"
    for run in case.solved:
        low, high = _ends(run)
        inside = low - half_unit <= compared <= high + half_unit
        if max(abs(low), abs(high)) < compared if case.compared.bound else inside:
            return case.decided("consistent", f"{reason}; {_interval_text(run)}", run)
    nearest = min(case.solved, key=lambda run: abs(run["computed"] - case.printed.value))
    found = case.decided("unreproducible", f"{reason}; {_interval_text(nearest)}", nearest)
    return found | {"reason": f"{found['reason']}; missing: {case.rule['interval']}"}


def _exact(case: Case) -> Outcome | None:
    """Reproduced: a rule calls the literal exact, a bare 0 for example, and a run meets it.

    Rounding is all that the rule allows; half a printed unit would let 0.4 pass for 0.
    """
    if "exact" not in case.rule:
        return None
    return _within(case, "exact", "reproduced") or _unexplained(case)


def _digits(case: Case) -> Outcome | None:
    """Reproduced: a run is equal to the printed digits, where no tolerance is stricter."""
    half_unit = case.printed.half_unit
    if float(case.rule.get("tolerance", nan)) < half_unit:
        return None
    for run in case.solved:
        if case.printed.matches(run["computed"]):
            return case.decided("reproduced", "equal to the printed digits", run, half_unit)
    return None


def _tolerance(case: Case) -> Outcome | None:
    """Consistent: a run is within the tolerance that a rule gives and explains."""
    return _within(case, "tolerance", "consistent")


def _within(case: Case, kind: str, verdict: str) -> Outcome | None:
    """The verdict if a run is as near to the printed number as the rule's entry of a kind says."""
    tolerance = float(case.rule.get(kind, nan))
    for run in case.solved:
        if abs(run["computed"] - case.printed.value) <= tolerance:
            return case.decided(verdict, case.rule["reason"], run, tolerance)
    return None


def _truncated(case: Case) -> Outcome | None:
    """Consistent: the printed digits are those of a run, cut off instead of rounded."""
    for run in case.solved:
        if "truncated" in case.rule and case.printed.truncates(run["computed"]):
            unit = 2 * case.printed.half_unit
            return case.decided("consistent", case.rule["reason"], run, unit)
    return None


def _surpassed(case: Case) -> Outcome | None:
    """Surpassed: a run has a better objective and meets its constraints, checked independently."""
    if "objective" not in case.rule:
        return None
    sign = {"minimise": 1.0, "maximise": -1.0}[case.rule["objective"]]
    printed, feasible_to = case.printed, case.rule["feasible_to"]
    better = [
        run
        for run in case.solved
        if sign * (printed.value - run["computed"]) > printed.half_unit
        and run["residual"] <= feasible_to
    ]
    if not better:
        return None
    best = min(better, key=lambda run: sign * run["computed"])
    reason = (
        f"{case.rule['reason']}; constraints met to {best['residual']:.0e} in an independent "
        f"re-integration (needed: {feasible_to:.0e})"
    )
    return case.decided("surpassed", reason, best, printed.half_unit)


def _unreproducible(case: Case) -> Outcome | None:
    """Unreproducible: a rule names what the document would have to say and does not."""
    if "unreproducible" not in case.rule:
        return None
    reason = f"{case.rule['reason']}; missing: {case.rule['unreproducible']}"
    return case.outcome("unreproducible", reason, case.shown, case.printed.half_unit)


def _unexplained(case: Case) -> Outcome:
    """What nothing explains is a mismatch."""
    reason = _note(case) or "not explained"
    return case.outcome("mismatch", reason, case.shown, case.printed.half_unit)


# In the order in which they are asked.
JUDGES: tuple[Callable[[Case], Outcome | None], ...] = (
    _pending,
    _input,
    _timing,
    _lost,
    _context,
    _erratum,
    _not_computed,
    _interval,
    _exact,
    _digits,
    _tolerance,
    _truncated,
    _surpassed,
    _unreproducible,
    _unexplained,
)


def _note(case: Case) -> str:
    """What the last run says of itself, such as a solver that did not converge."""
    note = case.runs[-1]["note"] if case.runs else ""
    return note if isinstance(note, str) else ""


def _ends(run: Run) -> tuple[float, float]:
    """Ends of the interval of a run; its value where it has none."""
    low, high = (run["computed"] if isnan(run[end]) else run[end] for end in ("low", "high"))
    return low, high


def _interval_text(run: Run) -> str:
    low, high = _ends(run)
    if low == high:
        return "compared to the printed digits"
    return f"interval {low:.4g} to {high:.4g}"
