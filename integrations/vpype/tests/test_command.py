"""The command is found where the user has it."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from vpype_drypoint.command import command


class TheCommand(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def ordered(self, **variables: str) -> subprocess.CompletedProcess[str]:
        """A pipeline that needs the command, in an environment where only these variables lead to it."""
        script = "import vpype_cli; print(len(vpype_cli.execute('random -n 9 dpsort').layers[1]))"
        kept = {name: value for name, value in os.environ.items() if name not in ("DRYPOINT", "PATH")}
        env = {**kept, "PATH": str(self.folder / "nothing"), **variables}
        return subprocess.run([sys.executable, "-c", script], env=env, capture_output=True, text=True)

    def test_by_its_variable(self) -> None:
        self.assertEqual(self.ordered(DRYPOINT=command()).stdout, "9\n")

    def test_on_the_path(self) -> None:
        (self.folder / "drypoint").symlink_to(command())
        self.assertEqual(self.ordered(PATH=str(self.folder)).stdout, "9\n")

    def test_of_the_python_package(self) -> None:
        (self.folder / "drypoint").mkdir()
        (self.folder / "drypoint" / "__init__.py").write_text(f"def command() -> str:\n    return {command()!r}\n")
        self.assertEqual(self.ordered(PYTHONPATH=str(self.folder)).stdout, "9\n")

    def test_a_folder_of_its_name_is_no_package(self) -> None:
        (self.folder / "lib" / "drypoint").mkdir(parents=True)
        (self.folder / "drypoint").symlink_to(command())
        done = self.ordered(PYTHONPATH=str(self.folder / "lib"), PATH=str(self.folder))
        self.assertEqual(done.stdout, "9\n")

    def test_missing(self) -> None:
        self.assertIn("the drypoint command is not found; install", self.ordered().stderr)
        self.assertIn("DRYPOINT is nonsense, which is no program", self.ordered(DRYPOINT="nonsense").stderr)


if __name__ == "__main__":
    unittest.main()
