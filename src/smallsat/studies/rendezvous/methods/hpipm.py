"""HPIPM through its C interface: the library that comes inside CasADi's wheel, called by ctypes.

CasADi's own interface to it exposes no tolerance. The functions here could be called from compiled
code too, since they are plain C; what they cost is measured around the solution alone.
"""

import ctypes
from functools import cache
from pathlib import Path
from typing import Any

import casadi
import numpy as np

from smallsat.optimal_control.riccati_interior_point import CONTROLS, STATES
from smallsat.studies.rendezvous.methods.qp_solvers import Answer, Sample, stage_rows, timed

SPEED = 1  # of the modes in hpipm_common.h; the absolute one has no soft constraints that work
SUCCESS = 0
ITERATION_LIMIT = 200


@cache
def _library() -> ctypes.CDLL:
    folder = Path(casadi.__file__).parent
    ctypes.CDLL(str(folder / "libblasfeo.so"), mode=ctypes.RTLD_GLOBAL)
    return ctypes.CDLL(str(folder / "libhpipm.so"))


def _memory(function: str, *arguments: Any) -> ctypes.Array:
    """Return as many bytes as a function of the library says, and some to align them."""
    size = getattr(_library(), function)
    size.restype = ctypes.c_size_t
    return ctypes.create_string_buffer(size(*arguments) + 64)


def _created(kind: str, *arguments: Any) -> tuple[ctypes.Array, ctypes.Array]:
    """Return an object of the library and the memory that it lives in and must outlive it."""
    made, memory = _memory(f"{kind}_strsize"), _memory(f"{kind}_memsize", *arguments)
    getattr(_library(), f"{kind}_create")(*arguments, made, memory)
    return made, memory


def _fields(sample: Sample, i: int) -> dict[str, np.ndarray]:
    """Return what HPIPM is told of a stage.

    The state at the start is eliminated; rows are soft constraints, with only their upper side.
    """
    fields: dict[str, Any] = {}
    program, stages, a = sample.program, sample.stages, sample.program.transition
    if i < stages:
        fields |= {"A": a} if i > 0 else {}
        fields |= {"B": a[:, 3:], "b": a @ sample.start if i == 0 else np.zeros(STATES)}
        fields |= {"R": np.diag(program.control_hessian), "r": np.zeros(CONTROLS)}
        fields |= {
            "idxbu": np.arange(CONTROLS),
            "lbu": -np.ones(CONTROLS),
            "ubu": np.ones(CONTROLS),
        }
    if i > 0:
        rows, limits, weights = stage_rows(program, i)
        none, first = np.zeros(len(limits)), CONTROLS if i < stages else 0
        fields["Q"] = np.diag(program.state_hessian) if i < stages else program.terminal_hessian
        fields["q"] = program.state_gradient[i]
        fields |= {"D": np.zeros((len(limits), CONTROLS))} if i < stages else {}
        fields |= {"C": rows, "ug": limits, "lg": none, "lg_mask": none}
        fields |= {"idxs": first + np.arange(len(limits)), "Zl": none, "Zu": none}
        fields |= {"zl": none + 1.0, "lls": none, "lus": none, "zu": weights}
    return fields


def hpipm(sample: Sample, tolerance: float) -> Answer:
    """HPIPM: a Riccati-based interior-point method, for quadratic costs."""
    library, stages = _library(), sample.stages
    sizes, sizes_memory = _created("d_ocp_qp_dim", stages)
    told = [_fields(sample, i) for i in range(stages + 1)]
    for i, fields in enumerate(told):
        controls, rows = len(fields.get("idxbu", [])), len(fields.get("ug", []))
        states = STATES if i > 0 else 0
        for name, size in zip(
            ("nx", "nu", "nbx", "nbu", "ng", "ns"),
            (states, controls, 0, controls, rows, rows),
            strict=True,
        ):
            library.d_ocp_qp_dim_set(name.encode(), i, size, sizes)
    problem, problem_memory = _created("d_ocp_qp", sizes)
    for i, fields in enumerate(told):
        for name, value in fields.items():
            # Matrices go column by column, and indices are whole numbers.
            kind = np.int32 if name.startswith("idx") else np.float64
            flat = np.asarray(value, dtype=kind).ravel(order="F")
            library.d_ocp_qp_set(name.encode(), i, ctypes.c_void_p(flat.ctypes.data), problem)
    solution, solution_memory = _created("d_ocp_qp_sol", sizes)
    options, options_memory = _created("d_ocp_qp_ipm_arg", sizes)
    library.d_ocp_qp_ipm_arg_set_default(SPEED, options)
    limit, accuracy = ctypes.c_int(ITERATION_LIMIT), ctypes.c_double(tolerance)
    library.d_ocp_qp_ipm_arg_set(b"iter_max", ctypes.byref(limit), options)
    for name in ("tol_stat", "tol_eq", "tol_ineq", "tol_comp"):
        library.d_ocp_qp_ipm_arg_set(name.encode(), ctypes.byref(accuracy), options)
    work, work_memory = _created("d_ocp_qp_ipm_ws", sizes, options)

    _, seconds = timed(lambda: library.d_ocp_qp_ipm_solve(problem, solution, options, work))
    status, iterations = ctypes.c_int(), ctypes.c_int()
    library.d_ocp_qp_ipm_get_status(work, ctypes.byref(status))
    library.d_ocp_qp_ipm_get_iter(work, ctypes.byref(iterations))
    found = np.zeros((stages, CONTROLS))
    for i in range(stages):
        library.d_ocp_qp_sol_get_u(i, solution, ctypes.c_void_p(found[i].ctypes.data))
    del sizes_memory, problem_memory, solution_memory, options_memory, work_memory
    return Answer(status.value == SUCCESS, found, iterations.value, seconds)
