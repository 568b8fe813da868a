"""Bodies of CAD and mesh files for tests, and the program that strikes them."""

import os
import subprocess
from pathlib import Path

PROGRAM = os.environ["IMPACTCHECK_PROGRAM"]
# a Python that has gmsh
MESHER = os.environ["IMPACTCHECK_PYTHON"]

STEEL = """
[materials.steel]
youngs_modulus = "210 GPa"
poisson_ratio  = 0.3
density        = "7780 kg/m^3"
"""


def made(folder: Path, script: str) -> None:
    """Runs a script of gmsh in ``folder``."""
    done = subprocess.run(
        [MESHER, "-c", script], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def run(folder: Path, *arguments: str, status: int = 0) -> tuple[str, str]:
    """Standard output and error of the program; its exit status has to be ``status``."""
    environment = {**os.environ, "IMPACTCHECK_CACHE": str(folder / "cache")}
    done = subprocess.run(
        [PROGRAM, *arguments],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == status, f"{arguments}: {done.returncode} {done.stdout}{done.stderr}"
    return done.stdout, done.stderr


def scene(
    folder: Path,
    body: str,
    outer: str = 'at = ["0 mm", "0 mm", "1 mm"]',
    inner: str = "",
    radius: str = "10 mm",
    speed: str = "550 mm/s",
) -> str:
    """Writes ``part.toml``; its name."""
    behind = f'[inner]\nkind = "sphere"\nradius = "{radius}"\nmaterial = "steel"\n{inner}\n'
    text = f"""
name = "part"
kind = "impact"
{STEEL}
[body]
material = "steel"
{body}
[outer]
kind     = "sphere"
radius   = "{radius}"
material = "steel"
speed    = "{speed}"
{outer}
{behind if inner else ""}
"""
    (folder / "part.toml").write_text(text)
    return "part.toml"


BLOCK = """
import gmsh
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
block = gmsh.model.occ.addBox(0, 0, 0, 10, 10, 5)
gmsh.model.occ.synchronize()
gmsh.model.addPhysicalGroup(3, [block], name="block")
gmsh.model.addPhysicalGroup(2, [5], name="base")
gmsh.option.setNumber("Mesh.MeshSizeMax", 2)
gmsh.model.mesh.generate(2)
gmsh.write("surface.msh")
gmsh.model.mesh.generate(3)
gmsh.write("block.msh")
gmsh.finalize()
"""
