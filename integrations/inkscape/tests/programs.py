"""The programs of the tests: Inkscape without a screen, the extension as Inkscape calls it, and drypoint itself."""

from __future__ import annotations

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

EXTENSION = Path(__file__).resolve().parent.parent / "drypoint"
SAMPLES = Path(__file__).resolve().parents[3] / "samples"
# Quick to draw; without detection, which takes longest.
QUICK = ["--sight=none", "--pitch=1.5mm"]


@dataclass(frozen=True)
class Said:
    """How a program ended."""

    status: int
    words: str


def drypoint(*arguments: str) -> str:
    ended = subprocess.run([os.environ["DRYPOINT"], *arguments], capture_output=True, text=True, check=True)
    return ended.stdout


def own_file(photograph: Path, size_mm: tuple[float, float], output: Path, *further: str) -> Path:
    """The command's own drawing of a photograph in this box."""
    size = f"--size={size_mm[0]:.4f}x{size_mm[1]:.4f}mm"
    drypoint("draw", str(photograph), "-o", str(output), size, "--quiet", *QUICK, *further)
    return output


def in_inkscape(page: Path, selected: list[str], fields: dict[str, str], output: Path, scratch: Path) -> Said:
    """Runs the extension in Inkscape, which takes the fields of the dialog from its preferences."""
    profile = scratch / "profile"
    extensions = profile / "extensions"
    extensions.mkdir(parents=True, exist_ok=True)
    if not (extensions / "drypoint").exists():
        (extensions / "drypoint").symlink_to(EXTENSION)
    settings = " ".join(f'org.drypoint.draw.{key}="{value}"' for key, value in fields.items())
    (profile / "preferences.xml").write_text(f'<inkscape version="1"><group id="extensions" {settings}/></inkscape>')
    actions = f"select-by-id:{','.join(selected)};org.drypoint.draw.noprefs;export-filename:{output};export-do"
    # A message would wait for a click that never comes.
    command = ["timeout", "300", "xvfb-run", "-a", "inkscape", "--batch-process", f"--actions={actions}", str(page)]
    environment = {**os.environ, "INKSCAPE_PROFILE_DIR": str(profile)}
    return _ended(command, environment, page.parent)


def directly(page: Path, selected: list[str], arguments: list[str], output: Path, **environment: str) -> Said:
    """Runs the extension's file with the arguments that Inkscape would give it."""
    script = [str(_system_python()), str(EXTENSION / "drypoint_draw.py")]
    ids = [f"--id={identity}" for identity in selected]
    command = [*script, *ids, *arguments, f"--output={output}", str(page)]
    inkex = {"PYTHONPATH": f"{EXTENSION}:/usr/share/inkscape/extensions", "PYTHONDONTWRITEBYTECODE": "1"}
    return _ended(command, {**os.environ, **inkex, **environment}, page.parent)


def _system_python() -> Path:
    # Debian's inkex belongs to Debian's Python.
    return Path("/usr/bin/python3")


def _ended(command: list[str], environment: dict[str, str], folder: Path) -> Said:
    ended = subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True, check=False)
    return Said(ended.returncode, ended.stderr)
