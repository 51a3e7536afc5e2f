"""Checks a filled manifest against what winget's schema 1.10.0 asks of its three files: manifest_test.py FOLDER VERSION"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import yaml

IDENTIFIER = r"[^.\s\\/:*?\"<>|]{1,32}(\.[^.\s\\/:*?\"<>|]{1,32}){1,7}"
VERSION = r"[^\\/:*?\"<>|]{1,128}"
NUMBERS = r"\d{1,5}(\.\d{1,5}){0,3}"
LOCALE = r"[a-zA-Z]{2,3}(-[a-zA-Z]{1,8})*"
ADDRESS = r"https?://.{1,2040}"
HEAD = {"PackageIdentifier": IDENTIFIER, "PackageVersion": VERSION, "ManifestVersion": r"1\.([6-9]|[1-9]\d)\.0"}

# Key: what its text must match. All keys here are required, by the schema or because an archive cannot be installed without them.
REQUIRED = {
    "": {**HEAD, "ManifestType": "version", "DefaultLocale": LOCALE},
    ".installer": {
        **HEAD,
        "ManifestType": "installer",
        "InstallerType": "zip",
        "NestedInstallerType": "portable",
        "MinimumOSVersion": NUMBERS,
    },
    ".locale.en-US": {
        **HEAD,
        "ManifestType": "defaultLocale",
        "PackageLocale": LOCALE,
        "Publisher": ".{2,256}",
        "PackageName": ".{2,256}",
        "License": ".{3,512}",
        "ShortDescription": ".{3,256}",
        "PackageUrl": ADDRESS,
        "Moniker": ".{1,40}",
    },
}
ALLOWED = {
    "": set(),
    ".installer": {"Platform", "NestedInstallerFiles", "Commands", "Installers"},
    ".locale.en-US": {"Copyright", "Description", "Tags"},
}
INSTALLER = {"Architecture": "x86|x64|arm64|neutral", "InstallerUrl": ADDRESS, "InstallerSha256": "[A-Fa-f0-9]{64}"}


def main(folder: Path, version: str) -> None:
    names = {f"Drypoint.Drypoint{part}.yaml" for part in REQUIRED}
    assert {path.name for path in folder.iterdir()} == names, sorted(folder.iterdir())
    parts = {part: _read(folder / f"Drypoint.Drypoint{part}.yaml", part) for part in REQUIRED}
    for part, keys in parts.items():
        _match(keys, REQUIRED[part])
        assert set(keys) <= set(REQUIRED[part]) | ALLOWED[part], f"no such key: {set(keys)}"
        assert keys["PackageVersion"] == version
    assert len({(keys["PackageIdentifier"], keys["ManifestVersion"]) for keys in parts.values()}) == 1
    assert parts[""]["DefaultLocale"] == parts[".locale.en-US"]["PackageLocale"]
    _check_installer(parts[".installer"])
    tags = parts[".locale.en-US"]["Tags"]
    assert len(tags) == len(set(tags)) <= 16 and all(1 <= len(tag) <= 40 for tag in tags)
    assert folder.parts[-5:] == ("manifests", "d", "Drypoint", "Drypoint", version)


def _read(path: Path, part: str) -> dict[str, Any]:
    text = path.read_text()
    assert "@" not in text, f"{path} is not filled"
    kind = {"": "version", ".installer": "installer", ".locale.en-US": "defaultLocale"}[part]
    keys = yaml.safe_load(text)
    schema = f"https://aka.ms/winget-manifest.{kind}.{keys['ManifestVersion']}.schema.json"
    assert text.startswith(f"# yaml-language-server: $schema={schema}\n"), f"{path} names another schema"
    return keys


def _match(keys: dict[str, Any], wanted: dict[str, str]) -> None:
    for key, pattern in wanted.items():
        # YAML takes 1.10 for a number, which winget refuses.
        assert isinstance(keys.get(key), str), f"{key}: {keys.get(key)!r} is no text"
        assert re.fullmatch(pattern, keys[key]), f"{key}: {keys[key]!r}"


def _check_installer(keys: dict[str, Any]) -> None:
    assert keys["Platform"] == ["Windows.Desktop"] and keys["Commands"] == ["drypoint"]
    (file,) = keys["NestedInstallerFiles"]
    _match(file, {"RelativeFilePath": r"drypoint\.exe", "PortableCommandAlias": "drypoint"})
    assert keys["Installers"]
    for installer in keys["Installers"]:
        _match(installer, INSTALLER)
        assert set(installer) == set(INSTALLER)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
