"""Commands of the evidence: prove, judge, merge, summarise. ``python -m smallsat.evidence -h``."""

import argparse
import json
from pathlib import Path

import pandas as pd

from smallsat.errors import InputError, report_input_errors
from smallsat.evidence.claims import judge_claims
from smallsat.evidence.errata import prove_errata
from smallsat.evidence.ledger import DOCUMENTS, read_ledger
from smallsat.evidence.not_converged import read_not_converged
from smallsat.evidence.summary import failures, summary_text
from smallsat.evidence.verdicts import TEXT_COLUMNS, judge, pending
from smallsat.results import read_table, write_table
from smallsat.strict_yaml import read_yaml


def main() -> None:
    """Parse the command line and run one command."""
    parser = argparse.ArgumentParser(prog="python -m smallsat.evidence", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)

    study = commands.add_parser("study", help="prove errata, judge values and claims of one study")
    study.add_argument("document", choices=DOCUMENTS)
    study.add_argument(
        "--config",
        required=True,
        type=json.loads,
        help="configuration with the section of the study, JSON",
    )
    study.add_argument("--published", required=True, type=Path, help="folder of published values")
    study.add_argument("--results", required=True, type=Path, help="folder of the study's results")

    merge = commands.add_parser("merge", help="all verdicts in one table, pending ones included")
    merge.add_argument("--published", required=True, type=Path)
    merge.add_argument("--output", required=True, type=Path)
    merge.add_argument("verdicts", nargs="*", type=Path)

    summary = commands.add_parser("summary", help="count the verdicts; exit 1 if one is wrong")
    summary.add_argument("verdicts", type=Path)
    summary.add_argument("--published", type=Path, default=Path("data/published"))
    summary.add_argument("--what-if", action="store_true", help="report differences, never fail")

    arguments = parser.parse_args()
    {"study": _study, "merge": _merge, "summary": _summary}[arguments.command](arguments)


def _study(arguments: argparse.Namespace) -> None:
    document, published, results = arguments.document, arguments.published, arguments.results
    rows = [row for row in read_ledger(published / "values.csv") if row["document"] == document]

    folder = published / document
    errata_path, claims_path = folder / "errata.yaml", folder / "claims.yaml"
    errata = read_yaml(errata_path)
    proofs = prove_errata(errata, arguments.config, results, str(errata_path))
    claims = judge_claims(read_yaml(claims_path), arguments.config, results, str(claims_path))
    verdicts = judge(
        rows,
        read_table(results / "observations.csv"),
        read_yaml(folder / "rules.yaml"),
        read_yaml(folder / "bindings.yaml"),
        errata,
        proofs,
        arguments.config,
    )
    write_table(proofs, results / "errata.csv")
    write_table(claims, results / "claims.csv")
    write_table(verdicts, results / "verdicts.csv")


def _merge(arguments: argparse.Namespace) -> None:
    rows = read_ledger(arguments.published / "values.csv")
    judged = [read_table(path, TEXT_COLUMNS) for path in arguments.verdicts]
    done = {document for table in judged for document in table["document"]}
    tables = {document: table for table in judged for document in table["document"].unique()}
    for document in DOCUMENTS:
        if document not in done:
            tables[document] = pending([row for row in rows if row["document"] == document])
    merged = pd.concat([tables[document] for document in DOCUMENTS], ignore_index=True)
    if sorted(merged["id"]) != sorted(row["id"] for row in rows):
        raise InputError(f"{arguments.output}: verdicts do not cover values.csv; run `snakemake`")
    write_table(merged, arguments.output)


def _summary(arguments: argparse.Namespace) -> None:
    rows = read_ledger(arguments.published / "values.csv")
    kinds = pd.Series({row["id"]: row["kind"] for row in rows})
    verdicts = read_table(arguments.verdicts, TEXT_COLUMNS)
    results = arguments.verdicts.parent
    report = results.parents[1] / "report/build/report.pdf"
    print(summary_text(verdicts, kinds, read_not_converged(results), report))
    if len(failures(verdicts)) and not arguments.what_if:
        raise SystemExit(1)


if __name__ == "__main__":
    report_input_errors(main)
