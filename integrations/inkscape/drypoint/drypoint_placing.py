"""Where a drawing lies on the page: exactly over its photograph, whatever its units, transforms and proportions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import inkex
from inkex.units import convert_unit

MILLIMETRES_PER_PIXEL = 25.4 / 96
# A picture that is stretched by less keeps marks of the asked size well enough.
STRETCH_OF_NOTE = 0.02


@dataclass(frozen=True)
class Box:
    """A box in any unit, y down."""

    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True)
class Aspect:
    """How a photograph fills the box of its image: `preserveAspectRatio` of SVG."""

    fit: str
    x: float
    y: float


class Place:
    """The place of one image: its box in its own units, and the way from there to the page and to millimetres."""

    def __init__(self, image: inkex.Image) -> None:
        self.image = image
        self.box = _box(image)
        self.aspect = _aspect(image)
        self.to_page = composed(ancestors_below_root(image))
        area = abs(self.to_page.a * self.to_page.d - self.to_page.b * self.to_page.c)
        if area == 0:
            raise inkex.AbortExtension(f"The image {image.get_id()} is squeezed to a line by its transform.")
        # A turned, sheared or stretched image has no single scale; this one keeps the area, and with it the tone.
        self.scale = math.sqrt(area) * millimetres_per_unit(image.root)

    def size_mm(self) -> tuple[float, float]:
        """The box that drypoint fits the photograph into, so that marks have their true size on the page."""
        return self.box.width * self.scale, self.box.height * self.scale

    def photograph_box(self, width: float, height: float) -> Box:
        """The photograph in the image's units, given its proportions."""
        box = self.box
        if self.aspect.fit != "meet":
            return box
        scale = min(box.width / width, box.height / height)
        spare_x, spare_y = box.width - scale * width, box.height - scale * height
        return Box(box.x + self.aspect.x * spare_x, box.y + self.aspect.y * spare_y, scale * width, scale * height)

    def drawing_to_page(self, picture: Box) -> inkex.Transform:
        """From a drawing's millimetres to the page, where `picture` is the photograph's box in the drawing."""
        box = self.photograph_box(picture.width, picture.height)
        across, down = box.width / picture.width, box.height / picture.height
        placed = inkex.Transform((across, 0, 0, down, box.x - across * picture.x, box.y - down * picture.y))
        return self.to_page @ placed

    def stretch(self, picture: Box) -> float:
        """How much larger the drawing is to be, for marks of the asked size; 1 unless the photograph is stretched."""
        box = self.photograph_box(picture.width, picture.height)
        factor = math.sqrt(box.width * box.height / (picture.width * picture.height)) * self.scale
        return 1.0 if abs(factor - 1) < STRETCH_OF_NOTE else factor


def ancestors_below_root(element: inkex.BaseElement) -> list[inkex.BaseElement]:
    """The element and all that hold it, the outermost first, without the document."""
    chain = [element]
    while True:
        parent = chain[0].getparent()
        if parent is None or parent is element.root:
            return chain
        if not isinstance(parent, (inkex.Group, inkex.Anchor)):
            raise inkex.AbortExtension(
                f"The image {element.get_id()} is inside a {parent.TAG} and cannot be drawn there. "
                "Take it out (Edit > Clone > Unlink, or Object > Pattern > Pattern to Objects) and select it again."
            )
        chain.insert(0, parent)


def composed(chain: list[inkex.BaseElement]) -> inkex.Transform:
    """All transforms of the chain, the outermost first."""
    transform = inkex.Transform()
    for element in chain:
        # Read as it stands: inkex's own property would write it back with six digits.
        transform = transform @ inkex.Transform(element.attrib.get("transform"))
    return transform


def millimetres_per_unit(svg: inkex.SvgDocumentElement) -> float:
    """The size of the page's unit, from its width, height and view box."""
    view = svg.get_viewbox()
    if not (view[2] > 0 and view[3] > 0):
        return MILLIMETRES_PER_PIXEL
    across = (convert_unit(svg.get("width"), "px") or view[2]) / view[2]
    down = (convert_unit(svg.get("height"), "px") or view[3]) / view[3]
    aspect = (svg.get("preserveAspectRatio") or "xMidYMid meet").split()
    if aspect[0] == "none":
        return math.sqrt(across * down) * MILLIMETRES_PER_PIXEL
    return (max if "slice" in aspect else min)(across, down) * MILLIMETRES_PER_PIXEL


def attribute_of(transform: inkex.Transform) -> str:
    """The transform as SVG writes it; inkex itself would write six digits, too few for a large sheet."""
    return "matrix({})".format(",".join(f"{number:.12g}" for number in transform.to_hexad()))


def _box(image: inkex.Image) -> Box:
    x, y, width, height = (convert_unit(image.get(key, "0"), "px") for key in ("x", "y", "width", "height"))
    if not (width > 0 and height > 0):
        raise inkex.AbortExtension(
            f"The image {image.get_id()} has no width or height of its own. Set both, in the bar of the selection tool."
        )
    return Box(x, y, width, height)


def _aspect(image: inkex.Image) -> Aspect:
    words = [word for word in (image.get("preserveAspectRatio") or "").split() if word != "defer"]
    align = words[0] if words else "xMidYMid"
    if align == "none":
        return Aspect("none", 0.5, 0.5)
    shares = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
    x, y = shares.get(align[1:4], 0.5), shares.get(align[5:8], 0.5)
    fit = "slice" if words[1:] == ["slice"] else "meet"
    if fit == "slice" and (x, y) != (0.5, 0.5):
        raise inkex.AbortExtension(
            f"The image {image.get_id()} is cut off centre (preserveAspectRatio {align} slice), which cannot be drawn. "
            "Cut it with a clip instead."
        )
    return Aspect(fit, x, y)
