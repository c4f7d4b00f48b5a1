"""Open the notebooks in JupyterLab, with this environment's kernel alone."""

import argparse
import os
import sys
from pathlib import Path

from smallsat.workflow.isolation import isolated

PROJECT = Path(__file__).parents[3]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``lab``."""
    parser.add_argument("words", nargs="*", help="options of JupyterLab, after --")


def main(arguments: argparse.Namespace) -> None:
    """Become JupyterLab in the project's folder; the user's own settings and kernels stay out."""
    call = [
        *(sys.executable, "-m", "jupyterlab", str(PROJECT)),
        "--LabApp.default_url=/lab/tree/notebooks",
        "--KernelSpecManager.allowed_kernelspecs=python3",
        *arguments.words,
    ]
    os.execve(sys.executable, call, isolated(os.environ, PROJECT / ".cache"))
