"""Checks the book's names against the command: options, styles with their parameters and defaults, presets and machines.

Needs no machine and no network: it covers what `commands.py` cannot run. `drypoint` must be on the PATH.
"""

import json
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import book

# Options of other programs that the pages name.
FOREIGN = {"--array", "--example", "--fast", "--features", "--no-default-features", "--open", "--path", "--release", "--version"}
# Pages about other things than the command line.
INSIDE = {"architecture.md", "samples.md"}


@cache
def said(*words: str) -> str:
    return subprocess.run(["drypoint", *words], capture_output=True, encoding="utf-8", check=True).stdout


def listed(what: str) -> list[dict]:
    return json.loads(said(what, "--json"))[what]


@cache
def options() -> dict[str, set[str]]:
    """The options of each subcommand."""
    commands = re.findall(r"^  ([a-z]+)  ", said("--help"), re.MULTILINE)
    known = {
        command: set(re.findall(r"(--[a-z][a-z-]+)", said(command, "--help")))
        for command in commands
        if command != "help"
    }
    if len(known) < 15 or len(known["draw"]) < 40:
        raise SystemExit("drypoint --help lists fewer commands or options than it must")
    return known


def unknown_options(page: Path) -> list[str]:
    """Options that no command knows, and in commands those that this command does not know."""
    everything = set().union(*options().values()) | FOREIGN
    text = page.read_text(encoding="utf-8")
    faults = [
        f"no command knows {option}"
        for option in re.findall(r"(?<![\w-])--[a-z][a-z-]+", text)
        if option not in everything
    ]
    for line in text.replace("\\\n", " ").splitlines():
        for command, rest in re.findall(r"(?:^|\| |`| )drypoint ([a-z]+)((?: +[^`|#]+)?)", line):
            if command not in options():
                continue
            for option in re.findall(r"(?<!\S)(--[a-z][a-z-]+)", rest):
                if option not in options()[command]:
                    faults.append(f"drypoint {command} does not know {option}")
    return faults


def wrong_parameters(style: dict) -> list[str]:
    """Parameters in the tables of a style's page that do not exist or have another default."""
    page = book.DOCS / "styles" / f"{style['name']}.md"
    if not page.is_file():
        return [f"{style['name']} has no page"]
    parameters = {
        parameter["name"]: parameter for parameter in json.loads(said("styles", style["name"], "--json"))["parameters"]
    }
    faults = []
    rows = re.findall(r"^\| `(\w+)`(?:, with `[^`]+`)? \| ([^|]+) \|", book.prose(page), re.MULTILINE)
    for name, default in rows:
        if name not in parameters:
            faults.append(f"{style['name']} has no parameter {name}")
        elif default.split(":")[0].strip("` ") != parameters[name]["default"]:
            faults.append(f"{style['name']}: the default of {name} is {parameters[name]['default']}, not {default}")
    if len(rows) < min(5, len(parameters)):
        faults.append(f"{style['name']}: the page names only {len(rows)} parameters")
    return faults


def missing_names(what: str, page: str, form: str) -> list[str]:
    """Presets or machines that a page leaves out. `form` is how it names them."""
    text = (book.DOCS / page).read_text(encoding="utf-8")
    names = [one["name"] for one in listed(what)]
    return [f"{page} leaves out {name}" for name in names if form.format(name) not in text]


def main() -> int:
    checks = {page.name: unknown_options(page) for page in book.pages() if page.name not in INSIDE}
    checks |= {f"styles {style['name']}": wrong_parameters(style) for style in listed("styles")}
    checks["presets"] = missing_names("presets", "presets.md", "| `{}` |")
    # The machine for tests is only named.
    machines = missing_names("profiles", "machines.md", "\n## {}\n")
    checks["profiles"] = [fault for fault in machines if not fault.endswith(" toy")]
    for name, faults in checks.items():
        for fault in dict.fromkeys(faults):
            print(f"FAILED: {name}: {fault}", file=sys.stderr)
    failed = sum(1 for faults in checks.values() if faults)
    print(f"{len(checks) - failed} {failed}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
