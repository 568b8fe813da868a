"""One run of the program."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

COLOUR = re.compile(r"\x1b\[[0-9;]*m")


class Error(Exception):
    """What the program refused or failed at, in its own words.

    Attributes:
        exit_status: 1 internal, 2 usage, 3 invalid scene, 11 no reference, 12 a solver failed.
    """

    def __init__(self, message: str, exit_status: int) -> None:
        super().__init__(message)
        self.exit_status = exit_status


def program() -> str:
    """Path of the program: $IMPACTCHECK_PROGRAM, else that of the package, else that on PATH."""
    name = "impactcheck.exe" if sys.platform == "win32" else "impactcheck"
    installed = [Path(sysconfig.get_path("scripts", scheme)) / name for scheme in schemes()]
    there = [str(path) for path in installed if path.is_file()]
    found = os.environ.get("IMPACTCHECK_PROGRAM") or next(iter(there), None) or shutil.which(name)
    if found is None:
        raise Error("the program impactcheck is neither installed with its package nor on PATH", 12)
    return found


def schemes() -> list[str]:
    """The places that packages are installed to: this interpreter's, then the user's."""
    return [sysconfig.get_default_scheme(), sysconfig.get_preferred_scheme("user")]


def run(*arguments: str) -> str:
    """Run the program with these arguments, as on the command line, and return what it prints.

    Raises:
        Error: If its exit status is not 0.
    """
    ended = subprocess.run(
        [program(), "--quiet", *arguments], capture_output=True, text=True, encoding="utf-8"
    )
    if ended.returncode != 0:
        message = COLOUR.sub("", ended.stderr).strip().removeprefix("error: ")
        raise Error(message or f"the program ended with {ended.returncode}", ended.returncode)
    return ended.stdout
