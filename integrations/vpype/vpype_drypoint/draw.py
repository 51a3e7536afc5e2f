"""`vpype drypoint`: draws a photograph for the pen."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from importlib.resources import as_file, files
from typing import Any

import click
import numpy as np
import vpype as vp
import vpype_cli

from .command import run
from .options import CommandWithOptions, value_of, words_of
from .order import in_best_order

_PIXELS_PER_MM = vp.convert_length("1mm")


@click.command(cls=CommandWithOptions)
@click.argument("photograph", type=vpype_cli.PathType())
@click.option("-l", "--layer", type=vpype_cli.LayerType(accept_new=True), help="Target layer or 'new'.")
@click.option(
    "--dot-length",
    type=vpype_cli.LengthType(),
    default="0.01mm",
    show_default=True,
    help="Length of the strokes that dots become.",
)
@vpype_cli.global_processor
def drypoint(
    document: vp.Document, photograph: str, layer: int | None, dot_length: float, **options: Any
) -> vp.Document:
    """Draw a photograph for the pen.

    PHOTOGRAPH is a picture (JPEG, PNG, WebP, TIFF, BMP or GIF), a scene of drypoint (.toml), or a dash (-) to read a picture from
    the standard input.

    The drawing is laid down with a nib of the width --pen: dots up to that width are touches, larger ones spirals, wide lines
    several passes, and tones finer than the nib are thinned out, so that the plot has the tone of the photograph. Its paths are
    in plotting order. A touch becomes a stroke of --dot-length, since vpype and most programs drop lines without length.

    The first layer goes to the target layer, as with other generators, and each further layer to a new one. Pen width, colour and
    name are set as properties of layers that do not have them yet. The page grows to the sheet of the drawing.

    All options of `drypoint draw` are understood. Lengths are in mm, cm, in or pt (mm if nothing is said). With --profile the
    drawing is checked against the reach of that plotter, and has as many pens; without it there may be 8 (--set-profile
    pens.count=N for another number).

    Examples:

        Draw a portrait for a pen of 0.3 mm:

            vpype drypoint portrait.jpg --size 90x120mm --pen 0.3mm write out.svg

        Engrave head and shoulders on A5, centred by vpype:

            vpype drypoint portrait.jpg --style engrave --crop head layout a5 write out.svg

        A drawing in the colours of the photograph, with four pens:

            vpype drypoint photo.jpg --style glass --set-profile pens.count=4 write out.svg
    """
    found = json.loads(run(list(_words(photograph, options)), has_own_stdin=photograph == "-"))
    target = vpype_cli.single_to_layer_id(layer, document)
    for number, drawn in enumerate(found["layers"]):
        _add(document, drawn, dot_length, target if number == 0 else document.free_id())
    width, height = found["page_mm"]
    document.extend_page_size((width * _PIXELS_PER_MM, height * _PIXELS_PER_MM))
    if photograph != "-":
        document.add_to_sources(photograph)
    vpype_cli.State.get_current().target_layer_id = target
    return document


drypoint.help_group = "Generators"  # type: ignore[attr-defined]


def _words(photograph: str, options: Mapping[str, Any]) -> Iterator[str]:
    yield from ["draw", "--output=-", "--format=json"]
    yield from words_of(options)
    if not value_of(options, "profile"):
        if value_of(options, "max-time"):
            raise click.UsageError("--max-time needs --profile, the plotter whose time it is")
        with as_file(files(__package__) / "sheet.toml") as sheet:
            yield f"--profile={sheet}"
    yield from ["--", photograph]


def _add(document: vp.Document, drawn: Mapping[str, Any], dot_length: float, target: int) -> None:
    document.add(_lines(drawn, dot_length), target)
    layer = document.layers[target]
    properties = {
        vp.METADATA_FIELD_NAME: drawn["name"],
        vp.METADATA_FIELD_COLOR: drawn["color"],
        vp.METADATA_FIELD_PEN_WIDTH: drawn["pen_mm"] * _PIXELS_PER_MM,
    }
    for name, value in properties.items():
        if not layer.property_exists(name):
            layer.set_property(name, value)


def _lines(drawn: Mapping[str, Any], dot_length: float) -> list[np.ndarray]:
    """The tool paths of one layer, in plotting order and in pixels."""
    half = np.array([-0.5 * dot_length, 0.5 * dot_length])
    strokes = [_line(stroke, half) for stroke in drawn["strokes"]]
    dots = [complex(x, y) * _PIXELS_PER_MM + half for x, y, _ in drawn["dots"]]
    # Each kind is in order by itself, but not how they follow one another.
    return in_best_order([*dots, *strokes]) if dots and strokes else [*dots, *strokes]


def _line(stroke: Mapping[str, Any], half: np.ndarray) -> np.ndarray:
    points = np.array(stroke["points"]) @ np.array([1, 1j]) * _PIXELS_PER_MM
    if np.all(points == points[0]):
        # Shorter than the step in which the command writes: a touch.
        return points[0] + half
    return np.append(points, points[0]) if stroke["closed"] and points[0] != points[-1] else points
