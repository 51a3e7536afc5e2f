"""What the user is told when it does not work: in words, with the page as it was."""

from __future__ import annotations

import shutil
from pathlib import Path

import pages
from programs import SAMPLES, directly

PNG = SAMPLES / "chelsea.png"


def nothing_selected(scratch: Path) -> None:
    _refused(scratch, "photo.png", [], [], "Nothing is selected. Select one or more photographs")


def no_photograph_in_the_selection(scratch: Path) -> None:
    page = scratch / "page.svg"
    page.write_text(f'<svg {pages.HEADER}><rect id="r" width="9" height="9"/></svg>')
    _told(page, ["r"], [], "There is no photograph in the selection")


def a_clone_of_a_photograph(scratch: Path) -> None:
    page = scratch / "page.svg"
    page.write_text(
        f'<svg {pages.HEADER}><image id="i" width="9" height="9" xlink:href="a.png"/>'
        '<use id="u" xlink:href="#i"/></svg>'
    )
    _told(page, ["u"], [], "is a clone of an image. Unlink it first")


def the_file_is_missing(scratch: Path) -> None:
    _refused(
        scratch,
        "gone/photo%20one.png",
        ["photo"],
        [],
        "photo one.png was not found: ",
        str(scratch / "gone/photo one.png"),
    )


def the_photograph_is_on_the_web(scratch: Path) -> None:
    _refused(scratch, "https://example.org/a.png", ["photo"], [], "is on the web (https://example.org/a.png)")


def the_embedded_picture_is_damaged(scratch: Path) -> None:
    _refused(scratch, "data:image/png;base64,A", ["photo"], [], "is damaged. Import the image again")


def the_picture_is_no_photograph(scratch: Path) -> None:
    (scratch / "notes.png").write_text("no picture at all")
    _refused(scratch, "notes.png", ["photo"], [], "notes.png is not in a known image format")


def an_embedded_picture_that_is_no_photograph_is_named(scratch: Path) -> None:
    _refused(
        scratch,
        "data:image/png;base64,bm8gcGljdHVyZSBhdCBhbGw=",
        ["photo"],
        [],
        "drypoint: photo is not in a known image",
    )


def drypoint_is_not_installed(scratch: Path) -> None:
    shutil.copy(PNG, scratch / "photo.png")
    bare = {"PATH": "/nowhere", "HOME": str(scratch), "DRYPOINT": ""}
    _refused(scratch, "photo.png", ["photo"], [], "drypoint was not found", "apt install", environment=bare)


def the_chosen_program_is_none(scratch: Path) -> None:
    shutil.copy(PNG, scratch / "photo.png")
    _refused(scratch, "photo.png", ["photo"], ["--program=/nowhere/drypoint"], "/nowhere/drypoint is no program")


def drypoint_itself_refuses(scratch: Path) -> None:
    shutil.copy(PNG, scratch / "photo.png")
    _refused(scratch, "photo.png", ["photo"], ["--pitch=0.01"], "pitch=0.01 is not valid")


def the_free_field_has_no_such_option(scratch: Path) -> None:
    shutil.copy(PNG, scratch / "photo.png")
    _refused(scratch, "photo.png", ["photo"], ["--more=--pich 3"], "--pich")


def the_free_field_wants_another_place(scratch: Path) -> None:
    shutil.copy(PNG, scratch / "photo.png")
    _refused(scratch, "photo.png", ["photo"], ["--more=--size=9x9"], "--size cannot be given here")


def the_free_field_lacks_a_quotation_mark(scratch: Path) -> None:
    shutil.copy(PNG, scratch / "photo.png")
    _refused(scratch, "photo.png", ["photo"], ["--more=--set 'a"], "Each quotation mark needs its partner")


def a_photograph_larger_than_the_machine(scratch: Path) -> None:
    shutil.copy(PNG, scratch / "photo.png")
    page = scratch / "page.svg"
    page.write_text(
        f'<svg {pages.HEADER} width="900mm" height="700mm" viewBox="0 0 900 700">'
        '<image id="photo" width="900" height="598" xlink:href="photo.png"/></svg>'
    )
    _told(page, ["photo"], ["--marks=axidraw-v3", "--pitch=9", "--more=--sight none"], "axidraw-v3")


def a_warning_comes_with_the_drawing(scratch: Path) -> None:
    shutil.copy(PNG, scratch / "photo.png")
    page = scratch / "page.svg"
    page.write_text(pages.PLAIN.with_href("photo.png"))
    output = scratch / "out.svg"
    said = directly(page, ["photo"], ["--style=glass", "--marks=pen-paths", "--more=--sight none --pitch 4"], output)
    assert said.status == 0 and output.exists(), said
    assert said.words.startswith("photo.png: ") and "colours" in said.words, said


def _refused(
    scratch: Path,
    href: str,
    selected: list[str],
    fields: list[str],
    *words: str,
    environment: dict[str, str] | None = None,
) -> None:
    page = scratch / "page.svg"
    page.write_text(pages.PLAIN.with_href(href))
    _told(page, selected, fields, *words, environment=environment)


def _told(
    page: Path, selected: list[str], fields: list[str], *words: str, environment: dict[str, str] | None = None
) -> None:
    output = page.with_name("out.svg")
    said = directly(page, selected, fields, output, **(environment or {}))
    assert said.status != 0, said
    assert not output.exists(), "a page was written"
    assert "Traceback" not in said.words, said.words
    for word in words:
        assert word in said.words, (word, said.words)
