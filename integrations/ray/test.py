"""Draws portraits on a Ray cluster of four workers on this machine, and compares with a plain run."""

import os
import re
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from kills import run_with_kills
from outcome import Outcome, digests, outcome, read_results
from plain import DRYPOINT, ENOUGH_TO_MEASURE, HOSTILE, PORTRAITS, RECIPE, prepare
from processes import MARK, Family, Watch, end_all, kill
from tally import Tally

HERE = Path(__file__).resolve().parent
FOLDER = Path(os.environ[MARK])
WORKERS = 4
# So many that each worker has several of them, also of few pictures.
PIECE = max(3, min(24, PORTRAITS // 16))
family = Family()
folders: list[str] = []
tally = Tally()


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Head:
    """A cluster: the head and its workers, on the loopback interface."""

    def __init__(self) -> None:
        # The paths of Ray's sockets, which begin here, must not exceed 107 bytes.
        self.folder = tempfile.mkdtemp(prefix="drypoint-ray-", dir="/tmp")
        folders.append(self.folder)
        self.port = free_port()
        words = [
            "start",
            "--head",
            "--block",
            "--node-ip-address=127.0.0.1",
            f"--port={self.port}",
            f"--num-cpus={WORKERS}",
        ]
        words += [f"--temp-dir={self.folder}", "--include-dashboard=false", "--disable-usage-stats"]
        words += ["--object-store-memory=100000000"]
        self.log = open(f"{self.folder}/log", "w")
        ray = Path(sys.executable).parent / "ray"
        self.process = subprocess.Popen([ray, *words], stdout=self.log, stderr=self.log, start_new_session=True)
        for _ in range(600):
            if "Ray runtime started" in Path(self.log.name).read_text():
                return
            time.sleep(0.5)
        sys.exit(f"Ray does not start: {Path(self.log.name).read_text()}")

    def kill(self) -> None:
        """The head's own processes; what it started is left to itself."""
        names = ("gcs_server", "raylet", "ray")
        for process in family.processes():
            if any(Path(word).name in names for word in process.command[:2]) and "draw.py" not in str(process.command):
                kill(process.pid)
        self.process.wait()


class Drawing:
    """A run of draw.py."""

    def __init__(
        self, head: Head, manifest: Path, output: str, results: Path, *words: str, drypoint: str = DRYPOINT
    ) -> None:
        command = [sys.executable, HERE / "draw.py", manifest, "-o", output, "--results", results]
        command += [
            "--address",
            f"127.0.0.1:{head.port}",
            "--piece",
            str(PIECE),
            "--drypoint",
            drypoint,
            *words,
            "--",
            *RECIPE,
        ]
        self.log = results.with_suffix(".log")
        with self.log.open("a") as log:
            self.process = subprocess.Popen(command, stdout=log, stderr=log)

    def is_going(self) -> bool:
        return self.process.poll() is None

    def end(self) -> bool:
        return self.process.wait(timeout=7200) == 3


def check_right(what: str, found: Outcome, status: int) -> None:
    tally.check(
        found.is_right(PORTRAITS, HOSTILE) and status == 3, f"{what}: all portraits right, all others reported", found
    )


def draw_all(head: Head, manifest: Path, reference: dict[str, str]) -> None:
    outputs, results = FOLDER / "out", FOLDER / "ray.jsonl"
    with Watch(family) as watch:
        begun = time.monotonic()
        first = Drawing(head, manifest, f"{outputs}/{{name}}.svg", results)
        first.end()
        print(f"Ray took {time.monotonic() - begun:.0f} s for {PORTRAITS} + {HOSTILE} pictures", flush=True)
    found = outcome(manifest, results, outputs, reference)
    check_right("Ray", found, first.process.returncode)
    tally.check(found.done == PORTRAITS, "each portrait is drawn once", found.done)
    enough = watch.busy.share >= 0.9 or PORTRAITS < ENOUGH_TO_MEASURE
    tally.check(enough, "processors busy 90 % while pictures are drawn, if these are many", watch.busy)

    times = {path: path.stat().st_mtime_ns for path in outputs.rglob("*")}
    again = Drawing(head, manifest, f"{outputs}/{{name}}.svg", results)
    again.end()
    found = outcome(manifest, results, outputs, reference)
    check_right("Ray again", found, again.process.returncode)
    same = times == {path: path.stat().st_mtime_ns for path in outputs.rglob("*")}
    tally.check(found.skipped == PORTRAITS and same, "a second run draws nothing and writes no file", found.skipped)


def draw_with_urls(head: Head, manifest: Path, reference: dict[str, str]) -> None:
    """Photographs and outputs of a store, here a folder by its URL."""
    outputs, results, urls = FOLDER / "store", FOLDER / "urls.jsonl", FOLDER / "urls.tsv"
    lines = manifest.read_text().splitlines(keepends=True)[: min(60, PORTRAITS)]
    urls.write_text("".join(f"file://{manifest.parent}/{line}" for line in lines))
    for status in ("done", "skipped"):
        run = Drawing(head, urls, f"file://{outputs}/{{name}}.svg", results)
        run.end()
        drawn = [line for line in read_results(results) if line["status"] == status]
        found = {path: digest for path, digest in digests(outputs).items() if not path.startswith(".drypoint")}
        expected = {path: digest for path, digest in reference.items() if path in found}
        right = (
            found == expected
            and len(found) == len(drawn)
            and len(drawn) + text_of(results).count('"failed"') == len(lines)
        )
        tally.check(
            right and run.process.returncode == 3,
            f"URLs: {status}, with the same bytes",
            f"{len(drawn)} of {len(lines)}",
        )
    local = [
        line
        for line in read_results(results)
        if "file://" not in line["photo"] or re.search("/drypoint-[^/]+/(in|out)/", str(line))
    ]
    tally.check(not local, "lines name the store's files, not temporary ones", local[:1])


def text_of(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def draw_with_killer(head: Head, manifest: Path) -> None:
    """One picture ends every worker that tries it. It is reported, and takes no other with it."""
    killer = FOLDER / "killer"
    lines = [line for line in text_of(manifest).splitlines(keepends=True) if "\tp" in line][:9]
    deadly = lines[4].split("\t")[1].strip()
    few = FOLDER / "few.tsv"
    few.write_text("".join(f"{manifest.parent}/{line}" for line in lines), encoding="utf-8")
    killer.write_text(
        "#!/bin/sh\n"
        f"pictures=$(mktemp {FOLDER}/XXXXXX); cat >$pictures\n"
        f"if grep -q '\t{deadly}$' $pictures; then kill -9 $PPID; fi\n"
        f'exec {DRYPOINT} "$@" <$pictures\n'
    )
    killer.chmod(0o755)
    results = FOLDER / "killer.jsonl"
    words = ["--retries", "1", "--piece", "3"]
    run = Drawing(head, few, f"{FOLDER}/killed/{{name}}.svg", results, *words, drypoint=str(killer))
    run.end()
    lines_of = {line["name"]: line["status"] for line in read_results(results)} if results.exists() else {}
    right = len(lines_of) == 9 and [name for name, status in lines_of.items() if status != "done"] == [deadly]
    tally.check(right, "a picture that ends its workers is reported, and takes no other with it", lines_of)


def check_refusals(head: Head, manifest: Path) -> None:
    """What is wrong for every picture stops the run, with words, and leaves no results."""
    results = FOLDER / "refused.jsonl"
    run = Drawing(head, manifest, f"{FOLDER}/no/{{name}}.svg", results, drypoint="/nowhere/drypoint")
    run.end()
    tally.check(
        run.process.returncode == 1 and not results.exists(), "no drypoint: the run stops", text_of(run.log)[-300:]
    )
    twice = FOLDER / "twice.tsv"
    twice.write_text("a/x.jpg\nb/x.jpg\n")
    run = Drawing(head, twice, f"{FOLDER}/no/{{name}}.svg", results)
    run.end()
    told = "same name" in text_of(run.log)
    tally.check(run.process.returncode == 1 and told, "two photographs of one name are refused")


def draw_with_kills(head: Head, manifest: Path, reference: dict[str, str]) -> Head:
    outputs, results = FOLDER / "killed-out", FOLDER / "killed.jsonl"
    heads = [head]

    def start() -> Drawing:
        if heads[-1].process.poll() is not None:
            heads.append(Head())
        return Drawing(heads[-1], manifest, f"{outputs}/{{name}}.svg", results)

    # The worker dies with the `drypoint batch` that it runs.
    told = run_with_kills(start, heads[-1].kill, outputs, family, depths=[1])
    check_right(f"Ray with kills ({told})", outcome(manifest, results, outputs, reference), 3)
    return heads[-1]


def main() -> None:
    # The usual way to stop a test must clean up too.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    # Only who knows the word may use the cluster while it runs.
    os.environ.update(RAY_AUTH_MODE="token", RAY_AUTH_TOKEN=secrets.token_hex(32))
    # The same variable keeps Ray on the loopback interface, on Linux too.
    os.environ.update(RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER="0", RAY_USAGE_STATS_ENABLED="0", RAY_TMPDIR=str(FOLDER))
    try:
        plain = prepare()
        reference = plain.digests()
        check_right("a plain run", outcome(plain.manifest, plain.results, plain.outputs, reference), 3)
        head = Head()
        draw_all(head, plain.manifest, reference)
        draw_with_urls(head, plain.manifest, reference)
        draw_with_killer(head, plain.manifest)
        check_refusals(head, plain.manifest)
        draw_with_kills(head, plain.manifest, reference)
    finally:
        end_all(family)
        for folder in folders:
            shutil.rmtree(folder, ignore_errors=True)
    left = [process.command for process in family.processes()]
    tally.check(not left, "no process is left", left)
    tally.close()


if __name__ == "__main__":
    main()
