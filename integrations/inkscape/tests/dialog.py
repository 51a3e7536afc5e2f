"""The dialog: what it offers is what drypoint has and what the script takes."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

from lxml import etree
from programs import EXTENSION, directly, drypoint

INX = "{http://www.inkscape.org/namespace/inkscape/extension}"


def the_description_follows_the_schema_of_inkscape(scratch: Path) -> None:
    schema = etree.RelaxNG(etree.parse("/usr/share/inkscape/extensions/inkscape.extension.rng"))
    schema.assertValid(etree.parse(str(EXTENSION / "drypoint.inx")))


def every_field_is_taken_by_the_script(scratch: Path) -> None:
    page = scratch / "page.svg"
    page.write_text('<svg xmlns="http://www.w3.org/2000/svg"/>')
    fields = [param.get("name") for param in _parameters()]
    said = directly(page, [], [f"--{name}={_default(name)}" for name in fields], scratch / "out.svg")
    assert "Nothing is selected" in said.words, said


def every_preset_and_style_is_offered(scratch: Path) -> None:
    for field, command in (("preset", "presets"), ("style", "styles")):
        known = {entry["name"] for entry in json.loads(drypoint(command, "--json"))[command]}
        assert _choices(field) - {"none", "auto"} == known, (field, _choices(field), known)


def every_machine_exists(scratch: Path) -> None:
    known = {entry["name"] for entry in json.loads(drypoint("profiles", "--json"))["profiles"]}
    assert _choices("marks") - {"print", "pen-paths"} <= known


def inkscape_lists_the_extension(scratch: Path) -> None:
    extensions = scratch / "extensions"
    extensions.mkdir()
    (extensions / "drypoint").symlink_to(EXTENSION)
    command = [
        "timeout",
        "120",
        "xvfb-run",
        "-a",
        "env",
        f"INKSCAPE_PROFILE_DIR={scratch}",
        "inkscape",
        "--action-list",
    ]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert "org.drypoint.draw.noprefs" in listed


def _parameters() -> list[etree._Element]:
    return list(etree.parse(str(EXTENSION / "drypoint.inx")).iter(INX + "param"))


def _choices(name: str) -> set[str]:
    return {option.get("value") for option in _parameter(name).iter(INX + "option")}


def _parameter(name: str) -> etree._Element:
    return next(param for param in _parameters() if param.get("name") == name)


def _default(name: str) -> str:
    text = (_parameter(name).text or "").strip()
    return str(int(text, 16)) if text.startswith("0x") else text or "x"
