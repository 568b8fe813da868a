"""What the program refuses."""

from __future__ import annotations


class Error(Exception):
    """What the program refused or failed at, in its own words.

    Attributes:
        exit_status: 1 internal, 2 usage, 3 invalid scene, 11 no reference, 12 a solver failed.
    """

    def __init__(self, message: str, exit_status: int) -> None:
        super().__init__(message, exit_status)
        self.exit_status = exit_status

    def __str__(self) -> str:
        return str(self.args[0])
