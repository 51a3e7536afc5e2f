"""Draws portraits with GNU parallel and compares with a plain run."""

import os
import signal
import subprocess
import sys
from pathlib import Path

from kills import run_with_kills
from outcome import outcome
from plain import DRYPOINT, HOSTILE, PORTRAITS, RECIPE, prepare
from processes import MARK, Family, end_all, kill
from tally import Tally

HERE = Path(__file__).resolve().parent
FOLDER = Path(os.environ[MARK])
family = Family()
tally = Tally()


class Drawing:
    """A run of draw.sh."""

    def __init__(self, manifest: Path, outputs: Path, results: Path) -> None:
        words = ["bash", HERE / "draw.sh", manifest, f"{outputs}/{{name}}.svg", results, *RECIPE]
        environment = {
            **os.environ,
            "DRYPOINT": DRYPOINT,
            "PARTS": "8",
            "JOBS": "4",
            "PARALLEL_HOME": str(FOLDER / "home"),
        }
        self.log = results.with_suffix(".err")
        with self.log.open("w") as log:
            self.process = subprocess.Popen(words, env=environment, stderr=log)

    def is_going(self) -> bool:
        return self.process.poll() is None

    def end(self) -> bool:
        return self.process.wait(timeout=7200) == 3


def kill_parallel() -> None:
    """Kills parallel and the script that started it; the parts that are drawn live on."""
    for process in family.processes():
        if "/parallel" in " ".join(process.command[:2]) or "draw.sh" in " ".join(process.command[:2]):
            kill(process.pid)


def main() -> None:
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    try:
        plain = prepare()
        reference = plain.digests()
        for attempt, drawn in (("parallel", "done"), ("parallel again", "skipped")):
            run = Drawing(plain.manifest, FOLDER / "out", FOLDER / "results.jsonl")
            run.end()
            found = outcome(plain.manifest, FOLDER / "results.jsonl", FOLDER / "out", reference)
            right = (
                found.is_right(PORTRAITS, HOSTILE)
                and getattr(found, drawn) == PORTRAITS
                and run.process.returncode == 3
            )
            tally.check(right, f"{attempt}: all portraits right, all others reported", found)
        outputs, results = FOLDER / "killed", FOLDER / "killed.jsonl"
        # What dies is the part's `drypoint batch` alone, or with the shell above it.
        told = run_with_kills(lambda: Drawing(plain.manifest, outputs, results), kill_parallel, outputs, family, [0, 1])
        found = outcome(plain.manifest, results, outputs, reference)
        tally.check(found.is_right(PORTRAITS, HOSTILE), f"parallel with kills ({told})", found)
    finally:
        end_all(family)
    tally.close()


if __name__ == "__main__":
    main()
