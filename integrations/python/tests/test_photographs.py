"""A photograph gives the same drawing in whatever form it is handed over."""

import io
import subprocess
import sys
import unittest
from typing import Any

import drypoint
import numpy as np
from commandline import CAT, HOPPER, SAMPLES, SMALL, InFolder
from PIL import Image


class Photographs(InFolder):
    def check_same(self, photo: Any, file: Any, **settings: Any) -> None:
        one, other = (drypoint.draw(given, **SMALL, **settings) for given in (photo, file))
        self.assertEqual(one.page_mm, other.page_mm)
        self.assertGreater(sum(len(layer.dots) for layer in one.layers), 100)
        for a, b in zip(one.layers, other.layers, strict=True):
            np.testing.assert_array_equal(a.dots, b.dots)
            self.assertEqual(len(a.strokes), len(b.strokes))

    def check_alike(self, photo: Any, file: Any) -> None:
        """Nearly the same drawing: two decoders of JPEG differ in the last bit."""
        one, other = (drypoint.draw(given, **SMALL) for given in (photo, file))
        self.assertEqual(one.page_mm, other.page_mm)
        for a, b in zip(one.layers, other.layers, strict=True):
            self.assertAlmostEqual(
                np.sum(a.dots[:, 2] ** 2), np.sum(b.dots[:, 2] ** 2), delta=0.02 * np.sum(b.dots[:, 2] ** 2)
            )

    def saved(self, image: Image.Image, name: str, **options: Any) -> str:
        path = str(self.folder / name)
        image.save(path, **options)
        return path

    def test_bytes_and_files(self) -> None:
        self.check_same(CAT.read_bytes(), CAT)
        self.check_same(io.BytesIO(CAT.read_bytes()), str(CAT))
        with open(HOPPER, "rb") as file:
            self.check_same(file, HOPPER)

    def test_arrays(self) -> None:
        self.check_same(np.array(Image.open(CAT)), CAT)
        grey = Image.open(CAT).convert("L")
        self.check_same(np.array(grey), self.saved(grey, "grey.png"))
        # Two dimensions or three.
        self.check_same(np.array(grey)[:, :, np.newaxis], np.array(grey))

    def test_arrays_of_other_numbers(self) -> None:
        pixels = np.array(Image.open(CAT))
        self.check_same(pixels.astype(np.uint16) * 257, CAT)
        self.check_same(pixels / 255, CAT)
        self.check_same((pixels / 255).astype(np.float32), CAT)
        self.check_same(np.array(Image.open(CAT).convert("1")), self.saved(Image.open(CAT).convert("1"), "bits.png"))

    def test_alpha_is_the_subject(self) -> None:
        cutout = SAMPLES / "astronaut-cutout.png"
        self.check_same(np.array(Image.open(cutout)), cutout)

    def test_slices_and_other_byte_orders(self) -> None:
        pixels = np.array(Image.open(CAT))
        path = self.saved(Image.fromarray(np.ascontiguousarray(pixels[::-2, ::2])), "half.png")
        self.check_same(pixels[::-2, ::2], path)
        self.check_same((pixels[::-2, ::2].astype(">u2") * 257), path)

    def test_pil_images(self) -> None:
        self.check_same(Image.open(CAT), CAT)
        self.check_alike(Image.open(HOPPER), HOPPER)
        self.check_same(Image.open(CAT).convert("P"), self.saved(Image.open(CAT).convert("P"), "palette.png"))
        self.check_same(Image.open(CAT).convert("CMYK"), Image.open(CAT).convert("CMYK").convert("RGB"))

    def test_pil_images_of_many_bits(self) -> None:
        grey = Image.open(CAT).convert("L")
        for image in [grey.convert("F").point(lambda v: v / 255), grey.convert("I").point(lambda v: v * 257)]:
            self.check_same(image, self.saved(grey, "grey.png"))
        with self.assertRaisesRegex(ValueError, "from 0 .* to 65535"):
            drypoint.draw(grey.convert("I").point(lambda v: v * 70000))

    def test_exif_turns_an_image_too(self) -> None:
        exif = Image.Exif()
        exif[0x0112] = 6
        path = self.saved(Image.open(HOPPER), "turned.jpg", exif=exif, quality=95)
        self.assertEqual(drypoint.draw(path, size=(60, 60)).page_mm, (60.0, 51.2))
        self.check_alike(Image.open(path), path)

    def test_no_picture_library_is_needed(self) -> None:
        script = (
            "import sys; sys.modules['PIL'] = None\n"
            "import drypoint, numpy\n"
            "print(drypoint.draw(numpy.full((40, 30), 99, numpy.uint8), size=(30, 40)).page_mm)"
        )
        told = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True).stdout
        self.assertEqual(told.strip(), "(30.0, 40.0)")

    def test_masks_and_depth_in_memory(self) -> None:
        bust = SAMPLES / "bust-light.png"
        hair, depth = SAMPLES / "bust-mask-hair.png", SAMPLES / "bust-depth.png"
        mask = np.array(Image.open(hair).convert("L"))
        self.assertNotEqual(
            len(drypoint.draw(bust, mask={"hair": np.zeros_like(mask)}, sight="none", **SMALL).layers[0].dots),
            len(drypoint.draw(bust, mask={"hair": mask}, sight="none", **SMALL).layers[0].dots),
        )
        self.check_same(bust, bust, mask={"hair": mask}, sight="none")
        by_file = drypoint.draw(bust, "engrave", depth=depth, **SMALL)
        in_memory = drypoint.draw(bust, "engrave", depth=Image.open(depth), **SMALL)
        self.assertEqual([len(l.strokes) for l in by_file.layers], [len(l.strokes) for l in in_memory.layers])

    def test_what_is_no_photograph(self) -> None:
        for photo, error, message in [
            (SAMPLES / "README.md", drypoint.DrypointError, "README.md is not in a known image format"),
            (b"no picture", drypoint.DrypointError, "not in a known image format"),
            ("missing.jpg", drypoint.DrypointError, "missing.jpg does not exist"),
            (np.zeros((4, 4), np.int64), TypeError, "int64"),
            (np.zeros((4, 4, 5), np.uint8), ValueError, "4 x 4 x 5 is no picture"),
            (np.full((4, 4), 1.5), ValueError, "from 0 .* to 1"),
            (np.full((4, 4), np.nan), ValueError, "from 0 .* to 1"),
            (io.StringIO("text"), TypeError, "opened for bytes"),
            (3, TypeError, "not int"),
        ]:
            with self.subTest(photo=str(photo)[:40]), self.assertRaisesRegex(error, message):
                drypoint.draw(photo)  # type: ignore[arg-type]


if __name__ == "__main__":
    unittest.main()
