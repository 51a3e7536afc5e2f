"""Drawings on the page: the same marks as drypoint's own file, exactly over the photograph."""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

import pages
from measure import INKSCAPE, SVG, bounds_mm, centre_mm, darkness, layers, marks, offset_mm, tree
from PIL import Image, ImageDraw
from programs import QUICK, SAMPLES, directly, in_inkscape, own_file

HOPPER = SAMPLES / "grace-hopper.jpg"
NEAR_MM = 0.1
MORE = " ".join(QUICK)


def an_embedded_photograph_in_inkscape(scratch: Path) -> None:
    page = _page(scratch, pages.PLAIN.with_href(pages.embedded(HOPPER, "jpeg")))
    drawn = _in_inkscape(page, ["photo"], {}, scratch)
    _same_marks_in_the_same_place(pages.PLAIN, drawn, scratch)
    photo = _photo(drawn)
    assert "display:none" in photo.get("style").replace(" ", "")
    assert photo.get("{http://www.w3.org/1999/xlink}href").startswith("data:image/jpeg;base64,")


def a_linked_transformed_photograph_in_inkscape(scratch: Path) -> None:
    folder = scratch / "my pictures"
    folder.mkdir()
    shutil.copy(HOPPER, folder / "grace hopper.jpg")
    page = _page(scratch, pages.TRANSFORMED.with_href("my%20pictures/grace%20hopper.jpg"))
    drawn = _in_inkscape(page, ["photo"], {"photograph": "below"}, scratch)
    _same_marks_in_the_same_place(pages.TRANSFORMED, drawn, scratch)
    photo = _photo(drawn)
    assert "display" not in (photo.get("style") or "")
    order = [element for element in tree(drawn) if element.tag == SVG + "g"]
    assert list(order[0].iter(SVG + "image")), "the layers lie above the photograph's"


def two_photographs_share_the_layers_of_each_pen_in_inkscape(scratch: Path) -> None:
    shutil.copy(HOPPER, scratch / "a.jpg")
    shutil.copy(SAMPLES / "chelsea.png", scratch / "b.png")
    page = _page(
        scratch,
        f'<svg {pages.HEADER} {pages.MILLIMETRES}><g id="both"><image id="a" x="5" y="5" width="25.6" height="30" '
        'xlink:href="a.jpg"/><g transform="translate(50,40)">'
        '<image id="b" width="45.1" height="30" xlink:href="b.png"/></g></g></svg>',
    )
    drawn = _in_inkscape(page, ["both"], {"marks": "pen-paths", "pen": "0.5"}, scratch)
    profile = [
        "--profile",
        str(Path(__file__).parent.parent / "drypoint/pen-paths.toml"),
        "--order=fast",
        "--pen=0.5mm",
    ]
    own = [
        own_file(scratch / "a.jpg", (25.6, 30), scratch / "own-a.svg", "--page=45.6x50mm", "--margin=0mm", *profile),
        own_file(scratch / "b.png", (45.1, 30), scratch / "own-b.svg", "--page=65.1x50mm", "--margin=0mm", *profile),
    ]
    found = layers(tree(drawn))
    for path in own:
        for label, layer in layers(tree(path)).items():
            groups = {marks(group) for group in found[label]}
            assert marks(layer) in groups, (label, marks(layer), groups)
    assert sum(marks(layer) for layer in found.values()) == sum(marks(tree(path)) for path in own)
    assert not any(element.tag == SVG + "circle" for element in tree(drawn).iter()), "pen paths have no circles"


def a_mirrored_photograph_at_the_side_of_its_box(scratch: Path) -> None:
    _drawn_directly(pages.MIRRORED, scratch)


def a_photograph_cut_by_its_box(scratch: Path) -> None:
    _drawn_directly(pages.CUT, scratch)


def a_stretched_photograph_keeps_the_amount_of_ink(scratch: Path) -> None:
    _drawn_directly(pages.STRETCHED, scratch)


def a_clipped_photograph(scratch: Path) -> None:
    _drawn_directly(pages.CLIPPED, scratch)


def a_black_shape_lies_over_itself(scratch: Path) -> None:
    photograph = Image.new("L", (640, 480), 255)
    ImageDraw.Draw(photograph).rectangle((100, 60, 419, 299), fill=0)
    photograph.save(scratch / "shape.png")
    text = (
        f'<svg {pages.HEADER} {pages.PIXELS}><g transform="rotate(90) translate(40,-700)">'
        '<image id="photo" x="50" y="30" width="600" height="450" preserveAspectRatio="none" '
        'xlink:href="shape.png"/></g></svg>'
    )
    page = _page(scratch, text)
    output = scratch / "drawn.svg"
    said = directly(page, ["photo"], ["--pitch=0.6", "--more=--sight none"], output)
    assert said.status == 0, said
    ink, photo = darkness(output), darkness(page)
    apart = [abs(one - other) for one, other in zip(centre_mm(ink), centre_mm(photo))]
    print(f"  shape: centres {max(apart):.4f} mm apart", file=sys.stderr)
    assert max(apart) < NEAR_MM, apart
    edges = [abs(one - other) for one, other in zip(bounds_mm(ink), bounds_mm(photo))]
    assert max(edges) < 0.6, edges


