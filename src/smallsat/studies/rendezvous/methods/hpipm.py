"""HPIPM through its C interface: the library that comes inside CasADi's wheel, called by ctypes.

CasADi's own interface to it exposes no tolerance. The functions here could be called from compiled
code too, since they are plain C; what they cost is measured around the solution alone.
"""

import ctypes
import time
from functools import cache
from pathlib import Path
from typing import Any

import casadi
import numpy as np

from smallsat.optimal_control.riccati_interior_point import CONTROLS, STATES, Program

SPEED = 1  # of the modes in hpipm_common.h; the absolute one has no soft constraints that work
SUCCESS = 0
ITERATION_LIMIT = 200


@cache
def _library() -> ctypes.CDLL:
    folder = Path(casadi.__file__).parent
    ctypes.CDLL(str(folder / "libblasfeo.so"), mode=ctypes.RTLD_GLOBAL)
    return ctypes.CDLL(str(folder / "libhpipm.so"))


def _room(function: str, *arguments: Any) -> ctypes.Array:
    size = getattr(_library(), function)
    size.restype = ctypes.c_size_t
    return ctypes.create_string_buffer(size(*arguments) + 64)


def _set(function: str, field: str, stage: int, value: np.ndarray, where: Any) -> None:
    """Hand over an array; matrices column by column, as the library wants them."""
    kind = np.int32 if field.startswith("idx") else np.float64
    flat = np.asarray(value, dtype=kind).ravel(order="F")
    getattr(_library(), function)(field.encode(), stage, ctypes.c_void_p(flat.ctypes.data), where)


