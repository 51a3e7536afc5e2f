"""What is on a page: its marks, its layers, and where its ink lies."""

from __future__ import annotations

import io
import subprocess
from pathlib import Path

import numpy
from lxml import etree
from PIL import Image

SVG = "{http://www.w3.org/2000/svg}"
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
DOTS_PER_INCH = 300
PIXELS_PER_MM = DOTS_PER_INCH / 25.4


def tree(path: Path) -> etree._Element:
    return etree.parse(str(path), etree.XMLParser(huge_tree=True)).getroot()


def marks(element: etree._Element) -> int:
    return sum(1 for _ in element.iter(SVG + "path", SVG + "circle"))


def layers(root: etree._Element) -> dict[str, etree._Element]:
    """Layers directly on the page, by name, the lowest first."""
    found = root.findall(f"{SVG}g[@{INKSCAPE}groupmode='layer']")
    return {layer.get(INKSCAPE + "label"): layer for layer in found if layer.get(INKSCAPE + "label")}


def darkness(path: Path) -> numpy.ndarray:
    """The page as librsvg draws it: 0 is paper, 1 is ink."""
    drawn = subprocess.run(
        [
            "rsvg-convert",
            "--unlimited",
            f"--dpi-x={DOTS_PER_INCH}",
            f"--dpi-y={DOTS_PER_INCH}",
            "-b",
            "white",
            path.name,
        ],
        cwd=path.parent,
        check=True,
        capture_output=True,
    ).stdout
    return 1 - numpy.asarray(Image.open(io.BytesIO(drawn)).convert("L"), dtype=float) / 255


def centre_mm(ink: numpy.ndarray) -> tuple[float, float]:
    """The centre of darkness."""
    total = ink.sum()
    rows, columns = numpy.indices(ink.shape)
    return float((ink * columns).sum() / total / PIXELS_PER_MM), float((ink * rows).sum() / total / PIXELS_PER_MM)


def offset_mm(one: numpy.ndarray, other: numpy.ndarray) -> float:
    """How far apart two pages of ink lie: the shift at which they agree best, by phase of their product."""
    spectrum = numpy.fft.rfft2(one) * numpy.conj(numpy.fft.rfft2(other))
    agreement = numpy.fft.irfft2(spectrum, one.shape)
    row, column = numpy.unravel_index(int(agreement.argmax()), agreement.shape)
    shift = [value - size if value > size / 2 else value for value, size in zip((row, column), one.shape)]
    return float(numpy.hypot(*shift)) / PIXELS_PER_MM


def bounds_mm(ink: numpy.ndarray) -> tuple[float, float, float, float]:
    """The box of the ink: left, top, right, bottom."""
    rows, columns = numpy.nonzero(ink > 0.5)
    edges = (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1)
    return tuple(float(edge) / PIXELS_PER_MM for edge in edges)
