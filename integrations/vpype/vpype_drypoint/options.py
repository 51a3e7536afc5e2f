"""The options of `drypoint draw` as options of a vpype command."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterator, Mapping
from typing import Any

import click
import vpype_cli

from .command import command, run

# What the pipeline decides, keys of scenes, and what would move a machine.
_NOT_HERE = {"photograph", "purpose", "output", "format", "embed", "json", "dry-run", "send", "yes"}
# Options that files of settings cannot hold, so the schema does not list them.
_UNLISTED = {
    "preset": "Options for a purpose, such as wsj-column; `drypoint presets` lists them. Options beside it win.",
    "params": "Parameters of the style, or any options, from a TOML file.",
}
# Their values hold % or braces of their own, which vpype would take for expressions and properties.
_LITERAL = {"crop", "region", "set-profile"}
# How values are written.
_FORMS = {"set": "KEY=VALUE", "mask": "ROLE=FILE", "set-profile": "KEY=VALUE", "region": "KEYS", "layers": "LIST"}
# What the schema does not say.
_TEXTS = {
    "region": 'A part of the picture in a style of its own, such as \'mask="hair", style="charcoal"\'; once per part.'
}
_PREFIX = "option_"


class CommandWithOptions(click.Command):
    """A command that takes the options of `drypoint draw`, before or behind its photograph.

    They are asked of the drypoint that is installed, and only when they are needed, as vpype loads every plug-in at its start.
    """

    def get_params(self, ctx: click.Context) -> list[click.Parameter]:
        # The last is --help.
        *own, last = super().get_params(ctx)
        return [*own, *options_of(command()), last]

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        return super().parse_args(ctx, self._photograph_last(ctx, args))

    def _photograph_last(self, ctx: click.Context, args: list[str]) -> list[str]:
        """The words with the photograph behind its options: in a chain of commands all that follows it would be the next one's."""
        options = [param for param in self.get_params(ctx) if isinstance(param, click.Option)]
        with_value = {word for option in options if not option.is_flag for word in option.opts}
        words = list(args)
        front: list[str] = []
        photograph: list[str] = []
        while words:
            is_option = words[0].startswith("-") and words[0] != "-"
            if not is_option and photograph:
                break
            word = words.pop(0)
            (front if is_option else photograph).append(word)
            if word in with_value and words:
                front.append(words.pop(0))
        return [*front, *photograph, *words]


@functools.lru_cache(maxsize=2)
def options_of(program: str) -> list[click.Option]:
    """The options that the drypoint at this path knows."""
    listed: Mapping[str, Any] = json.loads(run(["schema"]))["properties"]
    unlisted = {name: {"type": "string", "description": text} for name, text in _UNLISTED.items()}
    known = {name: about for name, about in listed.items() if name not in _NOT_HERE}
    return [_option(name, about) for name, about in (unlisted | known).items()]


def _option(name: str, about: Mapping[str, Any]) -> click.Option:
    kind = about.get("type")
    declared = [f"--{name}", _PREFIX + name.replace("-", "_")]
    text = about.get("description") or _TEXTS.get(name, "")
    if kind == "boolean":
        return click.Option(declared, is_flag=True, help=text)
    values = about.get("enum")
    return click.Option(
        declared,
        type=str if name in _LITERAL else vpype_cli.TextType(),
        multiple=kind in ("array", "object"),
        metavar=_FORMS.get(name) or ("|".join(values) if values else "VALUE"),
        help=text + (f" [default: {about['default']}]" if "default" in about else ""),
    )


def words_of(options: Mapping[str, Any]) -> Iterator[str]:
    """The options that were given, as words of the command line."""
    for key, value in options.items():
        option = "--" + key.removeprefix(_PREFIX).replace("_", "-")
        if value is True:
            yield option
        elif isinstance(value, tuple):
            yield from (f"{option}={member}" for member in value)
        elif value not in (None, False):
            yield f"{option}={value}"


def value_of(options: Mapping[str, Any], name: str) -> Any:
    """The value of one of these options, or none."""
    return options.get(_PREFIX + name.replace("-", "_"))
