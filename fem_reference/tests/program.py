"""The package as a program."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def run_program(*arguments: object) -> subprocess.CompletedProcess[str]:
    """Run ``python3 -m fem_reference`` in the project's root."""
    command = [sys.executable, "-m", "fem_reference", *map(str, arguments)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
