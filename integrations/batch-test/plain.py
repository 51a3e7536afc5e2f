"""The pictures of a test and a plain run of `drypoint batch` over them, with which the engines' runs are compared."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from dataclasses import asdict, dataclass, field
from pathlib import Path

from make import make
from outcome import digests
from processes import DRYPOINT, MARK, Busy, Family, Watch

# A small recipe: about a quarter of a second for each portrait.
RECIPE = ["--style", "hedcut", "--size", "30x40mm", "--sight", "none"]
HOSTILE = 20
# So few that the tests take minutes; a thousand for acceptance.
PORTRAITS = int(os.environ.get("DRYPOINT_PICTURES", "60"))
# A share of busy processors says something only where the beginning and the end are a small part of the run.
ENOUGH_TO_MEASURE = 500


@dataclass
class Memory:
    """Resident memory in kilobytes while `drypoint batch` runs."""

    itself: list[int] = field(default_factory=list)  # after each picture
    largest_child: int = 0
    all_together: int = 0  # the most at once

    def grown(self) -> float:
        """Growth from a tenth of the way to its end: from picture 100 to picture 1000."""
        return self.itself[-1] / self.itself[len(self.itself) // 10] - 1

    def __str__(self) -> str:
        tenth = len(self.itself) // 10
        return (
            f"drypoint batch {self.itself[tenth]} kB at picture {tenth}, {self.itself[-1]} kB at picture {len(self.itself)}, "
            f"grown by {self.grown():.1%}; largest child {self.largest_child} kB, all together at most {self.all_together} kB"
        )


def status_number(pid: int, key: str) -> int:
    try:
        lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    except OSError:
        return 0
    return next((int(line.split()[1]) for line in lines if line.startswith(f"{key}:")), 0)


def children_of(pid: int) -> list[int]:
    """Threads start children too."""
    try:
        threads = list(Path(f"/proc/{pid}/task").iterdir())
        return [int(child) for thread in threads for child in (thread / "children").read_text().split()]
    except OSError:
        return []


@dataclass
class Plain:
    """A folder with the pictures, the outputs of a plain run, and what that run said."""

    folder: Path
    memory: Memory = field(default_factory=Memory)
    busy: Busy = field(default_factory=Busy)

    @property
    def manifest(self) -> Path:
        return self.folder / "manifest.tsv"

    @property
    def outputs(self) -> Path:
        return self.folder / "plain"

    @property
    def results(self) -> Path:
        return self.folder / "plain.jsonl"

    def digests(self) -> dict[str, str]:
        return digests(self.outputs)

    def run(self) -> int:
        """Draws all pictures in one process, notes its memory, and returns its exit status."""
        command = [DRYPOINT, "batch", str(self.manifest), "-o", f"{self.outputs}/{{name}}.svg", "--quiet", *RECIPE]
        memory, ended = self.memory, threading.Event()
        with self.results.open("w", encoding="utf-8") as results:
            batch = subprocess.Popen(command, stdout=subprocess.PIPE, encoding="utf-8")

            def watch_children() -> None:
                while not ended.wait(0.05):
                    children = children_of(batch.pid)
                    memory.largest_child = max(
                        [memory.largest_child, *(status_number(child, "VmHWM") for child in children)]
                    )
                    together = sum(status_number(pid, "VmRSS") for pid in [batch.pid, *children])
                    memory.all_together = max(memory.all_together, together)

            watcher = threading.Thread(target=watch_children, daemon=True)
            watcher.start()
            for line in batch.stdout:
                memory.itself.append(status_number(batch.pid, "VmRSS"))
                results.write(line)
            status = batch.wait()
            ended.set()
            watcher.join()
        # The last line may come as the process ends, when it has no memory any more.
        memory.itself = [kilobytes for kilobytes in memory.itself if kilobytes]
        return status


def prepare() -> Plain:
    """The pictures and a plain run; made once where several tests share DRYPOINT_BATCH_FOLDER."""
    shared = os.environ.get("DRYPOINT_BATCH_FOLDER") or tempfile.mkdtemp(dir=os.environ[MARK])
    folder = Path(shared).resolve() / "portraits"
    plain = Plain(folder)
    wanted = [PORTRAITS, DRYPOINT, os.stat(DRYPOINT).st_mtime, RECIPE]
    made = folder / "made.json"
    if made.exists():
        before = json.loads(made.read_text())
        if before["of"] == wanted:
            plain.memory, plain.busy = Memory(**before["memory"]), Busy(**before["busy"])
            return plain
    shutil.rmtree(folder, ignore_errors=True)
    make(folder, PORTRAITS)
    with Watch(Family()) as watch:
        status = plain.run()
    plain.busy = watch.busy
    if status != 3:
        sys.exit(f"the plain run ended with status {status} instead of 3, as some files are no pictures")
    made.write_text(json.dumps({"of": wanted, "memory": asdict(plain.memory), "busy": asdict(plain.busy)}))
    return plain
