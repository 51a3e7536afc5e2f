"""A finished drawing: its marks as numbers, and its files."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ._request import Request

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Stroke:
    """A line with a width at each of its points."""

    #: (n, 2): x and y in millimetres.
    points: Floats
    #: (n,): the line's full width at each point, in millimetres.
    widths: Floats
    #: True if the last point is joined to the first.
    closed: bool
    #: Its colour, such as ``#000000``; white covers what lies below.
    color: str


@dataclass(frozen=True, eq=False)
class Layer:
    """The marks of one pen or ink."""

    #: Such as ``dots``.
    name: str
    #: The pen's number, from 1.
    pen: int
    #: The nib's width in millimetres; 0 if each mark has its own.
    pen_mm: float
    #: The ink's colour, such as ``#000000``.
    color: str
    #: (n, 3): x, y and radius in millimetres.
    dots: Floats
    #: The shapes of dots that are no discs: (n, 2) in millimetres, closed, by the index of the dot.
    outlines: Mapping[int, Floats]
    #: Lines, in drawing order.
    strokes: list[Stroke]
    #: Filled areas, each a list of rings: (n, 2) in millimetres, closed, filled by the nonzero rule.
    areas: list[list[Floats]]
    #: Colours of marks that differ from the layer's: by kind (``dots``, ``strokes``, ``areas``) and index.
    colors: Mapping[str, Mapping[int, str]]


class Drawing:
    """A drawing made by ``drypoint.draw``.

    Its marks are here at once. Other formats are drawn when they are asked for, which takes as long as the drawing did; an SVG
    is kept, so that showing and saving it draws it once.
    """

    #: Width and height of the sheet in millimetres.
    page_mm: tuple[float, float]
    #: The colour of the paper, such as ``#ffffff``.
    paper: str
    #: The layers in drawing order.
    layers: list[Layer]
    #: What drypoint decided by itself, such as ``background left out: 1 face found; --background keep draws it``.
    notices: tuple[str, ...]

    def __init__(self, request: Request, data: bytes, notices: tuple[str, ...]) -> None:
        found = json.loads(data)
        width, height = found["page_mm"]
        self.page_mm = (float(width), float(height))
        self.paper = found["paper"]
        self.layers = [_layer(layer) for layer in found["layers"]]
        self.notices = notices
        self._request = request
        self._json = data
        self._svg: bytes | None = None

    def __repr__(self) -> str:
        dots = sum(len(layer.dots) for layer in self.layers)
        strokes = sum(len(layer.strokes) for layer in self.layers)
        areas = sum(len(layer.areas) for layer in self.layers)
        width, height = self.page_mm
        return f"<Drawing {width:g} x {height:g} mm: {dots} dots, {strokes} strokes, {areas} areas>"

    def to_svg(self) -> str:
        """The drawing as SVG, the same bytes that ``drypoint draw -o FILE.svg`` writes. Drawn once, then kept."""
        if self._svg is None:
            self._svg = self._request.run_again(["--output=-", "--format=svg"]).data
        return self._svg.decode()

    def _repr_svg_(self) -> str:
        """What a notebook shows."""
        return self.to_svg()

    def save(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Writes a file in the format of the path's ending: .svg, .svgz, .pdf, .json, .inkml, and with a plotter .gcode, .hpgl.

        ``options`` are settings of ``drypoint.draw`` that differ for this file, such as ``profile="grbl-servo"``,
        ``max_time="2h"`` or ``preview="check.svg"``; ``None`` takes one back that the drawing had. The file appears whole or
        not at all, and never in place of the photograph.
        """
        target = os.path.abspath(os.fspath(path))
        ending = os.path.splitext(target)[1].lower()
        has_layers = "{layer}" in target
        if ending == ".json" and not options and not has_layers:
            self._write(target, self._json)
        elif ending == ".svg" and not options and not has_layers and self._svg is not None:
            self._write(target, self._svg)
        else:
            self._request.run_again([f"--output={target}"], options)

    def _write(self, path: str, data: bytes) -> None:
        if self._request.is_photograph(path):
            raise ValueError(f"{path} is the photograph; choose another name")
        # Beside it, since only a rename within a folder is whole or not at all.
        temporary = Path(os.path.dirname(path), f".{os.path.basename(path)}.{os.getpid()}.unfinished")
        try:
            temporary.write_bytes(data)
            if os.path.exists(path):
                shutil.copymode(path, temporary)
            os.replace(temporary, path)
        finally:
            temporary.unlink(missing_ok=True)


def _layer(found: Mapping[str, Any]) -> Layer:
    colors = {kind: {int(i): color for i, color in own.items()} for kind, own in found.get("colors", {}).items()}
    own = colors.get("strokes", {})
    strokes = [
        Stroke(
            _floats(stroke["points"], 2),
            np.array(stroke["widths"], float),
            stroke["closed"],
            own.get(i, found["color"]),
        )
        for i, stroke in enumerate(found["strokes"])
    ]
    return Layer(
        name=found["name"],
        pen=found["pen"],
        pen_mm=found["pen_mm"],
        color=found["color"],
        dots=_floats(found["dots"], 3),
        outlines={dot: _floats(ring, 2) for dot, ring in found.get("outlines", [])},
        strokes=strokes,
        areas=[[_floats(ring, 2) for ring in area] for area in found["areas"]],
        colors=colors,
    )


def _floats(rows: list[Any], columns: int) -> Floats:
    """The rows as an array with this many columns, also if there are none."""
    return np.array(rows, dtype=float).reshape(-1, columns)
