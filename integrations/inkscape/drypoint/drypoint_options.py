"""The fields of the dialog as options of `drypoint draw`."""

from __future__ import annotations

import shlex
from argparse import ArgumentParser, Namespace
from pathlib import Path

import inkex

PEN_PATHS = Path(__file__).with_name("pen-paths.toml")
# Marks may reach over the photograph's edge; for a machine, what reaches over the sheet's edge is refused.
PLOTTER_MARGIN_MM = 10
BLACK = 0x000000FF
# They say where the drawing goes and what comes back, which is the extension's part.
RESERVED = (
    "--output -o --format --embed --json --quiet -q --dry-run --send --yes -y --size --fit --page --margin --crop "
    "--rotate --mirror --at --center --help -h"
).split()


def add_fields(parser: ArgumentParser) -> None:
    """The fields of drypoint.inx. Inkscape leaves out empty ones; 0 and `auto` are drypoint's or the preset's."""
    parser.add_argument("--tab", default="")
    parser.add_argument("--style", default="auto")
    parser.add_argument("--preset", default="none")
    parser.add_argument("--pitch", type=float, default=0.0)
    parser.add_argument("--pen", type=float, default=0.0)
    parser.add_argument("--min_mark", type=float, default=0.0)
    parser.add_argument("--ink", type=int, default=BLACK)
    parser.add_argument("--tone", default="auto")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--marks", default="print")
    parser.add_argument("--photograph", default="hide")
    parser.add_argument("--more", default="")
    parser.add_argument("--program", default="")


def options(fields: Namespace, size_mm: tuple[float, float], cover: bool) -> list[str]:
    """The command line of one drawing of this size; what is typed in the free field wins over the other fields."""
    more = _typed(fields.more)
    typed = {word.partition("=")[0] for word in more if word.startswith("-")}
    chosen = _of_fields(fields)
    margin = 0
    if "--profile" in typed or "--profile" in chosen:
        # Ten thousand dots are ordered in a second instead of half a minute.
        chosen["--order"] = "fast"
        margin = PLOTTER_MARGIN_MM
    chosen = {name: value for name, value in chosen.items() if name not in typed}
    width, height = size_mm
    placed = {
        "--size": f"{width:.4f}x{height:.4f}mm",
        "--page": f"{width + 2 * margin:.4f}x{height + 2 * margin:.4f}mm",
        "--margin": "0mm",
        "--fit": "cover" if cover else "contain",
        # A preset may crop to the head; the drawing lies over the whole photograph.
        "--crop": "0,0,100%,100%",
    }
    return [f"{name}={value}" for name, value in {**chosen, **placed}.items()] + more


def _of_fields(fields: Namespace) -> dict[str, str]:
    found = {
        "--style": fields.style if fields.style != "auto" else "",
        "--preset": fields.preset if fields.preset != "none" else "",
        "--pitch": _millimetres(fields.pitch),
        "--pen": _millimetres(fields.pen),
        "--min-mark": _millimetres(fields.min_mark),
        "--ink": _ink(fields.ink),
        "--tone": fields.tone if fields.tone != "auto" else "",
        "--seed": str(fields.seed) if fields.seed else "",
        "--profile": {"print": "", "pen-paths": str(PEN_PATHS)}.get(fields.marks, fields.marks),
    }
    return {name: value for name, value in found.items() if value}


def _millimetres(length: float) -> str:
    return f"{length:g}mm" if length > 0 else ""


def _ink(colour: int) -> str:
    """Inkscape passes red, green, blue and opacity as bytes of a number; black is left to drypoint and the preset."""
    rgb = (colour >> 8) & 0xFFFFFF
    return f"#{rgb:06x}" if rgb else ""


def _typed(text: str) -> list[str]:
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise inkex.AbortExtension(f"Further options: {error}. Each quotation mark needs its partner.") from error
    for word in words:
        name = word.partition("=")[0]
        if name in RESERVED:
            raise inkex.AbortExtension(
                f"Further options: {name} cannot be given here. The drawing takes the place and the size of the image; "
                "change the image itself (to draw a part of it, crop it first)."
            )
    return words
