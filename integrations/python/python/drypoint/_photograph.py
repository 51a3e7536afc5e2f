"""Pictures as Python has them, and how they are handed to the command."""

from __future__ import annotations

import io
import os
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, BinaryIO, Union

import numpy as np
import numpy.typing as npt

from ._errors import DrypointError
from ._png import png_of_array

if TYPE_CHECKING:
    import PIL.Image

#: A picture: the path of a file, the bytes of one, a file opened for bytes, a PIL image, or a numpy array (rows, columns, and
#: up to 4 channels; uint8, uint16, bool, or floats from 0 to 1).
Picture = Union[
    str, "os.PathLike[str]", bytes, bytearray, memoryview, BinaryIO, "PIL.Image.Image", "npt.NDArray[np.generic]"
]

# The modes that PNG can hold as they are, and what those with alpha become that it cannot.
_PNG_MODES = ("1", "L", "LA", "P", "RGB", "RGBA", "I;16")
_PNG_MODE_FOR = {"La": "LA", "RGBa": "RGBA", "PA": "RGBA"}


@dataclass(frozen=True)
class Photograph:
    """A photograph that can be drawn several times."""

    #: Its path, or "-" for stdin.
    word: str
    #: What goes to stdin.
    data: bytes | None
    #: Size and time of change of the file.
    stamp: tuple[int, int] | None

    @classmethod
    def of(cls, picture: Picture) -> Photograph:
        """Takes the bytes of anything but a path, since a file object can be read once and an array may change."""
        if isinstance(picture, (str, os.PathLike)):
            path = os.fspath(picture)
            if not isinstance(path, str):
                raise TypeError("the path of a photograph must be text, not bytes")
            return cls(path, None, _stamp(path))
        return cls("-", bytes_of(picture), None)

    def check_unchanged(self, folder: str) -> None:
        """Refuses to draw a file again that is no longer the one drawn before."""
        if self.data is None and _stamp(os.path.join(folder, self.word)) != self.stamp:
            raise DrypointError(f"{self.word} has changed since it was drawn; call drypoint.draw again")


def bytes_of(picture: Any) -> bytes:
    """The bytes of a picture file that holds this picture."""
    if isinstance(picture, (bytes, bytearray, memoryview)):
        return bytes(picture)
    if isinstance(picture, np.ndarray):
        return png_of_array(picture)
    # Without PIL loaded, nothing can be one of its images.
    pil = sys.modules.get("PIL.Image")
    if pil is not None and isinstance(picture, pil.Image):
        return _png_of_image(picture)
    if hasattr(picture, "read"):
        data = picture.read()
        if not isinstance(data, bytes):
            raise TypeError("a photograph's file must be opened for bytes: open(path, 'rb')")
        return data
    raise TypeError(
        f"a photograph is a path, bytes, a file, a PIL image or a numpy array, not {type(picture).__name__}"
    )


def _png_of_image(image: PIL.Image.Image) -> bytes:
    from PIL import ImageOps

    # A file is turned by its EXIF too.
    upright = ImageOps.exif_transpose(image)
    if upright.mode in ("I", "F"):
        return png_of_array(_numbers_of(upright))
    profile = upright.info.get("icc_profile")
    if upright.mode not in _PNG_MODES:
        # The profile describes the colours before this.
        upright, profile = upright.convert(_PNG_MODE_FOR.get(upright.mode, "RGB")), None
    out = io.BytesIO()
    upright.save(out, "PNG", compress_level=1, icc_profile=profile)
    return out.getvalue()


def _numbers_of(image: PIL.Image.Image) -> npt.NDArray[Any]:
    """The pixels of an image of floats from 0 to 1, or of whole numbers of up to 16 bits."""
    pixels = np.asarray(image)
    if image.mode == "F":
        return pixels
    if pixels.min() < 0 or pixels.max() > 65535:
        raise ValueError("an image of whole numbers must have 16 bits: from 0 (black) to 65535 (white)")
    return pixels.astype(np.uint16)


def _stamp(path: str) -> tuple[int, int] | None:
    try:
        found = os.stat(path)
    except OSError:
        # The command says what is wrong with it.
        return None
    return found.st_size, found.st_mtime_ns
