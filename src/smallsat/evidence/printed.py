"""Reading a printed literal: its value, and how finely it was printed."""

import ast
import math
import operator
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

LOST = "(illegible)"

_DECIMAL = re.compile(r"[+-]?(\d+)(\.(\d+))?(e([+-]?\d+))?", re.IGNORECASE)
_OPERATORS: dict[type, Callable[..., float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
}


@dataclass(frozen=True)
class Printed:
    """A printed number.

    Attributes
    ----------
    value
        The number.
    half_unit
        Half a unit of the last printed digit; 0 for an exact expression such as 1/6.
    bound
        True for an upper bound, printed as ``<0.01``.
    """

    value: float
    half_unit: float
    bound: bool = False

    def __float__(self) -> float:
        """The number, so that a list of printed numbers makes an array of numbers."""
        return self.value

    def matches(self, computed: float) -> bool:
        """Whether a computed number is equal to the printed digits."""
        if self.bound:
            return abs(computed) < self.value
        # The guard is for rounding only, binary and to the digits of a results file: half a unit
        # must count as equal, and so must 1/6.
        guard = 1e-11 * max(abs(self.value), abs(computed), 1e-300)
        return abs(computed - self.value) <= self.half_unit + guard

    def truncates(self, computed: float) -> bool:
        """Whether the printed digits are the computed number cut off instead of rounded."""
        unit = 2 * self.half_unit
        return 0 <= math.copysign(1, self.value) * (computed - self.value) < unit


def parse_printed(literal: str) -> Printed | None:
    """Parse a literal as printed; None for text and for a value lost from the document.

    Understands decimals (``-0.7390``, ``1e-8``, ``1,500,000``), upper bounds (``<0.01``),
    arithmetic with square roots (``sqrt(2)/2``) and a chain of equal expressions
    (``20/120 = 1/6``), of which the last counts.
    """
    text = literal.strip()
    if text.startswith("<") and not text.startswith("<="):
        inner = parse_printed(text[1:])
        return Printed(inner.value, inner.half_unit, bound=True) if inner else None
    text = text.split("=")[-1].strip() if not text.startswith(("<=", ">=")) else text
    plain = text.replace(",", "")
    if match := _DECIMAL.fullmatch(plain):
        exponent = int(match[5] or 0) - len(match[3] or "")
        return Printed(float(plain), 0.5 * 10.0**exponent)
    value = _arithmetic(text)
    return None if value is None else Printed(value, 0.0)


def looks_numeric(literal: str) -> bool:
    """Whether a literal is meant as a number, so that failing to parse it is a damage."""
    return bool(re.match(r"[<+-]?\s*[\d.]", literal.strip()))


def _arithmetic(text: str) -> float | None:
    try:
        return _evaluate(ast.parse(text.replace("^", "**"), mode="eval").body)
    except (SyntaxError, ValueError, ZeroDivisionError, TypeError):
        return None


def _evaluate(node: Any) -> float:
    match node:
        case ast.Constant(value=int() | float() as number):
            return float(number)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_evaluate(left), _evaluate(right))
        case ast.UnaryOp(op=op, operand=operand) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_evaluate(operand))
        case ast.Call(func=ast.Name(id="sqrt"), args=[argument]):
            return math.sqrt(_evaluate(argument))
    raise ValueError(f"not arithmetic: {ast.dump(node)}")
