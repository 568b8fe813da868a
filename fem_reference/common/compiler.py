"""The C compiler that builds the time loop."""

from __future__ import annotations

import os
import shutil
import subprocess

from .errors import SolverError


def compiler() -> str:
    """Path of the C compiler: $CC, else cc, gcc or clang.

    Raises:
        SolverError: there is none.
    """
    requested = os.environ.get("CC")
    for name in (requested,) if requested else ("cc", "gcc", "clang"):
        path = shutil.which(name)
        if path:
            return path
    raise SolverError(
        f"no C compiler found ({requested or 'cc, gcc, clang'}); the time loop needs one: "
        "install gcc or set CC"
    )


def compiler_version() -> str:
    """First line of the compiler's --version."""
    output = subprocess.run([compiler(), "--version"], capture_output=True, text=True, check=False)
    return output.stdout.splitlines()[0] if output.stdout else "unknown"
