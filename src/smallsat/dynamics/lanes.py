"""Four numbers side by side in a processor's vector registers, for compiled functions.

A function that is written for numbers and for arrays of them is compiled for lanes too, as it
stands, if it decides by `where`, `at_most` and their like in place of branches, which must be the
same in all lanes. Each lane then goes through the same operations in the same order as a number on
its own and ends with the same bits, whatever the others hold. LLVM has such vectors on every
processor, with as many registers as it takes: one for four numbers where they are 256 bits wide.
More lanes wait longer for the last of them.
"""

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import extending, types
from numba.core import cgutils
from numba.core.typeconv import Conversion
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin, lower_cast, models, register_model
from numba.np import arrayobj

LANES = 4

# The decorator's own type would ask callers for the first argument, which Numba gives.
intrinsic: Any = extending.intrinsic

_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_SCALARS = (types.Float, types.Integer)


class LanesType(types.Type):
    """Type of floats side by side."""

    def __init__(self) -> None:
        super().__init__(name=f"lanes({LANES})")

    def unify(self, typingctx: Any, other: types.Type) -> types.Type | None:
        """A variable that holds a number first and lanes later holds lanes."""
        return self if isinstance(other, _SCALARS) else None

    def can_convert_from(self, typingctx: Any, other: types.Type) -> Conversion | None:
        """A number stands for itself in every lane."""
        return Conversion.safe if isinstance(other, _SCALARS) else None


lanes = LanesType()


@register_model(LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, of: types.Type) -> None:
        super().__init__(manager, of, _VECTOR)


@lower_cast(types.Float, LanesType)
@lower_cast(types.Integer, LanesType)
def _in_every_lane(context: Any, builder: Any, source: Any, target: Any, value: Any) -> Any:
    number = context.cast(builder, value, source, types.float64)
    first = builder.insert_element(
        ir.Constant(_VECTOR, ir.Undefined), number, ir.Constant(ir.IntType(32), 0)
    )
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return builder.shuffle_vector(first, first, zeros)


def _common(of: tuple[types.Type, ...]) -> types.Type:
    """Lanes if any of the types is, else a float; none of them may be anything else."""
    if any(isinstance(one, LanesType) for one in of):
        return lanes
    return types.float64


def _arithmetic(operation: Any, build: Callable[..., Any]) -> None:
    """Make an operation of two known, of which one at least has lanes."""

    @infer_global(operation)
    class _Typing(AbstractTemplate):
        def generic(self, args: tuple[types.Type, ...], kws: Any) -> Any:
            known = all(isinstance(one, (LanesType, *_SCALARS)) for one in args)
            return signature(lanes, *args) if known and _common(args) is lanes else None

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        pair = (
            context.cast(builder, value, of, lanes)
            for value, of in zip(args, sig.args, strict=True)
        )
        return build(builder, *pair)

    for one in (LanesType, *_SCALARS):
        for other in (LanesType, *_SCALARS):
            if LanesType in (one, other):
                lower_builtin(operation, one, other)(lower)


for _operations, _build in (
    ((operator.add, operator.iadd), lambda builder, a, b: builder.fadd(a, b)),
    ((operator.sub, operator.isub), lambda builder, a, b: builder.fsub(a, b)),
    ((operator.mul, operator.imul), lambda builder, a, b: builder.fmul(a, b)),
    ((operator.truediv, operator.itruediv), lambda builder, a, b: builder.fdiv(a, b)),
):
    for _operation in _operations:
        _arithmetic(_operation, _build)


@infer_global(operator.neg)
class _Negative(AbstractTemplate):
    def generic(self, args: tuple[types.Type, ...], kws: Any) -> Any:
        return signature(lanes, lanes) if isinstance(args[0], LanesType) else None


