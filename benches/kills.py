"""What a reference leaves that is killed: by signal, phase and number of processes.

The program runs in a terminal of its own, whose progress bar tells the phase. It is killed there,
and every process it has started is watched until none is left. Then it is started again. Writes
the table, and fails if a row is out of bounds:

    python3 benches/kills.py PROGRAM --out reports/kills.md
"""

from __future__ import annotations

import argparse
import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time
import uuid
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import product
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MARK = "IMPACTCHECK_KILLED"
"""Names the run in the environment of all its processes, whoever started them."""
PHASES = ("stepping", "assembly", "mesh")
BOUNDS = {"SIGKILL": 2.0, "SIGTERM": 0.5, "SIGINT": 0.5, "Ctrl-C": 0.5}
"""Seconds until nothing runs. Ctrl-C is typed, and reaches all processes of the terminal; the
others reach the program alone."""
STATUS = {"SIGKILL": 9, "SIGTERM": 15, "SIGINT": 2, "Ctrl-C": 2}
"""Signal that the program's exit status must name."""
PATIENCE = 600.0
"""Seconds within which a run has to come to its phase, and to its end."""
YOUNG = 11.0
"""Seconds after which the store takes a work folder without a living maker for a leftover."""
SPEED_AND_END = {"550 mm/s": "2 m/s", "[reduced]": '[run]\nend_time = "1 us"\n\n[reduced]'}
SMALL = {'"33 mm"': '"12 mm"', '"10 mm"': '"5 mm"'}
SOLID = """
[reference]
geometry = "solid"
elements_per_contact_radius = 2
elements_per_thickness = 1
element_order = 1
"""


@dataclass(frozen=True)
class Case:
    """One kill."""

    geometry: str
    processes: int
    phase: str
    sent: str


@dataclass(frozen=True)
class Outcome:
    """What came of it."""

    ended: int
    """Processes that ran when it was sent."""
    quiet: float
    """Seconds until none did."""
    status: int
    left: list[str]
    """In the scene's folder of the store."""
    elsewhere: list[str]
    """Among the temporary files."""
    locked: bool
    again: int
    """Exit status of the next run."""
    after: list[str]
    """In the scene's folder after that."""

    def faults(self, case: Case) -> Iterator[str]:
        """What must not be."""
        if self.ended < case.processes + 1:
            yield f"only {self.ended} processes ran"
        if self.quiet > BOUNDS[case.sent]:
            yield f"quiet after {self.quiet:.2f} s"
        if self.status != STATUS[case.sent]:
            yield f"ended by signal {self.status}"
        left_over = [name for name in self.left if not name.startswith(".checkpoint-")]
        if case.sent == "SIGKILL":
            left_over = [name for name in left_over if not name.startswith(".partial-")]
        if left_over:
            yield f"left {', '.join(left_over)}"
        if self.locked:
            yield "the lock is held"
        if self.again != 0 or self.after != ["coarse"]:
            yield f"the next run ended with {self.again} and left {', '.join(self.after)}"


def scene_text(name: str, geometry: str) -> str:
    """A short impact of the shipped scene."""
    text = (ROOT / "scenes" / "scaled-plate-r10.toml").read_text(encoding="utf-8")
    changes = {"scaled-plate-r10": name, "radius = 12": "radius = 4"} | SPEED_AND_END
    for old, new in (changes | SMALL if geometry == "solid" else changes).items():
        text = text.replace(old, new)
    if geometry == "solid":
        text = re.sub(r"\[reference\][^\[]*", SOLID, text)
    return text


def running(mark: str) -> list[int]:
    """Processes with the mark that are no zombies."""
    found = []
    wanted = f"{MARK}={mark}".encode()
    for process in Path("/proc").glob("[0-9]*"):
        try:
            state = (process / "stat").read_text().rpartition(") ")[2][0]
            if state not in "ZX" and wanted in (process / "environ").read_bytes().split(b"\0"):
                found.append(int(process.name))
        except OSError:
            continue  # gone, or another user's
    return found


class Terminal:
    """A program in a terminal of its own."""

    def __init__(self, command: list[str], environment: dict[str, str]) -> None:
        self.pid, self._line = pty.fork()
        if self.pid == 0:
            os.chdir(ROOT)
            os.execve(command[0], command, environment)
        fcntl.ioctl(self._line, termios.TIOCSWINSZ, struct.pack("HHHH", 50, 250, 0, 0))
        self.said = ""

    def listen(self, seconds: float) -> None:
        """Read what it says for some time, so that it need not wait."""
        if select.select([self._line], [], [], seconds)[0]:
            try:
                self.said += os.read(self._line, 65536).decode(errors="replace")
            except OSError:
                time.sleep(seconds)  # nobody is left who could say anything

    def wait_for(self, phase: str) -> None:
        """Until its bar tells of ``phase``."""
        start = time.monotonic()
        while not re.search(rf"\({phase}, | {phase}: ", self.said):
            if time.monotonic() - start > PATIENCE or os.waitpid(self.pid, os.WNOHANG)[0]:
                sys.exit(f"{phase} was not reached:\n{self.said[-2000:]}")
            self.listen(0.05)

    def send(self, sent: str) -> None:
        """Type Ctrl-C or kill."""
        if sent == "Ctrl-C":
            os.write(self._line, b"\x03")
        else:
            os.kill(self.pid, signal.Signals[sent])

    def close(self) -> int:
        """The signal it was ended by, 0 if by none."""
        status = os.waitpid(self.pid, 0)[1]
        os.close(self._line)
        return os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0


