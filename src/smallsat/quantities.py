"""What a configuration is made of: its parts, and the kinds of values that stand in them."""

from itertools import pairwise
from typing import Annotated, Any, Self, TypeVar

from annotated_types import Ge, Gt, Interval, Le, Len, Lt
from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Strict, TypeAdapter

# Sizes of numbers: no quantity of a mission lies beyond, and squares and cubes stay numbers.
SMALLEST, LARGEST = 1e-30, 1e30

T = TypeVar("T")


class Part(BaseModel):
    """A part of the configuration: what stands in it is of its kind, and stays as it is."""

    model_config = ConfigDict(frozen=True, extra="forbid", serialize_by_alias=True)

    def __getitem__(self, key: str) -> Any:
        """The value of a key that another value names; KeyError where there is none."""
        name = key.replace("-", "_")
        if name not in type(self).model_fields:
            raise KeyError(key)
        return getattr(self, name)

    def only(self, kind: "type[Part]") -> dict[str, Any]:
        """The values of a kind of part that this is one of, as plain data."""
        return TypeAdapter(kind).dump_python(self)

    def with_(self, **changes: Any) -> Self:
        """The same part with some values changed."""
        return self.model_validate(dict(self) | changes, by_alias=False, by_name=True)


# Of one study.
Section = TypeVar("Section", bound=Part)


def _sized(value: Any) -> Any:
    """Any value but a number that is none, or is of no size that is thought of."""
    if isinstance(value, int | float) and not (value == 0 or SMALLEST <= abs(value) <= LARGEST):
        raise ValueError(f"must be a number, 0 or between {SMALLEST:g} and {LARGEST:g} in size")
    return value


def _whole(value: Any) -> Any:
    return int(value) if isinstance(value, float) and value.is_integer() else value


def _text(value: Any) -> Any:
    """A name such as 2024 is a text."""
    return str(value) if type(value) is int else value


def _differing(values: tuple[T, ...]) -> tuple[T, ...]:
    if len(set(values)) < len(values):
        raise ValueError("items must differ")
    return values


def _growing(values: tuple[Any, ...]) -> tuple[Any, ...]:
    if any(first >= second for first, second in pairwise(values)):
        raise ValueError("must grow from value to value")
    return values


Number = Annotated[float, Strict(), BeforeValidator(_sized)]
Positive = Annotated[Number, Gt(0)]
NonNegative = Annotated[Number, Ge(0)]
Fraction = Annotated[Number, Ge(0), Lt(1)]
Percent = Annotated[Number, Gt(0), Le(100)]
# Of an orbit, deg.
Inclination = Annotated[Number, Interval(ge=0, le=180)]

Integer = Annotated[int, Strict(), BeforeValidator(_whole), BeforeValidator(_sized)]
Count = Annotated[Integer, Ge(1)]
Seed = Annotated[Integer, Ge(0)]

Text = Annotated[str, Strict(), BeforeValidator(_text)]

Vector = Annotated[tuple[Number, Number, Number], Len(3, 3)]
# Values of a kind without one twice, with one at least, and from the least to the largest.
Differing = Annotated[tuple[T, ...], AfterValidator(_differing)]
Several = Annotated[Differing[T], Len(1)]
Growing = Annotated[tuple[T, ...], AfterValidator(_growing), Len(1)]
Range = Annotated[tuple[T, T], AfterValidator(_growing), Len(2, 2)]
