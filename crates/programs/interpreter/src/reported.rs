//! What the user is told in a run. None of it is state to go back to.

use bahn_path::BlockRef;

use crate::availability::{Feature, Said};
use crate::error::{Fault, Warning, WarningKind};
use crate::settings::Settings;

/// Warnings since somebody took them, and what is said once.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reported {
    warnings: Vec<Warning>,
    /// Functions and rounded numbers.
    pub said: Said,
    /// That the place of machine zero is not known.
    pub machine_zero: bool,
}

impl Reported {
    /// Notes a warning; the same one at the same block is counted, so that loops do not pile them up.
    pub fn warn(&mut self, block: BlockRef, kind: WarningKind) {
        const LOOKED_BACK: usize = 64;
        let mut recent = self.warnings.iter_mut().rev().take(LOOKED_BACK);
        match recent.find(|warning| warning.block == block && warning.kind == kind) {
            Some(warning) => warning.count += 1,
            None => self.warnings.push(Warning {
                block,
                kind,
                count: 1,
            }),
        }
    }

    /// Whether a function of a block is to be executed. Where it is met first, the user is told when it is not,
    /// or not wholly.
    ///
    /// # Errors
    /// FUNCTION NOT AVAILABLE ON THIS CONTROL for what must not be passed over.
    pub fn executes(
        &mut self,
        block: BlockRef,
        feature: Feature,
        settings: &Settings,
    ) -> Result<bool, Fault> {
        if let Some(executes) = self.said.executes(feature) {
            return Ok(executes);
        }
        let (executes, remark) = feature.judge(settings)?;
        if let Some(kind) = remark {
            self.warn(block, kind);
        }
        self.said.note(feature, executes);
        Ok(executes)
    }

    /// The warnings since the last time.
    pub fn take_warnings(&mut self) -> Vec<Warning> {
        std::mem::take(&mut self.warnings)
    }

    /// What was told before comes before what is told here.
    pub fn put_before(&mut self, mut before: Vec<Warning>) {
        before.append(&mut self.warnings);
        self.warnings = before;
    }
}
