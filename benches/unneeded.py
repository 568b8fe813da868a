"""What a scene does not need, it does not pay for: instructions of an impact, by callgrind.

Instructions repeat where times do not. A scene without a feature is held against the same scene
with the feature named and off, and, to see that a new feature costs those nothing who have none,
against a program BEFORE that was built without it. Writes unneeded.json and unneeded.md:

    python3 benches/unneeded.py PROGRAM [--before PROGRAM] --out DIR
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

SCENE = Path(__file__).resolve().parent.parent / "scenes" / "scaled-plate-r10.toml"
TIME_LOOP = "impactcheck_physics::dynamics::integrator::integrate"
FLUID_OFF = """
[fluid]
viscosity = "1 mPa*s"
density = "1000 kg/m^3"
minimum_gap = "0.25 um"
squeeze_film = false
added_mass_frequency_ratio = 1.0
plate_damping_ratio = 0.0
drag_coefficient = 0.0
"""


def count(program: Path, arguments: list[str], cache: str = "", whole: bool = False) -> int:
    """Instructions of `program`: of its time loop, or of the whole process."""
    with tempfile.TemporaryDirectory() as folder:
        toggle = [] if whole else [f"--toggle-collect={TIME_LOOP}"]
        command = [
            "valgrind",
            "--tool=callgrind",
            f"--callgrind-out-file={folder}/out",
            *toggle,
            str(program),
        ]
        environment = os.environ | {"IMPACTCHECK_CACHE": cache, "RAYON_NUM_THREADS": "1"}
        done = subprocess.run(
            [*command, *arguments], env=environment, capture_output=True, text=True
        )
    if done.returncode != 0:
        sys.exit(f"{' '.join(arguments)} failed:\n{done.stderr}")
    found = re.search(r"Collected : (\d+)", done.stderr)
    if found is None:
        sys.exit(f"callgrind did not say how much it collected:\n{done.stderr}")
    return int(found[1])


def main() -> None:
    """Counts, writes both files, and fails if a feature that is off costs something."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", type=Path)
    parser.add_argument("--before", type=Path, metavar="PROGRAM")
    parser.add_argument("--out", type=Path, required=True)
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    text = SCENE.read_text()

    with tempfile.TemporaryDirectory() as folder:

        def scene(name: str, **changes: str) -> str:
            """A scene file: `text` with tables or keys added."""
            changed = text + changes.get("more", "")
            for table, line in changes.items():
                if table != "more":
                    changed = changed.replace(f"[{table}]\n", f"[{table}]\n{line}\n", 1)
            path = Path(folder) / f"{name}.toml"
            path.write_text(changed)
            return str(path)

        def b(path: str, *more: str, by: Path = program) -> int:
            return count(by, ["reduced", path, "--model", "B", "--json", *more])

        def seconds(path: str) -> dict:
            done = subprocess.run(
                [program, "reduced", path, "--model", "B", "--json"],
                capture_output=True,
                check=True,
            )
            return json.loads(done.stdout)

        dry = scene("dry")
        usual = b(dry)
        damped = scene("damped", plate="damping_ratio = 0.01")
        far = scene("far", inner='gap = "20 mm"')
        long = scene("long", more='\n[run]\nend_time = "100 ms"\n')
        summary = seconds(dry)
        last = max(summary["outer_contact_end"], summary["inner_contact_end"])
        cache = str(Path(folder) / "cache")
        model_c = ["reduced", dry, "--model", "C", "--modes", "16", "--json"]
        rows = [
            (
                "off: fluid, named in the scene with every effect off",
                usual,
                b(scene("off", more=FLUID_OFF)),
            ),
            ("on: damping of the plate", usual, b(damped)),
            (
                "on: history, by a second run that keeps it",
                usual,
                b(dry, "--history", str(Path(folder) / "history.csv")),
            ),
            (
                "on: residual flexibility (C, 16 modes), with the rough run that sizes the patches",
                usual,
                count(program, model_c),
            ),
            ("off: second contact, never reached", usual, b(far)),
            ("exact free flight for 100 ms after the last contact", usual, b(long)),
            ("the same in steps as long as those of the contact", usual, round(usual * 0.1 / last)),
            (
                "cached bodies of model C, whole program: miss, hit",
                count(program, model_c, cache, whole=True),
                count(program, model_c, cache, whole=True),
            ),
        ]

        if arguments.before is not None:
            rows.append(("the program before", b(dry, by=arguments.before.resolve()), usual))

    arguments.out.mkdir(parents=True, exist_ok=True)
    entries = [
        {"case": case, "base": base, "instructions": new, "ratio": new / base}
        for case, base, new in rows
    ]
    (arguments.out / "unneeded.json").write_text(
        json.dumps({"schema_version": 1, "rows": entries}, indent=1) + "\n"
    )
    lines = ["| case | base, instructions | instructions | ratio |", "|---|---|---|---|"]
    lines += [
        f"| {e['case']} | {e['base']} | {e['instructions']} | {e['ratio']:.4f} |" for e in entries
    ]
    (arguments.out / "unneeded.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))
    # a feature that is off may not cost more than the noise of another inlining
    before = [e["ratio"] for e in entries if e["case"] == "the program before"]
    if not entries[0]["ratio"] < 1.001 or not all(ratio < 1.03 for ratio in before):
        sys.exit("a feature that is switched off costs something")


if __name__ == "__main__":
    main()
