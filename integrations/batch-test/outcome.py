"""What a run left behind, compared with the manifest and with a plain run's outputs."""

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path


def read_results(path: Path) -> list[dict]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def read_names(manifest: Path) -> list[str]:
    return [line.split("\t")[1] for line in manifest.read_text(encoding="utf-8").splitlines()]


def digests(folder: Path) -> dict[str, str]:
    """The SHA-256 of every file in a folder and below, by its path there."""
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in folder.rglob("*")
        if path.is_file()
    }


@dataclass
class Outcome:
    done: int
    skipped: int
    failed: int
    lost: int  # pictures of the manifest without a line
    doubled: int  # lines beyond one per picture
    wrong: list[str]  # outputs that are missing, or whose bytes are neither their line's nor the plain run's
    strangers: list[str]  # files that no picture explains, such as half of an output

    @property
    def drawn(self) -> int:
        return self.done + self.skipped

    def is_right(self, portraits: int, hostile: int) -> bool:
        counts = (self.drawn, self.failed, self.lost, self.doubled)
        return counts == (portraits, hostile, 0, 0) and not self.wrong and not self.strangers

    def __str__(self) -> str:
        text = (
            f"{self.done} done, {self.skipped} skipped, {self.failed} failed, {self.lost} lost, {self.doubled} doubled"
        )
        text += f", {len(self.wrong)} wrong, {len(self.strangers)} strangers"
        examples = self.wrong[:2] + self.strangers[:3]
        return text + (f": {', '.join(examples)}" if examples else "")


def outcome(manifest: Path, results: Path, outputs: Path, reference: dict[str, str]) -> Outcome:
    """Judges the run that wrote `results` and `outputs`; `reference` are the digests of a plain run's folder."""
    lines = read_results(results) if results.exists() else []
    names = read_names(manifest)
    status = {line["name"]: line for line in lines}
    counts = {kind: sum(line["status"] == kind for line in lines) for kind in ("done", "skipped", "failed")}
    found = digests(outputs)
    wrong = []
    for name, line in status.items():
        file = f"{name}.svg"
        if line["status"] == "failed":
            if not line.get("reason"):
                wrong.append(f"{file}: failed without a reason")
        elif not found.get(file) == line["sha256"] == reference.get(file):
            wrong.append(file)
        elif (outputs / file).stat().st_size != line["bytes"]:
            wrong.append(f"{file}: bytes")
    return Outcome(
        **counts,
        lost=len(set(names) - set(status)),
        doubled=len(lines) - len(status),
        wrong=sorted(wrong),
        strangers=sorted(set(found) - set(reference)),
    )
