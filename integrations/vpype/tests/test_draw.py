"""`vpype drypoint` brings the command's tool paths into the pipeline, none lost, with their pens."""

import subprocess
import tempfile
import unittest
from pathlib import Path

import click
import vpype
from pipeline import CAT, HOPPER, MM, SMALL, drawn_by_command, pipeline, vpype_itself


class Draw(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_paths_and_ink_are_the_commands(self) -> None:
        for style in ["hedcut", "grid", "engrave"]:
            with self.subTest(style=style):
                words = f"--style {style} --pen 0.25mm {SMALL}"
                paths, report = drawn_by_command(words, HOPPER)
                dots = sum(len(layer["dots"]) for layer in paths["layers"])
                document = pipeline(f"drypoint {HOPPER} {words} --dot-length 0.02mm")
                self.assertGreater(report["total"]["paths"], 500)
                self.assertEqual(sum(len(lines) for lines in document.layers.values()), report["total"]["paths"])
                ink = document.length() / MM - 0.02 * dots
                self.assertAlmostEqual(ink / report["total"]["pen_down_mm"], 1, delta=0.001)
                # The command's travel includes the way from the corner.
                self.assertLess(document.pen_up_length() / MM, report["total"]["pen_up_mm"] * 1.02)

    def test_layers_have_their_pens(self) -> None:
        paths, _ = drawn_by_command(f"--style grid --pen 0.4mm {SMALL}", HOPPER)
        document = pipeline(f"drypoint --style grid --pen 0.4mm {SMALL} {HOPPER}")
        self.assertEqual(list(document.layers), [1, 2, 3])
        for lines, layer in zip(document.layers.values(), paths["layers"], strict=True):
            self.assertEqual(lines.property("vp_name"), layer["name"])
            self.assertEqual(lines.property("vp_color"), vpype.Color(layer["color"]))
            self.assertAlmostEqual(lines.property("vp_pen_width") / MM, 0.4, places=9)
            self.assertEqual(len(lines), len(layer["dots"]) + len(layer["strokes"]))
        for side, told in zip(document.page_size, paths["page_mm"], strict=True):
            self.assertAlmostEqual(side / MM, told, places=6)
        self.assertEqual(document.sources, {HOPPER.resolve()})

    def test_all_is_inside_the_page(self) -> None:
        document = pipeline(f"drypoint {HOPPER} {SMALL}")
        left, top, right, bottom = document.bounds()
        width, height = document.page_size
        self.assertTrue(left >= 0 and top >= 0 and right <= width + 0.01 * MM and bottom <= height + 0.01 * MM)

    def test_dots_come_through_files(self) -> None:
        path = self.folder / "out.svg"
        done = vpype_itself("drypoint", HOPPER, *SMALL.split(), "write", path)
        self.assertEqual(done.returncode, 0, done.stderr)
        _, report = drawn_by_command(SMALL, HOPPER)
        self.assertEqual(
            sum(len(lines) for lines in pipeline(f"read {path}").layers.values()), report["total"]["paths"]
        )

    def test_target_layers(self) -> None:
        small = f"drypoint {CAT} --style grid {SMALL}"
        self.assertEqual(list(pipeline(f"{small} --layer 4").layers), [4, 1, 2])
        self.assertEqual(list(pipeline(f"line 0 0 1 1 {small} --layer new").layers), [1, 2, 3, 4])
        mine = pipeline(f"line 0 0 1 1 name -l 1 mine penwidth -l 1 1mm drypoint {CAT} {SMALL}")
        self.assertEqual(list(mine.layers), [1])
        self.assertEqual(mine.layers[1].property("vp_name"), "mine")
        self.assertAlmostEqual(mine.layers[1].property("vp_pen_width"), MM)
        self.assertEqual(mine.layers[1].property("vp_color"), vpype.Color("black"))

    def test_colours_go_to_a_few_pens(self) -> None:
        for words, most in [("", 8), (" --set-profile pens.count=3", 3)]:
            document = pipeline(f"drypoint {CAT} --style glass --size 30x20mm --pitch 1{words}")
            colours = {str(lines.property("vp_color")) for lines in document.layers.values()}
            self.assertEqual((len(document.layers), len(colours)), (most, most))

    def test_options_stand_anywhere(self) -> None:
        behind = pipeline(f"drypoint {CAT} {SMALL} --mirror linemerge --tolerance 1mm")
        before = pipeline(f"drypoint {SMALL} --mirror {CAT} linemerge --tolerance 1mm")
        self.assertEqual(behind, before)
        self.assertNotEqual(behind, pipeline(f"drypoint {CAT} {SMALL} linemerge --tolerance 1mm"))

    def test_every_kind_of_option(self) -> None:
        words = f"drypoint {HOPPER} {SMALL} --crop 10%,0,80%,100% --set outline=off --set edge_length=4"
        one = pipeline(f"{words} --background keep --seed %1+2%")
        paths, report = drawn_by_command(
            f"{SMALL} --crop 10%,0,80%,100% --set outline=off --set edge_length=4 --background keep --seed 3", HOPPER
        )
        self.assertEqual(len(one.layers[1]), report["total"]["paths"])
        self.assertEqual(one.layers[1].property("vp_name"), paths["layers"][0]["name"])

    def test_stdin(self) -> None:
        path = self.folder / "out.svg"
        with open(CAT, "rb") as photo:
            subprocess.run(["vpype", "drypoint", "-", *SMALL.split(), "write", str(path)], stdin=photo, check=True)
        self.assertEqual(
            sum(len(lines) for lines in pipeline(f"read {path}").layers.values()),
            drawn_by_command(SMALL, CAT)[1]["total"]["paths"],
        )

    def test_a_plotter_of_the_users(self) -> None:
        with self.assertRaisesRegex(click.ClickException, "axidraw-mini"):
            pipeline(f"drypoint {HOPPER} --page a4 --size 150x200mm --profile axidraw-mini --pitch 2")
        with self.assertRaisesRegex(click.UsageError, "--max-time needs --profile"):
            pipeline(f"drypoint {HOPPER} --max-time 1h")

    def test_wrong_words(self) -> None:
        for words, message in [
            (["drypoint", HOPPER, "--sizze", "3x4"], "--size"),
            (["drypoint", HOPPER, "--size", "3"], "'3' is not a size"),
            (["drypoint", HOPPER, "--set", "pich=3"], "did you mean pitch"),
            (["drypoint", "missing.jpg"], "missing.jpg does not exist"),
        ]:
            with self.subTest(words=words):
                done = vpype_itself(*words)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(message, done.stderr)
                self.assertNotIn("Traceback", done.stderr)

    def test_help_lists_the_options(self) -> None:
        told = vpype_itself("drypoint", "--help").stdout
        for option in ["--style", "--size", "--mask", "--region", "--mirror", "--dot-length", "--layer"]:
            self.assertIn(f"{option} ", told.replace("\n", " "))
        for option in ["--output", "--format", "--send"]:
            self.assertNotIn(f"{option} ", told)


if __name__ == "__main__":
    unittest.main()
