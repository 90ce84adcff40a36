//! Why an operation has no block in a language, for people.

use bahn_program::{CycleFunction, Feed, MotionKind, Operation, cycle};

use crate::Language;

/// Why these operations cannot be written in `language`.
pub(crate) fn reason(operations: &[Operation], language: Language) -> String {
    let Some(first) = operations.first() else {
        return String::new();
    };
    match (first, language) {
        (Operation::Invalid(invalid), _) => match &*invalid.error.detail {
            "" => "the block cannot be read".to_owned(),
            detail => format!("the block cannot be read: {detail}"),
        },
        (_, Language::Plain) => "plain language has no block that says the same".to_owned(),
        (Operation::Motion(motion), _) => match motion.kind {
            MotionKind::LineNormal => "DIN/ISO has no line with the normal of a surface".to_owned(),
            kind if motion.feed == Some(Feed::Max) && !straight(kind) => {
                "in DIN/ISO only lines move in rapid traverse".to_owned()
            }
            _ => "DIN/ISO has no block with these words".to_owned(),
        },
        (Operation::CircleCentre(_), _) => "in DIN/ISO a centre lies in X, Y and Z: I, J, K".to_owned(),
        (Operation::ToolCall { .. }, _) => {
            "in DIN/ISO the tool axis is that of G17 to G19 and chosen with a tool".to_owned()
        }
        (Operation::CallLabel { .. }, _) => "in DIN/ISO no repeat is a call of a subprogram".to_owned(),
        (Operation::Cycle(block), _) => {
            let name = cycle(CycleFunction::Definition, block.number).map_or("", |cycle| cycle.name);
            format!(
                "no G function defines cycle {} {name} with these words",
                block.number
            )
        }
        (Operation::Probe(block), _) => format!("DIN/ISO has no TCH PROBE {}", block.number),
        (Operation::Dialog(_), _) => "DIN/ISO has no dialogue blocks".to_owned(),
        _ => "DIN/ISO has no block that says the same".to_owned(),
    }
}

fn straight(kind: MotionKind) -> bool {
    matches!(
        kind,
        MotionKind::Line | MotionKind::LinePolar | MotionKind::LineNormal
    )
}
