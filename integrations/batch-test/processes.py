"""The processes that a test started: those that carry its mark in their environment, and all below them. Linux only."""

import os
import random
import shutil
import signal
import sys
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

MARK = "DRYPOINT_TEST_RUN"
TICKS = os.sysconf("SC_CLK_TCK")


def find_drypoint() -> str:
    built = Path(__file__).resolve().parent.parent.parent / "target/release/drypoint"
    command = os.environ.get("DRYPOINT") or shutil.which("drypoint") or str(built)
    found = shutil.which(command)
    if not found:
        sys.exit(f"{command} is not there: build drypoint, or set DRYPOINT to the command")
    return os.path.abspath(found)


DRYPOINT = find_drypoint()
# What it may be called in a list of processes: `drypoint batch` starts its children by the name to which links lead.
NAMES = {"drypoint", Path(DRYPOINT).name, Path(DRYPOINT).resolve().name}


@dataclass
class Process:
    pid: int
    parent: int
    started: int  # with the number it names a process for good; numbers alone are used again
    cpu_seconds: float
    command: list[str]

    @property
    def is_batch(self) -> bool:
        return Path(self.command[0]).name in NAMES and self.command[1:2] == ["batch"]

    @property
    def draws(self) -> bool:
        """`drypoint batch` draws each picture in a process of its own."""
        return Path(self.command[0]).name in NAMES


def read_process(pid: int) -> Process | None:
    """None if it has ended by now."""
    try:
        # The name, in parentheses, may hold anything: the numbers begin after the last parenthesis.
        numbers = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        command = Path(f"/proc/{pid}/cmdline").read_bytes().decode(errors="replace").split("\0")
    except OSError:
        return None
    if numbers[0] in "ZX":
        return None
    return Process(pid, int(numbers[1]), int(numbers[19]), (int(numbers[11]) + int(numbers[12])) / TICKS, command)


def carries_mark(pid: int) -> bool:
    wanted = f"{MARK}={os.environ[MARK]}".encode()
    try:
        return wanted in Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
    except OSError:
        return False


class Family:
    """All processes of this test but the test itself."""

    def __init__(self) -> None:
        self.known: dict[tuple[int, int], bool] = {}

    def processes(self) -> list[Process]:
        pids = [int(name) for name in os.listdir("/proc") if name.isdigit()]
        processes = {
            process.pid: process for process in map(read_process, pids) if process and process.pid != os.getpid()
        }

        # Some programs write their title over their environment, so a process below a marked one is ours too.
        def is_ours(process: Process) -> bool:
            key = (process.pid, process.started)
            if key not in self.known:
                parent = processes.get(process.parent)
                self.known[key] = carries_mark(process.pid) or (parent is not None and is_ours(parent))
            return self.known[key]

        return [process for process in processes.values() if is_ours(process)]


def below(process: Process, family: list[Process]) -> list[Process]:
    children = [other for other in family if other.parent == process.pid]
    return children + [further for child in children for further in below(child, family)]


def kill(pid: int) -> None:
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def kill_a_worker(family: Family, with_parents: int) -> bool:
    """Kills one `drypoint batch`, so many of the processes above it, and all that they run. False if none draws now."""
    processes = family.processes()
    batches = [process for process in processes if process.is_batch]
    if not batches:
        return False
    top = random.choice(batches)
    for _ in range(with_parents):
        top = next((process for process in processes if process.pid == top.parent), top)
    # The top first, so that it cannot see its child's death and act on it.
    for process in [top, *below(top, processes)]:
        kill(process.pid)
    return True


def end_all(family: Family) -> int:
    """Kills what is left and returns how many that were."""
    seen: set[int] = set()
    for _ in range(50):
        processes = family.processes()
        if not processes:
            break
        for process in processes:
            seen.add(process.pid)
            kill(process.pid)
        time.sleep(0.1)
    return len(seen)


def idle_seconds() -> float:
    """Idle time of all processors since boot, waiting for disks counted in."""
    with open("/proc/stat", encoding="ascii") as file:
        numbers = file.readline().split()
    return (int(numbers[4]) + int(numbers[5])) / TICKS


@dataclass
class Busy:
    """How busy the processors were between the first and the last moment at which `drypoint batch` ran.

    Others may use the machine meanwhile, so the share is of what they left: own time / (own time + idle time).
    """

    seconds: float = 0.0
    drawing: float = 0.0
    engine: float = 0.0
    idle: float = 0.0

    @property
    def share(self) -> float:
        own = self.drawing + self.engine
        return own / (own + self.idle) if own else 0.0

    def __str__(self) -> str:
        per_second = self.seconds * (os.cpu_count() or 1)
        if not per_second:
            return "nothing was seen drawing"
        return (
            f"busy {self.share:.1%} of what other programs left; over {self.seconds:.0f} s and {os.cpu_count()} processors: "
            f"drypoint {self.drawing / per_second:.1%}, engine {self.engine / per_second:.1%}, idle {self.idle / per_second:.1%}"
        )


@dataclass
class Watch:
    """Measures in the background, in a `with` block."""

    family: Family
    busy: Busy = field(default_factory=Busy)

    def __enter__(self) -> "Watch":
        self.stopping = threading.Event()
        self.thread = threading.Thread(target=self.measure)
        self.thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.stopping.set()
        self.thread.join()

    def measure(self) -> None:
        first: dict[tuple[int, int], float] = {}
        last: dict[tuple[int, int], Process] = {}
        begun: tuple[float, float] | None = None
        while not self.stopping.wait(0.2):
            processes = self.family.processes()
            now = (time.monotonic(), idle_seconds())
            draws = any(process.draws for process in processes)
            if begun is None and not draws:
                continue
            if begun is None:
                begun = now
                first = {(process.pid, process.started): process.cpu_seconds for process in processes}
            for process in processes:
                last[process.pid, process.started] = process
            if draws:
                spent = [(process.draws, process.cpu_seconds - first.get(key, 0.0)) for key, process in last.items()]
                self.busy = Busy(
                    seconds=now[0] - begun[0],
                    drawing=sum(seconds for draws, seconds in spent if draws),
                    engine=sum(seconds for draws, seconds in spent if not draws),
                    idle=now[1] - begun[1],
                )
