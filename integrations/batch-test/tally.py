"""Counts checks; each prints what it saw, and the closing line is what integrations/test.sh adds up."""

import sys


class Tally:
    def __init__(self) -> None:
        self.passed = 0
        self.failed = 0

    def check(self, holds: bool, what: str, seen: object = "") -> bool:
        """Counts one check; `what` says what must hold, `seen` the figures."""
        if holds:
            self.passed += 1
        else:
            self.failed += 1
        print(f"{'ok' if holds else 'FAILED'}: {what}{f' ({seen})' if seen != '' else ''}", flush=True)
        return holds

    def close(self) -> None:
        print(f"{self.passed} passed, {self.failed} failed", flush=True)
        sys.exit(1 if self.failed else 0)