def a_preset_gives_the_manner_but_not_the_place(scratch: Path) -> None:
    page = _page(scratch, pages.PLAIN.with_href(pages.embedded(HOPPER, "jpeg")))
    output = scratch / "drawn.svg"
    said = directly(page, ["photo"], ["--preset=wsj-column", f"--more={MORE}"], output)
    assert said.status == 0, said
    whole = ["--preset=wsj-column", "--crop=0,0,100%,100%", "--fit=contain"]
    assert _shapes(output) == _shapes(own_file(HOPPER, (51.2, 60), scratch / "own.svg", *whole))


def options_of_the_dialog_and_the_free_field_reach_drypoint(scratch: Path) -> None:
    page = _page(scratch, pages.PLAIN.with_href(pages.embedded(HOPPER, "jpeg")))
    output = scratch / "drawn.svg"
    fields = ["--style=grid", "--pitch=1.5", f"--ink={0xCC0000FF}", "--seed=7", "--tone=linear", "--min_mark=0.2"]
    said = directly(page, ["photo"], [*fields, "--more=--sight none --set 'blob=0.5' --gamma=1.4 --seed 8"], output)
    assert said.status == 0, said
    further = [
        "--style=grid",
        "--ink=#cc0000",
        "--seed=8",
        "--tone=linear",
        "--min-mark=0.2mm",
        "--set=blob=0.5",
        "--gamma=1.4",
    ]
    own = own_file(HOPPER, (51.2, 60), scratch / "own.svg", *further)
    assert _shapes(output) == _shapes(own), "the same marks, character by character"
    assert 'fill="#cc0000"' in output.read_text(), "the ink"


def _shapes(path: Path) -> list[dict[str, str]]:
    return [dict(mark.attrib) for mark in tree(path).iter(SVG + "path", SVG + "circle")]


def _page(scratch: Path, text: str) -> Path:
    path = scratch / "page.svg"
    path.write_text(text)
    return path


def _in_inkscape(page: Path, selected: list[str], fields: dict[str, str], scratch: Path) -> Path:
    output = scratch / "drawn.svg"
    said = in_inkscape(page, selected, {"more": MORE, **fields}, output, scratch)
    assert said.status == 0 and output.exists(), said
    return output


def _drawn_directly(page: pages.Page, scratch: Path) -> None:
    shutil.copy(HOPPER, scratch / "photo.jpg")
    output = scratch / "drawn.svg"
    said = directly(_page(scratch, page.with_href("photo.jpg")), ["photo"], [f"--more={MORE}"], output)
    assert said.status == 0 and said.words == "", said
    _same_marks_in_the_same_place(page, output, scratch)


def _same_marks_in_the_same_place(page: pages.Page, drawn: Path, scratch: Path) -> None:
    """The extension's page against the page whose photograph is drypoint's own file, placed by the renderer."""
    size = _noted_size(drawn)
    assert max(abs(one - other) for one, other in zip(size, page.size_mm)) < 0.01, (size, page.size_mm)
    own = own_file(HOPPER, size, scratch / "own.svg", f"--fit={page.fit}")
    expected_layers, found_layers = layers(tree(own)), layers(tree(drawn))
    assert [name for name in found_layers if name in expected_layers] == list(expected_layers), list(found_layers)
    for name, layer in expected_layers.items():
        assert marks(found_layers[name]) == marks(layer) > 0, (name, marks(found_layers[name]), marks(layer))
        assert found_layers[name].get(INKSCAPE + "groupmode") == "layer"
    expected = scratch / "expected.svg"
    expected.write_text(page.with_drawing(own))
    ink, own_ink = darkness(_hidden_photograph(drawn)), darkness(expected)
    apart = [abs(one - other) for one, other in zip(centre_mm(ink), centre_mm(own_ink))]
    difference = abs(ink - own_ink).mean() / own_ink.mean()
    print(
        f"  {page.name}: {sum(map(marks, expected_layers.values()))} marks, centres {max(apart):.4f} mm apart, "
        f"best fit at {offset_mm(ink, own_ink):.3f} mm, {difference:.2%} of the ink elsewhere",
        file=sys.stderr,
    )
    assert max(apart) < NEAR_MM and offset_mm(ink, own_ink) < NEAR_MM, apart
    assert difference < 0.05


def _noted_size(drawn: Path) -> tuple[float, float]:
    """The box that the extension asked for, from the description of its groups."""
    width, height = re.search(r"--size=([0-9.]+)x([0-9.]+)mm", drawn.read_text()).groups()
    return float(width), float(height)


def _hidden_photograph(drawn: Path) -> Path:
    root = tree(drawn)
    for photo in root.iter(SVG + "image"):
        photo.set("style", "display:none")
    path = drawn.with_name("ink.svg")
    root.getroottree().write(str(path))
    return path


def _photo(drawn: Path):
    return next(tree(drawn).iter(SVG + "image"))
