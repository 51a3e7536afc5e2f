"""Draws pages in headless Inkscape and compares them with drypoint's own files."""

from __future__ import annotations

import shutil
import sys
import tempfile
import traceback
from pathlib import Path
from typing import Callable

import dialog
import drawings
import messages

Case = Callable[[Path], None]


def cases() -> list[Case]:
    return [
        case
        for module in (dialog, drawings, messages)
        for name, case in vars(module).items()
        if callable(case) and getattr(case, "__module__", "") == module.__name__ and not name.startswith("_")
    ]


def main() -> int:
    passed = failed = 0
    for case in cases():
        scratch = Path(tempfile.mkdtemp(prefix="drypoint-test-"))
        try:
            case(scratch)
        except Exception:  # Each case is told, whatever became of the others.
            failed += 1
            print(f"FAILED {case.__name__}\n{traceback.format_exc()}", file=sys.stderr)
        else:
            passed += 1
            print(f"passed {case.__name__}", file=sys.stderr, flush=True)
        finally:
            shutil.rmtree(scratch)
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
