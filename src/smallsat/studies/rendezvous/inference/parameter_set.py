"""A parameter set: values and readings of what the document leaves open, put into a section."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeVar, get_args

from smallsat.studies.rendezvous.configuration import Bounds, Configuration, Flight, Readings

Section = TypeVar("Section", bound=Flight)

# Numbers that are fitted, in the order of their bounds.
FITTED = list(Bounds.model_fields)
# Readings that are searched, with their options; how delta-v was summed is read off afterwards.
OPTIONS: dict[str, tuple[Any, ...]] = {
    name: (False, True) if field.annotation is bool else get_args(field.annotation)
    for name, field in Readings.model_fields.items()
    if name != "delta_v"
}
# One search each: a reading is held at one of its options, everything else is free.
SEARCHES = [
    f"{reading}-{option}".replace("_", "-").replace(" ", "-").lower()
    for reading, options in OPTIONS.items()
    for option in options
]


@dataclass(frozen=True)
class ParameterSet:
    """Values of `FITTED` and options of `OPTIONS`, by name."""

    values: Mapping[str, float]
    readings: Mapping[str, Any]

    @classmethod
    def of_row(cls, row: Mapping[Any, Any]) -> "ParameterSet":
        """The set that stands in a row of a table of sets."""
        return cls(
            {name: float(row[name]) for name in FITTED},
            {
                name: next(option for option in options if str(option) == str(row[name]))
                for name, options in OPTIONS.items()
            },
        )

    @classmethod
    def configured(cls, section: Flight) -> "ParameterSet":
        """The set that a section has."""
        inferred = section.inferred
        return cls(
            {name: inferred[name] for name in FITTED},
            {name: inferred.readings[name] for name in OPTIONS},
        )

    @property
    def row(self) -> dict[str, Any]:
        """One row of a table of sets; readings as text."""
        return {**self.values, **{name: str(option) for name, option in self.readings.items()}}

    def put_into(self, section: Section) -> Section:
        """The section with these inferred values and readings."""
        inferred = section.inferred
        return section.with_(
            inferred=inferred.with_(
                **self.values, readings=inferred.readings.with_(**self.readings)
            )
        )


def member(section: Configuration, row: Mapping[Any, Any]) -> Configuration:
    """The section with a set of the ensemble put in, and the ensemble's sizes."""
    sizes, studies = section.inference.ensemble, section.studies
    robustness = studies.robustness
    changed = ParameterSet.of_row(row).put_into(section)
    readings = changed.inferred.readings.with_(delta_v=row["delta_v"])
    return changed.with_(
        inferred=changed.inferred.with_(readings=readings),
        studies=studies.with_(
            share=1.0,
            samples=min(sizes.samples, studies.samples),
            robustness=robustness.with_(
                states=min(sizes.states, robustness.states),
                runs=min(sizes.runs, robustness.runs),
                variant_runs=min(sizes.runs, robustness.variant_runs),
            ),
        ),
    )


def fixed_reading(search: str) -> tuple[str, Any]:
    """The reading and the option that a search of `SEARCHES` holds."""
    pairs = [(reading, option) for reading, options in OPTIONS.items() for option in options]
    return pairs[SEARCHES.index(search)]
