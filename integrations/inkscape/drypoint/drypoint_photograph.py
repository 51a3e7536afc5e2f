"""The photograph behind an image of the page, as a file that drypoint can read."""

from __future__ import annotations

import base64
import binascii
import mimetypes
import os
from pathlib import Path
from urllib.parse import unquote, unquote_to_bytes, urlsplit
from urllib.request import url2pathname

import inkex


def name_of(image: inkex.Image) -> str:
    """What the user knows the image by: its label, its file's name or its id."""
    if image.label:
        return str(image.label)
    href = _href(image)
    if href and not href.startswith("data:"):
        return unquote(os.path.basename(urlsplit(href.replace("\\", "/")).path)) or image.get_id()
    return image.get_id()


def file_of(image: inkex.Image, folders: list[Path], scratch: Path) -> Path:
    """The image's file: an embedded one is written to `scratch`, a linked one is looked for in `folders`."""
    href = _href(image)
    if not href:
        raise inkex.AbortExtension(f"The image {name_of(image)} has no picture in it. Remove it, or import it again.")
    if href.startswith("data:"):
        return _unpacked(image, href, scratch)
    return _linked(image, href, folders)


def _href(image: inkex.Image) -> str:
    return (image.get("xlink:href") or image.get("href") or "").strip()


def _unpacked(image: inkex.Image, href: str, scratch: Path) -> Path:
    header, _, payload = href[len("data:") :].partition(",")
    parts = header.split(";")
    try:
        if "base64" in parts[1:]:
            content = base64.b64decode(unquote_to_bytes(payload))
        else:
            content = unquote_to_bytes(payload)
    except (binascii.Error, ValueError):
        content = b""
    if not content:
        raise inkex.AbortExtension(f"The picture embedded in {name_of(image)} is damaged. Import the image again.")
    path = scratch / ("photograph" + (mimetypes.guess_extension(parts[0]) or ""))
    path.write_bytes(content)
    return path


def _linked(image: inkex.Image, href: str, folders: list[Path]) -> Path:
    scheme = urlsplit(href).scheme
    if scheme in ("http", "https", "ftp"):
        raise inkex.AbortExtension(
            f"The image {name_of(image)} is on the web ({href}). Save it to this computer and link or embed that file."
        )
    if scheme == "file":
        places = [Path(url2pathname(urlsplit(href).path))]
    else:
        places = [folder / name for folder in folders for name in (unquote(href), href)]
    # Inkscape keeps the absolute place here, for documents that were moved.
    absolute = image.get("sodipodi:absref")
    for path in [*places, *([Path(absolute)] if absolute else [])]:
        if path.is_file():
            return path
    raise inkex.AbortExtension(
        f"The file of the image {name_of(image)} was not found: {os.path.normpath(places[0])}. "
        "Put it there again, or choose the file anew in the image's properties."
    )
