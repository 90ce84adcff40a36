//! From the programmed contour to the path: corners of G12, then radius correction, then feeds by what comes next. Each stage
//! holds back what waits for the next element.

use std::collections::VecDeque;

use bahn_path::Barrier;
use bahn_path::parallel::Side;
use bahn_system900::PathData;

use crate::ahead::{Ahead, AheadRules};
use crate::corner::{Corners, Insert};
use crate::correction::{Correction, Move};
use crate::correction_rules::CorrectionRules;
use crate::item::Item;
use crate::refusal::Refusal;

/// What parameters say of the stages.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ContourRules {
    pub correction: CorrectionRules,
    pub ahead: AheadRules,
}

impl ContourRules {
    pub fn of(data: &PathData, kv: f64) -> ContourRules {
        ContourRules {
            correction: CorrectionRules::of(data),
            ahead: AheadRules::of(data, kv),
        }
    }
}

/// The stages in a row.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contour {
    corners: Corners,
    correction: Correction,
    ahead: Ahead,
    /// On its way to the last stage; empty between two blocks.
    passed: VecDeque<Item>,
}

impl Contour {
    /// Whether a movement without correction passes as it is.
    pub fn is_idle(&self, rules: &ContourRules) -> bool {
        !self.corners.holds() && self.correction.is_idle() && !self.ahead.holds() && !rules.ahead.act()
    }

    /// Whether something waits for what comes after it.
    pub fn holds(&self) -> bool {
        self.corners.holds() || self.correction.holds() || self.ahead.holds()
    }

    /// Takes a movement or a hold, with what G12 puts into the corner after it.
    pub fn push(
        &mut self,
        item: Move,
        insert: Option<Insert>,
        rules: &ContourRules,
        out: &mut VecDeque<Item>,
    ) -> Result<(), Refusal> {
        if insert.is_none() && item.side == Side::Off && self.correction.is_idle() && !self.corners.holds() {
            self.ahead.push(Item::Element(item.element), &rules.ahead, out);
            return Ok(());
        }
        let correction = &mut self.correction;
        self.corners.push(item, insert, &mut |item| {
            correction.push(item, &rules.correction, &mut self.passed)
        })?;
        self.pass_on(rules, out);
        Ok(())
    }

    /// Takes what the run waits for. Nothing after a stop of the look-ahead is read before it: what is held ends there.
    pub fn barrier(
        &mut self,
        barrier: Barrier,
        rules: &ContourRules,
        out: &mut VecDeque<Item>,
    ) -> Result<(), Refusal> {
        match barrier {
            Barrier::Stop { .. } if self.correction.holds() && !self.corners.holds() => {
                let item = Item::Barrier(barrier);
                self.correction
                    .beside(item, &rules.correction, &mut self.passed)?;
                self.pass_on(rules, out);
            }
            _ => {
                self.flush(rules, out)?;
                out.push_back(Item::Barrier(barrier));
            }
        }
        Ok(())
    }

    /// Ends what is held as if nothing followed.
    pub fn flush(&mut self, rules: &ContourRules, out: &mut VecDeque<Item>) -> Result<(), Refusal> {
        self.corners.end()?;
        self.correction.flush(&rules.correction, &mut self.passed)?;
        self.pass_on(rules, out);
        self.ahead.flush(out);
        Ok(())
    }

    fn pass_on(&mut self, rules: &ContourRules, out: &mut VecDeque<Item>) {
        for item in self.passed.drain(..) {
            self.ahead.push(item, &rules.ahead, out);
        }
    }
}
