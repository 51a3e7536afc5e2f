"""The settings of a drawing as words of the command line."""

from __future__ import annotations

import difflib
import functools
import json
import numbers
import os
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ._command import command, run

# Options that files of settings cannot hold, so the schema does not list them.
_UNLISTED = {"preset", "params", "save-scene"}
# Options that this package gives itself, keys of scenes, and what would move a machine.
_NOT_HERE = {"photograph", "purpose", "output", "format", "json", "dry-run", "send", "yes"}
# How a tuple of numbers is written.
_SEPARATORS = {"size": "x", "page": "x", "at": ",", "crop": ","}
_DEFAULT_STYLE = "hedcut"


def words_of(settings: Mapping[str, Any], is_scene: bool) -> list[str]:
    """The words that say these settings; a ``None`` says nothing. A scene may name its own style."""
    given = {name: value for name, value in settings.items() if value is not None}
    words: list[str] = []
    for name, value in given.items():
        option = name.replace("_", "-")
        if option in _options():
            words += _option(name, option, value)
        elif name in _parameters(_style(given, is_scene)):
            words.append(f"--set={name}={_parameter(value)}")
        else:
            raise TypeError(_unknown(name, _style(given, is_scene)))
    return words


def _style(given: Mapping[str, Any], is_scene: bool) -> str | None:
    """The style, if it is clear from the settings alone."""
    if "style" in given:
        return str(given["style"])
    return None if is_scene or "preset" in given or "params" in given else _DEFAULT_STYLE


def _options() -> Mapping[str, str]:
    """The options of ``draw`` and what each takes."""
    return _options_of(command())


def _parameters(style: str | None) -> frozenset[str]:
    """The parameters of a style, or of all."""
    return _parameters_of(command(), style)


@functools.lru_cache(maxsize=4)
def _schema_of(program: str) -> Mapping[str, Any]:
    """What the command at this path knows. It is the key, so that another command is asked anew."""
    properties: Mapping[str, Any] = json.loads(run(["schema"]).data)["properties"]
    return properties


@functools.lru_cache(maxsize=4)
def _options_of(program: str) -> Mapping[str, str]:
    listed = {name: str(about.get("type", "")) for name, about in _schema_of(program).items()}
    return {name: kind for name, kind in (listed | dict.fromkeys(_UNLISTED, "")).items() if name not in _NOT_HERE}


@functools.lru_cache(maxsize=32)
def _parameters_of(program: str, style: str | None) -> frozenset[str]:
    if style is None:
        return frozenset(_schema_of(program)["set"]["properties"])
    return frozenset(about["name"] for about in json.loads(run(["styles", "--json", "--", style]).data)["parameters"])


def _option(name: str, option: str, value: Any) -> Iterator[str]:
    kind = _options()[option]
    if kind == "boolean":
        if not isinstance(value, (bool, np.bool_)):
            raise TypeError(f"{name} is True or False, not {value!r}")
        return iter([f"--{option}"] if value else [])
    if kind == "object" or option == "set-profile" and isinstance(value, Mapping):
        return _pairs(name, option, value)
    if kind == "array":
        members = value if isinstance(value, (list, tuple)) else [value]
        return (f"--{option}={_member(name, member)}" for member in members)
    return iter([f"--{option}={_value(name, option, value)}"])


def _pairs(name: str, option: str, value: Any) -> Iterator[str]:
    if not isinstance(value, Mapping):
        raise TypeError(f"{name} is a dict, such as {name}={{'hair': 'hair.png'}}, not {value!r}")
    return (f"--{option}={key}={_parameter(item)}" for key, item in value.items())


def _member(name: str, value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{key} = {_toml(item)}" for key, item in value.items())
    return _value(name, name, value)


def _value(name: str, option: str, value: Any) -> str:
    if isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} takes a value, not {value!r}")
    if isinstance(value, (list, tuple)) and option in _SEPARATORS:
        return _SEPARATORS[option].join(_parameter(item) for item in value)
    return _parameter(value)


def _parameter(value: Any) -> str:
    """One value as text. A number needs no unit: lengths are millimetres."""
    if isinstance(value, (bool, np.bool_)):
        return "on" if value else "off"
    if isinstance(value, str):
        return value
    if isinstance(value, os.PathLike):
        return str(os.fspath(value))
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return np.format_float_positional(float(value), trim="-")
    if isinstance(value, (list, tuple)):
        return "[" + ",".join(_parameter(item) for item in value) + "]"
    raise TypeError(f"a setting is text, a number, a path or True or False, not {value!r}")


def _toml(value: Any) -> str:
    """A value in the table of a region."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(str(os.fspath(value)), ensure_ascii=False)
    return _parameter(value)


def _unknown(name: str, style: str | None) -> str:
    if name.replace("_", "-") in _NOT_HERE:
        return f"{name} is no setting of drypoint.draw; Drawing.save writes files, in the format of the path's ending"
    owner = f"the style {style}" if style else "any style"
    message = f"'{name}' is neither an option of drypoint nor a parameter of {owner}"
    options = {option.replace("-", "_") for option in _options()}
    if near := difflib.get_close_matches(name, sorted(options | _parameters(style)), n=3, cutoff=0.6):
        return f"{message}; did you mean {' or '.join(near)}?"
    if name in _parameters(None):
        return f"{message}; it belongs to another style"
    return f"{message}; `drypoint draw --help` and `drypoint styles {style or 'NAME'}` list them"
