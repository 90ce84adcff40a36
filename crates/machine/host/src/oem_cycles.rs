//! The cycles of the machine builder that a machine has, with their dialogue texts [000:17691-17984].
//!
//! Decision: The name of a customized macro of a TNC 151/155 may have 16 characters, as the manual's example has, not 14;
//! nothing of its Q parameters is local, and DLG-DEF, which the manual prints, runs at its definition (also
//! `parameters/src/limits/models.rs`, `parameters/src/settings/operation.rs`)

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use bahn_parameters::{OemTexts, ParameterList};
use bahn_program::{Dialog, Operation, Program};

use crate::HostError;
use crate::files::{self, Loaded};

/// The numbers of the cycles: of their programs less 99999900 [000:17728-17730].
pub const NUMBERS: RangeInclusive<u32> = 68..=99;
/// M2240 inhibits cycle 68 of the EPROM [000:10674-10705].
const FIRST_INHIBIT: u32 = 2240;

/// A cycle of the machine builder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OemCycle {
    /// Its number, 68 to 99.
    pub number: u32,
    /// File of its program.
    pub path: PathBuf,
    /// It is in the EPROM, not in the program memory.
    pub in_eprom: bool,
    /// A program of the same number goes before it [000:17757-17761].
    pub is_hidden: bool,
    /// Its dialogue block: DLG-CALL or DLG-DEF, and the dialogues of its name and its parameters; `None` when it has none.
    pub dialog: Option<OemDialog>,
    /// Line of the first CALL LBL REP, which must not stand in the EPROM [000:17705-17724].
    pub repeats_at: Option<u32>,
    /// What the model asks of the texts.
    limits: OemTexts,
}

/// What a dialogue block says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OemDialog {
    /// It runs at the cycle call, not at its definition.
    pub at_call: bool,
    /// Number and text of the dialogue of its name.
    pub name: Text,
    /// Its parameters: Q parameter, number and text of its dialogue.
    pub parameters: Vec<(u32, Text)>,
}

/// A dialogue text by its number in the file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Text {
    /// Number of the dialogue: the line of the file, from 0.
    pub number: u32,
    /// The text; empty where the file has none.
    pub text: String,
}

impl OemCycle {
    /// The marker with which the PLC inhibits it in the EPROM.
    pub fn inhibit(&self) -> u32 {
        FIRST_INHIBIT + self.number - NUMBERS.start()
    }

    /// What is wrong with it where it is, or in the EPROM.
    pub fn faults(&self, in_eprom: bool) -> Vec<String> {
        let Some(dialog) = &self.dialog else {
            return vec!["no dialogue block DLG-DEF or DLG-CALL".into()];
        };
        let repeats = self.repeats_at.filter(|_| in_eprom || self.in_eprom);
        let repeats = repeats.map(|line| format!("line {line}: CALL LBL REP must not stand in the EPROM"));
        let OemTexts {
            number_max,
            name_max,
            parameter_max,
            ..
        } = self.limits;
        let parameters = dialog.parameters.iter().map(|(_, text)| (text, parameter_max));
        let texts = std::iter::once((&dialog.name, name_max)).chain(parameters);
        let wrong = texts.filter_map(|(Text { number, text }, most)| match text.chars().count() {
            _ if *number > u32::from(number_max) => Some(format!(
                "dialogue {number}: the texts have the numbers 0 to {number_max}"
            )),
            0 => Some(format!("dialogue {number} has no text")),
            length if length > usize::from(most) => {
                Some(format!("dialogue {number} has {length} characters, {most} fit"))
            }
            _ => None,
        });
        wrong.chain(repeats).collect()
    }
}

/// The cycles of a folder of part programs and of the folder `eprom` in it, by number; those of the program memory first.
///
/// # Errors
/// When the folders or programs cannot be read.
pub fn find(programs: &Path, dialogues: &[String], list: &ParameterList) -> Result<Vec<OemCycle>, HostError> {
    let rules = list.operation_parameters().oem_cycles;
    let mut found: BTreeMap<(u32, bool), OemCycle> = BTreeMap::new();
    for (in_eprom, folder) in [(false, programs.to_owned()), (true, programs.join("eprom"))] {
        for number in NUMBERS {
            let path = folder.join(format!("{}.H", 99_999_900 + number));
            if !path.is_file() {
                continue;
            }
            let (dialog, repeats_at) = match files::load_program(&path)? {
                Loaded::Program(program) => (dialog_block(&program), repeat(&program)),
                Loaded::Empty(_) | Loaded::TooLarge => (None, None),
            };
            let text_of = |number: u16| text(number, dialogues, list);
            let cycle = OemCycle {
                number,
                path,
                in_eprom,
                is_hidden: false,
                dialog: dialog.map(|dialog| read(&dialog, text_of, rules.definition_offset)),
                repeats_at,
                limits: list.model().limits().oem_texts,
            };
            found.insert((number, in_eprom), cycle);
        }
    }
    for number in NUMBERS {
        let both = [false, true].map(|in_eprom| found.contains_key(&(number, in_eprom)));
        if both == [true, true]
            && let Some(hidden) = found.get_mut(&(number, rules.names_free))
        {
            hidden.is_hidden = true;
        }
    }
    Ok(found.into_values().collect())
}

fn dialog_block(program: &Program) -> Option<Dialog> {
    let mut blocks = program.blocks().take(16);
    blocks.find_map(|block| match &block.block.operation {
        Operation::Dialog(dialog) => Some((**dialog).clone()),
        _ => None,
    })
}

fn repeat(program: &Program) -> Option<u32> {
    let is_repeat =
        |operation: &Operation| matches!(operation, Operation::CallLabel { repeats: Some(_), .. });
    let mut blocks = program.blocks();
    blocks
        .find(|block| is_repeat(&block.block.operation))
        .map(|block| block.line)
}

/// The text in force for a dialogue of a program: in English MP259 higher [001:2801-2823]; where the machine builder has
/// none that of the control [001:2911-2922].
fn text(number: u16, dialogues: &[String], list: &ParameterList) -> Text {
    let shown = number + u16::from(list.operation_parameters().oem_cycles.text_offset);
    let own = dialogues.get(usize::from(shown)).filter(|own| !own.is_empty());
    let standard = || list.model().limits().oem_texts.standard(number);
    Text {
        number: u32::from(shown),
        text: own.cloned().unwrap_or_else(standard),
    }
}

fn read(dialog: &Dialog, text: impl Fn(u16) -> Text, definition_offset: u8) -> OemDialog {
    let text = |number: &u16| text(*number);
    let offset = if dialog.call {
        0
    } else {
        u32::from(definition_offset)
    };
    let mut texts = dialog.texts.iter();
    OemDialog {
        at_call: dialog.call,
        name: texts.next().map(text).unwrap_or_default(),
        parameters: (offset + 1..).zip(texts.map(text)).collect(),
    }
}
