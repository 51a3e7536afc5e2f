"""Draws portraits on a Slurm cluster of four nodes on this machine, and compares with a plain run."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from cluster import Cluster, ask
from kills import run_with_kills
from outcome import Outcome, outcome
from plain import DRYPOINT, ENOUGH_TO_MEASURE, HOSTILE, PORTRAITS, RECIPE, Plain, prepare
from processes import MARK, Family, Watch, end_all
from tally import Tally

HERE = Path(__file__).resolve().parent
FOLDER = Path(os.environ[MARK])
# Some for each node, so that one part that takes longer does not leave the others idle for long.
PARTS = 8 if PORTRAITS < ENOUGH_TO_MEASURE else 32
family = Family()
tally = Tally()


class Drawing:
    """The array and the step that collects, submitted as the scripts say."""

    def __init__(self, manifest: Path, name: str) -> None:
        self.manifest, self.outputs, self.parts = manifest, FOLDER / name / "out", FOLDER / name / "parts"
        self.results, self.log = FOLDER / f"{name}.jsonl", FOLDER / f"{name}.log"
        draw = [f"--array=1-{PARTS}", "--cpus-per-task=1", "--mem=900M", f"--output={FOLDER}/{name}-%a.txt"]
        words = [HERE / "draw.sbatch", manifest, f"{self.outputs}/{{name}}.svg", self.parts, *RECIPE]
        self.array = ask("sbatch", "--parsable", *draw, *map(str, words)).strip()
        collect = [f"--dependency=afterany:{self.array}", "--mem=100M", f"--output={self.log}"]
        words = [HERE / "collect.sbatch", manifest, self.parts, PARTS, self.results]
        self.collecting = ask("sbatch", "--parsable", *collect, *map(str, words)).strip()

    def is_going(self) -> bool:
        queued = ask("squeue", "--noheader", "--format=%A", "--states=PD,R,CG,CF,S,RQ,SE", "--me").split()
        return bool(queued)

    def end(self) -> bool:
        while self.is_going():
            time.sleep(0.3)
        return "ExitCode=3:0" in ask("scontrol", "show", "job", self.collecting)


def check_right(what: str, found: Outcome) -> None:
    tally.check(found.is_right(PORTRAITS, HOSTILE), f"{what}: all portraits right, all others reported", found)


def result_of(run: Drawing, reference: dict[str, str]) -> Outcome:
    return outcome(run.manifest, run.results, run.outputs, reference)


def draw_all(plain: Plain, reference: dict[str, str]) -> None:
    with Watch(family) as watch:
        begun = time.monotonic()
        run = Drawing(plain.manifest, "first")
        ended = run.end()
        print(f"Slurm took {time.monotonic() - begun:.0f} s for {PORTRAITS} + {HOSTILE} pictures", flush=True)
    found = result_of(run, reference)
    check_right("Slurm", found)
    tally.check(found.done == PORTRAITS, "each portrait is drawn once", found.done)
    tally.check(ended and " 0 lost" in run.log.read_text(), "the results are collected", run.log.read_text().strip())
    enough = watch.busy.share >= 0.9 or PORTRAITS < ENOUGH_TO_MEASURE
    tally.check(enough, "processors busy 90 % while pictures are drawn, if these are many", watch.busy)

    times = {path: path.stat().st_mtime_ns for path in run.outputs.rglob("*")}
    again = Drawing(plain.manifest, "first")
    again.end()
    found = result_of(again, reference)
    check_right("Slurm again", found)
    same = times == {path: path.stat().st_mtime_ns for path in again.outputs.rglob("*")}
    tally.check(found.skipped == PORTRAITS and same, "a second run draws nothing and writes no file", found.skipped)


def check_refusals(plain: Plain) -> None:
    """Part 3 of 1 would leave photographs out without a word."""
    environment = {**os.environ, "SLURM_ARRAY_TASK_ID": "3", "SLURM_ARRAY_TASK_COUNT": "1"}
    words = ["bash", HERE / "draw.sbatch", plain.manifest, f"{FOLDER}/no/{{name}}.svg", FOLDER / "no"]
    done = subprocess.run(words, env=environment, capture_output=True, encoding="utf-8")
    tally.check(
        done.returncode == 2 and not (FOLDER / "no").exists(), "a part beyond the last is refused", done.stderr.strip()
    )


def draw_with_kills(cluster: Cluster, plain: Plain, reference: dict[str, str]) -> None:
    # With `drypoint batch` alone the script lives and has the part queued again; with the script the part has failed and is submitted
    # again; with the daemon above it, the controller finds it missing and queues it again.
    start = lambda: Drawing(plain.manifest, "killed")  # noqa: E731
    told = run_with_kills(start, cluster.kill_controller, FOLDER / "killed/out", family, depths=[0, 1, 2, 0, 1])
    found = outcome(plain.manifest, FOLDER / "killed.jsonl", FOLDER / "killed/out", reference)
    check_right(f"Slurm with kills ({told})", found)


def main() -> None:
    # The usual way to stop a test must clean up too.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    os.environ["DRYPOINT"] = DRYPOINT
    try:
        plain = prepare()
        reference = plain.digests()
        check_right("a plain run", outcome(plain.manifest, plain.results, plain.outputs, reference))
        cluster = Cluster(FOLDER / "cluster", family)
        draw_all(plain, reference)
        check_refusals(plain)
        draw_with_kills(cluster, plain, reference)
    finally:
        end_all(family)
    left = [process.command for process in family.processes()]
    tally.check(not left, "no process is left", left)
    tally.close()


if __name__ == "__main__":
    main()
