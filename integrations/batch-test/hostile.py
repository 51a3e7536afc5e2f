"""Twenty files that are named like pictures and are none. Each must be refused with a reason, and none may stop the others."""

import io
import random
import struct
import zlib
from pathlib import Path

from PIL import Image


def png_chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png_that_claims(width: int, height: int) -> bytes:
    """A sound PNG but for its size: the rows are those of one pixel."""
    header = png_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + header + png_chunk(b"IDAT", zlib.compress(bytes(4))) + png_chunk(b"IEND", b"")


def bmp_that_claims(width: int, height: int) -> bytes:
    header = struct.pack("<IiiHHIIiiII", 40, width, height, 1, 24, 0, 0, 2835, 2835, 0, 0)
    return b"BM" + struct.pack("<IHHI", 54 + 4, 0, 0, 54) + header + bytes(4)


def encoded(kind: str) -> bytes:
    """A good picture as the named kind of file."""
    ramp = Image.linear_gradient("L").resize((300, 400)).convert("RGB")
    file = io.BytesIO()
    ramp.save(file, kind)
    return file.getvalue()


def jpeg_that_claims(width: int, height: int) -> bytes:
    """A sound JPEG but for the size in its frame header."""
    jpeg = bytearray(encoded("JPEG"))
    frame = jpeg.index(b"\xff\xc0")
    jpeg[frame + 5 : frame + 9] = struct.pack(">HH", height, width)
    return bytes(jpeg)


def hostile_files(folder: Path) -> list[str]:
    """Writes them and returns the names, those of files that do not exist among them."""
    noise = random.Random(20).randbytes(20_000)
    jpeg, png, webp, gif, tiff = (encoded(kind) for kind in ("JPEG", "PNG", "WEBP", "GIF", "TIFF"))
    contents = {
        "h01 empty.jpg": b"",
        "h02 cut in the middle.jpg": jpeg[: len(jpeg) // 2],
        "h03 text.jpg": b"This is no photograph.\n",
        "h04 page not found.jpg": b"<!DOCTYPE html><html><title>404 Not Found</title><body>Not Found</body></html>\n",
        "h05 noise.jpg": noise,
        "h06 noise after a beginning.jpg": b"\xff\xd8\xff\xe0" + noise,
        "h07 cut in its header.jpg": jpeg[: jpeg.index(b"\xff\xda") - 20],
        "h08 noise after a beginning.png": b"\x89PNG\r\n\x1a\n" + noise,
        "h09 bomb of 60000 x 60000.png": png_that_claims(60_000, 60_000),
        "h10 nothing wide.png": png_that_claims(0, 300),
        "h11 nothing high.png": png_that_claims(300, 0),
        "h12 bomb of 65000 x 65000.jpg": jpeg_that_claims(65_000, 65_000),
        "h13 cut.webp": webp[:40],
        "h14 cut.gif": gif[:20],
        "h15 cut.tif": tiff[:60],
        "h16 bomb of 2147483647 x 2147483647.bmp": bmp_that_claims(2**31 - 1, 2**31 - 1),
        "h17 document.jpg": b"%PDF-1.4\n1 0 obj\n<< /Type /Catalog >>\nendobj\ntrailer << /Root 1 0 R >>\n%%EOF\n",
    }
    for name, content in contents.items():
        (folder / name).write_bytes(content)
    (folder / "h18 folder.jpg").mkdir(exist_ok=True)
    dangling = folder / "h19 link to nothing.jpg"
    if not dangling.is_symlink():
        dangling.symlink_to("nothing.jpg")
    return [*contents, "h18 folder.jpg", "h19 link to nothing.jpg", "h20 never existed.jpg"]
