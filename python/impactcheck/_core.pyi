from collections.abc import Callable, Iterable, Mapping, Sequence
from os import PathLike
from typing import Any, final

__all__ = [
    "Samples",
    "Scene",
    "compare",
    "figure",
    "main",
    "optimise",
    "predicted",
    "project_root",
    "reduced",
    "reference",
]

@final
class Scene:
    """One impact, read and checked.

    It can be copied and pickled.

    Args:
        content: The keys of a scene file, or its text. Quantities are texts with units ("33 mm") or
            numbers in SI; `impactcheck schema` lists all keys.
        file: The file that it is the content of, if there is one.

    Raises:
        Error: With every fault, if it is no valid scene.
    """

    def __new__(
        cls, content: Mapping[str, Any] | str, file: str | PathLike[str] | None = None
    ) -> Scene: ...
    def __getnewargs__(self) -> tuple[str, str | PathLike[str] | None]: ...
    @staticmethod
    def read(path: str | PathLike[str]) -> Scene:
        """The scene in a file, or the shipped one of that name.

        Raises:
            Error: If there is none, or it is not valid.
        """

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def hash(self) -> str:
        """What identifies its physics: SHA-256, hexadecimal."""

@final
class Samples:
    @property
    def __array_interface__(self) -> dict[str, Any]: ...

_Run = tuple[str, list[tuple[str, Samples]]]

def predicted(
    scene: Scene, model: str | None, modes: int | None, tolerance: float | None
) -> _Run: ...
def reduced(
    scenes: list[Scene],
    model: str | None,
    modes: int | None,
    tolerance: float | None,
    threads: int | None,
) -> list[_Run]: ...
def reference(scene: Scene, resolution: str, compute: bool) -> _Run: ...
def compare(
    scenes: Sequence[Scene],
    models: Sequence[str],
    resolution: str,
    compute: bool,
    allow_external: bool,
    out: str | PathLike[str] | None,
    measured: Sequence[str | PathLike[str]],
    how: tuple[str | None, str | None, str | PathLike[str] | None],
) -> tuple[str, list[str]]: ...
def optimise(
    scene: Scene,
    options: Sequence[str],
    progress: Callable[[int, float | None], object] | None,
) -> tuple[str, str, str]: ...
def figure(
    title: str, time: Iterable[float], curves: Sequence[tuple[str, Iterable[float]]]
) -> str: ...
def project_root() -> str: ...
def main(arguments: Sequence[str]) -> int: ...
