"""Solve scenes of the validation base: reference, its band, and the reduced models.

    python validation/solve.py SCENES ROWS [--known TABLE] [--shard 1/4] [--longest SECONDS]

writes `ROWS/<scene>.json` for every scene file in the folder SCENES that has none yet and is not in
TABLE; so a run that was stopped goes on, and shards on several machines share the work. A scene
that is refused or not solved gets a row with the reason; one that takes longer than SECONDS gets
none, and waits for a run that allows more.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path
from typing import Any

PROGRAM = Path(__file__).resolve().parent.parent / "target" / "release" / "impactcheck"
MODELS = ("A", "B", "C")
OF_KIND = {"plate-impact": MODELS, "impact": ("C",), "seal-seat": ("C",)}
"""Models that a kind of scene has."""
CONTACTS = ("outer_contacts", "inner_contacts")
"""Numbers of contacts, which seal seats do not count."""
DIGITS = 7

Row = dict[str, Any]


def short(value: float | None) -> float | None:
    """With the digits that are kept."""
    return None if value is None else float(f"{value:.{DIGITS}g}")


def row(document: Row, continuum: Row | None) -> Row:
    """What is kept of the comparison of one scene: what the meshes say, and the models' values.

    ``continuum`` is the summary of model C as it is by default.
    """
    scene = document["scenes"][0]
    reference = scene["reference"]
    found = reference["convergence"]["quantities"]
    summaries = {model["model"]: model["summary"] for model in scene["models"]}
    if continuum is not None:
        summaries["C"] = continuum
    return {
        "hash": reference["scene_hash"],
        "dofs": reference["mesh"]["dofs"],
        "unsound": [check["check"] for check in scene["integrity"] if check["verdict"] == "fail"],
        "contacts": [reference[name] for name in CONTACTS if name in reference],
        "extrapolated": {name: short(of["extrapolated"]) for name, of in found.items()},
        "bands": {name: short(of["band"]) for name, of in found.items()},
        "similarity": (continuum or {}).get("similarity"),
        "models": {
            model: {name: short(summary.get(name)) for name in found}
            for model, summary in summaries.items()
        },
    }


def _continuum(path: Path, program: Path) -> Row | None:
    """Summary of model C as it is by default, which predictions are made of; none without a form.

    A comparison may have another one: off the centre none, of a seat that on the reference's mesh.
    """
    command: list[str | Path] = [program, "reduced", path, "--model", "C", "--json"]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    return dict(json.loads(ran.stdout)) if ran.returncode == 0 else None


def solve(path: Path, program: Path, longest: float | None = None) -> Row:
    """Compare the models with a fresh reference of the scene; or why that is not possible.

    Raises ``subprocess.TimeoutExpired`` after ``longest`` seconds.
    """
    begun = time.monotonic()
    file = tomllib.loads(path.read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as folder:
        command: list[str | Path] = [
            program,
            "--store",
            f"{folder}/store",
            "compare",
            path,
            "--compute",
            "--json",
        ]
        command += [
            "--resolution",
            "coarse",
            "--models",
            ",".join(OF_KIND[file["kind"]]),
            "--out",
            f"{folder}/page",
        ]
        ran = subprocess.run(command, capture_output=True, text=True, check=False, timeout=longest)
        continuum = _continuum(path, program) if ran.stdout.strip() else None
    found: Row = {
        "scene": path.stem,
        "stratum": path.stem.rsplit("-", 1)[0],
        "content": content(path),
    }
    if ran.stdout.strip():
        found |= row(json.loads(ran.stdout), continuum)
    else:
        # the sentence of the error, which is broken into lines with bars before them
        reason = ran.stderr[ran.stderr.rfind("\u00d7") + 1 :].split("help:")[0]
        found |= {
            "refused": " ".join(reason.replace("\u2502", " ").split()),
            "status": ran.returncode,
        }
    return found | {"seconds": round(time.monotonic() - begun, 1), "file": file}


def _shard(text: str) -> tuple[int, int]:
    number, count = (int(part) for part in text.split("/"))
    if not 1 <= number <= count:
        raise argparse.ArgumentTypeError(f"shard {text}: the number must be 1 to {count}")
    return number, count


def content(path: Path) -> str:
    """Short hash of a scene file: a scene that is drawn otherwise is solved again."""
    return hashlib.sha256(path.read_bytes()).hexdigest()[:12]


def _contents(table: Path | None) -> dict[str, str]:
    """Of the scenes in a table, by name."""
    lines = table.read_text(encoding="utf-8").splitlines() if table and table.exists() else []
    return {row["scene"]: row["content"] for row in map(json.loads, lines)}


def main() -> None:
    """Solve what is missing."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", type=Path)
    parser.add_argument("rows", type=Path)
    parser.add_argument("--shard", type=_shard, default=(1, 1), help="such as 2/4: the second of 4")
    parser.add_argument("--known", type=Path, help="table of scenes that are not solved again")
    parser.add_argument("--longest", type=float, help="seconds for a scene; others wait")
    parser.add_argument("--program", type=Path, default=PROGRAM)
    given = parser.parse_args()
    number, count = given.shard
    known = _contents(given.known)
    given.rows.mkdir(parents=True, exist_ok=True)
    # from every stratum early
    paths = sorted(given.scenes.glob("*.toml"), key=lambda path: (path.stem[-3:], path.stem))
    for path in paths[number - 1 :: count]:
        target = given.rows / f"{path.stem}.json"
        if known.get(path.stem) != content(path) and not target.exists():
            try:
                found = solve(path, given.program, given.longest)
            except subprocess.TimeoutExpired:
                print(f"{path.stem}: over {given.longest:g} s, waits", file=sys.stderr, flush=True)
                continue
            partial = target.with_suffix(".partial")
            partial.write_text(json.dumps(found))
            shutil.move(partial, target)
            outcome = found.get("refused", f"{found.get('dofs')} unknowns")
            print(f"{path.stem}: {found['seconds']} s, {outcome}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
