//! What must not stand in a main program that is transferred while it runs [003:1640-1690].

use bahn_parameters::MessageId;
use bahn_program::{CycleBlock, Operation};

use crate::Settings;
use crate::error::Fault;
use crate::run::Run;

/// Refuses what must not stand in a main program that is transferred while it runs.
pub(crate) fn permit(run: &Run, operation: &Operation, settings: &Settings) -> Result<(), Fault> {
    if !settings.transferred || run.at.program != 0 {
        return Ok(());
    }
    let limits = settings.model.limits().blockwise;
    let digitizes = |block: &CycleBlock| (5..=7).contains(&block.number);
    let what = match operation {
        Operation::CallLabel { repeats: Some(_), .. } => "CALL LBL REP".to_owned(),
        Operation::CallLabel { .. } => "CALL LBL".to_owned(),
        // Their contours are subprograms.
        Operation::Cycle(block) if block.number == 14 => "CYCL DEF 14".to_owned(),
        Operation::Probe(block) if digitizes(block) && !limits.digitizes_and_prints => {
            format!("TCH PROBE {}", block.number)
        }
        Operation::Print(_) if !limits.digitizes_and_prints => "FN15".to_owned(),
        Operation::ToolDefinition { .. } => {
            return match limits.tool_definitions_max {
                Some(max) if run.tools.definitions() > usize::from(max) => {
                    let detail = format!("the control holds {max} TOOL DEF blocks");
                    Err(Fault::new(MessageId::NotInBlockwiseTransfer, detail))
                }
                _ => Ok(()),
            };
        }
        _ => return Ok(()),
    };
    let detail = format!("{what} must not stand in a program that is transferred while it runs");
    Err(Fault::new(MessageId::NotInBlockwiseTransfer, detail))
}
