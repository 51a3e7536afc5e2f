"""Runs all tests of the folder that is named and ends with one line: how many passed and failed."""

import sys
import unittest


def main(folder: str) -> int:
    tests = unittest.defaultTestLoader.discover(folder, pattern="test_*.py")
    result = unittest.TextTestRunner(verbosity=2).run(tests)
    failed = len(result.failures) + len(result.errors) + len(result.skipped) + len(result.unexpectedSuccesses)
    print(f"{result.testsRun - failed} passed, {failed} failed")
    return 1 if failed or result.testsRun == 0 else 0


sys.exit(main(sys.argv[1]))
