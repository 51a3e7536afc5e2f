"""The pages of the book, and their fenced blocks."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

DOCS = Path(__file__).resolve().parent.parent


@dataclass(frozen=True)
class Block:
    """A fenced block: its words (`sh`, `toml file=pens.toml`), its text, and the line of its fence."""

    words: list[str]
    text: str
    line: int

    @property
    def language(self) -> str:
        return self.words[0] if self.words else ""

    @property
    def file(self) -> str | None:
        """The file that the reader is told to write."""
        return next((word.removeprefix("file=") for word in self.words if word.startswith("file=")), None)


def pages() -> list[Path]:
    """All pages, in the order of the book."""
    names = re.findall(r"\]\(([^)]+\.md)\)", (DOCS / "SUMMARY.md").read_text(encoding="utf-8"))
    return [DOCS / name for name in names]


def blocks(page: Path) -> Iterator[Block]:
    words: list[str] | None = None
    start, text = 0, ""
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if words is None and line.startswith("```"):
            words, start, text = line[3:].split(), number, ""
        elif words is not None and line.startswith("```"):
            yield Block(words, text, start)
            words = None
        elif words is not None:
            text += line + "\n"
    if words is not None:
        raise ValueError(f"{page.name}: the block of line {start} does not end")


def prose(page: Path) -> str:
    """The page without its fenced blocks."""
    return re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
