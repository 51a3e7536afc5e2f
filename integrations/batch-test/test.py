"""Checks `drypoint batch` without an engine."""

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

from PIL import Image

from kills import run_with_kills
from make import make
from outcome import digests, outcome, read_names
from plain import DRYPOINT, ENOUGH_TO_MEASURE, HOSTILE, PORTRAITS, RECIPE, Plain, prepare
from processes import MARK, Family, end_all
from tally import Tally

FOLDER = Path(os.environ[MARK])
family = Family()
tally = Tally()


def check_pictures() -> None:
    """The same pictures each time, and few are the first of many."""
    made = []
    for name, count in (("one", 10), ("two", 10), ("three", 13)):
        make(FOLDER / name, count)
        made.append(digests(FOLDER / name / "in"))
    tally.check(
        made[0] == made[1] and made[0].items() < made[2].items(), "pictures are the same each time", len(made[0])
    )
    tally.check(len(set(made[2].values())) >= 13 + 14, "pictures differ", len(set(made[2].values())))


def check_hostile(plain: Plain) -> None:
    """Each of them is refused by `draw` too, with words and without a file."""
    names = sorted(name for name in read_names(plain.manifest) if name.startswith("h"))
    files = {Path(line.split("\t")[0]).stem: line.split("\t")[0] for line in plain.manifest.read_text().splitlines()}
    wrong = []
    for name in names:
        output = FOLDER / "hostile.svg"
        command = [DRYPOINT, "draw", plain.folder / files[name], "-o", output, *RECIPE]
        done = subprocess.run(command, capture_output=True, encoding="utf-8", timeout=120)
        if done.returncode != 1 or output.exists() or Path(files[name]).name not in done.stderr:
            wrong.append(f"{name}: status {done.returncode}, {done.stderr.strip()}")
    tally.check(len(names) == HOSTILE and not wrong, "every hostile file is refused by draw", wrong or len(names))


def batch(manifest: Path, outputs: Path, *words: str, limit: int = 7200) -> tuple[int, list[dict]]:
    """Exit status and lines of a run; status 124 if it takes longer than so many seconds."""
    command = [DRYPOINT, "batch", manifest, "-o", f"{outputs}/{{name}}.svg", "--quiet", *RECIPE, *words]
    try:
        done = subprocess.run(
            command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, encoding="utf-8", timeout=limit
        )
    except subprocess.TimeoutExpired:
        return 124, []
    return done.returncode, [json.loads(line) for line in done.stdout.splitlines()]


def check_shards(plain: Plain) -> None:
    """Three shards are all pictures, each in one, with the plain run's bytes."""
    # Few are enough.
    few = plain.folder / "few.tsv"
    few.write_text("".join(plain.manifest.read_text(encoding="utf-8").splitlines(keepends=True)[:60]), encoding="utf-8")
    runs = [batch(few, FOLDER / "shards", "--shard", f"{shard}/3") for shard in (1, 2, 3)]
    lines = [line for _, lines in runs for line in lines]
    results = FOLDER / "shards.jsonl"
    results.write_text("".join(json.dumps(line) + "\n" for line in lines), encoding="utf-8")
    found = outcome(few, results, FOLDER / "shards", plain.digests())
    whole = (found.lost, found.doubled, found.wrong, found.strangers) == (0, 0, [], [])
    tally.check(whole and all(lines for _, lines in runs), "three shards are the whole", found)


def check_odd(plain: Plain) -> None:
    """Files that are no photograph in a way of their own, first in line, each with a good portrait after it."""
    folder = FOLDER / "odd"
    folder.mkdir()
    Image.new("RGB", (300, 1)).save(folder / "one pixel high.png")
    os.mkfifo(folder / "named pipe.jpg")
    (folder / "endless device.jpg").symlink_to("/dev/zero")
    portrait = next(path for path in sorted((plain.folder / "in").iterdir()) if path.name.startswith("p"))
    for odd in ("one pixel high.png", "named pipe.jpg", "endless device.jpg"):
        manifest = folder / f"{Path(odd).stem}.tsv"
        manifest.write_text(f"{folder}/{odd}\todd\n{portrait}\tgood\n")
        status, lines = batch(manifest, FOLDER / "odd-out" / Path(odd).stem, "--jobs", "1", limit=60)
        statuses = {line["name"]: line["status"] for line in lines}
        right = status == 3 and statuses == {"odd": "failed", "good": "done"}
        tally.check(right, f"{odd} is reported and stops no other", f"status {status}, {statuses}")


class Drawing:
    """A run of `drypoint batch`."""

    def __init__(self, manifest: Path, outputs: Path, results: Path) -> None:
        command = [DRYPOINT, "batch", str(manifest), "-o", f"{outputs}/{{name}}.svg", "--quiet", *RECIPE]
        with results.open("w") as lines:
            self.process = subprocess.Popen(command, stdout=lines, stderr=subprocess.DEVNULL)

    def is_going(self) -> bool:
        return self.process.poll() is None

    def end(self) -> bool:
        return self.process.wait(timeout=7200) == 3


def check_kills(plain: Plain) -> None:
    outputs, results = FOLDER / "killed", FOLDER / "killed.jsonl"
    told = run_with_kills(lambda: Drawing(plain.manifest, outputs, results), None, outputs, family, depths=[0])
    found = outcome(plain.manifest, results, outputs, plain.digests())
    tally.check(found.is_right(PORTRAITS, HOSTILE), f"drypoint batch with kills ({told})", found)


def main() -> None:
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    try:
        check_pictures()
        plain = prepare()
        found = outcome(plain.manifest, plain.results, plain.outputs, plain.digests())
        tally.check(found.is_right(PORTRAITS, HOSTILE), "all portraits right, all others reported", found)
        tally.check(abs(plain.memory.grown()) <= 0.05, "memory is flat within 5 %", plain.memory)
        enough = plain.busy.share >= 0.9 or PORTRAITS < ENOUGH_TO_MEASURE
        tally.check(enough, "processors busy 90 % while pictures are drawn, if these are many", plain.busy)
        check_hostile(plain)
        copy = FOLDER / "again"
        shutil.copytree(plain.outputs, copy)
        status, lines = batch(plain.manifest, copy)
        skipped = sum(line["status"] == "skipped" for line in lines)
        tally.check(
            status == 3 and skipped == PORTRAITS, "a second run skips all that is drawn, in another folder too", skipped
        )
        check_shards(plain)
        check_odd(plain)
        check_kills(plain)
    finally:
        end_all(family)
    tally.close()


if __name__ == "__main__":
    main()
