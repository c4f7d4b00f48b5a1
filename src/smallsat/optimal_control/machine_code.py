"""Symbolic steps as machine code: integrations in a tenth of the time of CasADi's interpreter.

CasADi hands out the instructions of a function, and LLVM, which Numba brings along, makes machine
code of them: one for one, in their order, without optimisation. So a chain has the same bits as
CasADi's own evaluation, on every processor, and is ready in a fraction of a second.
"""

import ctypes
import struct
from collections.abc import Iterator
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

_CHAIN = """
declare double @llvm.sqrt.f64(double)
declare double @sin(double)
declare double @cos(double)
declare double @pow(double, double)

define void @chain(ptr %a0, ptr %a1, ptr %each, i64 %count) {{
entry:
  br label %step
step:
  %k = phi i64 [0, %entry], [%next, %step]
  %offset = mul i64 %k, {width}
  %a2 = getelementptr double, ptr %each, i64 %offset
{body}
  %next = add i64 %k, 1
  %more = icmp slt i64 %next, %count
  br i1 %more, label %step, label %end
end:
  ret void
}}
"""


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
        body = "\n".join(f"  {line}" for line in _translated(step))
        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
        module = llvm.parse_assembly(_CHAIN.format(width=step.numel_in(2), body=body))
        machine = llvm.Target.from_default_triple().create_target_machine(opt=0)
        # The code lives as long as its engine.
        self._engine = llvm.create_mcjit_compiler(module, machine)
        self._engine.finalize_object()
        pointer = ctypes.c_void_p
        signature = ctypes.CFUNCTYPE(None, pointer, pointer, pointer, ctypes.c_int64)
        self._run = signature(self._engine.get_function_address("chain"))
        self._shapes = [step.numel_in(k) for k in range(3)]

    def __call__(self, x: np.ndarray, p: np.ndarray, each: np.ndarray) -> np.ndarray:
        """The last x, (n,), of a chain from ``x`` with ``p`` (m,) and ``each`` (steps, l)."""
        n, m, width = self._shapes
        end = np.array(x, dtype=float)
        common, own = (np.ascontiguousarray(a, dtype=float) for a in (p, each))
        if end.shape != (n,) or common.shape != (m,) or own.shape[1:] != (width,) or not len(own):
            shapes = f"{end.shape}, {common.shape} and {own.shape}"
            raise ValueError(f"a chain of ({n},), ({m},) and (steps, {width}) is given {shapes}")
        self._run(end.ctypes.data, common.ctypes.data, own.ctypes.data, len(own))
        return end


def _translated(step: ca.Function) -> Iterator[str]:
    """Instructions of a function in LLVM's language; its results go where x came from."""
    # What each of CasADi's registers holds now; results wait until all of x has been read.
    held: dict[int, str] = {}
    stores = []
    for k in range(step.n_instructions()):
        operation = step.instruction_id(k)
        taken, given = step.instruction_input(k), step.instruction_output(k)
        if operation == ca.OP_CONST:
            held[given[0]] = _literal(step.instruction_constant(k))
        elif operation == ca.OP_INPUT:
            argument, element = taken
            yield f"%p{k} = getelementptr double, ptr %a{argument}, i64 {element}"
            yield f"%v{k} = load double, ptr %p{k}"
            held[given[0]] = f"%v{k}"
        elif operation == ca.OP_OUTPUT:
            stores.append(f"%p{k} = getelementptr double, ptr %a0, i64 {given[1]}")
            stores.append(f"store double {held[taken[0]]}, ptr %p{k}")
        elif operation in OPERATIONS:
            operands = [held[register] for register in taken]
            yield f"%v{k} = " + OPERATIONS[operation].format(*operands)
            held[given[0]] = f"%v{k}"
        else:
            name = step.name()
            raise ValueError(f"{name}: CasADi's operation {operation} has no translation yet")
    yield from stores


def _literal(value: Any) -> str:
    """A number in LLVM's language, to the bit."""
    (bits,) = struct.unpack(">Q", struct.pack(">d", value))
    return f"0x{bits:016X}"
