"""A photograph with its settings, drawn in one format or another."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ._command import Answer, run
from ._drawing import Drawing
from ._photograph import Photograph, Picture, bytes_of
from ._settings import words_of


def draw(photo: Picture, style: str | None = None, **settings: Any) -> Drawing:
    """Draws a photograph.

    ``photo`` is the path of a photograph or of a scene (.toml), the bytes of a picture file, a file opened for bytes, a PIL
    image, or a numpy array: rows, columns and up to 4 channels (grey, grey and alpha, RGB, RGBA) in sRGB, as uint8, uint16,
    bool, or floats from 0 to 1.

    ``style`` is ``hedcut`` (which is also meant without it, unless a preset or scene names another), ``grid``, ``engrave``,
    ``charcoal`` or ``glass``.

    ``settings`` are the options of ``drypoint draw`` by name: ``size="38x50mm"`` or ``size=(38, 50)``, ``pitch=0.5``,
    ``crop="head"``, ``preset="wsj-column"``, ``profile="grbl-servo"``, ``mirror=True``, ``mask={"hair": "hair.png"}``,
    ``depth=array``. Lengths without a unit are millimetres. Masks and depth are any picture that a photograph may be. All
    other names are parameters of the style: ``edge_length=8`` (millimetres), ``outline=False``. Where a style's parameter has
    the name of an option, as ``size`` of hedcut, write ``set={"size": "paper"}``.

    With ``profile`` the drawing holds the tool paths of that plotter, in drawing order within each kind, else the marks for
    print. The same photograph and settings give the same drawing everywhere.

    Raises ``TypeError`` for a setting that does not exist, ``ValueError`` for a value that it cannot have, and
    ``DrypointError``, with the command's own message, if the photograph cannot be drawn. Ctrl-C stops the command.
    """
    request = Request(photo, {"style": style, **settings})
    answer = request.run(["--output=-", "--format=json"])
    return Drawing(request, answer.data, answer.notices)


class Request:
    """A photograph and its settings."""

    def __init__(self, photo: Picture, settings: Mapping[str, Any]) -> None:
        self._photograph = Photograph.of(photo)
        # Masks that are no files yet; the folder goes when the drawing does.
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        # Paths mean the same when the photograph is drawn again.
        self._home = os.getcwd()
        self._settings = self._with_files(settings)

    def run(self, words: list[str], changes: Mapping[str, Any] | None = None) -> Answer:
        """Draws it, with other settings where they are given; a ``None`` there takes one back."""
        settings = self._settings | self._with_files(changes or {})
        is_scene = self._photograph.word.lower().endswith(".toml")
        all_words = ["draw", *words_of(settings, is_scene), *words, "--", self._photograph.word]
        return run(all_words, self._photograph.data, self._home)

    def run_again(self, words: list[str], changes: Mapping[str, Any] | None = None) -> Answer:
        """Draws the same photograph once more."""
        self._photograph.check_unchanged(self._home)
        return self.run(words, changes)

    def is_photograph(self, path: str) -> bool:
        """True if the photograph lies at this path."""
        photograph = os.path.join(self._home, self._photograph.word)
        return self._photograph.data is None and os.path.exists(path) and os.path.samefile(path, photograph)

    def _with_files(self, settings: Mapping[str, Any]) -> dict[str, Any]:
        """The settings with files in place of pictures in memory, which the command cannot take."""
        files = dict(settings)
        if "depth" in files:
            files["depth"] = self._file("depth", files["depth"])
        if isinstance(masks := files.get("mask"), Mapping):
            files["mask"] = {role: self._file(role, mask) for role, mask in masks.items()}
        return files

    def _file(self, name: str, picture: Any) -> Any:
        if picture is None or isinstance(picture, (str, os.PathLike)):
            return picture
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="drypoint-")
        path = Path(self._folder.name, f"{name}.png")
        path.write_bytes(bytes_of(picture))
        return path
