"""Puts drawings on the page: a layer for each of drypoint's, above the layers that hold the photographs."""

from __future__ import annotations

import inkex
from drypoint_placing import ancestors_below_root, attribute_of, composed

LABEL = inkex.addNS("label", "inkscape")
GROUP_MODE = inkex.addNS("groupmode", "inkscape")


class Layers:
    """The layers of one run. Drawings of several photographs share them, so that each pen's marks are together."""

    def __init__(self) -> None:
        self.by_name: dict[str, inkex.Layer] = {}
        self.highest: inkex.BaseElement | None = None

    def rise_above(self, image: inkex.Image) -> None:
        """New layers lie above this image's layer; images come in the order of the page, the lowest first."""
        self.highest = ancestors_below_root(image)[0]

    def add(
        self, drawn: inkex.SvgDocumentElement, image: inkex.Image, to_page: inkex.Transform, name: str, note: str
    ) -> int:
        """Moves the marks of a drawing into the layers; answers how many marks there are."""
        marks = 0
        for layer in drawn.xpath("./svg:g[@inkscape:groupmode='layer']"):
            marks += _without_ids(layer)
            group = inkex.Group()
            # The layer's colours go with the marks, for drawings that share a layer.
            group.attrib.update({key: value for key, value in layer.attrib.items() if key not in (LABEL, GROUP_MODE)})
            group.extend(list(layer))
            group.label = name
            group.desc = note
            self._layer(layer.label).append(_clipped(group, image, to_page))
        return marks

    def place(self) -> None:
        """Puts the layers on the page."""
        for layer in reversed(self.by_name.values()):
            self.highest.addnext(layer)

    def _layer(self, label: str) -> inkex.Layer:
        if label not in self.by_name:
            self.by_name[label] = inkex.Layer.new(label)
        return self.by_name[label]


def _without_ids(layer: inkex.BaseElement) -> int:
    """Inkscape gives new ids; drypoint's would meet again in a second drawing of the same photograph."""
    marks = 0
    for element in layer.iter():
        element.attrib.pop("id", None)
        marks += element.tag in (inkex.addNS("path", "svg"), inkex.addNS("circle", "svg"))
    return marks


def _clipped(group: inkex.Group, image: inkex.Image, to_page: inkex.Transform) -> inkex.Group:
    """The group on the page, cut as the image is. Each clip and mask above it has units of its own."""
    chain = ancestors_below_root(image)
    outer, reached = group, to_page
    for depth in range(len(chain), 0, -1):
        cuts = _cuts(chain[depth - 1])
        if cuts:
            units = composed(chain[:depth])
            outer.attrib["transform"] = attribute_of(-units @ reached)
            frame = inkex.Group()
            frame.attrib.update(cuts)
            frame.append(outer)
            outer, reached = frame, units
    outer.attrib["transform"] = attribute_of(reached)
    return outer


def _cuts(element: inkex.BaseElement) -> dict[str, str]:
    style = inkex.Style(element.attrib.get("style"))
    found = {key: element.attrib.get(key) or style.get(key) for key in ("clip-path", "mask")}
    return {key: str(value) for key, value in found.items() if value and value != "none"}
