"""The marks of a drawing are those that the command reports, and lie on the sheet."""

import unittest

import drypoint
import numpy as np
from commandline import HOPPER, SMALL, SMALL_WORDS, report_of

STYLES = ["hedcut", "grid", "engrave", "charcoal", "glass"]


class Marks(unittest.TestCase):
    def test_counts_are_those_of_the_report(self) -> None:
        for style in STYLES:
            with self.subTest(style=style):
                drawing = drypoint.draw(HOPPER, style=style, **SMALL)
                report = report_of(HOPPER, "--style", style, *SMALL_WORDS)
                found = [(l.name, l.pen, len(l.dots), len(l.strokes), len(l.areas)) for l in drawing.layers]
                told = [(l["name"], l["pen"], l["dots"], l["strokes"], l["areas"]) for l in report["layers"]]
                self.assertEqual(found, told)
                self.assertGreater(sum(sum(counts[2:]) for counts in found), 100)
                np.testing.assert_allclose(drawing.page_mm, report["page_mm"], atol=0.001)

    def test_marks_are_sound_and_on_the_sheet(self) -> None:
        for style in STYLES:
            with self.subTest(style=style):
                drawing = drypoint.draw(HOPPER, style=style, **SMALL)
                for layer in drawing.layers:
                    self.check_layer(layer, drawing.page_mm)

    def check_layer(self, layer: drypoint.Layer, page: tuple[float, float]) -> None:
        self.assertRegex(layer.color, "^#[0-9a-f]{6}$")
        self.assertEqual(layer.dots.shape[1], 3)
        self.assertTrue(np.all(layer.dots[:, 2] > 0))
        self.check_inside(layer.dots[:, :2], page)
        for stroke in layer.strokes:
            self.assertGreaterEqual(len(stroke.points), 1)
            self.assertEqual(stroke.widths.shape, (len(stroke.points),))
            self.assertTrue(np.all(stroke.widths >= 0))
            self.assertGreater(stroke.widths.max(), 0)
            self.check_inside(stroke.points, page)
        for ring in [ring for area in layer.areas for ring in area] + list(layer.outlines.values()):
            self.assertGreaterEqual(len(ring), 3)
            self.check_inside(ring, page)

    def check_inside(self, points: np.ndarray, page: tuple[float, float]) -> None:
        self.assertTrue(np.all(np.isfinite(points)))
        # Files have a grid of 0.001 mm.
        self.assertTrue(np.all(points >= -0.001), points.min(axis=0, initial=0))
        self.assertTrue(np.all(points <= np.array(page) + 0.001), points.max(axis=0, initial=0))

    def test_the_ink_is_that_of_the_report(self) -> None:
        (layer,) = [found for found in drypoint.draw(HOPPER, style="grid", **SMALL).layers if found.name == "dots"]
        (told,) = [l for l in report_of(HOPPER, "--style=grid", *SMALL_WORDS)["layers"] if l["name"] == "dots"]
        self.assertEqual((told["strokes"], told["areas"]), (0, 0))
        self.assertAlmostEqual(np.pi * np.sum(layer.dots[:, 2] ** 2) / told["ink_mm2"], 1, delta=0.02)

    def test_the_same_settings_give_the_same_marks(self) -> None:
        one, other = (drypoint.draw(HOPPER, threads=threads, **SMALL) for threads in (1, 2))
        for a, b in zip(one.layers, other.layers, strict=True):
            np.testing.assert_array_equal(a.dots, b.dots)

    def test_tool_paths_have_the_width_of_the_nib(self) -> None:
        drawing = drypoint.draw(HOPPER, profile="axidraw-v3", pen=0.4, **SMALL)
        report = report_of(HOPPER, "--profile=axidraw-v3", "--pen=0.4", *SMALL_WORDS)
        self.assertEqual(sum(len(l.dots) + len(l.strokes) for l in drawing.layers), report["total"]["paths"])
        for layer in drawing.layers:
            self.assertEqual(layer.pen_mm, 0.4)
            self.assertTrue(np.all(layer.dots[:, 2] == 0.2))
            self.assertEqual({width for stroke in layer.strokes for width in stroke.widths}, {0.4})
            self.assertEqual(layer.areas, [])


if __name__ == "__main__":
    unittest.main()
