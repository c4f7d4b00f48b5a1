"""The kernel of a notebook: a process of the build like any other."""

import argparse
import sys

from jupyter_client.manager import AsyncKernelManager


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``kernel``."""
    parser.add_argument("words", nargs="*", help="what IPython's kernel takes")


def main(arguments: argparse.Namespace) -> None:
    """Be the kernel until the notebook is done."""
    from ipykernel.kernelapp import launch_new_instance

    launch_new_instance(argv=arguments.words)


class Kernel(AsyncKernelManager):
    """Starts the kernel by the command ``kernel``, in place of that of a kernel specification."""

    def format_kernel_cmd(self, extra_arguments: list[str] | None = None) -> list[str]:
        """The command; papermill's further arguments are IPython's."""
        words = ["-f", self.connection_file, *(extra_arguments or [])]
        return [sys.executable, "-m", "smallsat", "kernel", "--", *words]
