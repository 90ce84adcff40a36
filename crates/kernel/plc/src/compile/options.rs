//! What a compilation is asked for.

use bahn_parameters::ControlModel;
use bahn_parameters::equipment::Equipment;

use crate::source::ProgramMemory;

/// How a program is compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Options {
    /// The control: it limits the length of the code.
    pub model: ControlModel,
    /// Options and software of the control: a marker or module that it lacks is out of range.
    pub equipment: Equipment,
    /// Whether lines that only the manual's own listings spell like that are errors.
    pub strict: bool,
    /// Where the files come from (MP4010).
    pub memory: ProgramMemory,
}

impl Default for Options {
    /// A TNC 415B, tolerant, from the RAM.
    fn default() -> Options {
        Options {
            model: ControlModel::Tnc415b,
            equipment: Equipment::default(),
            strict: false,
            memory: ProgramMemory::Ram,
        }
    }
}

impl Options {
    /// For a control model, tolerant, from the RAM.
    pub fn for_model(model: ControlModel) -> Options {
        Options {
            model,
            ..Options::default()
        }
    }

    /// For a control with other options or software.
    pub fn with_equipment(self, equipment: Equipment) -> Options {
        Options { equipment, ..self }
    }

    /// Refuses what only the manual's own listings spell like that.
    pub fn strict(self) -> Options {
        Options { strict: true, ..self }
    }

    /// With files of a memory.
    pub fn stored_in(self, memory: ProgramMemory) -> Options {
        Options { memory, ..self }
    }

    /// Bytes of code of all files together.
    pub(super) fn code_bytes_max(self) -> u32 {
        self.model.limits().plc_code_max_bytes
    }
}
