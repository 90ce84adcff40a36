//! Blocks of a program as lines with fields.

use bahn_program::{Block, CycleFunction, FormatOptions, Language, MotionKind, Operation};

use crate::cycles::{assigned, assigned_line, cycle_line};
use crate::line::{Line, written};

/// Reads a block. One that the table does not know, or that stands in other words, is a line of text; BEGIN and END are
/// the control's.
pub(crate) fn line_of_block(block: &Block, language: &dyn Language) -> Option<Line> {
    let bare = Block {
        skip: false,
        operation: block.operation.clone(),
        comment: None,
    };
    let text = written(&bare, language);
    if let Some(mut line) = template(&block.operation)?
        && line.read(&text)
        && line.canonical(language).as_deref() == Some(text.as_str())
    {
        return Some(line.like(block));
    }
    let mut line = Line::of_row("TEXT").pop()?;
    line.read(&text).then(|| line.like(block))
}

/// The fields that a block has; `Some(None)` where it has none that the table knows, `None` for a block that is not
/// the operator's.
fn template(operation: &Operation) -> Option<Option<Line>> {
    let id = match operation {
        Operation::Begin(_) | Operation::End(_) => return None,
        Operation::Cycle(block) => {
            if let Some(numbers) = assigned(block) {
                return Some(Some(assigned_line(block.number, block.sub, &numbers)));
            }
            return Some(Some(cycle_line(
                CycleFunction::Definition,
                block.number,
                block.sub,
            )));
        }
        Operation::Probe(block) => {
            return Some(Some(cycle_line(CycleFunction::Probe, block.number, block.sub)));
        }
        Operation::BlankMin(..) => "BLK FORM",
        Operation::BlankMax(_) => return Some(Line::of_row("BLK FORM").pop()),
        Operation::Motion(motion) => match motion.kind {
            MotionKind::Paraxial => "AXIS",
            kind => kind.word(),
        },
        Operation::CircleCentre(_) => "CC",
        Operation::Rounding { .. } => "RND",
        Operation::Chamfer { .. } => "CHF",
        Operation::ToolDefinition { .. } => "TOOL DEF",
        Operation::ToolCall { .. } => "TOOL CALL",
        Operation::Label(_) => "LBL",
        Operation::CallLabel { .. } => "CALL LBL",
        Operation::CallProgram(_) => "CALL PGM",
        Operation::Stop(_) => "STOP",
        Operation::CycleCall(_) => "CYCL CALL",
        Operation::Miscellaneous(_) => "M",
        Operation::Formula { .. } => "FORMULA",
        Operation::ErrorNumber(_) => "FN 14",
        Operation::Print(_) => "FN 15",
        Operation::Plc { .. } => "FN 19",
        Operation::Calculate { .. } | Operation::Jump { .. } => return Some(function_line(operation)),
        Operation::Dialog(_) => "DLG",
        // Blocks of languages with G functions are text here.
        Operation::Comment(_) | Operation::Invalid(_) | Operation::Modal(_) => "TEXT",
    };
    Some(Line::of_row(id).into_iter().next())
}

/// FN 0 to 13 by the number that the listing shows.
fn function_line(operation: &Operation) -> Option<Line> {
    let block = Block {
        skip: false,
        operation: operation.clone(),
        comment: None,
    };
    let text = bahn_program::format_block(&block, FormatOptions::default());
    let number = text.strip_prefix("FN")?.split(':').next()?;
    Line::of_row(&format!("FN {number}")).pop()
}
