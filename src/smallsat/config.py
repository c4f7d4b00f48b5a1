"""The configuration: read strictly, validated against its schema, with a folder for each run."""

import difflib
import hashlib
import json
import re
import reprlib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import jsonschema

from smallsat.catalogue import read_catalogue
from smallsat.errors import InputError
from smallsat.strict_yaml import parse_yaml, read_yaml

Config = dict[str, Any]

# Sizes of numbers: no quantity of a mission lies beyond, and squares and cubes stay numbers.
SMALLEST, LARGEST = 1e-30, 1e30

_Validator = jsonschema.validators.extend(
    jsonschema.Draft202012Validator,
    type_checker=jsonschema.Draft202012Validator.TYPE_CHECKER.redefine(
        "number", lambda _, value: _is_quantity(value)
    ).redefine("integer", lambda _, value: _is_quantity(value) and value == int(value)),
)
# A key of `--config`, as Snakemake takes it.
_KEY = re.compile(r"[a-zA-Z_][\w-]*\w")


def default_config(project: Path) -> Config:
    """The documents' own values, from the files in ``config/default``, one a study."""
    config: Config = {"run": ""}
    for study in read_catalogue(project / "data/published"):
        path = project / f"config/default/{study.name}.yaml"
        entries = read_yaml(path)
        if not isinstance(entries, dict) or list(entries) != [study.name]:
            raise InputError(f"{path}: needs the one key '{study.name}', with the study's values")
        config |= entries
    return validate(config, schema_of(project))


def schema_of(project: Path) -> dict[str, Any]:
    """The JSON schema of the configuration, from the files in ``config/schema``, one a study."""
    folder = project / "config/schema"
    sections: dict[str, Any] = {"run": {"type": "string", "pattern": "^[A-Za-z0-9_-]*$"}}
    definitions = read_yaml(folder / "common.yaml")
    for study in read_catalogue(project / "data/published"):
        section = read_yaml(folder / f"{study.name}.yaml")
        definitions |= section.pop("$defs", {})
        sections[study.name] = section
    return {
        "$defs": definitions,
        "type": "object",
        "additionalProperties": False,
        "required": list(sections),
        "properties": sections,
    }


