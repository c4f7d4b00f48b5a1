"""Count the verdicts and say what has moved since the accepted results.

Exits with 1 if a verdict is wrong, or if a verdict, a claim or a proof is not as accepted.
"""

import argparse
from pathlib import Path

from smallsat.evidence import summary
from smallsat.evidence.accepted import RELEASES, findings, flipped, movement_text
from smallsat.results import read_table


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``check``."""
    summary.add_arguments(parser)
    parser.add_argument("--accepted", type=Path, default=Path("data/accepted"))


def main(arguments: argparse.Namespace) -> None:
    """Print counts, movements and flips."""
    results, accepted = arguments.verdicts.parent, arguments.accepted
    before, now = findings(accepted), findings(results)
    release = read_table(accepted / RELEASES).iloc[-1]
    print(f"Since {release['date']} ({release['reason']}):")
    print(movement_text(before, now), end="\n\n", flush=True)
    summary.main(arguments)
    if len(flipped(before, now)):
        print('An outcome is not as accepted; if it is right: make accept REASON="why it changed"')
        raise SystemExit(1)
