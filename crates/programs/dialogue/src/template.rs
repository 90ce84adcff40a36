//! The blocks of a cycle with what is asked for in them, for editors that are no dialogue.

use bahn_program::{CycleFunction, cycle};

use crate::Prompt;
use crate::cycles::lines_of;
use crate::field::Need;
use crate::prompt::prompt;

/// A part of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TemplatePart {
    /// Text that stands there as it is.
    Text(String),
    /// A value that is asked for.
    Ask {
        /// What the dialogue says.
        prompt: Option<&'static Prompt>,
        /// Whether the block may stand without it, with the text before it.
        optional: bool,
    },
}

/// The blocks n.0, n.1, ... of a cycle or probe function; none that the table of cycles does not know.
///
/// ```
/// use bahn_dialogue::{TemplatePart, Tongue, cycle_template};
/// use bahn_program::CycleFunction;
///
/// let pecking = cycle_template(CycleFunction::Definition, 1);
/// assert_eq!(pecking[0], [TemplatePart::Text("CYCL DEF 1.0 PECKING".into())]);
/// let TemplatePart::Ask { prompt: Some(prompt), .. } = pecking[1][1] else { panic!() };
/// assert_eq!(prompt.text(Tongue::English), "SETUP CLEARANCE?");
/// ```
pub fn cycle_template(function: CycleFunction, number: u16) -> Vec<Vec<TemplatePart>> {
    if cycle(function, number).is_none() {
        return Vec::new();
    }
    let lines = lines_of(function, number, None);
    let parts = lines.iter().map(|line| {
        let mut before = line.head().to_owned();
        let mut parts = Vec::new();
        for field in line.fields() {
            before += &field.glue;
            before += field.slot.address;
            parts.push(TemplatePart::Text(std::mem::take(&mut before)));
            parts.push(TemplatePart::Ask {
                prompt: prompt(field.slot.prompt),
                optional: field.slot.need != Need::Required,
            });
        }
        if !before.is_empty() {
            parts.push(TemplatePart::Text(before));
        }
        parts
    });
    parts.collect()
}
