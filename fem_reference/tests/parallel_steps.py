"""Takes some steps of a small plate scene: ``mpirun -n N ... parallel_steps SCENE STEPS OUT``.

OUT (.npz) gets displacement, velocity, forces and ledger in a numbering that does not depend on N.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from fem_reference.common.fenicsx import world
from fem_reference.explicit.levels import MOST_LEVELS
from fem_reference.explicit.spectrum import critical_time_step
from fem_reference.plate_impact.estimate import estimate_contact, shortest_wavelengths
from fem_reference.plate_impact.scene import read_scene
from fem_reference.plate_impact.solid_model import plate_model
from fem_reference.solid.system import make_loop


def main(scene_path: Path, steps: int, out: Path) -> None:
    """Step and write."""
    comm = world()
    scene = read_scene(scene_path)
    estimate = estimate_contact(scene)
    waves = shortest_wavelengths(scene, estimate.duration)
    made = plate_model(scene, estimate, waves, 0.6) if comm.rank == 0 else None
    loop = make_loop(comm.bcast(made).model, comm)
    critical = critical_time_step(loop)
    loop.set_step(0.9 * critical, 1, MOST_LEVELS)
    loop.advance(steps)
    u, v = loop.gather(loop.u), loop.gather(loop.v)
    energy = loop.energies().total
    if comm.rank == 0:
        state = loop.problem.state
        force = [list(contact.force) for contact in loop.problem.contacts]
        np.savez(
            out,
            **{"u": u, "v": v, "force": np.array(force), "reaction": np.array(state.reaction)},
            **{"energy": energy, "critical": critical, "processes": comm.size},
            **{"levels": np.array(loop.levels)},
        )


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]))