def _stage_rows(program: Program, i: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rows on the state of a stage: G (R, 6), b, w."""
    planes, bounds = program.plane_count[i], len(program.components)
    rows = np.zeros((planes + bounds, STATES))
    rows[:planes, :3] = program.normals[i, :planes]
    rows[planes + np.arange(bounds), program.components] = program.signs
    limits = np.concatenate([program.offsets[i, :planes], program.bounds[i, :bounds]])
    weights = np.concatenate([program.plane_weights[i, :planes], program.bound_weights[i, :bounds]])
    return rows, limits, weights


class Solver:
    """One program in HPIPM's own memory.

    The state at the start is eliminated; penalty rows are its soft constraints, with only their
    upper side in use.
    """

    def __init__(self, program: Program, stages: int, start: np.ndarray, tolerance: float):
        if program.control_norm[0] > 0.0:
            raise ValueError("HPIPM is given quadratic costs only")
        self.stages = stages
        library = _library()
        rows = {i: _stage_rows(program, i) for i in range(1, stages + 1)}
        counts = [0, *(len(rows[i][1]) for i in range(1, stages + 1))]
        self._dimensions = self._create_dimensions(counts)
        self._program = _room("d_ocp_qp_strsize")
        self._memory = [_room("d_ocp_qp_memsize", self._dimensions)]
        library.d_ocp_qp_create(self._dimensions, self._program, self._memory[0])
        a, b = program.transition, program.transition[:, 3:]
        for i in range(stages + 1):
            if i < stages:
                if i > 0:
                    self._put("A", i, a)
                self._put("B", i, b)
                self._put("b", i, a @ start if i == 0 else np.zeros(STATES))
                self._put("R", i, np.diag(program.control_hessian))
                self._put("r", i, np.zeros(CONTROLS))
                self._put("idxbu", i, np.arange(CONTROLS))
                self._put("lbu", i, -np.ones(CONTROLS))
                self._put("ubu", i, np.ones(CONTROLS))
            if i > 0:
                weight = np.diag(program.state_hessian) if i < stages else program.terminal_hessian
                self._put("Q", i, weight)
                self._put("q", i, program.state_gradient[i])
                self._put_rows(i, *rows[i])
        self._solution = _room("d_ocp_qp_sol_strsize")
        self._memory.append(_room("d_ocp_qp_sol_memsize", self._dimensions))
        library.d_ocp_qp_sol_create(self._dimensions, self._solution, self._memory[1])
        self._arguments = self._create_arguments(tolerance)
        self._work = _room("d_ocp_qp_ipm_ws_strsize")
        self._memory.append(_room("d_ocp_qp_ipm_ws_memsize", self._dimensions, self._arguments))
        library.d_ocp_qp_ipm_ws_create(
            self._dimensions, self._arguments, self._work, self._memory[-1]
        )

    def _put(self, field: str, stage: int, value: np.ndarray) -> None:
        _set("d_ocp_qp_set", field, stage, value, self._program)

    def _put_rows(self, i: int, rows: np.ndarray, limits: np.ndarray, weights: np.ndarray) -> None:
        count = len(limits)
        if i < self.stages:
            self._put("D", i, np.zeros((count, CONTROLS)))
        self._put("C", i, rows)
        self._put("ug", i, limits)
        self._put("lg", i, np.zeros(count))
        self._put("lg_mask", i, np.zeros(count))
        self._put("idxs", i, np.arange(count) + (CONTROLS if i < self.stages else 0))
        for field, value in (("Zl", 0.0), ("Zu", 0.0), ("zl", 1.0), ("lls", 0.0), ("lus", 0.0)):
            self._put(field, i, np.full(count, value))
        self._put("zu", i, weights)

    def _create_dimensions(self, counts: list[int]) -> ctypes.Array:
        library = _library()
        dimensions = _room("d_ocp_qp_dim_strsize")
        self._dimension_memory = _room("d_ocp_qp_dim_memsize", self.stages)
        library.d_ocp_qp_dim_create(self.stages, dimensions, self._dimension_memory)
        for i, count in enumerate(counts):
            last = i == self.stages
            for field, value in (
                ("nx", STATES if i > 0 else 0),
                ("nu", 0 if last else CONTROLS),
                ("nbx", 0),
                ("nbu", 0 if last else CONTROLS),
                ("ng", count),
                ("ns", count),
            ):
                library.d_ocp_qp_dim_set(field.encode(), i, value, dimensions)
        return dimensions

    def _create_arguments(self, tolerance: float) -> ctypes.Array:
        library = _library()
        arguments = _room("d_ocp_qp_ipm_arg_strsize")
        self._memory.append(_room("d_ocp_qp_ipm_arg_memsize", self._dimensions))
        library.d_ocp_qp_ipm_arg_create(self._dimensions, arguments, self._memory[-1])
        library.d_ocp_qp_ipm_arg_set_default(SPEED, arguments)
        limit = ctypes.c_int(ITERATION_LIMIT)
        library.d_ocp_qp_ipm_arg_set(b"iter_max", ctypes.byref(limit), arguments)
        value = ctypes.c_double(tolerance)
        for field in (b"tol_stat", b"tol_eq", b"tol_ineq", b"tol_comp"):
            library.d_ocp_qp_ipm_arg_set(field, ctypes.byref(value), arguments)
        return arguments

    def solve(self) -> tuple[bool, np.ndarray, int, float]:
        """Whether solved, controls (N, 3), iterations, processor seconds."""
        library = _library()
        begin = time.process_time()
        library.d_ocp_qp_ipm_solve(self._program, self._solution, self._arguments, self._work)
        seconds = time.process_time() - begin
        status, iterations = ctypes.c_int(), ctypes.c_int()
        library.d_ocp_qp_ipm_get_status(self._work, ctypes.byref(status))
        library.d_ocp_qp_ipm_get_iter(self._work, ctypes.byref(iterations))
        controls = np.zeros((self.stages, CONTROLS))
        for i in range(self.stages):
            library.d_ocp_qp_sol_get_u(i, self._solution, ctypes.c_void_p(controls[i].ctypes.data))
        return status.value == SUCCESS, controls, iterations.value, seconds