def names(folder: Path) -> list[str]:
    """What is in a folder, if it is there."""
    return sorted(path.name for path in folder.iterdir()) if folder.is_dir() else []


def is_locked(folder: Path) -> bool:
    """Whether somebody holds one of the turns to compute a solution."""
    for path in folder.glob("impactcheck-*.lock"):
        with path.open("a") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                return True
    return False


def kill(program: Path, case: Case, folder: Path) -> Outcome:
    """Starts, kills, watches, starts again."""
    scene, temporary = folder / "killed.toml", folder / "tmp"
    scene.write_text(scene_text("killed", case.geometry), encoding="utf-8")
    temporary.mkdir()
    mark, store = uuid.uuid4().hex, folder / "store"
    environment = os.environ | {MARK: mark, "TMPDIR": str(temporary), "TERM": "xterm"}
    command = [str(program), "reference", str(scene), "--store", str(store)]
    command += ["--resolution", "coarse", "--np", str(case.processes)]
    terminal = Terminal([*command, "--fresh"], environment)
    terminal.wait_for(case.phase)
    ended, start = len(running(mark)), time.monotonic()
    terminal.send(case.sent)
    while running(mark) and time.monotonic() - start < PATIENCE:
        terminal.listen(0.005)
    quiet = time.monotonic() - start
    status = terminal.close()
    left, elsewhere = names(store / "killed"), names(temporary)
    locked = is_locked(temporary)
    for leftover in (store / "killed").glob(".partial-*"):
        old = time.time() - YOUNG
        os.utime(leftover, (old, old))
    again = subprocess.run(
        command, cwd=ROOT, env=environment, capture_output=True, timeout=PATIENCE
    )
    if again.returncode != 0:
        print(again.stderr.decode(errors="replace"), file=sys.stderr)
    after = names(store / "killed")
    return Outcome(ended, quiet, status, left, elsewhere, locked, again.returncode, after)


def short(found: list[str]) -> str:
    """Names without what is random in them."""
    cut = {re.sub(r"(\.partial-|impactcheck-|ompi\.)[^ ]*?(\.lock)?$", r"\1*\2", n) for n in found}
    return ", ".join(f"`{name}`" for name in sorted(cut)) or "nothing"


def table(found: list[tuple[Case, Outcome]], planned: int) -> str:
    """Markdown; of `planned` cases those found so far."""
    lines = [
        "# Killed references",
        "",
        "Made by `benches/kills.py`. `reference SCENE --fresh --resolution coarse` is killed in a",
        "phase that its progress bar tells; quiet is the time until none of its processes is left.",
        "Ctrl-C is typed and reaches all processes of the terminal, the others the program alone.",
        "Bounds: quiet within 0.5 s, after SIGKILL 2 s; the program ends by that signal; in the",
        "store at most `.checkpoint-*` stays, after SIGKILL `.partial-*` too; the lock is free;",
        "the next run ends with 0 and leaves nothing but its solution.",
        f"{len(found)} of {planned} cases:",
        "",
        "| phase | signal | reference | processes | ended | quiet, s | left in the store |"
        " among temporary files | next run |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for case, outcome in found:
        cells = [case.phase, case.sent, case.geometry, case.processes, outcome.ended]
        cells += [f"{outcome.quiet:.2f}", short(outcome.left), short(outcome.elsewhere)]
        cells += ["; ".join(outcome.faults(case)) or f"{outcome.again}, {short(outcome.after)}"]
        lines.append(f"| {' | '.join(map(str, cells))} |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Kills, writes the table, and fails if anything is out of bounds."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", type=lambda path: Path(path).resolve())
    parser.add_argument("--out", type=Path, required=True, help="Markdown")
    parser.add_argument("--signal", choices=BOUNDS, nargs="+", default=list(BOUNDS))
    parser.add_argument("--jobs", type=int, default=1, help="cases at once")
    arguments = parser.parse_args()
    runs = [("axisymmetric", 1), ("solid", 1), ("solid", 2)]
    cases = [Case(*run, *of) for of in product(PHASES, arguments.signal) for run in runs]

    def outcome_of(case: Case) -> Outcome:
        with tempfile.TemporaryDirectory() as folder:
            return kill(arguments.program, case, Path(folder))

    found = []
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for case, outcome in zip(cases, pool.map(outcome_of, cases), strict=True):
            faults = "; ".join(outcome.faults(case)) or "as it should be"
            print(case, f"{outcome.quiet:.2f} s", faults, flush=True)
            found.append((case, outcome))
            arguments.out.write_text(table(found, len(cases)), encoding="utf-8")
    sys.exit(any(list(outcome.faults(case)) for case, outcome in found))


if __name__ == "__main__":
    main()
