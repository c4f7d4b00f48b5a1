"""Reading YAML so that a text means one thing: what is ambiguous or lost elsewhere is refused.

PyYAML reads YAML 1.1, in which ``12:30`` is 750, ``010`` is 8, ``no`` is false, ``1e-3`` is a text,
and the first of two sections with one name is lost. Here numbers and booleans are those of JSON and
of the core schema of YAML 1.2; anything else without quotes is a text, which a schema then refuses
where it asks for a number.
"""

import re
from pathlib import Path
from typing import Any

import yaml

from smallsat.errors import InputError


class _Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]
    """Plain data of YAML 1.2's core schema; a key twice, or one that is no text, is an error."""

    yaml_implicit_resolvers: dict[str, list[tuple[str, re.Pattern[str]]]] = {}  # noqa: RUF012


_TAG = "tag:yaml.org,2002:"
_INTEGER = r"-?(?:0|[1-9]\d*)"
for _name, _pattern, _first in (
    ("null", r"~|null|Null|NULL|", ["~", "n", "N", ""]),
    ("bool", r"true|True|TRUE|false|False|FALSE", list("tTfF")),
    ("int", _INTEGER, list("-0123456789")),
    (
        "float",
        rf"{_INTEGER}(?:\.\d*)?(?:[eE][-+]?\d+)?|-?\.\d+(?:[eE][-+]?\d+)?",
        list("-.0123456789"),
    ),
):
    _Loader.add_implicit_resolver(_TAG + _name, re.compile(rf"(?:{_pattern})\Z"), _first)


def _mapping(loader: _Loader, node: yaml.MappingNode) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key_node, value_node in node.value:
        key = loader.construct_object(key_node, deep=True)
        if not isinstance(key, str):
            problem = f"the key {key!r} is no text; put it in quotes"
            raise yaml.MarkedYAMLError(problem=problem, problem_mark=key_node.start_mark)
        if key in found:
            problem = f"the key '{key}' stands here a second time; keep one of them"
            raise yaml.MarkedYAMLError(problem=problem, problem_mark=key_node.start_mark)
        found[key] = loader.construct_object(value_node, deep=True)
    return found


def _sequence(loader: _Loader, node: yaml.SequenceNode) -> list[Any]:
    return [loader.construct_object(item, deep=True) for item in node.value]


_Loader.add_constructor(f"{_TAG}map", _mapping)
_Loader.add_constructor(f"{_TAG}seq", _sequence)


def _refuse_tags(text: str | bytes) -> None:
    """A tag makes a value what it does not look like, and one without a name is lost."""
    if (b"!" if isinstance(text, bytes) else "!") not in text:  # type: ignore[operator]
        return
    event: Any
    for event in yaml.parse(text, Loader=_Loader):
        if tag := getattr(event, "tag", None):
            problem = f"the tag {tag}; write the value without it, or in quotes"
            raise yaml.MarkedYAMLError(problem=problem, problem_mark=event.start_mark)


def parse_yaml(text: str | bytes, name: str) -> Any:
    """The data of a YAML text: mappings with text keys, lists, texts, numbers, booleans, None.

    Parameters
    ----------
    text
        The text, or the bytes of a file in UTF-8 or UTF-16.
    name
        What it is called in messages, such as the path of its file.

    Raises
    ------
    InputError
        Naming the line and what is wrong with it.
    """
    try:
        _refuse_tags(text)
        return yaml.load(text, Loader=_Loader)
    except yaml.MarkedYAMLError as error:
        line = f"line {error.problem_mark.line + 1}: " if error.problem_mark else ""
        problem = " ".join(str(error.problem or error.context).split())
        raise InputError(f"{name}: {line}not valid YAML: {problem}") from None
    except (yaml.YAMLError, ValueError, TypeError, LookupError, AttributeError):
        # A character or a number that no text may have, or a tag that does not fit its value.
        raise InputError(f"{name}: not valid YAML; write plain text, numbers and lists") from None
    except RecursionError:
        raise InputError(f"{name}: nested too deeply; a configuration has few levels") from None


def read_yaml(path: Path) -> Any:
    """The data of a YAML file; one that is missing, unreadable or no YAML is an `InputError`."""
    return parse_yaml(read_bytes(path), str(path))


def read_bytes(path: Path) -> bytes:
    """The content of a file that a person named; if there is none, an `InputError` says so."""
    try:
        return Path(path).read_bytes()
    except FileNotFoundError:
        raise InputError(f"{path}: no such file; correct the path") from None
    except IsADirectoryError:
        raise InputError(f"{path}: a folder, where a file is needed; name the file") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "no path of a file"
        raise InputError(f"{path}: cannot be read ({reason}); name another file") from None
