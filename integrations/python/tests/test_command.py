"""The command is found, and does not outlive its caller's patience."""

import os
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import drypoint
from commandline import HOPPER, InFolder


class TheCommand(InFolder):
    def test_the_package_finds_its_own_command(self) -> None:
        told = subprocess.run([drypoint.command(), "--version"], check=True, capture_output=True, text=True).stdout
        self.assertEqual(told.strip(), f"drypoint {drypoint.version()}")
        if "DRYPOINT" not in os.environ:
            self.assertEqual(Path(drypoint.command()).parent, Path(sys.executable).parent)

    def test_ctrl_c_stops_the_command(self) -> None:
        # A wrapper that tells its process, which `exec` makes the command's.
        wrapper = self.folder / "wrapper"
        wrapper.write_text(
            f'#!/bin/sh\n[ "$1" = draw ] && echo $$ > "{self.folder}/pid"\nexec "{drypoint.command()}" "$@"\n'
        )
        wrapper.chmod(0o755)
        # So large that it takes many seconds, and not so large that it is refused at once.
        script = f"import drypoint; drypoint.draw({str(HOPPER)!r}, size=(200, 250), pitch=0.4)"
        python = subprocess.Popen(
            [sys.executable, "-c", script],
            env={**os.environ, "DRYPOINT": str(wrapper)},
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
        self.addCleanup(python.kill)
        pid = self.wait_for_pid()
        time.sleep(0.3)
        # To Python alone, as a notebook does; a terminal sends it to both.
        python.send_signal(signal.SIGINT)
        said = python.communicate(timeout=60)[1]
        self.assertIn("KeyboardInterrupt", said)
        with self.assertRaises(ProcessLookupError):
            os.kill(pid, 0)

    def wait_for_pid(self) -> int:
        end = time.monotonic() + 60
        while time.monotonic() < end:
            path = self.folder / "pid"
            if path.exists() and path.read_text().strip():
                return int(path.read_text())
            time.sleep(0.05)
        raise AssertionError("the command did not start")

    def test_a_missing_command_is_told(self) -> None:
        script = "import drypoint; drypoint.draw('a.jpg')"
        env = {name: value for name, value in os.environ.items() if name != "DRYPOINT"} | {"PATH": str(self.folder)}
        # A copy of the package without its command.
        shutil.copytree(Path(drypoint.__file__).parent, self.folder / "lib" / "drypoint")
        site = f"import sys, sysconfig; sys.path.insert(0, {str(self.folder / 'lib')!r})\n"
        site += f"sysconfig.get_path = lambda *given, **more: {str(self.folder)!r}\n"
        told = subprocess.run([sys.executable, "-c", site + script], env=env, capture_output=True, text=True).stderr
        self.assertIn("the drypoint command is not found; install it", told)

    def test_the_package_is_typed(self) -> None:
        self.assertTrue((Path(drypoint.__file__).parent / "py.typed").exists())


if __name__ == "__main__":
    unittest.main()
