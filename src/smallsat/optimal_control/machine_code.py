"""Symbolic functions as machine code, applied again and again: faster than CasADi's interpreter.

CasADi hands out the instructions of a function, and LLVM, which Numba brings along, makes machine
code of them: one for one, in their order, without optimisation. So it has the same bits as CasADi's
own evaluation, on every processor, and is ready in a fraction of a second.
"""

import ctypes
import struct
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import casadi as ca
import numpy as np
from llvmlite import binding as llvm

# Those that have a translation.
OPERATIONS = {
    ca.OP_ADD: "fadd double {0}, {1}",
    ca.OP_SUB: "fsub double {0}, {1}",
    ca.OP_MUL: "fmul double {0}, {1}",
    ca.OP_DIV: "fdiv double {0}, {1}",
    ca.OP_NEG: "fneg double {0}",
    ca.OP_SQ: "fmul double {0}, {0}",
    ca.OP_TWICE: "fadd double {0}, {0}",
    ca.OP_INV: "fdiv double 1.0, {0}",
    ca.OP_SQRT: "call double @llvm.sqrt.f64(double {0})",
    ca.OP_SIN: "call double @sin(double {0})",
    ca.OP_COS: "call double @cos(double {0})",
    ca.OP_POW: "call double @pow(double {0}, double {1})",
    ca.OP_CONSTPOW: "call double @pow(double {0}, double {1})",
}

_LOOP = """
declare double @llvm.sqrt.f64(double)
declare double @sin(double)
declare double @cos(double)
declare double @pow(double, double)

define void @loop({arguments}, i64 %count) {{
entry:
  br label %step
step:
  %k = phi i64 [0, %entry], [%next, %step]
{body}
  %next = add i64 %k, 1
  %more = icmp slt i64 %next, %count
  br i1 %more, label %step, label %end
end:
  ret void
}}
"""


class _Loop:
    """Machine code that evaluates a function for k = 0, 1, ..., at least once.

    It takes the addresses of the function's arguments and of its result. An argument, or the
    result, with a ``width`` has its numbers for k so many times k further on.
    """

    def __init__(self, function: ca.Function, into: str, widths: dict[str, int]):
        places = list(dict.fromkeys([f"a{k}" for k in range(function.n_in())] + [into]))
        lines = []
        for place in places:
            lines.append(f"%offset_{place} = mul i64 %k, {widths.get(place, 0)}")
            lines.append(f"%at_{place} = getelementptr double, ptr %{place}, i64 %offset_{place}")
        lines += _translated(function, into)
        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
        arguments = ", ".join(f"ptr %{place}" for place in places)
        body = "\n".join(f"  {line}" for line in lines)
        module = llvm.parse_assembly(_LOOP.format(arguments=arguments, body=body))
        machine = llvm.Target.from_default_triple().create_target_machine(opt=0)
        # The code lives as long as its engine.
        self._engine = llvm.create_mcjit_compiler(module, machine)
        self._engine.finalize_object()
        signature = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * len(places), ctypes.c_int64)
        self._run = signature(self._engine.get_function_address("loop"))

    def __call__(self, arrays: Iterable[np.ndarray], count: int) -> None:
        """Evaluate it ``count`` times, on contiguous arrays."""
        self._run(*(array.ctypes.data for array in arrays), count)


class Chain:
    """A step ``(x, p, e) -> x`` that is applied again and again.

    Parameters
    ----------
    step
        Of x, (n,), of p, (m,), which all steps have in common, and of e, (l,), which each has its
        own of; a function of scalar symbols (SX), dense.

    Raises
    ------
    ValueError
        Where the step is not dense, or has an operation that is not translated.
    """

    def __init__(self, step: ca.Function):
        if not all(step.sparsity_in(k).is_dense() for k in range(3)) or not (
            step.sparsity_out(0).is_dense()
        ):
            raise ValueError(f"{step.name()}: a chain takes dense vectors; use casadi.densify")
        self._loop = _Loop(step, "a0", {"a2": step.numel_in(2)})
        self._shapes = [step.numel_in(k) for k in range(3)]

    def __call__(self, x: np.ndarray, p: np.ndarray, each: np.ndarray) -> np.ndarray:
        """The last x, (n,), of a chain from ``x`` with ``p`` (m,) and ``each`` (steps, l)."""
        n, m, width = self._shapes
        end = np.array(x, dtype=float)
        common, own = (np.ascontiguousarray(a, dtype=float) for a in (p, each))
        if end.shape != (n,) or common.shape != (m,) or own.shape[1:] != (width,) or not len(own):
            shapes = f"{end.shape}, {common.shape} and {own.shape}"
            raise ValueError(f"a chain of ({n},), ({m},) and (steps, {width}) is given {shapes}")
        self._loop((end, common, own), len(own))
        return end


