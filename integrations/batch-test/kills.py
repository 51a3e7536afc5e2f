"""A run whose workers are killed at random moments, and started again until it ends."""

import os
import random
import shutil
import time
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from plain import PORTRAITS
from processes import Family, kill_a_worker


class Run(Protocol):
    """A run of an engine over all pictures."""

    def is_going(self) -> bool: ...

    def end(self) -> bool:
        """Waits for what is left of it, and tells whether it came to its end."""
        ...


def run_with_kills(
    start: Callable[[], Run],
    kill_head: Callable[[], None] | None,
    outputs: Path,
    family: Family,
    depths: list[int],
    kills: int = 10,
) -> str:
    """Runs from nothing until a run ends after all kills, and says what happened.

    `depths` are the numbers of processes above `drypoint batch` that die with it, in turn. The head, if there is one, dies once, half-way. If all is
    drawn before all have died, it begins from nothing again.
    """
    killed, heads, runs, afresh = 0, 0, 0, 0
    # Kills are spread over a run, at a quarter of a second for each picture. In a short one some pictures are drawn between them.
    pause = max(2.0, 2 * PORTRAITS * 0.25 / (os.cpu_count() or 1) / kills)
    shutil.rmtree(outputs, ignore_errors=True)
    while runs < 40:
        run = start()
        runs += 1
        while run.is_going():
            time.sleep(random.uniform(0.1, pause))
            if kill_head and not heads and killed >= kills // 2:
                kill_head()
                heads += 1
            elif killed < kills and kill_a_worker(family, depths[killed % len(depths)]):
                killed += 1
        if not run.end():
            continue
        if killed >= kills and (heads or not kill_head):
            break
        shutil.rmtree(outputs)
        afresh += 1
    return f"{killed} workers{' and the head' if heads else ''} killed, {runs} runs, {afresh} times from nothing again"
