"""Inkscape extension: draws the selected photographs as stroke art, exactly where they lie on the page."""

from __future__ import annotations

import shlex
import tempfile
from argparse import ArgumentParser
from pathlib import Path

import inkex
from drypoint_command import Drawing, Photograph, draw, find_program
from drypoint_layers import Layers
from drypoint_options import add_fields, options
from drypoint_photograph import file_of, name_of
from drypoint_placing import Place


class DrawPhotographs(inkex.EffectExtension):
    """Draws each selected image and puts the drawing over it."""

    def add_arguments(self, pars: ArgumentParser) -> None:
        add_fields(pars)

    def effect(self) -> None:
        images = self.selected_images()
        program = find_program(self.options.program)
        layers = Layers()
        warnings: list[str] = []
        with tempfile.TemporaryDirectory(prefix="drypoint-inkscape-") as scratch:
            for image in images:
                place = Place(image)
                photograph = Photograph(file_of(image, self.folders(), Path(scratch)), name_of(image))
                drawing, note = self.drawn(program, photograph, place, Path(scratch))
                layers.rise_above(image)
                to_page = place.drawing_to_page(drawing.picture)
                if layers.add(drawing.svg, image, to_page, photograph.name, note) == 0:
                    warnings.append(f"{photograph.name}: nothing to draw in it; it is as light as the paper.")
                warnings += [f"{photograph.name}: {warning}" for warning in drawing.warnings]
        layers.place()
        if self.options.photograph == "hide":
            for image in images:
                image.style["display"] = "none"
        if warnings:
            inkex.errormsg("\n".join(warnings))

    def selected_images(self) -> list[inkex.Image]:
        """The selected images, also those in selected groups, the lowest on the page first."""
        if not self.svg.selection:
            raise inkex.AbortExtension("Nothing is selected. Select one or more photographs on the page and try again.")
        images = list(self.svg.selection.get(inkex.Image))
        if images:
            chosen = set(images)
            return [image for image in self.svg.iter(inkex.addNS("image", "svg")) if image in chosen]
        if any(isinstance(clone.href, inkex.Image) for clone in self.svg.selection.get(inkex.Use)):
            raise inkex.AbortExtension(
                "The selection is a clone of an image. Unlink it first (Edit > Clone > Unlink Clone)."
            )
        raise inkex.AbortExtension(
            "There is no photograph in the selection: drypoint draws images (File > Import), not paths or text."
        )

    def folders(self) -> list[Path]:
        """Where linked files may be: Inkscape writes links relative to the copy of the document that it hands over."""
        found = []
        if isinstance(self.options.input_file, str):
            found.append(Path(self.options.input_file).parent)
        found.append(self.document_folder())
        return found

    def document_folder(self) -> Path:
        folder = self.svg_path()
        return Path(folder) if folder and Path(folder).is_dir() else Path.home()

    def drawn(self, program: str, photograph: Photograph, place: Place, scratch: Path) -> tuple[Drawing, str]:
        """The drawing and the options it was made with."""
        width, height = place.size_mm()
        stretch = 1.0
        # The proportions of the photograph are known when it is drawn; only a stretched one is drawn again.
        while True:
            size = (width * stretch, height * stretch)
            asked = options(self.options, size, cover=place.aspect.fit == "slice")
            drawing = draw(program, photograph, asked, self.document_folder(), scratch)
            if stretch != 1.0 or place.stretch(drawing.picture) == 1.0:
                return drawing, "drypoint draw " + shlex.join(asked)
            stretch = place.stretch(drawing.picture)


if __name__ == "__main__":
    DrawPhotographs().run()
