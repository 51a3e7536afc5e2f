"""The shortest way through paths, found by `drypoint plot`.

The search needs to know only where an open path begins and ends, so each is sent as a straight line, and a closed path as its
polygon. What comes back tells the order; the paths themselves are the given ones to the last bit.
"""

from __future__ import annotations

import json
import tempfile
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

import click
import numpy as np
import vpype as vp

from .command import run

#: The grid of drypoint's files in pixels: positions on it come back as they were sent.
_GRID = vp.convert_length("0.001mm")
#: Millions of steps that drypoint may take to read the paths; its usual limit is for files from strangers.
_MOST_WORK = 1000


def in_best_order(
    lines: Sequence[np.ndarray], is_fast: bool = False, keeps_direction: bool = False, keeps_seam: bool = False
) -> list[np.ndarray]:
    """The same lines in the order with the least travel; open ones may be reversed, closed ones begin elsewhere."""
    if len(lines) < 2:
        return list(lines)
    corner = _upper_left(lines)
    places = [_on_grid(line, corner) for line in lines]
    stand_ins = [_stand_in(line, own, keeps_seam) for line, own in zip(lines, places)]
    words = [f"--order={'fast' if is_fast else 'full'}", *(["--keep-direction"] if keeps_direction else [])]
    register = _Register(stand_ins)
    ordered: list[np.ndarray] = []
    for visit in _ordered_by_drypoint(stand_ins, words):
        i, is_reversed = register.take(visit)
        if len(stand_ins[i]) > 2:
            ordered.append(_begun_at(lines[i], corner + visit[0] @ [1, 1j] * _GRID))
        else:
            ordered.append(lines[i][::-1] if is_reversed else lines[i])
    return ordered


def _upper_left(lines: Sequence[np.ndarray]) -> complex:
    """The corner where the pen starts: the page's, or farther out if paths lie there."""
    return complex(min(0.0, *(line.real.min() for line in lines)), min(0.0, *(line.imag.min() for line in lines)))


def _on_grid(line: np.ndarray, corner: complex) -> np.ndarray:
    away = line - corner
    places: np.ndarray = np.rint(np.column_stack([away.real, away.imag]) / _GRID).astype(np.int64)
    return places


def _stand_in(line: np.ndarray, places: np.ndarray, keeps_seam: bool) -> np.ndarray:
    """What is sent for a path: its polygon if it may begin anywhere, else a line between its ends, which must not coincide."""
    if line[0] == line[-1] and not keeps_seam:
        is_new = np.append(True, np.any(np.diff(places, axis=0) != 0, axis=1))
        if np.count_nonzero(is_new) > 2:
            return places[is_new]
    ends: np.ndarray = places[[0, -1]]
    return ends if np.any(ends[0] != ends[1]) else ends + [[0, 0], [1, 0]]


class _Register:
    """Finds the path that a line which came back stands for. Of several that lie alike each is found once."""

    def __init__(self, stand_ins: Sequence[np.ndarray]) -> None:
        self._waiting: dict[bytes, list[int]] = defaultdict(list)
        # From the last, as they are taken from the end.
        for i in reversed(range(len(stand_ins))):
            self._waiting[_key(stand_ins[i])].append(i)

    def take(self, visit: np.ndarray) -> tuple[int, bool]:
        """The path, and whether it is reversed. A loop may begin at a vertex that it did not have."""
        keys = [_key(visit), _key(visit[::-1]), _key(visit[1:-1], is_ring=True)]
        for n, key in enumerate(keys):
            if waiting := self._waiting.get(key):
                return waiting.pop(), n == 1
        raise click.ClickException("drypoint plot returned a path that it was not given; please report this drawing")


def _key(places: np.ndarray, is_ring: bool = False) -> bytes:
    """The same for a loop wherever it begins and whichever way it runs; for other lines their two ends."""
    if len(places) == 2 and not is_ring:
        return places.tobytes()
    corners = places if is_ring else places[1:]
    return b"ring" + corners[np.lexsort(corners.T)].tobytes()


def _ordered_by_drypoint(stand_ins: Sequence[np.ndarray], words: Sequence[str]) -> list[np.ndarray]:
    """The lines in drypoint's order, as places on the grid."""
    with tempfile.TemporaryDirectory(prefix="vpype-drypoint-") as folder:
        output = Path(folder, "ordered.json")
        lossless = ["--ink-model=lines", "--merge=0", "--duplicates=keep", f"--most-work={_MOST_WORK}"]
        report = run(["plot", "-", f"--output={output}", "--json", *lossless, *words], stdin=_svg(stand_ins))
        layers = json.loads(output.read_bytes())["layers"]
    strokes = [stroke["points"] for layer in layers for stroke in layer["strokes"]]
    if json.loads(report)["dropped"] or len(strokes) != len(stand_ins):
        raise click.ClickException(
            f"drypoint plot returned {len(strokes)} of {len(stand_ins)} paths; please report this drawing"
        )
    return [np.rint(np.array(points) * 1000).astype(np.int64) for points in strokes]


def _svg(stand_ins: Sequence[np.ndarray]) -> bytes:
    width, height = np.maximum(1000, np.max([line.max(axis=0) for line in stand_ins], axis=0)) / 1000
    paths = "".join("M" + "L".join(f"{x / 1000:.3f} {y / 1000:.3f}" for x, y in line.tolist()) for line in stand_ins)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" viewBox="0 0 {width} {height}">'
        f'<path fill="none" stroke="black" d="{paths}"/></svg>'
    ).encode()


def _begun_at(loop: np.ndarray, place: complex) -> np.ndarray:
    """The loop begun at the nearest place on its line. A point is added unless one of the loop's own lies there."""
    near = np.abs(loop[:-1] - place)
    if near.min() < _GRID:
        first = int(near.argmin())
        return np.concatenate([loop[first:-1], loop[: first + 1]])
    sides = np.diff(loop)
    squares = np.maximum(np.abs(sides) ** 2, np.finfo(float).tiny)
    along = np.clip(((place - loop[:-1]) * sides.conj()).real / squares, 0, 1)
    feet = loop[:-1] + along * sides
    side = int(np.abs(feet - place).argmin())
    return np.concatenate([[feet[side]], loop[side + 1 : -1], loop[: side + 1], [feet[side]]])
