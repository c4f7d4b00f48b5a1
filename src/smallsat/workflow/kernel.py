"""The kernel of a notebook: a process of the build like any other."""

import argparse
import os
import sys
import time
from math import inf
from queue import Empty

import zmq.asyncio
from jupyter_client.asynchronous import AsyncKernelClient
from jupyter_client.manager import AsyncKernelManager
from traitlets import Type, default


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``kernel``."""
    parser.add_argument("words", nargs="*", help="what IPython's kernel takes")


def main(arguments: argparse.Namespace) -> None:
    """Be the kernel until the notebook is done."""
    # Nobody debugs it, and the debugger takes longer to import than all the rest of the kernel.
    sys.modules["debugpy"] = None  # type: ignore[assignment]
    from ipykernel.kernelapp import launch_new_instance

    _settle()
    # Read as the module is imported, which may have been in another process.
    parent = os.environ.get("JPY_PARENT_PID", "0")
    launch_new_instance(argv=[*arguments.words, f"--IPKernelApp.parent_handle={parent}"])


def _settle() -> None:
    """Settle what libraries that a fork has already would have, had they been imported here.

    As it is imported, pandas asks whether it is in a notebook, and matplotlib which backend a
    kernel shows its figures by.
    """
    if pandas := sys.modules.get("pandas"):
        pandas.set_option("display.max_columns", 20)
    if matplotlib := sys.modules.get("matplotlib"):
        matplotlib.rcParams["backend"] = "module://matplotlib_inline.backend_inline"


class Client(AsyncKernelClient):
    """Takes the kernel as ready once it has answered and says that it is idle.

    Jupyter's own listens on for a fifth of a second, for what others may have asked before.
    """

    @default("context")
    def _connecting_soon(self) -> zmq.asyncio.Context:
        """Tries again after milliseconds to connect: the kernel begins to listen after that."""
        context = zmq.asyncio.Context()
        context.reconnect_ivl = 5
        self._created_context = True
        return context

    async def wait_for_ready(self, timeout: float | None = None) -> None:
        """Ask until it answers; a `RuntimeError` if it ends or takes longer than ``timeout``, s."""
        deadline = time.monotonic() + (inf if timeout is None else timeout)
        while True:
            asked = self.kernel_info()
            try:
                while not self._is_idle_after(asked, await self.get_iopub_msg(timeout=1)):
                    pass
            except Empty:
                # It was not there yet, or what it said was not heard.
                if not await self.is_alive():
                    raise RuntimeError("the kernel ended before it answered") from None
                if time.monotonic() > deadline:
                    raise RuntimeError(f"the kernel did not answer in {timeout} s") from None
            else:
                return

    @staticmethod
    def _is_idle_after(asked: str, message: dict) -> bool:
        own = message["parent_header"].get("msg_id") == asked
        return own and message["content"].get("execution_state") == "idle"


class Kernel(AsyncKernelManager):
    """Starts the kernel by the command ``kernel``, in place of that of a kernel specification."""

    client_factory = Type(Client)

    def format_kernel_cmd(self, extra_arguments: list[str] | None = None) -> list[str]:
        """The command; papermill's further arguments are IPython's."""
        words = ["-f", self.connection_file, *(extra_arguments or [])]
        return [sys.executable, "-m", "smallsat", "kernel", "--", *words]

    async def _async_wait(self, pollinterval: float = 0.005) -> None:
        # Of the end of a kernel that was killed: Jupyter looks for it every tenth of a second.
        await super()._async_wait(pollinterval)
