"""The configuration: read strictly, a typed section a study, with a folder for each run."""

import difflib
import hashlib
import json
import re
import reprlib
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic import AfterValidator, ValidationError, create_model

from smallsat.catalogue import read_catalogue, section_type
from smallsat.errors import InputError
from smallsat.quantities import Part, Section, Text
from smallsat.strict_yaml import parse_yaml, read_yaml

# Plain data, as a file has it.
Values = dict[str, Any]

# A key of `--config`, as Snakemake takes it.
_KEY = re.compile(r"[a-zA-Z_][\w-]*\w")
_TYPES = {float: "number", int: "integer", str: "string", bool: "boolean", tuple: "array"}
_LIMITS = {
    "gt": "must be greater than {}",
    "ge": "must be at least {}",
    "lt": "must be less than {}",
    "le": "must be at most {}",
    "min_length": "needs at least {} items",
    "max_length": "takes at most {} items",
}


def _folder_name(name: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9_-]*", name):
        raise ValueError("must be of letters, digits, '-' and '_'")
    return name


class Config(Part):
    """The configuration: the name of a run; a model of it has a section for each study beside."""

    run: Annotated[Text, AfterValidator(_folder_name)]


@cache
def model_of(project: Path) -> type[Config]:
    """The type of the whole configuration of a project."""
    studies = [study.name for study in read_catalogue(project / "data/published")]
    sections: dict[str, Any] = {study: section_type(study) for study in studies}
    return create_model("Configuration", __base__=Config, **sections)


def default_config(project: Path) -> Config:
    """The documents' own values, from the files in ``config/default``, one a study."""
    values: Values = {"run": ""}
    for study in read_catalogue(project / "data/published"):
        path = project / f"config/default/{study.name}.yaml"
        entries = read_yaml(path)
        if not isinstance(entries, dict) or list(entries) != [study.name]:
            raise InputError(f"{path}: needs the one key '{study.name}', with the study's values")
        values |= entries
    return validate(values, model_of(project))


def overlaid_config(default: Config, files: Iterable[Path], entries: Iterable[str]) -> Config:
    """The default with the values that a person gave on top, validated.

    Parameters
    ----------
    default
        The documents' own values.
    files
        YAML or JSON files, as given to ``--configfile``; later ones win.
    entries
        Texts such as ``transfer={"problem": {"thrust": 0.2}}``, as given to ``--config``; they win
        over the files.

    Raises
    ------
    InputError
        Naming the file or key, the value and what is allowed.
    """
    values = default.model_dump()
    for path in files:
        values = merged(values, read_overlay(path))
    for entry in entries:
        values = merged(values, parse_entry(entry))
    return validate(values, type(default))


def read_overlay(path: Path) -> Values:
    """The values in a file of a person; one without values, or without keys, is refused."""
    overlay = read_yaml(path)
    if not isinstance(overlay, dict):
        found = "empty" if overlay is None else f"{_shown(overlay)}, which has no keys"
        raise InputError(f"{path}: {found}; give keys such as 'transfer:' with values below them")
    return overlay


def parse_entry(entry: str) -> Values:
    """One ``key=value`` of the command line, as an overlay; a value is YAML, a name plain text."""
    key, equals, value = entry.partition("=")
    if not equals or not _KEY.fullmatch(key):
        raise InputError(
            f"--config {_shown(entry)}: no setting; give key=value, "
            f"""such as 'transfer={{"problem": {{"thrust": 0.2}}}}'"""
        )
    return {key: value if key == "run" else parse_yaml(value, f"--config {key}")}


def validate(values: Values, model: type[Section]) -> Section:
    """Check values against a model and return them in one form.

    Where the model asks for a number, 1 becomes 1.0, and where it asks for an integer, 2.0 becomes
    2; so equal configurations are equal to the letter. A name such as 2024 becomes a text.

    Raises
    ------
    InputError
        Naming the first offending key, its value and what is allowed.
    """
    try:
        return model.model_validate(values)
    except ValidationError as error:
        # What is wrong with an item comes before what is wrong with its list.
        first = min(error.errors(), key=lambda one: [*map(str, one["loc"]), "~"])
        raise InputError(_one_line(model, **first)) from None


