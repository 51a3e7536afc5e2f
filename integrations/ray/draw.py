#!/usr/bin/env python3
"""Draws the photographs of a manifest on a Ray cluster, in small pieces that are each a run of `drypoint batch`.

    draw.py portraits.tsv -o '/shared/out/{name}.svg' --results results.jsonl -- --style hedcut --size 90x120mm

Photographs and outputs are files that every node sees, or URLs of an object store (s3://, gs://, abfs://, file://).
A run that stopped goes on where it was: pieces are drawn again until they end, and `drypoint batch` skips what is drawn.
Exit status: 0 all drawn, 3 some photographs could not be drawn, 1 the work could not be done, 2 wrong usage.
"""

import argparse
import json
import os
import re
import shutil
import socket
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import ray
import store

# What the tasks need of store.py goes to the workers with them; it need not be installed there.
ray.cloudpickle.register_pickle_by_value(store)

Picture = tuple[str, str]  # photograph and name
# What a piece may die of. Anything else, such as the death of the head, ends the run.
DEATHS = (
    ray.exceptions.RayTaskError,
    ray.exceptions.WorkerCrashedError,
    ray.exceptions.OutOfMemoryError,
    ray.exceptions.NodeDiedError,
)


@dataclass
class Ended:
    """How a piece ended: the exit status of `drypoint batch`, one JSON line per picture, and its messages."""

    status: int
    lines: list[dict]
    messages: str


def draw_piece(pictures: list[Picture], output: str, command: list[str]) -> Ended:
    """Runs on a worker."""
    if not shutil.which(command[0]):
        return Ended(
            1, [], f"{command[0]} is not there on {socket.gethostname()}; install it, or give its path with --drypoint"
        )
    with store.Brought(pictures, output) as brought:
        command = [*command, "-o", brought.output]
        # Without its worker a run would draw on beside the one that replaces it.
        if shutil.which("setpriv"):
            command = ["setpriv", "--pdeathsig", "KILL", "--", *command]
        manifest = "".join(f"{photo}\t{name}\n" for photo, name in brought.pictures)
        run = subprocess.run(command, input=manifest, capture_output=True, encoding="utf-8", errors="replace")
        if run.returncode in (1, 2):
            return Ended(run.returncode, [], run.stderr)
        lines = [json.loads(line) for line in run.stdout.splitlines()] if run.returncode in (0, 3) else []
        if len(lines) != len(brought.pictures):
            raise RuntimeError(
                f"drypoint ended with status {run.returncode} before all was drawn: {run.stderr[-2000:]}"
            )
        return Ended(run.returncode, brought.put_home(lines), run.stderr)


def read_manifest(path: str) -> Iterator[Picture]:
    """Photograph and name of each line. Workers have other folders, so paths are made absolute."""
    folder = Path.cwd() if path == "-" else Path(path).resolve().parent
    with sys.stdin if path == "-" else open(path, encoding="utf-8") as lines:
        for line in lines:
            photo, _, rest = line.rstrip("\r\n").partition("\t")
            if photo.strip() and not photo.startswith("#"):
                name = rest.partition("\t")[0] or Path(photo).stem
                yield photo if store.is_url(photo) else os.path.join(folder, photo), name


def pieces_of(pictures: list[Picture], length: int) -> Iterator[list[Picture]]:
    return (pictures[start : start + length] for start in range(0, len(pictures), length))