@lower_builtin(operator.neg, LanesType)
def _negative(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return builder.fneg(args[0])


def _elementwise(args: tuple[types.Type, ...], build: Callable[..., Any]) -> Any:
    """Signature and code of a function of numbers or lanes that returns the like."""
    common = _common(args)

    def codegen(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        alike = [
            context.cast(builder, value, of, common)
            for value, of in zip(values, sig.args, strict=True)
        ]
        return build(builder, context.get_value_type(common), *alike)

    return common(*args), codegen


@intrinsic
def where(typingctx: Any, flag: Any, one: Any, other: Any) -> Any:
    """Take `one` where the flag is not 0, else `other`."""

    def build(builder: Any, kind: Any, flag: Any, one: Any, other: Any) -> Any:
        chosen = builder.fcmp_unordered("!=", flag, ir.Constant(kind, _filled(kind, 0.0)))
        return builder.select(chosen, one, other)

    return _elementwise((flag, one, other), build)


@intrinsic
def at_most(typingctx: Any, one: Any, other: Any) -> Any:
    """Whether a number is at most another, as 1.0 or 0.0."""
    return _elementwise(
        (one, other),
        lambda builder, kind, a, b: builder.uitofp(builder.fcmp_ordered("<=", a, b), kind),
    )


@intrinsic
def less(typingctx: Any, one: Any, other: Any) -> Any:
    """Whether a number is less than another, as 1.0 or 0.0."""
    return _elementwise(
        (one, other),
        lambda builder, kind, a, b: builder.uitofp(builder.fcmp_ordered("<", a, b), kind),
    )


@intrinsic
def larger(typingctx: Any, one: Any, other: Any) -> Any:
    """Return the larger of two; as Python's `max`, the first where they do not compare."""
    return _elementwise(
        (one, other),
        lambda builder, kind, a, b: builder.select(builder.fcmp_ordered(">", b, a), b, a),
    )


@intrinsic
def smaller(typingctx: Any, one: Any, other: Any) -> Any:
    """Return the smaller of two; as Python's `min`, the first where they do not compare."""
    return _elementwise(
        (one, other),
        lambda builder, kind, a, b: builder.select(builder.fcmp_ordered("<", b, a), b, a),
    )


@intrinsic
def root(typingctx: Any, one: Any) -> Any:
    """Return the square root."""
    return _elementwise((one,), lambda builder, kind, a: _call(builder, "llvm.sqrt", kind, a))


@intrinsic
def size(typingctx: Any, one: Any) -> Any:
    """Return the absolute value."""
    return _elementwise((one,), lambda builder, kind, a: _call(builder, "llvm.fabs", kind, a))


@intrinsic
def power(typingctx: Any, one: Any, exponent: Any) -> Any:
    """Raise to a power that is a number, in each lane as the processor's library has it."""

    def codegen(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        double = ir.DoubleType()
        function = builder.module.declare_intrinsic(
            "llvm.pow", [double], ir.FunctionType(double, [double, double])
        )
        index = ir.IntType(32)
        if sig.args[0] is types.float64:
            return builder.call(function, values)
        raised = values[0]
        for lane in (ir.Constant(index, k) for k in range(LANES)):
            alone = builder.call(function, [builder.extract_element(values[0], lane), values[1]])
            raised = builder.insert_element(raised, alone, lane)
        return raised

    return one(one, types.float64), codegen


@intrinsic
def some(typingctx: Any, flag: Any) -> Any:
    """Whether the flag of any lane is not 0."""

    def codegen(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        kind = context.get_value_type(sig.args[0])
        chosen = builder.fcmp_unordered("!=", values[0], ir.Constant(kind, _filled(kind, 0.0)))
        if sig.args[0] is types.float64:
            return chosen
        bits = ir.IntType(LANES)
        return builder.icmp_unsigned("!=", builder.bitcast(chosen, bits), ir.Constant(bits, 0))

    return types.boolean(_common((flag,))), codegen


@intrinsic
def as_lanes(typingctx: Any, array: Any) -> Any:
    """View a contiguous array of floats (..., LANES) as an array (...) of lanes."""
    view = types.Array(lanes, array.ndim - 1, "C", aligned=False)

    def codegen(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        old = arrayobj.make_array(sig.args[0])(context, builder, values[0])
        new = arrayobj.make_array(sig.return_type)(context, builder)
        arrayobj.populate_array(
            new,
            data=builder.bitcast(old.data, _VECTOR.as_pointer()),
            shape=cgutils.unpack_tuple(builder, old.shape)[:-1],
            strides=cgutils.unpack_tuple(builder, old.strides)[:-1],
            itemsize=context.get_constant(types.intp, 8 * LANES),
            meminfo=old.meminfo,
            parent=old.parent,
        )
        return arrayobj.impl_ret_borrowed(context, builder, sig.return_type, new._getvalue())

    return view(array), codegen


def _filled(kind: Any, number: float) -> Any:
    return number if kind == ir.DoubleType() else [number] * LANES


def _call(builder: Any, name: str, kind: Any, value: Any) -> Any:
    suffix = "f64" if kind == ir.DoubleType() else f"v{LANES}f64"
    function = builder.module.declare_intrinsic(
        f"{name}.{suffix}", fnty=ir.FunctionType(kind, [kind])
    )
    return builder.call(function, [value])
