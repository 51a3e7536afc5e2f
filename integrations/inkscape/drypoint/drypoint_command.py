"""The drypoint program: where it is, and one run of it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import inkex
from drypoint_placing import Box

MISSING = """drypoint was not found on this computer. This extension only places what the program drypoint draws.

Install it from a release of drypoint:
  Debian, Ubuntu   sudo apt install ./drypoint_*.deb
  macOS            brew install drypoint   after drypoint's own brew tap
  Windows          winget install Drypoint.Drypoint
  from source      cargo install --path .   in drypoint's folder

If it is installed, choose the program in the tab More."""


@dataclass(frozen=True)
class Drawing:
    """What drypoint drew: the SVG, the photograph's box in it in mm, and what the user should know."""

    svg: inkex.SvgDocumentElement
    picture: Box
    warnings: list[str]


def find_program(chosen: str) -> str:
    """The program chosen in the dialog, or $DRYPOINT, or the one on the path or in the usual places of installers."""
    if chosen:
        if shutil.which(chosen):
            return chosen
        raise inkex.AbortExtension(f"{chosen} is no program that can be run. Choose drypoint itself in the tab More.")
    named = os.environ.get("DRYPOINT")
    found = (shutil.which(named) if named else None) or shutil.which("drypoint")
    # Programs started from a desktop often do not have the path of the user's shell.
    found = found or shutil.which("drypoint", path=os.pathsep.join(_usual_folders()))
    if not found:
        raise inkex.AbortExtension(MISSING)
    return found


@dataclass(frozen=True)
class Photograph:
    """A picture, and what the user knows it by."""

    path: Path
    name: str


def draw(program: str, photograph: Photograph, options: list[str], folder: Path, scratch: Path) -> Drawing:
    """Runs `drypoint draw` in `folder`, so that masks and other files are found beside the document."""
    output = scratch / "drawing.svg"
    command = [program, "draw", *options, "--quiet", "--json", f"--output={output}", "--", str(photograph.path)]
    try:
        ended = subprocess.run(
            command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, check=False, **_hidden()
        )
    except OSError as error:
        raise inkex.AbortExtension(f"{program} could not be started: {error}.") from error
    if ended.returncode != 0:
        raise inkex.AbortExtension(_words(ended, photograph))
    svg = inkex.load_svg(output.read_bytes()).getroot()
    return Drawing(svg, _picture(svg), json.loads(ended.stdout).get("warnings", []))


def _usual_folders() -> list[str]:
    home = Path.home()
    folders = [home / ".cargo/bin", home / ".local/bin", Path("/usr/local/bin"), Path("/opt/homebrew/bin")]
    if sys.platform == "win32":
        folders.append(Path(os.environ.get("LOCALAPPDATA", home)) / "Microsoft/WinGet/Links")
    return [str(folder) for folder in folders]


def _hidden() -> dict[str, int]:
    # No console window flashes up on Windows.
    return {"creationflags": subprocess.CREATE_NO_WINDOW} if sys.platform == "win32" else {}


def _words(ended: subprocess.CompletedProcess[bytes], photograph: Photograph) -> str:
    said = ended.stderr.decode("utf-8", "replace").strip()
    if said:
        return said.replace(str(photograph.path), photograph.name)
    return f"drypoint stopped without a word (exit status {ended.returncode})."


def _picture(svg: inkex.SvgDocumentElement) -> Box:
    recipe = svg.xpath("//*[local-name()='recipe']")
    try:
        return Box(*json.loads(recipe[0].text)["picture_mm"])
    except (IndexError, KeyError, TypeError, ValueError) as error:
        raise inkex.AbortExtension(
            "This drypoint writes drawings that the extension does not understand. Update both to the same version."
        ) from error
