"""The configuration: validated against its schema, and given a folder of its own if it deviates."""

import difflib
import hashlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import yaml

from smallsat.errors import InputError

Config = dict[str, Any]


def read_yaml(path: Path) -> Any:
    """Read a YAML file; a file that is missing or no YAML is an `InputError`."""
    try:
        return yaml.safe_load(Path(path).read_text())
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = f" in line {mark.line + 1}" if mark else ""
        raise InputError(f"{path}: not valid YAML{line}; correct it") from None


def validate(config: Config, schema: dict[str, Any]) -> Config:
    """Check a configuration against its JSON schema and return it with numbers as numbers.

    Values given on the command line inside braces arrive as text; where the schema asks for
    something else they are read as YAML first.

    Raises
    ------
    InputError
        Naming the first offending key, its value and what is allowed.
    """
    config = _numbers_as_numbers(config, schema, schema)
    validator = jsonschema.Draft202012Validator(schema)
    errors = sorted(validator.iter_errors(config), key=lambda e: [str(p) for p in e.absolute_path])
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


def _numbers_as_numbers(value: Any, schema: dict[str, Any], root: dict[str, Any]) -> Any:
    if "$ref" in schema:
        schema = root["$defs"][schema["$ref"].removeprefix("#/$defs/")]
    if isinstance(value, dict):
        properties = schema.get("properties", {})
        return {k: _numbers_as_numbers(v, properties.get(k, {}), root) for k, v in value.items()}
    if isinstance(value, list):
        return [_numbers_as_numbers(v, schema.get("items", {}), root) for v in value]
    if isinstance(value, str) and schema.get("type") in ("number", "integer", "boolean"):
        try:
            return yaml.safe_load(value)
        except yaml.YAMLError:
            return value
    return value


def _one_line(error: jsonschema.ValidationError) -> str:
    path = ".".join(str(p) for p in error.absolute_path)
    if error.validator == "additionalProperties":
        allowed = list(error.schema.get("properties", {}))
        unknown = sorted(set(error.instance) - set(allowed))[0]
        key = f"{path}.{unknown}" if path else unknown
        close = difflib.get_close_matches(unknown, allowed, n=1)
        hint = f"did you mean '{close[0]}'?" if close else "remove it"
        return f"config key '{key}': unknown; allowed here: {', '.join(allowed)}; {hint}"
    if error.validator == "required":
        missing = error.message.split("'")[1]
        return f"config key '{f'{path}.{missing}' if path else missing}': missing; add it"
    return f"config key '{path}': {error.instance!r} is not allowed; {', '.join(_allowed(error))}"


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
