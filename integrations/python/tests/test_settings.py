"""Settings reach the command as they are meant, and wrong ones are refused with help."""

import unittest
import warnings
from pathlib import Path
from typing import Any

import drypoint
from commandline import CAT, HOPPER, SAMPLES, SMALL, InFolder, bytes_of

BUST = SAMPLES / "bust-light.png"


class Settings(InFolder):
    def check_words(self, photo: Path, settings: dict[str, Any], *words: str) -> None:
        """The settings draw what the words of a command line draw; the SVG holds the recipe too."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", drypoint.DrypointWarning)
            self.assertEqual(drypoint.draw(photo, **settings).to_svg().encode(), bytes_of("svg", photo, *words))

    def test_options(self) -> None:
        self.check_words(
            CAT, {"size": (30, 40), "pitch": 0.8, "mirror": True}, "--size=30x40", "--pitch=0.8", "--mirror"
        )
        self.check_words(
            CAT, {"page": "a6", "margin": "40mm", "center": False, "seed": 3}, "--page=a6", "--margin=40mm", "--seed=3"
        )
        self.check_words(
            CAT, {"crop": ("10%", 0, "50%", "100%"), "size": "3x4cm"}, "--crop=10%,0,50%,100%", "--size=3x4cm"
        )
        self.check_words(HOPPER, {"preset": "wsj-column"}, "--preset=wsj-column")
        self.check_words(HOPPER, {"preset": "banknote", "size": "30x40"}, "--preset=banknote", "--size=30x40")
        self.check_words(
            CAT, {"layers": ["dots", "outline"], **SMALL}, "--layers=dots,outline", "--size=30x40mm", "--pitch=0.6"
        )

    def test_masks_and_regions(self) -> None:
        hair = SAMPLES / "bust-mask-hair.png"
        self.check_words(
            BUST, {"mask": {"hair": hair}, **SMALL}, f"--mask=hair={hair}", "--size=30x40mm", "--pitch=0.6"
        )
        region = {"mask": "clothing", "style": "engrave", "pen": 2, "set": {"pitch": 0.9}}
        words = 'mask = "clothing", style = "engrave", pen = 2, set = { pitch = 0.9 }'
        self.check_words(BUST, {"region": [region], **SMALL}, f"--region={words}", "--size=30x40mm", "--pitch=0.6")

    def test_parameters_of_the_style(self) -> None:
        self.check_words(
            CAT,
            {"outline": False, "edge_length": 4.5, "size": "30x40"},
            "--set=outline=off",
            "--set=edge_length=4.5",
            "--size=30x40",
        )
        self.check_words(CAT, {"set": {"size": "paper"}, **SMALL}, "--set=size=paper", "--size=30x40mm", "--pitch=0.6")
        self.check_words(
            CAT,
            {"style": "glass", "whirls": 4, **SMALL},
            "--style=glass",
            "--set=whirls=4",
            "--size=30x40mm",
            "--pitch=0.6",
        )

    def test_profiles(self) -> None:
        settings = {"profile": "grbl-servo", "set_profile": {"area.x": [0, 430], "motion.draw_speed": 30}, **SMALL}
        words = ["--profile=grbl-servo", "--set-profile=area.x=[0,430]", "--set-profile=motion.draw_speed=30"]
        self.check_words(CAT, settings, *words, "--size=30x40mm", "--pitch=0.6")

    def test_scenes(self) -> None:
        scene = self.folder / "scene.toml"
        scene.write_text(f'photograph = "{CAT}"\nstyle = "charcoal"\nsize = "30x40mm"\n[set]\npitch = 0.8\n')
        self.check_words(scene, {}, "--size=30x40mm")
        self.assertIn("charcoal", drypoint.draw(scene, arc_length=6).to_svg()[:400])

    def test_wrong_names(self) -> None:
        for settings, message in [
            ({"pich": 0.5}, "'pich' is neither an option .* the style hedcut; did you mean pitch"),
            ({"mirrored": True}, "did you mean mirror"),
            ({"edge_lenght": 3}, "did you mean edge_length"),
            ({"whirls": 3}, "neither .* hedcut; it belongs to another style"),
            ({"preset": "wsj-column", "whirrls": 3}, "any style; did you mean whirls"),
            ({"output": "a.svg"}, "Drawing.save"),
            ({"json": True}, "Drawing.save"),
            ({"xyzzy": 1}, "drypoint styles hedcut"),
        ]:
            with self.subTest(settings=settings), self.assertRaisesRegex(TypeError, message):
                drypoint.draw(CAT, **settings)

    def test_wrong_values(self) -> None:
        for settings, error, message in [
            ({"size": "38"}, ValueError, "'38' is not a size"),
            ({"pitch": -1}, ValueError, "must be above 0"),
            ({"pitch": float("nan")}, ValueError, "nan"),
            ({"style": "gird"}, ValueError, "there is no style 'gird'"),
            ({"style": "gird", "blob": 1}, ValueError, "there is no style 'gird'"),
            ({"levels": "many"}, ValueError, "levels"),
            ({"tone": "dark"}, ValueError, "portrait, lightness, linear"),
            ({"profile": "grbl-serv"}, ValueError, "grbl-servo"),
            ({"mirror": "yes"}, TypeError, "mirror is True or False"),
            ({"pen": True}, TypeError, "pen takes a value"),
            ({"mask": "hair.png"}, TypeError, "mask is a dict"),
            ({"pitch": object()}, TypeError, "a setting is text"),
            ({"mask": {"hair": "missing.png"}}, drypoint.DrypointError, "missing.png does not exist"),
        ]:
            with self.subTest(settings=settings), self.assertRaisesRegex(error, message):
                drypoint.draw(CAT, **settings)

    def test_warnings_show_the_callers_line(self) -> None:
        with self.assertWarns(drypoint.DrypointWarning) as told:
            drypoint.draw(CAT, size_max=0.3, **SMALL)
        self.assertEqual(told.filename, __file__)
        self.assertIn("size_max", str(told.warning))

    def test_notices(self) -> None:
        notices = " ".join(drypoint.draw(HOPPER, **SMALL).notices)
        self.assertIn("background left out", notices)


if __name__ == "__main__":
    unittest.main()
