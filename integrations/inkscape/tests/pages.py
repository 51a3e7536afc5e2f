"""Pages with photographs on them, as Inkscape users make them."""

from __future__ import annotations

import base64
import re
from dataclasses import dataclass
from pathlib import Path

HEADER = (
    'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
    'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
)


@dataclass(frozen=True)
class Page:
    """A page with one image; `size_mm` is the box for drypoint that keeps marks at their size, worked out by hand."""

    name: str
    root: str
    before: str
    box: str
    moved: str
    after: str
    size_mm: tuple[float, float]
    fit: str = "contain"

    def with_href(self, href: str) -> str:
        """The page with this picture as its photograph."""
        return self._around(f'<image id="photo" {self.box} {self.moved} xlink:href="{href}"/>')

    def with_drawing(self, drawing: Path) -> str:
        """The page with this SVG in the place of its photograph; the renderer fits it into the box."""
        opening, _, content = drawing.read_text().partition(">")
        view = re.search('viewBox="[^"]*"', opening)
        inner = f'<svg {self.box} {view[0]} overflow="visible">{content}'
        return self._around(f"<g {self.moved}>{inner}</g>")

    def _around(self, content: str) -> str:
        return f"<svg {HEADER} {self.root}>{self.before}{content}{self.after}</svg>"


def embedded(photograph: Path, kind: str) -> str:
    """A data URI with line breaks, as Inkscape writes it."""
    return f"data:image/{kind};base64," + base64.encodebytes(photograph.read_bytes()).decode("ascii")


MILLIMETRES = 'width="120mm" height="100mm" viewBox="0 0 120 100"'
# 96 pixels per inch at half size: a unit is 0.1323 mm.
PIXELS = 'width="100mm" height="100mm" viewBox="0 0 755.90551 755.90551"'
PIXEL_MM = 25.4 / 96

PLAIN = Page(
    "plain",
    MILLIMETRES,
    '<g inkscape:groupmode="layer" inkscape:label="photos">',
    'x="20" y="15" width="51.2" height="60" preserveAspectRatio="none"',
    "",
    "</g>",
    (51.2, 60),
)

# Shears keep areas, so the scale is the product of the two factors and of the page's half.
TRANSFORMED = Page(
    "transformed",
    PIXELS,
    '<g inkscape:groupmode="layer" transform="translate(370,60) scale(1.25)"><g transform="rotate(20)">',
    'x="-40" y="30" width="300" height="250"',
    'transform="matrix(1.2,0,0.24,1.2,10,20)"',
    "</g></g>",
    (300 * 1.25 * 1.2 * PIXEL_MM / 2, 250 * 1.25 * 1.2 * PIXEL_MM / 2),
)

MIRRORED = Page(
    "mirrored",
    MILLIMETRES,
    "<g>",
    'x="-100" y="20" width="60" height="60" preserveAspectRatio="xMinYMax meet"',
    'transform="scale(-1,1)"',
    "</g>",
    (60, 60),
)

# 512 x 600 pixels in a box of 60 x 40 mm: a drawing of 45.2548 x 53.0330 mm has the same area.
# It is the largest in this box:
STRETCHED = Page(
    "stretched",
    MILLIMETRES,
    "<g>",
    'x="20" y="20" width="60" height="40" preserveAspectRatio="none"',
    "",
    "</g>",
    (79.5495, 53.0330),
)

CUT = Page(
    "cut",
    MILLIMETRES,
    "<g>",
    'x="20" y="20" width="40" height="60" preserveAspectRatio="xMidYMid slice"',
    "",
    "</g>",
    (40, 60),
    "cover",
)

# The clip is in the units of the group, which is turned; the mask in those of the image.
CLIPPED = Page(
    "clipped",
    MILLIMETRES,
    '<defs><clipPath id="cut"><circle cx="50" cy="35" r="22"/></clipPath>'
    '<mask id="fade" maskUnits="userSpaceOnUse"><rect x="20" y="20" width="20" height="90" fill="white"/></mask></defs>'
    '<g transform="translate(10,0) rotate(5)" style="clip-path:url(#cut)">',
    'x="20" y="15" width="51.2" height="60"',
    'transform="translate(4,0)" mask="url(#fade)"',
    "</g>",
    (51.2, 60),
)
