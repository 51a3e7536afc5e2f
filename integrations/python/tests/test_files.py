"""Files are, byte for byte, what the command writes."""

import os
import unittest
from pathlib import Path
from xml.etree import ElementTree

import drypoint
from commandline import CAT, HOPPER, SMALL, SMALL_WORDS, InFolder, bytes_of


class Files(InFolder):
    def test_svg_is_well_formed_and_the_commands_own(self) -> None:
        drawing = drypoint.draw(HOPPER, **SMALL)
        svg = drawing._repr_svg_()
        root = ElementTree.fromstring(svg)
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        self.assertEqual(root.get("width"), f"{drawing.page_mm[0]:g}mm")
        self.assertEqual(svg.encode(), bytes_of("svg", HOPPER, *SMALL_WORDS))

    def test_an_svg_is_drawn_once(self) -> None:
        drawing = drypoint.draw(CAT, **SMALL)
        svg = drawing.to_svg()
        self.addCleanup(os.environ.update, {"DRYPOINT": drypoint.command()})
        os.environ["DRYPOINT"] = str(self.folder / "missing")
        self.assertEqual(drawing.to_svg(), svg)
        drawing.save(self.folder / "a.svg")
        self.assertEqual((self.folder / "a.svg").read_text(), svg)
        with self.assertRaisesRegex(drypoint.DrypointError, "DRYPOINT is .*missing"):
            drawing.save(self.folder / "a.pdf")

    def test_every_format_is_the_commands_own(self) -> None:
        drawing = drypoint.draw(HOPPER, style="engrave", **SMALL)
        words = [HOPPER, "--style=engrave", *SMALL_WORDS]
        for ending, settings, more in [
            ("svg", {}, []),
            ("json", {}, []),
            ("pdf", {"dot_gain": 0.2}, ["--dot-gain=0.2"]),
            ("gcode", {"profile": "grbl-servo"}, ["--profile=grbl-servo"]),
            ("svg", {"embed": True}, ["--embed"]),
        ]:
            with self.subTest(ending=ending, settings=settings):
                path = self.folder / f"out.{ending}"
                drawing.save(path, **settings)
                self.assertEqual(path.read_bytes(), bytes_of(ending, *words, *more))

    def test_a_setting_can_be_taken_back(self) -> None:
        drawing = drypoint.draw(CAT, profile="axidraw-v3", **SMALL)
        drawing.save(self.folder / "a.pdf", profile=None)
        self.assertEqual((self.folder / "a.pdf").read_bytes(), bytes_of("pdf", CAT, *SMALL_WORDS))

    def test_paths_are_relative_to_where_they_are_given(self) -> None:
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(CAT.parent)
        drawing = drypoint.draw(CAT.name, **SMALL)
        os.chdir(self.folder)
        drawing.save("a.svg")
        self.assertEqual(Path("a.svg").read_bytes(), bytes_of("svg", CAT, *SMALL_WORDS))

    def test_a_photograph_is_never_replaced(self) -> None:
        photo = self.folder / "photo.json"
        photo.write_bytes(CAT.read_bytes())
        drawing = drypoint.draw(photo, **SMALL)
        with self.assertRaisesRegex(ValueError, "is the photograph"):
            drawing.save(photo)
        self.assertEqual(photo.read_bytes(), CAT.read_bytes())
        self.assertEqual(os.listdir(self.folder), ["photo.json"])

    def test_a_photograph_that_changed_is_not_drawn_again(self) -> None:
        photo = self.folder / "photo.png"
        photo.write_bytes(CAT.read_bytes())
        drawing = drypoint.draw(photo, **SMALL)
        photo.write_bytes(HOPPER.read_bytes())
        with self.assertRaisesRegex(drypoint.DrypointError, "has changed"):
            drawing.to_svg()


if __name__ == "__main__":
    unittest.main()
