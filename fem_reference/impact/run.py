"""What every run of an impact leaves."""

from __future__ import annotations

from dataclasses import dataclass

from ..common.arrays import Floats
from ..explicit.records import ContactRecord
from ..explicit.supervision import Account


@dataclass(frozen=True)
class Losses:
    """Energy lost so far in the part modelled, J."""

    plate_damping: float = 0.0
    squeeze_film: float = 0.0
    drag: float = 0.0
    contacts: tuple[float, ...] = (0.0, 0.0)
    """To friction and to yielding, at the contacts of striking and struck body; empty: nothing rubs
    or yields."""
    bodies: tuple[float, ...] | None = None
    """To relaxation, of striking body, the one between and struck body; None: none relaxes."""

    @property
    def total(self) -> float:
        """All of it, J."""
        others = (*self.contacts, *(self.bodies or ()))
        return self.plate_damping + self.squeeze_film + self.drag + sum(others)

    def of_whole(self, share: float) -> Losses:
        """That of the whole bodies, if this is that of a ``share``."""
        return Losses(
            self.plate_damping / share,
            self.squeeze_film / share,
            self.drag / share,
            tuple(lost / share for lost in self.contacts),
            self.bodies and tuple(lost / share for lost in self.bodies),
        )


@dataclass(frozen=True, kw_only=True)
class ImpactRun:
    """Result of the time loop, of the whole bodies; a kind adds what its bodies do."""

    times: Floats
    """(m,) raw sampling instants, s."""
    rows: Floats
    """(m, columns) raw samples."""
    contacts: tuple[ContactRecord, ...]
    in_contact_at_end: bool
    """Whether the run ended during a contact, which leaves open what the impact comes to."""
    time_step: float
    """s"""
    critical_time_step: float | None = None
    """s; None: implicit steps have none."""
    steps: int
    loop_seconds: float
    """Wall time of the loop, s."""
    processor_seconds: float
    """As `loop_seconds`, without the time other programs had the processor."""
    initial_energy: float
    """J"""
    energy_residual: float
    """Energy that the balance misses over the initial energy."""
    contact_loss: float = 0.0
    """Energy the contact constraint took out over the initial energy."""
    momentum_residual: float
    """Largest momentum that a balance misses over the initial momentum."""
    support_impulse: float = 0.0
    """Along z, N s."""
    losses: Losses | None = None
    """None if nothing loses."""

    def account(self, levels: int) -> Account:
        """For `stable_run`, of a run with so many levels."""
        relaxed = sum(self.losses.bodies or ()) if self.losses else 0.0
        return Account(levels, self.energy_residual, relaxed / self.initial_energy)
