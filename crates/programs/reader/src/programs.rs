//! Programs by their names, whoever keeps them.
//!
//! Decision: Programs are asked for by name with `Programs`, whatever reads them: the interpreter its called ones, the control
//! those that are selected. `Shelf` finds them in folders; the files of a data interface are others, since they are listed,
//! written and streamed block by block (also `text/src/files.rs`, `link/src/files.rs`)

use std::sync::Arc;

use bahn_program::Program;

use crate::reader::Reader;
use crate::start::Start;

/// Where programs come from. They are asked for by name, as it is written in CALL PGM and chosen by the operator.
pub trait Programs: Send + Sync {
    /// The program that a name means in the program `caller`, empty for the operator; `Ok(None)` when there is none.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn open(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String>;

    /// A cycle of the machine builder in the EPROM of the PLC; there is none by default.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn open_in_eprom(&self, _name: &str, _caller: &str) -> Result<Option<Arc<Program>>, String> {
        Ok(None)
    }

    /// A program in a language that the control does not read itself, ready to run from its first block; `Ok(None)` when
    /// it is none of those: then it is [opened](Programs::open). There are none by default.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn reader(&self, _name: &str, _start: &Start) -> Result<Option<Box<dyn Reader>>, String> {
        Ok(None)
    }

    /// What a program is opened by that is not here, but counts as if it lay here: those that it calls do.
    fn name_here(&self, name: &str) -> String {
        name.to_owned()
    }

    /// Keeps a program that was digitized, whole or not at all; a control itself calls this never, whoever drives it does.
    ///
    /// # Errors
    /// Why it cannot be kept.
    fn store(&self, name: &str, _pieces: &[Arc<[u8]>]) -> Result<(), String> {
        Err(format!("{name}: these programs cannot be added to"))
    }
}

/// No programs.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoPrograms;

impl Programs for NoPrograms {
    fn open(&self, _name: &str, _caller: &str) -> Result<Option<Arc<Program>>, String> {
        Ok(None)
    }
}
