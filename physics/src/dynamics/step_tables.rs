//! The step tables of a run, made when their length is first taken.

use super::batch::OscillatorBatch;
use super::collocation::Collocation;
use super::step_table::StepTable;

/// Tables of the step lengths in use: a fixed number of places, taken over from the level farthest off when all are
/// in use. One more serves steps of any other length.
pub(super) struct StepTables {
    places: Vec<(i32, StepTable)>,
    other: StepTable,
    blocks: usize,
}

/// Places of a [`StepTables`].
const PLACES: usize = 8;

impl StepTables {
    /// For oscillators in `blocks` blocks.
    pub(super) fn new(blocks: usize) -> Self {
        Self { places: Vec::with_capacity(PLACES), other: StepTable::empty(blocks), blocks }
    }

    /// Table of the steps of `level`, of length `h` s.
    pub(super) fn get(
        &mut self,
        batch: &OscillatorBatch,
        collocation: &Collocation,
        level: i32,
        h: f64,
    ) -> &StepTable {
        let place = match self.places.iter().position(|(l, _)| *l == level) {
            Some(place) => return &self.places[place].1,
            None if self.places.len() < PLACES => {
                self.places.push((level, StepTable::empty(self.blocks)));
                self.places.len() - 1
            }
            None => (0..PLACES).max_by_key(|p| (self.places[*p].0 - level).abs()).expect("places"),
        };
        self.places[place].0 = level;
        self.places[place].1.fill(batch, collocation, h);
        &self.places[place].1
    }

    /// Table of a step of any length `h` s.
    pub(super) fn other(&mut self, batch: &OscillatorBatch, collocation: &Collocation, h: f64) -> &StepTable {
        self.other.fill(batch, collocation, h);
        &self.other
    }
}
