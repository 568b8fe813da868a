"""What gmsh does not pass on of a STEP file: its unit of length and the names of its faces."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

RECORD = re.compile(r"#(\d+)\s*=\s*((?:'(?:[^']|'')*'|[^;'])*);")
ENTITY = re.compile(r"\s*([A-Z0-9_]+)\s*\(")
REFERENCE = re.compile(r"#(\d+)")
TEXT = re.compile(r"'((?:[^']|'')*)'")
UNICODE = re.compile(r"\\X2\\([0-9A-F]+)\\X0\\")
METRES = {
    ".MILLI.": 1e-3, ".CENTI.": 1e-2, ".DECI.": 1e-1, ".MICRO.": 1e-6, ".KILO.": 1e3,
    "$": 1.0, "*": 1.0, "": 1.0,
}  # fmt: skip
CONVERTED = {"INCH": 0.0254, "FOOT": 0.3048, "MIL": 25.4e-6}
SI_LENGTH = re.compile(r"SI_UNIT\s*\(\s*(\.\w+\.|\$|\*)?\s*,\s*\.METRE\.\s*\)")
CONVERTED_LENGTH = re.compile(r"CONVERSION_BASED_UNIT\s*\(\s*'(INCH|FOOT|MIL)", re.IGNORECASE)
SURFACES = {
    "PLANE": "Plane",
    "CYLINDRICAL_SURFACE": "Cylinder",
    "CONICAL_SURFACE": "Cone",
    "SPHERICAL_SURFACE": "Sphere",
    "TOROIDAL_SURFACE": "Torus",
}
"""gmsh's name of a STEP surface."""
UNNAMED = ("", "NONE")


@dataclass(frozen=True)
class StepText:
    """What the text of a STEP file says."""

    unit: float | None
    """m; None: it states none, or several."""
    faces: list[tuple[str, str]]
    """Name ("" if none) and gmsh's kind of surface ("" if other) of the faces of its only solid, in
    their order."""


def read_step(path: Path) -> StepText:
    """The unit and the faces' names."""
    text = path.read_text(encoding="latin-1")
    records = dict(RECORD.findall(text))
    return StepText(_unit(text), _faces(records))


def _unit(text: str) -> float | None:
    found = {CONVERTED[each.upper()] for each in CONVERTED_LENGTH.findall(text)}
    if not found:
        found = {METRES.get(prefix, 0.0) for prefix in SI_LENGTH.findall(text)}
    return found.pop() if len(found) == 1 and 0.0 not in found else None


def _faces(records: dict[str, str]) -> list[tuple[str, str]]:
    solids = [
        body
        for body in records.values()
        if body.lstrip().startswith(("MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS"))
    ]
    if len(solids) != 1:
        return []
    faces: list[tuple[str, str]] = []
    for shell in REFERENCE.findall(TEXT.sub("", solids[0])):
        body = records.get(shell, "")
        if body.lstrip().startswith("ORIENTED_CLOSED_SHELL"):
            inner = REFERENCE.findall(TEXT.sub("", body))
            body = records.get(inner[0], "") if inner else ""
        for face in REFERENCE.findall(TEXT.sub("", body)):
            faces.append(_face(records, records.get(face, "")))
    return faces


def _face(records: dict[str, str], body: str) -> tuple[str, str]:
    name = TEXT.search(body)
    references = REFERENCE.findall(TEXT.sub("", body))
    surface = ENTITY.match(records.get(references[-1], "")) if references else None
    title = _decoded(name[1]) if name else ""
    return ("" if title.upper() in UNNAMED else title), SURFACES.get(
        surface[1] if surface else "", ""
    )


def _decoded(text: str) -> str:
    def characters(match: re.Match[str]) -> str:
        return bytes.fromhex(match[1]).decode("utf-16-be", errors="replace")

    return UNICODE.sub(characters, text.replace("''", "'")).strip()