def run_folder(config: Config, default: Config) -> str:
    """Folder of a run: the project itself for the default, `runs/<name>` for anything else."""
    if config.with_(run="") == default.with_(run=""):
        return "."
    return f"runs/{config.run or hashlib.sha256(as_json(config).encode()).hexdigest()[:8]}"


def as_json(value: Any) -> str:
    """Plain data or parts as text; sorted, so that equal values are equal text."""
    return json.dumps(value, sort_keys=True, default=Part.model_dump)


def departures(config: Values, default: Values) -> list[Values]:
    """Where a configuration departs from the documents' own: ``key``, ``value`` and ``default``.

    Parameters
    ----------
    config, default
        As plain data, with the same keys; the name of the run is none of it.
    """
    own, reference = ({**values, "run": ""} for values in (config, default))
    return [
        {"key": key, "value": ours, "default": theirs}
        for (key, ours), (_, theirs) in zip(_leaves(own), _leaves(reference), strict=True)
        if ours != theirs
    ]


def lookup(config: Any, key: str) -> Any:
    """Value at a dotted key such as ``mars.orbits.lmo.altitude_km`` or ``transfer.degrees.0``."""
    value = config
    for part in key.split("."):
        try:
            value = value[int(part)] if isinstance(value, tuple) else value[part]
        except (KeyError, IndexError, ValueError, TypeError):
            raise InputError(f"config key '{key}': not in the configuration") from None
    return value


def merged(config: Any, overlay: Any) -> Any:
    """A configuration with an overlay's values in place of its own; a list is one value."""
    if isinstance(config, dict) and isinstance(overlay, dict):
        return config | {
            key: merged(config[key], value) if key in config else value
            for key, value in overlay.items()
        }
    return overlay


def _leaves(value: Any, key: str = "") -> Iterator[tuple[str, str]]:
    if isinstance(value, dict):
        for name in sorted(value):
            yield from _leaves(value[name], f"{key}.{name}" if key else name)
    else:
        yield key, json.dumps(value)


def _one_line(model: type[Part], type: str, loc: tuple[Any, ...], input: Any, **more: Any) -> str:
    key = ".".join(map(str, loc))
    if type == "extra_forbidden":
        part, _ = _kind(model, loc[:-1])
        known = [field.alias or name for name, field in part.model_fields.items()]
        close = difflib.get_close_matches(loc[-1], known, n=1)
        hint = f"did you mean '{close[0]}'?" if close else "remove it"
        return f"config key {_shown(key)}: unknown; allowed here: {', '.join(known)}; {hint}"
    if type == "missing":
        return f"config key '{key}': missing; add it"
    where = f"config key '{key}'" if key else "configuration"
    allowed = more["ctx"]["error"] if type == "value_error" else _allowed(model, loc)
    return f"{where}: {_shown(input)} is not allowed; {allowed}"


def _shown(value: Any) -> str:
    """A value for a message: on one line, and not without end."""
    short = reprlib.Repr()
    short.maxstring = short.maxother = short.maxlong = 60
    return short.repr(value)


def _kind(model: type[Part], place: Iterable[Any]) -> tuple[Any, list[Any]]:
    """The type at a place of a model, and its limits."""
    kind: Any = model
    limits: list[Any] = []
    for key in place:
        if isinstance(key, int):
            kind, limits = get_args(kind)[0], []
        else:
            fields = kind.model_fields
            field = fields[next(name for name in fields if key in (name, fields[name].alias))]
            kind, limits = field.annotation, field.metadata
        if get_origin(kind) is Annotated:
            kind, *limits = get_args(kind)
    return kind, limits


def _allowed(model: type[Part], place: Iterable[Any]) -> str:
    kind, limits = _kind(model, place)
    if get_origin(kind) is Literal:
        return f"must be one of {list(get_args(kind))}"
    # The last of several limits of one sort is the strictest.
    found = {
        name: text.format(value)
        for limit in limits
        for name, text in _LIMITS.items()
        if (value := getattr(limit, name, None)) is not None
    }
    of_type = f"must be of type {_TYPES.get(get_origin(kind) or kind, 'object')}"
    return ", ".join([of_type, *found.values()])
