//! A PLC source, read for all questions about it.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use bahn_parameters::ControlModel;
use bahn_plc::{LineOperand, LineWords, line_words};

use crate::language::{Mention, Role, Thing};
use crate::text::Text;
use crate::world::World;

/// A source file as the editor has it.
pub(crate) struct PlcSource {
    pub(super) path: PathBuf,
    pub(super) text: Arc<Text>,
    pub(super) model: ControlModel,
    pub(super) lines: Vec<Line>,
    pub(super) mentions: OnceLock<Vec<Mention>>,
}

/// A line of the source.
pub(super) struct Line {
    /// Its bytes without the line end.
    pub(super) bytes: Range<usize>,
    /// The instruction that can be read in it, with places in bytes of the text.
    pub(super) words: Option<LineWords>,
}

impl PlcSource {
    pub(crate) fn new(path: &Path, text: Arc<Text>, world: &World) -> PlcSource {
        let model = world.model_of(path);
        let mut start = 0;
        let mut lines = Vec::new();
        for whole in text.text.split_inclusive('\n') {
            let line = whole.trim_end_matches(['\r', '\n']);
            let words = line_words(line, model).map(|words| LineWords {
                instruction_at: bytes_of(line, start, words.instruction_at),
                operand_at: bytes_of(line, start, words.operand_at),
                ..words
            });
            lines.push(Line {
                bytes: start..start + line.len(),
                words,
            });
            start += whole.len();
        }
        PlcSource {
            path: path.to_owned(),
            text,
            model,
            lines,
            mentions: OnceLock::new(),
        }
    }

    /// The line around a byte.
    pub(super) fn line_at(&self, at: usize) -> Option<&Line> {
        let index = self.lines.partition_point(|line| line.bytes.end < at);
        self.lines.get(index).filter(|line| line.bytes.start <= at)
    }

    pub(super) fn words(&self) -> impl Iterator<Item = (usize, &Line, &LineWords)> {
        let lines = self.lines.iter().enumerate();
        lines.filter_map(|(number, line)| Some((number, line, line.words.as_ref()?)))
    }
}

/// Characters of a line as bytes of the text.
pub(super) fn bytes_of(line: &str, start: usize, characters: Range<usize>) -> Range<usize> {
    let byte = |count: usize| {
        let found = line.char_indices().nth(count);
        start + found.map_or(line.len(), |(at, _)| at)
    };
    byte(characters.start)..byte(characters.end)
}

/// Instructions that write their operand.
pub(super) const WRITING: [&str; 14] = [
    "=", "=N", "=-", "B=", "W=", "D=", "S", "R", "SN", "RN", "INC", "DEC", "PL", "OVWR",
];

/// Instructions that define the label after them; EXTERN says that another file does.
pub(super) const DEFINING: [&str; 3] = ["LBL", "KFIELD", "EXTERN"];

pub(super) fn mention(words: &LineWords) -> Option<Mention> {
    let writes = WRITING.contains(&words.instruction) || DEFINING.contains(&words.instruction);
    let thing = match &words.operand {
        LineOperand::Bit(bit) => Thing::Operand(bit.bit.to_string()),
        LineOperand::Number(number) => Thing::Operand(number.number.to_string()),
        LineOperand::Label(name) | LineOperand::Field(name) => Thing::PlcLabel(name.clone()),
        LineOperand::File(name) => Thing::File(name.clone()),
        LineOperand::Text(text) => match text {
            bahn_plc::TextOperand::Memory { string, .. } | bahn_plc::TextOperand::Part { string } => {
                Thing::Operand(format!("S{string}"))
            }
            _ => return None,
        },
        LineOperand::None | LineOperand::Constant(_) | LineOperand::Module(_) => return None,
    };
    Some(Mention {
        range: words.operand_at.clone(),
        thing,
        role: if writes { Role::Sets } else { Role::Uses },
    })
}
