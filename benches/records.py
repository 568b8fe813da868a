"""Whether records of instruments are read and judged rightly: records whose truth is known.

Histories of stored references are seen by a synthetic instrument: filtered, sampled, with noise,
offset and drift, as numbers of some bits. The files are written in the forms of instruments and
programs, with flaws of three sizes, and clean. The program compares each with its scene. Writes the
table, and fails if a target is missed:

    python3 benches/records.py PROGRAM --out reports/records.md

Needs numpy, scipy and the libraries of the formats (`pip install "impactcheck[records]"`).
"""

from __future__ import annotations

import argparse
import fnmatch
import sys
import tempfile
import time
from pathlib import Path

from record_flaws import FLAWS, SIZES, Case
from record_readings import ROOT, SCENES, Program, read_clean, read_flawed, read_forms
from record_report import SEEDS, Found, report
from record_signals import clean, history_of

SOLUTIONS = ROOT / "fem_reference" / "solutions"
PLATES = {"plate-2.1mm": "2.1 mm", "plate-3mm": "3 mm"}
"""Other scenes, by the thickness of their plate."""


def main() -> None:
    """Makes, reads, writes the table, and fails if a target is missed."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", type=lambda path: Path(path).resolve())
    parser.add_argument("--out", type=Path, required=True, help="Markdown")
    parser.add_argument("--draws", type=int, default=120, help="clean records")
    parser.add_argument("--only", default="*", help="names: forms, clean-*, gap-1-*, ...")
    parser.add_argument("--keep", type=Path, help="folder for the files")
    arguments = parser.parse_args()
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as temporary:
        folder = (arguments.keep or Path(temporary)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        program = Program(arguments.program, folder)
        histories = {
            name: history_of(name, SOLUTIONS / name / "paper" / "history.csv") for name in SCENES
        }
        histories |= {name: program.history(name, size) for name, size in PLATES.items()}
        sizes = range(len(SIZES))
        cases = [
            Case(flaw, size, seed, histories)
            for flaw in FLAWS
            for size in sizes
            for seed in range(SEEDS)
        ]
        cases = [case for case in cases if fnmatch.fnmatch(case.name, arguments.only)]
        seeds = range(arguments.draws)
        seeds_wanted = [k for k in seeds if fnmatch.fnmatch(f"clean-{k:03}", arguments.only)]
        with_forms = fnmatch.fnmatch("forms", arguments.only)
        found = Found(
            read_forms(program, histories) if with_forms else {},
            read_clean(program, [clean(seed, histories) for seed in seeds_wanted]),
            read_flawed(program, cases),
        )
    arguments.out.write_text(report(found), encoding="utf-8")
    missed = [
        f"{what}: {value}, target {target}"
        for what, value, target, met in found.targets()
        if not met
    ]
    print(f"{time.monotonic() - start:.0f} s", *missed, sep="\n")
    sys.exit(bool(missed))


if __name__ == "__main__":
    main()
