#!/usr/bin/env python3
"""Makes the pictures of the batch tests: portraits that differ in crop, tone and size, and files that are no pictures.

    make.py FOLDER [--portraits 1000]

writes FOLDER/in/* and FOLDER/manifest.tsv. The same Pillow writes the same bytes each time. The names of some portraits are
awkward, since a name must come through every shell and every engine as it is.
"""

import argparse
import random
from pathlib import Path

from PIL import Image, ImageEnhance, ImageOps

from hostile import hostile_files

SAMPLES = Path(__file__).resolve().parent.parent.parent / "samples"
# The part of each sample that holds the head, as shares of width and height: left, top, right, bottom. Crops contain it.
HEADS = {
    "astronaut.jpg": (0.28, 0.02, 0.62, 0.52),
    "grace-hopper.jpg": (0.25, 0.02, 0.80, 0.66),
    "bust-light.png": (0.22, 0.06, 0.78, 0.66),
    "bust-brown.png": (0.22, 0.06, 0.78, 0.66),
    "bust-dark.png": (0.22, 0.06, 0.78, 0.66),
}
AWKWARD = [
    "with space",
    "it's",
    'a "quote"',
    "100%",
    "-dash",
    "#hash",
    "$HOME",
    "größe",
    "{name}",
    "a;b&c",
    "back\\slash",
    "*",
]


def portrait(number: int, photographs: list[tuple[str, Image.Image]]) -> Image.Image:
    """One portrait; its number decides everything, so that 60 are the first 60 of 1000."""
    chance = random.Random(number)
    name, photograph = photographs[number % len(photographs)]
    left, top, right, bottom = HEADS[name]
    width, height = photograph.size
    box = (
        round(width * chance.uniform(0, left)),
        round(height * chance.uniform(0, top)),
        round(width * chance.uniform(right, 1)),
        round(height * chance.uniform(bottom, 1)),
    )
    cropped = photograph.crop(box)
    longest = chance.randint(256, 400)
    scale = longest / max(cropped.size)
    picture = cropped.resize((round(cropped.width * scale), round(cropped.height * scale)), Image.Resampling.BICUBIC)
    if chance.random() < 0.5:
        picture = ImageOps.mirror(picture)
    picture = ImageEnhance.Brightness(picture).enhance(chance.uniform(0.75, 1.25))
    return ImageEnhance.Contrast(picture).enhance(chance.uniform(0.75, 1.25))


def write_portraits(folder: Path, count: int) -> list[tuple[str, str]]:
    """Writes the portraits and returns a manifest's lines: path and name."""
    photographs = [(name, Image.open(SAMPLES / name).convert("RGB")) for name in HEADS]
    lines = []
    for number in range(count):
        stem = f"p{number:04}"
        if number % 5 == 0:
            stem = f"{stem} {AWKWARD[number // 5 % len(AWKWARD)]}"
        picture = portrait(number, photographs)
        # Each kind of file that is common, among them a grey one, one in a press's colours and one with a wrong ending.
        kind = number % 10
        path = folder / f"{stem}.{'png' if kind in (3, 7) else 'webp' if kind == 6 else 'jpg'}"
        if kind in (3, 9):
            picture.save(path, "PNG", compress_level=1)
        elif kind == 6:
            picture.save(path, "WEBP", quality=90)
        else:
            mode = {4: "CMYK", 8: "L"}.get(kind, "RGB")
            picture.convert(mode).save(path, "JPEG", quality=90)
        lines.append((f"{folder.name}/{path.name}", stem))
    return lines


def make(folder: Path, portraits: int) -> None:
    """Writes all pictures and the manifest."""
    pictures = folder / "in"
    pictures.mkdir(parents=True, exist_ok=True)
    lines = write_portraits(pictures, portraits)
    lines += [(f"in/{name}", Path(name).stem) for name in hostile_files(pictures)]
    # Mixed, so that each piece and each shard has some of both, as in life.
    random.Random(0).shuffle(lines)
    text = "".join(f"{path}\t{name}\n" for path, name in lines)
    (folder / "manifest.tsv").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--portraits", type=int, default=1000)
    arguments = parser.parse_args()
    make(arguments.folder, arguments.portraits)
