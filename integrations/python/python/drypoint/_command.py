"""Finds the drypoint command and runs it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
import warnings
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ._errors import DrypointError, DrypointWarning

_NAME = "drypoint.exe" if os.name == "nt" else "drypoint"
# The command ends within a second when it is asked to, and then leaves no unfinished file.
_PATIENCE_SECONDS = 3.0
_WRONG_USAGE = 2


@dataclass(frozen=True)
class Answer:
    """What a run of the command gave."""

    #: What it wrote to its standard output.
    data: bytes
    #: Its decisions, such as "background left out: 1 face found".
    notices: tuple[str, ...]


def command() -> str:
    """The path of the command: ``$DRYPOINT``, else the one that this package brought, else the one on ``PATH``."""
    if given := os.environ.get("DRYPOINT"):
        if found := shutil.which(given):
            return found
        raise DrypointError(f"DRYPOINT is {given}, which is no program that can be run; correct or unset it")
    for folder in _script_folders():
        if os.access(path := folder / _NAME, os.X_OK):
            return str(path)
    if found := shutil.which("drypoint"):
        return found
    raise DrypointError("the drypoint command is not found; install it and put it on PATH, or set DRYPOINT to its path")


def version() -> str:
    """The version of the command, such as ``0.1.0``."""
    return run(["--version"]).data.decode().split()[-1]


def run(words: Sequence[str], stdin: bytes | None = None, folder: str | None = None) -> Answer:
    """Runs the command in a folder. It is stopped if an exception, such as Ctrl-C, ends the waiting for it."""
    program = command()
    process = subprocess.Popen(
        [program, *words],
        stdin=subprocess.DEVNULL if stdin is None else subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        cwd=folder,
    )
    try:
        data, said = process.communicate(stdin)
    except BaseException:
        _stop(process)
        raise
    lines = said.decode("utf-8", "replace").splitlines()
    if process.returncode != 0:
        raise _failure(process.returncode, lines)
    return Answer(data, tuple(_notices(lines)))


def _script_folders() -> Iterator[Path]:
    yield Path(sysconfig.get_path("scripts"))
    yield Path(sysconfig.get_path("scripts", sysconfig.get_preferred_scheme("user")))
    # Where `pip install --target` puts commands.
    yield Path(__file__).parents[1] / "bin"


def _stop(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.communicate(timeout=_PATIENCE_SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _notices(lines: Iterable[str]) -> Iterator[str]:
    """The notices among the lines; warnings are handed to Python's own."""
    for line in lines:
        if not line.startswith("drypoint: "):
            continue
        text = line.removeprefix("drypoint: ")
        if text.startswith("warning: "):
            warnings.warn(text.removeprefix("warning: "), DrypointWarning, stacklevel=_frames_of_this_package())
        else:
            yield text


def _frames_of_this_package() -> int:
    """How far up the stack the caller of this package is, for the place that a warning shows."""
    frame, depth = sys._getframe(1), 1
    while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
        frame, depth = frame.f_back, depth + 1
    return depth


def _failure(status: int, lines: list[str]) -> Exception:
    said = "\n".join(line for line in lines if not line.startswith(("drypoint: warning: ", "Usage: ", "For more ")))
    message = said.strip().removeprefix("drypoint: ").removeprefix("error: ")
    if status == _WRONG_USAGE:
        return ValueError(message)
    if status < 0:
        message = f"{message}\nthe drypoint command was ended by signal {-status}".strip()
    return DrypointError(message or f"the drypoint command ended with status {status}")
