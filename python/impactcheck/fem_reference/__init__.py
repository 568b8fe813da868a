"""The finite elements behind the references, from the project's files or those the package brings.

What is computed with FEniCSx needs a Python that has it: `impactcheck doctor` tells.
"""

from pathlib import Path

from impactcheck import _core

__path__ = [str(Path(_core.project_root(), "fem_reference"))]