def overlaid_config(
    default: Config, schema: dict[str, Any], files: Iterable[Path], entries: Iterable[str]
) -> Config:
    """The default with the values that a person gave on top, validated.

    Parameters
    ----------
    default, schema
        The documents' own values, and the JSON schema of the configuration.
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
    config = default
    for path in files:
        config = merged(config, read_overlay(path))
    for entry in entries:
        config = merged(config, parse_entry(entry, schema))
    return validate(config, schema)


def read_overlay(path: Path) -> Config:
    """The values in a file of a person; one without values, or without keys, is refused."""
    overlay = read_yaml(path)
    if not isinstance(overlay, dict):
        found = "empty" if overlay is None else f"{_shown(overlay)}, which has no keys"
        raise InputError(f"{path}: {found}; give keys such as 'transfer:' with values below them")
    return overlay


def parse_entry(entry: str, schema: dict[str, Any] | None = None) -> Config:
    """One ``key=value`` of the command line, as an overlay; the value is YAML or plain text."""
    key, equals, value = entry.partition("=")
    if not equals or not _KEY.fullmatch(key):
        raise InputError(
            f"--config {_shown(entry)}: no setting; give key=value, "
            f"""such as 'transfer={{"problem": {{"thrust": 0.2}}}}'"""
        )
    if (schema or {}).get("properties", {}).get(key, {}).get("type") == "string":
        return {key: value}
    return {key: parse_yaml(value, f"--config {key}")}


def validate(config: Config, schema: dict[str, Any]) -> Config:
    """Check a configuration against its JSON schema and return it in one form.

    Where the schema asks for a number, 1 becomes 1.0, and where it asks for an integer, 2.0 becomes
    2; so equal configurations are equal to the letter. A name such as 2024 becomes a text.

    Raises
    ------
    InputError
        Naming the first offending key, its value and what is allowed.
    """
    config = _in_one_form(config, schema, schema)
    errors = sorted(
        _Validator(schema).iter_errors(config),
        key=lambda error: [str(part) for part in error.absolute_path],
    )
    if errors:
        raise InputError(_one_line(errors[0]))
    return config


def run_folder(config: Config, default: Config) -> str:
    """Folder of a run: the project itself for the default, `runs/<name>` for anything else."""
    if {**config, "run": ""} == {**default, "run": ""}:
        return "."
    digest = hashlib.sha256(json.dumps(config, sort_keys=True).encode()).hexdigest()[:8]
    return f"runs/{config.get('run') or digest}"


def lookup(config: Config, key: str) -> Any:
    """Value at a dotted key such as ``mars.orbits.lmo.altitude_km`` or ``transfer.degrees.0``."""
    value: Any = config
    for part in key.split("."):
        try:
            value = value[int(part)] if isinstance(value, list) else value[part]
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


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_quantity(value: Any) -> bool:
    return _is_number(value) and (value == 0 or SMALLEST <= abs(value) <= LARGEST)


def _in_one_form(value: Any, schema: Any, root: dict[str, Any]) -> Any:
    if "$ref" in schema:
        schema = root["$defs"][schema["$ref"].removeprefix("#/$defs/")]
    if isinstance(value, dict):
        properties = schema.get("properties", {})
        return {k: _in_one_form(v, properties.get(k, {}), root) for k, v in value.items()}
    if isinstance(value, list):
        return [_in_one_form(v, schema.get("items", {}), root) for v in value]
    wanted = schema.get("type")
    if wanted == "number" and _is_quantity(value):
        return float(value)
    if wanted == "integer" and isinstance(value, float) and value.is_integer():
        return int(value)
    if wanted == "string" and isinstance(value, int) and not isinstance(value, bool):
        return str(value)
    return value


def _one_line(error: jsonschema.ValidationError) -> str:
    path = ".".join(str(p) for p in error.absolute_path)
    if error.validator == "additionalProperties":
        allowed = list(error.schema.get("properties", {}))
        unknown = sorted(set(error.instance) - set(allowed))[0]
        key = f"{path}.{unknown}" if path else unknown
        close = difflib.get_close_matches(unknown, allowed, n=1)
        hint = f"did you mean '{close[0]}'?" if close else "remove it"
        return f"config key {_shown(key)}: unknown; allowed here: {', '.join(allowed)}; {hint}"
    if error.validator == "required":
        missing = error.message.split("'")[1]
        return f"config key '{f'{path}.{missing}' if path else missing}': missing; add it"
    where = f"config key '{path}'" if path else "configuration"
    if (
        error.validator == "type"
        and _is_number(error.instance)
        and not _is_quantity(error.instance)
    ):
        size = f"must be a number, 0 or between {SMALLEST:g} and {LARGEST:g} in size"
        return f"{where}: {_shown(error.instance)} is not allowed; {size}"
    return f"{where}: {_shown(error.instance)} is not allowed; {', '.join(_allowed(error))}"


def _shown(value: Any) -> str:
    """A value for a message: on one line, and not without end."""
    short = reprlib.Repr()
    short.maxstring = short.maxother = short.maxlong = 60
    return short.repr(value)


def _allowed(error: jsonschema.ValidationError) -> Iterator[str]:
    words = {
        "type": "must be of type {}",
        "minimum": "must be at least {}",
        "maximum": "must be at most {}",
        "exclusiveMinimum": "must be greater than {}",
        "exclusiveMaximum": "must be less than {}",
        "enum": "must be one of {}",
        "minItems": "needs at least {} items",
        "maxItems": "takes at most {} items",
        "pattern": "must match {}",
        "multipleOf": "must be a multiple of {}",
        "uniqueItems": "items must differ",
    }
    schema = error.schema
    assert isinstance(schema, dict)
    yield from (text.format(schema[name]) for name, text in words.items() if name in schema)