def draw_all(pictures: list[Picture], arguments: argparse.Namespace, command: list[str]) -> Iterator[dict]:
    """The lines of all pictures as their pieces end."""
    task = ray.remote(draw_piece).options(
        num_cpus=arguments.cpus, memory=arguments.memory, max_retries=arguments.retries, retry_exceptions=True
    )
    pieces = pieces_of(pictures, arguments.piece)
    again: list[list[Picture]] = []
    flying: dict[ray.ObjectRef, list[Picture]] = {}
    while True:
        # Two for each place that draws: one is drawn and one waits. A million at once would fill the memory of the head.
        places = max(1, int(ray.cluster_resources().get("CPU", 1) // arguments.cpus))
        while len(flying) < 2 * places and (piece := again.pop() if again else next(pieces, None)):
            flying[task.remote(piece, arguments.output, command)] = piece
        if not flying:
            return
        (ended, *_), _ = ray.wait(list(flying), num_returns=1)
        piece = flying.pop(ended)
        try:
            result = ray.get(ended)
        except DEATHS as error:
            # One picture may end every worker that tries it; alone it takes no other with it.
            again += [[picture] for picture in piece] if len(piece) > 1 else []
            if len(piece) == 1:
                yield failed(piece[0], arguments.output, f"{arguments.retries + 1} attempts ended: {error}")
            continue
        if result.status in (1, 2):
            raise SystemExit(f"draw.py: drypoint batch could not start: {result.messages.strip()}")
        yield from result.lines


def failed(picture: Picture, output: str, reason: str) -> dict:
    photo, name = picture
    return {
        "photo": photo,
        "name": name,
        "output": output.replace("{name}", name),
        "status": "failed",
        "reason": reason,
    }


def size_in_bytes(text: str) -> int:
    """A size such as 4GB, as `--max-memory` of `drypoint batch` takes it."""
    found = re.fullmatch(r"([\d.]+)\s*([KMGT]?)(i?)B?", text, re.IGNORECASE)
    if not found:
        raise argparse.ArgumentTypeError(f"'{text}' is no size such as 4GB")
    return int(float(found[1]) * (1024 if found[3] else 1000) ** " KMGT".index(found[2].upper() or " "))


def read_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        usage="draw.py MANIFEST -o OUTPUT --results FILE [options] [-- options of drypoint batch]",
    )
    parser.add_argument("manifest", help="a photograph per line and, after a tab, its name; - is stdin")
    parser.add_argument("-o", "--output", required=True, help="such as '/shared/out/{name}.svg'")
    parser.add_argument("--results", required=True, help="the JSON lines of all pictures; appears at the end")
    parser.add_argument("--piece", type=int, default=24, help="pictures per task [default: %(default)s]")
    parser.add_argument("--cpus", type=int, default=1, help="processors per task, each draws a picture [default: 1]")
    parser.add_argument("--memory", type=size_in_bytes, help="memory per task, such as 4GB [default: not reserved]")
    parser.add_argument("--retries", type=int, default=5, help="when a worker dies [default: %(default)s]")
    parser.add_argument("--address", default="auto", help="of the cluster; local starts one here [default: auto]")
    parser.add_argument("--drypoint", default="drypoint", help="the command on the workers [default: from their PATH]")
    words = sys.argv[1:]
    end = words.index("--") if "--" in words else len(words)
    arguments = parser.parse_args(words[:end])
    arguments.options = words[end + 1 :]
    if "{name}" not in arguments.output:
        parser.error("all pictures would be one file; put {name} into -o, such as 'out/{name}.svg'")
    if not store.is_url(arguments.output):
        arguments.output = os.path.abspath(arguments.output)
    return arguments


def main() -> int:
    arguments = read_arguments()
    command = [arguments.drypoint, "batch", "-", "--quiet", "--jobs", str(arguments.cpus), "--threads", "1"]
    command += ["--max-memory", f"{arguments.memory / 1e6:.0f}MB"] if arguments.memory else []
    pictures = list(read_manifest(arguments.manifest))
    if len({name for _, name in pictures}) < len(pictures):
        # `drypoint batch` sees this within a piece only.
        raise SystemExit("draw.py: two photographs have the same name; give names in the manifest's second column")
    ray.init(address=arguments.address, log_to_driver=False, logging_level="warning")
    counts = {"done": 0, "skipped": 0, "failed": 0}
    part = Path(f"{arguments.results}.part")
    with part.open("w", encoding="utf-8") as results:
        for line in draw_all(pictures, arguments, [*command, *arguments.options]):
            counts[line["status"]] += 1
            results.write(json.dumps(line, ensure_ascii=False) + "\n")
    part.replace(arguments.results)
    print(f"{counts['done']} done, {counts['skipped']} skipped, {counts['failed']} failed", file=sys.stderr)
    if sum(counts.values()) != len(pictures):
        raise SystemExit(f"draw.py: {len(pictures)} photographs were given; run it again")
    return 3 if counts["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
