"""Finds the drypoint command and runs it."""

from __future__ import annotations

import importlib
import importlib.util
import logging
import os
import shutil
import subprocess
from collections.abc import Sequence

import click


def command() -> str:
    """The path of the command: `$DRYPOINT`, else that of the Python package drypoint, else the one on `PATH`."""
    if given := os.environ.get("DRYPOINT"):
        if found := shutil.which(given):
            return found
        raise click.ClickException(f"DRYPOINT is {given}, which is no program that can be run; correct or unset it")
    if found := _of_package() or shutil.which("drypoint"):
        return found
    raise click.ClickException(
        "the drypoint command is not found; install the Python package drypoint, put the command on PATH, or set "
        "DRYPOINT to its path"
    )


def run(words: Sequence[str], stdin: bytes | None = None, has_own_stdin: bool = False) -> bytes:
    """What the command writes to stdout. Its warnings are logged as warnings, its decisions as information.

    It reads the bytes given, or this program's own stdin, or nothing.
    """
    source = subprocess.PIPE if stdin is not None else None if has_own_stdin else subprocess.DEVNULL
    with subprocess.Popen([command(), *words], stdin=source, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        try:
            data, said = process.communicate(stdin)
        except BaseException:
            # Asked to end, it leaves no unfinished file.
            process.terminate()
            raise
    lines = said.decode("utf-8", "replace").splitlines()
    if process.returncode != 0:
        raise click.ClickException(_reason(process.returncode, lines))
    for line in lines:
        if line.startswith("drypoint: warning: "):
            logging.warning(line)
        elif line.startswith("drypoint: "):
            logging.info(line)
    return data


def _of_package() -> str | None:
    """The command that the Python package brought, if it is installed."""
    if importlib.util.find_spec("drypoint") is None:
        return None
    package = importlib.import_module("drypoint")
    try:
        return str(package.command())
    except (AttributeError, RuntimeError):
        # Another package of this name, or one whose command is gone.
        return None


def _reason(status: int, lines: list[str]) -> str:
    said = "\n".join(line for line in lines if not line.startswith(("drypoint: warning: ", "Usage: ", "For more ")))
    message = said.strip().removeprefix("error: ")
    return message or f"the drypoint command ended with status {status}"
