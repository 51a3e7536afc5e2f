"""vpype and drypoint, called for the tests."""

import json
import os
import subprocess
import tempfile
from collections import Counter
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import vpype
import vpype_cli
from vpype_drypoint.command import command

SAMPLES = Path(os.environ.get("DRYPOINT_SAMPLES", Path(__file__).parents[3] / "samples")).resolve()
HOPPER = SAMPLES / "grace-hopper.jpg"
CAT = SAMPLES / "chelsea.png"
MM = vpype.convert_length("1mm")
# Small and coarse, so that a test takes a second.
SMALL = "--size 40x50mm --pitch 0.7"


def pipeline(words: str, document: vpype.Document | None = None) -> vpype.Document:
    """What a command line of vpype makes of a document."""
    return vpype_cli.execute(words, document)


def vpype_itself(*words: Any) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["vpype", *map(str, words)], capture_output=True, text=True)


def drawn_by_command(words: str, photo: Path) -> tuple[Any, Any]:
    """The tool paths that `drypoint draw` writes for the plug-in's sheet, and what it reports of them."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "paths.json")
        sheet = files("vpype_drypoint") / "sheet.toml"
        call = [command(), "draw", str(photo), *words.split(), f"--profile={sheet}", "--json", "-o", str(path)]
        report = subprocess.run(call, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
        return json.loads(path.read_bytes()), json.loads(report)


def document_of(lines: list[np.ndarray]) -> vpype.Document:
    return vpype.Document(vpype.LineCollection(lines))


def travel_mm(document: vpype.Document) -> float:
    return float(document.pen_up_length() / MM)


def undirected(lines: vpype.LineCollection) -> Counter[bytes]:
    """The lines to the last bit, whichever way they run, with how often each is there."""
    return Counter(min(line.tobytes(), line[::-1].tobytes()) for line in lines)


def directed(lines: vpype.LineCollection) -> Counter[bytes]:
    return Counter(line.tobytes() for line in lines)
