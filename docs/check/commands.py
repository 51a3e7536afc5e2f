"""Runs every block of the book that is fenced as `sh`, page by page, and checks the files that its commands write.

    commands.py SAMPLES [PAGE.md...]

The blocks of a page run one after another in a folder of their own, which holds `samples/` and `portrait.jpg`; a block with
`file=NAME` is written there first. Stops at the first that fails. `drypoint` must be on the PATH.
"""

import json
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import book

# What the file of each ending must begin with or hold.
CONTENT = {
    ".svg": rb"^<\?xml|^<svg",
    ".pdf": rb"^%PDF-",
    ".gcode": rb"(?m)^G[01] X",
    ".ngc": rb"(?m)^G[01] X",
    ".hpgl": rb"IN;.*PD-?\d",
    ".toml": rb"(?m)^\w[\w-]* *=",
}


class Wrong(Exception):
    """What is wrong with a block."""


def outputs(text: str) -> list[str]:
    """The files and folders that the commands of a block say they write."""
    found = []
    for line in text.replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        if "--dry-run" not in words:
            given = zip(words, words[1:], strict=False)
            found += [value for option, value in given if option in ("-o", "--preview", ">") and value != "-"]
    return found


def check_output(folder: Path, name: str) -> None:
    if "{name}" in name:
        if not list(folder.glob(name.replace("{name}", "*"))):
            raise Wrong(f"no file {name} was written")
        return
    path = folder / name
    if path.is_dir():
        if not any(path.iterdir()):
            raise Wrong(f"the folder {name} is empty")
        return
    if not path.is_file():
        raise Wrong(f"{name} was not written")
    data = path.read_bytes()
    if path.suffix == ".json":
        json.loads(data)
    elif not re.search(CONTENT.get(path.suffix, rb"(?s)."), data):
        raise Wrong(f"{name} does not hold what a {path.suffix} holds")


def run(block: book.Block, folder: Path) -> None:
    script = f"set -euo pipefail\n{block.text}"
    done = subprocess.run(["bash", "-c", script], cwd=folder, capture_output=True, encoding="utf-8", check=False)
    if done.returncode != 0:
        raise Wrong(f"exit status {done.returncode}\n{block.text}{done.stderr}")
    if re.search(r"^drypoint: warning: .*(no effect|unknown)", done.stderr, re.MULTILINE):
        raise Wrong(f"an option has no effect\n{block.text}{done.stderr}")
    for name in outputs(block.text):
        check_output(folder, name)


def run_page(page: Path, samples: Path) -> int:
    """Runs the blocks of a page. Returns how many commands they held."""
    wanted = [block for block in book.blocks(page) if block.language == "sh" or block.file]
    count = 0
    with tempfile.TemporaryDirectory(prefix="drypoint-docs-") as name:
        folder = Path(name)
        shutil.copytree(samples, folder / "samples")
        shutil.copy(samples / "grace-hopper.jpg", folder / "portrait.jpg")
        for block in wanted:
            if block.file:
                (folder / block.file).write_text(block.text, encoding="utf-8")
                continue
            try:
                run(block, folder)
            except Wrong as wrong:
                raise Wrong(f"{page.relative_to(book.DOCS)}, line {block.line}: {wrong}") from None
            count += len(re.findall(r"^(?:.*\| )?drypoint ", block.text, re.MULTILINE))
    return count


def main() -> int:
    samples = Path(sys.argv[1])
    chosen = [book.DOCS / name for name in sys.argv[2:]] or book.pages()
    passed = 0
    for page in chosen:
        begin = time.monotonic()
        try:
            count = run_page(page, samples)
        except Wrong as wrong:
            print(f"FAILED: {wrong}", file=sys.stderr)
            print(f"{passed} 1")
            return 1
        if count:
            print(f"{page.relative_to(book.DOCS)}: {count} commands, {time.monotonic() - begin:.0f} s", file=sys.stderr)
        passed += count
    print(f"{passed} 0")
    return 0


if __name__ == "__main__":
    sys.exit(main())
