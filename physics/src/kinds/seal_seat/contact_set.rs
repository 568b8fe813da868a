//! The contact set: how it changes, and the factor of the flexibility between its nodes.

use super::contact::ContactProblem;
use crate::error::{Error, Result};
use nalgebra::Vector3;

/// Rows that the factor takes up or loses, beyond a sixteenth of it, before it is rather made anew.
const UPDATES: usize = 4;

impl ContactProblem<'_> {
    /// Makes the factor that of the contact set: anew if `anew` or much has changed, else by adding and taking rows. Rows that
    /// stay keep the normals they were made with, which is what the method's chord is.
    pub(super) fn fit(&mut self, anew: bool) -> Result<()> {
        self.wrong.fill(false);
        for &i in &self.loads.active {
            self.wrong[i] = true;
        }
        let gone = self.factored.iter().filter(|&&i| !self.wrong[i]).count();
        let new = self.loads.active.len() + gone - self.factored.len();
        if anew || gone + new > UPDATES + self.factored.len() / 16 {
            return self.factorise();
        }
        for k in (0..self.factored.len()).rev() {
            if !self.wrong[self.factored[k]] {
                self.factored.remove(k);
                if !self.factor.remove(k) {
                    return self.factorise();
                }
            }
        }
        self.factored.iter().for_each(|&i| self.wrong[i] = false);
        let end = self.watch.up_to(&self.loads.active);
        for a in 0..self.loads.active.len() {
            let i = self.loads.active[a];
            if self.wrong[i] {
                self.factored.push(i);
                self.factor_normal[i] = self.loads.normal[i];
                self.watch.under(self.nodes, i, self.factor_normal[i], end);
                let (factored, normal, watch) = (&self.factored, &self.factor_normal, &self.watch);
                if !self.factor.append(|b| watch.compliance(factored[b], normal[factored[b]])) {
                    return self.factorise();
                }
            }
        }
        Ok(())
    }

    fn factorise(&mut self) -> Result<()> {
        self.factored.clone_from(&self.loads.active);
        self.work.factorisations += 1;
        for &i in &self.factored {
            self.factor_normal[i] = self.loads.normal[i];
        }
        let end = self.watch.up_to(&self.factored);
        let (active, normal, watch) = (&self.factored, &self.factor_normal, &mut self.watch);
        let entry = |a: usize, b: usize| {
            // the first entry of a column
            if a == b {
                watch.under(self.nodes, active[b], normal[active[b]], end);
            }
            watch.compliance(active[a], normal[active[a]])
        };
        if self.factor.factorise(active.len(), entry) {
            return Ok(());
        }
        self.factored.clear();
        Err(Error::Solver(
            "the residual flexibility of the seal seat's contact nodes is not positive definite: the mesh has too few nodes for this number of modes".into(),
        ))
    }

    /// Marks the nodes that pull; their number.
    pub(super) fn mark_tensile(&mut self) -> usize {
        self.wrong.fill(false);
        let mut count = 0;
        for &i in &self.loads.active {
            self.wrong[i] = self.loads.force[i] < 0.0;
            count += usize::from(self.wrong[i]);
        }
        count
    }

    /// Moves the marked nodes, or only the last one, into the contact set or out of it.
    pub(super) fn exchange(&mut self, single: bool) {
        if single && let Some(last) = self.wrong.iter().rposition(|wrong| *wrong) {
            self.wrong[..last].fill(false);
        }
        for &i in self.loads.active.iter().filter(|&&i| self.wrong[i]) {
            self.loads.force[i] = 0.0;
            if let Some(friction) = &mut self.loads.friction {
                friction.force[i] = Vector3::zeros();
            }
        }
        self.previous.clone_from(&self.loads.active);
        self.loads.active.clear();
        let mut next = 0;
        for (i, &wrong) in self.wrong.iter().enumerate() {
            let was = self.previous.get(next) == Some(&i);
            next += usize::from(was);
            if was != wrong {
                self.loads.active.push(i);
            }
        }
    }
}