class Everywhere(ca.Callback):
    """A function at many places at once, as CasADi's ``map`` has it, without derivatives.

    Parameters
    ----------
    function
        Of scalar symbols (SX), with one result; all dense.
    places
        How many: arguments (n, m) of the function are (n, m places) here, and so is its result.

    Raises
    ------
    ValueError
        Where something is not dense, or has an operation that is not translated.
    """

    def __init__(self, function: ca.Function, places: int):
        super().__init__()
        given = [function.sparsity_in(k) for k in range(function.n_in())]
        taken = function.sparsity_out(0)
        if not all(one.is_dense() for one in (*given, taken)):
            raise ValueError(f"{function.name()}: dense matrices alone; use casadi.densify")
        self._places = places
        self._given, self._taken = (
            [ca.Sparsity.dense(one.size1(), one.size2() * places) for one in of]
            for of in (given, [taken])
        )
        widths = {f"a{k}": one.numel() for k, one in enumerate(given)}
        self._loop = _Loop(function, "result", widths | {"result": taken.numel()})
        self.construct(f"{function.name()}_everywhere", {})

    def get_n_in(self) -> int:
        """Number of arguments."""
        return len(self._given)

    def get_n_out(self) -> int:
        """One result."""
        return 1

    def get_sparsity_in(self, i: int) -> ca.Sparsity:
        """Shape of an argument."""
        return self._given[i]

    def get_sparsity_out(self, i: int) -> ca.Sparsity:
        """Shape of the result."""
        return self._taken[i]

    def has_eval_buffer(self) -> bool:
        """It works on CasADi's own memory."""
        return True

    def eval_buffer(self, given: Sequence[Any], taken: Sequence[Any]) -> int:
        """Fill the result."""
        self._loop((np.frombuffer(one) for one in (*given, *taken)), self._places)
        return 0


def _translated(function: ca.Function, into: str) -> Iterator[str]:
    """Instructions of a function in LLVM's language, with its first result to a place."""
    # What each of CasADi's registers holds now; results wait until all arguments have been read.
    held: dict[int, str] = {}
    stores = []
    for k in range(function.n_instructions()):
        operation = function.instruction_id(k)
        taken, given = function.instruction_input(k), function.instruction_output(k)
        if operation == ca.OP_CONST:
            held[given[0]] = _literal(function.instruction_constant(k))
        elif operation == ca.OP_INPUT:
            argument, element = taken
            yield f"%p{k} = getelementptr double, ptr %at_a{argument}, i64 {element}"
            yield f"%v{k} = load double, ptr %p{k}"
            held[given[0]] = f"%v{k}"
        elif operation == ca.OP_OUTPUT:
            stores.append(f"%p{k} = getelementptr double, ptr %at_{into}, i64 {given[1]}")
            stores.append(f"store double {held[taken[0]]}, ptr %p{k}")
        elif operation in OPERATIONS:
            operands = [held[register] for register in taken]
            yield f"%v{k} = " + OPERATIONS[operation].format(*operands)
            held[given[0]] = f"%v{k}"
        else:
            name = function.name()
            raise ValueError(f"{name}: CasADi's operation {operation} has no translation yet")
    yield from stores


def _literal(value: Any) -> str:
    """A number in LLVM's language, to the bit."""
    (bits,) = struct.unpack(">Q", struct.pack(">d", value))
    return f"0x{bits:016X}"
