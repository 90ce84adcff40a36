//! What a block may touch while it is executed.

use bahn_parameters::{MessageId, technology};
use bahn_path::Function;

use crate::availability::Feature;
use crate::error::{Fault, WarningKind};
use crate::flow;
use crate::modal::Modal;
use crate::numbers::Numbers;
use crate::pen::Pen;
use crate::reported::Reported;
use crate::settings::Settings;

/// The parts of a run that a block works on. It leads nowhere by itself: where the run goes on is left to whoever
/// executes it.
pub(crate) struct Context<'a> {
    pub modal: &'a mut Modal,
    pub numbers: &'a mut Numbers,
    pub pen: &'a mut Pen,
    pub reported: &'a mut Reported,
    pub at: &'a flow::Position,
    pub settings: &'a Settings,
}

impl Context<'_> {
    /// See [`Reported::executes`].
    pub fn executes(&mut self, feature: Feature) -> Result<bool, Fault> {
        self.reported.executes(self.pen.block, feature, self.settings)
    }

    /// Warns of the block.
    pub fn warn(&mut self, kind: WarningKind) {
        self.reported.warn(self.pen.block, kind);
    }

    /// Says that what the block programs does nothing, or not all of it; with strict checking it is refused.
    pub fn without_effect(&mut self, text: String) -> Result<(), Fault> {
        if self.settings.strict {
            return Err(Fault::new(MessageId::BlockNotKnown, text));
        }
        self.warn(WarningKind::Function { text });
        Ok(())
    }

    /// See [`Pen::output_function`].
    pub fn output_function(&mut self, function: Function, block: technology::Block) -> Result<(), Fault> {
        self.pen
            .output_function(self.modal, function, block, self.settings)
    }
}
