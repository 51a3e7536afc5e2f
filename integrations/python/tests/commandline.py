"""The same command, called by itself to compare with."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Any

import drypoint

SAMPLES = Path(os.environ.get("DRYPOINT_SAMPLES", Path(__file__).parents[3] / "samples")).resolve()
HOPPER = SAMPLES / "grace-hopper.jpg"
CAT = SAMPLES / "chelsea.png"
# Small and coarse, so that a test takes a second.
SMALL = {"size": "30x40mm", "pitch": 0.6}
SMALL_WORDS = ["--size=30x40mm", "--pitch=0.6"]


def call(*words: Any) -> bytes:
    return subprocess.run(
        [drypoint.command(), *map(str, words)], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    ).stdout


def report_of(*words: Any) -> Any:
    """What `drypoint draw --json` reports."""
    with tempfile.TemporaryDirectory() as folder:
        return json.loads(call("draw", *words, "--json", "-o", Path(folder, "report.svg")))


def bytes_of(ending: str, *words: Any) -> bytes:
    """The file that `drypoint draw` writes."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"drawing.{ending}")
        call("draw", *words, "-o", path)
        return path.read_bytes()


class InFolder(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
