"""Prove the errata of a study, judge its values and its claims."""

import argparse
import json
from pathlib import Path

from smallsat.catalogue import section_type
from smallsat.evidence.claims import judge_claims
from smallsat.evidence.errata import prove_errata
from smallsat.evidence.grounds import read_grounds
from smallsat.evidence.verdicts import judge
from smallsat.results import read_table, write_table
from smallsat.strict_yaml import read_yaml


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``judge``."""
    parser.add_argument("--config", required=True, type=json.loads, help="its section, JSON")
    parser.add_argument("--published", required=True, type=Path, help="folder of its values")
    parser.add_argument("--results", required=True, type=Path, help="folder of its results")


def main(arguments: argparse.Namespace) -> None:
    """Write ``errata.csv``, ``claims.csv`` and ``verdicts.csv`` beside the study's results."""
    folder, results = arguments.published, arguments.results
    section = section_type(folder.resolve().name).model_validate(arguments.config)
    errata_path, claims_path = folder / "errata.yaml", folder / "claims.yaml"
    errata = read_yaml(errata_path)
    grounds = read_grounds(section, folder, results)
    proofs = prove_errata(errata, grounds, str(errata_path))
    claims = judge_claims(read_yaml(claims_path), grounds, str(claims_path))
    verdicts = judge(
        grounds.ledger.rows,
        read_table(results / "observations.csv"),
        read_yaml(folder / "rules.yaml"),
        read_yaml(folder / "bindings.yaml"),
        errata,
        proofs,
        section,
    )
    write_table(proofs, results / "errata.csv")
    write_table(claims, results / "claims.csv")
    write_table(verdicts, results / "verdicts.csv")
