"""Writes numpy arrays as PNG, so that no picture library is needed."""

from __future__ import annotations

import struct
import zlib

from typing import Any

import numpy as np
import numpy.typing as npt

# PNG's colour types by the number of channels: grey, grey with alpha, colours, colours with alpha.
_COLOUR_TYPES = {1: 0, 2: 4, 3: 2, 4: 6}
# The file only passes through a pipe; more effort would take longer than it saves.
_EFFORT = 1


def png_of_array(array: npt.NDArray[Any]) -> bytes:
    """The array as PNG: rows, columns and 1 to 4 channels; sRGB values as uint8, uint16, bool, or floats from 0 to 1."""
    pixels = _whole_numbers(array)
    if pixels.ndim == 2:
        pixels = pixels[:, :, np.newaxis]
    if pixels.ndim != 3 or pixels.shape[2] not in _COLOUR_TYPES or 0 in pixels.shape:
        shape = " x ".join(str(side) for side in array.shape)
        raise ValueError(f"an array of {shape} is no picture; give rows x columns, or rows x columns x 1 to 4 channels")
    height, width, channels = pixels.shape
    depth = 8 * pixels.dtype.itemsize
    rows = np.ascontiguousarray(pixels, dtype=pixels.dtype.newbyteorder(">")).view(np.uint8).reshape(height, -1)
    # Each row begins with its filter: none.
    lines = np.hstack([np.zeros((height, 1), np.uint8), rows])
    head = struct.pack(">IIBBBBB", width, height, depth, _COLOUR_TYPES[channels], 0, 0, 0)
    data = zlib.compress(lines.tobytes(), _EFFORT)
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", head) + _chunk(b"IDAT", data) + _chunk(b"IEND", b"")


def _whole_numbers(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    if array.dtype in (np.uint8, np.uint16):
        return array
    if array.dtype == np.bool_:
        return array.astype(np.uint8) * np.uint8(255)
    if not np.issubdtype(array.dtype, np.floating):
        raise TypeError(f"a picture of {array.dtype} is not clear; give uint8, uint16, bool, or floats from 0 to 1")
    if not (np.all(array >= 0) and np.all(array <= 1)):
        raise ValueError("the floats of a picture must be from 0 (black) to 1 (white)")
    return np.round(array.astype(np.float64) * 65535).astype(np.uint16)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
