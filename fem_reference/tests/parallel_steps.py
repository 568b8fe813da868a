"""Steps a small plate scene: ``mpirun -n N ... parallel_steps SCENE STEPS THREADS OUT``.

OUT (.npz) gets displacement, velocity, forces and ledger in a numbering that does not depend on N.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from fem_reference.common.fenicsx import world
from fem_reference.explicit.energies import energies_of
from fem_reference.explicit.levels import MOST_LEVELS
from fem_reference.explicit.loop import SerialLoop
from fem_reference.explicit.parallel import ParallelLoop
from fem_reference.explicit.spectrum import critical_time_step
from fem_reference.plate_impact.estimate import estimate_contact, shortest_wavelengths
from fem_reference.plate_impact.scene import read_scene
from fem_reference.plate_impact.solid_model import plate_model
from fem_reference.solid.system import SolidSystem


def main(scene_path: Path, steps: int, threads: int, out: Path) -> None:
    """Step and write."""
    comm = world()
    scene = read_scene(scene_path)
    estimate = estimate_contact(scene)
    waves = shortest_wavelengths(scene, estimate.duration)
    made = plate_model(scene, estimate, waves, 0.6) if comm.rank == 0 else None
    kind = SerialLoop if comm.size == 1 else ParallelLoop
    loop = kind(SolidSystem(comm.bcast(made).model, comm), comm, threads)
    critical = critical_time_step(loop)
    loop.set_step(0.9 * critical, 1, MOST_LEVELS)
    loop.advance(steps)
    u, v = loop.gather(loop.u), loop.gather(loop.v)
    energy = energies_of(loop).total
    if comm.rank == 0:
        state = loop.problem.state
        force = [list(contact.force) for contact in loop.problem.contacts]
        np.savez(
            out,
            u=u,
            v=v,
            force=np.array(force),
            reaction=np.array(state.reaction),
            energy=energy,
            critical=critical,
            processes=comm.size,
            levels=np.array(loop.levels),
            threads=np.array(loop.threads),
            impulse=np.array([record.impulse for record in loop.problem.records()]),
        )


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]), Path(sys.argv[4]))
