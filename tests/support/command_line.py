"""`yarpy VERB ...` as a person starts it: in processes of its own, against a given name server.

Rules: nothing of this machine's configuration is read or changed; what is started ends with its
`with` block; every run has a time limit.
"""

import contextlib
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

from support.process import Process
from support.wait import HANG

YARPY = [sys.executable, "-m", "yarpy"]


class CommandLine:
    """The command and its environment: `home` for files, `variables` say where the server is."""

    def __init__(self, home: Path, variables: Mapping[str, str] | None = None) -> None:
        self.home = home
        self.environment = {
            name: value
            for name, value in os.environ.items()
            if not name.startswith(("YARP_", "YARPY_"))
        }
        self.environment["YARP_CONFIG_HOME"] = str(home / "config")
        self.environment["YARP_DATA_HOME"] = str(home / "data")
        self.environment.update(variables or {})

    def start(self, *words: str) -> Process:
        """Start `yarpy WORDS`; a context manager that ends it."""
        return Process([*YARPY, *words], env=self.environment, cwd=self.home)

    def run(
        self, *words: str, input: str = "", timeout: float = HANG
    ) -> "subprocess.CompletedProcess[str]":
        """Run `yarpy WORDS` to its end: output and exit code. AssertionError if it takes longer."""
        with self.start(*words) as process:
            with contextlib.suppress(BrokenPipeError):  # it may end without reading
                process.write(input)
            process.end_input()
            code = process.wait(timeout)
            return subprocess.CompletedProcess(process.args, code, process.stdout, process.stderr)
