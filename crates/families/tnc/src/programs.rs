//! Which program a channel has selected.

use std::sync::Arc;

use bahn_parameters::MessageId;
use bahn_program::Program;
use bahn_reader::{Programs, Reader, Start};

use crate::message::Message;

/// A program that is to run.
pub(crate) enum Opened {
    /// One of a TNC.
    Program(Arc<Program>),
    /// One in another language.
    Reader(Box<dyn Reader>),
}

impl Opened {
    /// The program of a name, in whatever language.
    ///
    /// # Errors
    /// PROGRAM NOT FOUND, when there is none that can be read.
    pub fn of(name: &str, programs: &dyn Programs, start: impl FnOnce() -> Start) -> Result<Opened, Message> {
        let reader = programs.reader(name, &start());
        let opened = reader.and_then(|reader| match reader {
            Some(reader) => Ok(Some(Opened::Reader(reader))),
            None => Ok(programs.open(name, "")?.map(Opened::Program)),
        });
        let found = opened.ok().flatten();
        found.ok_or(Message::Plain(MessageId::ProgramNotFound))
    }
}

/// What runs in the automatic modes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Selection {
    /// Name of the program that runs in single block and full sequence.
    pub program: Option<String>,
    /// Block at which the next run starts.
    pub start_block: u32,
    /// Blocks that MDI executes; `None` before any were entered.
    pub mdi: Option<String>,
}

impl Selection {
    /// The program of MDI, or of the other automatic modes.
    pub fn open(
        &self,
        mdi: bool,
        programs: &dyn Programs,
        start: impl FnOnce() -> Start,
    ) -> Result<Opened, Message> {
        if mdi {
            let blocks = self
                .mdi
                .as_ref()
                .ok_or(Message::Plain(MessageId::KeyNonFunctional))?;
            let text = format!("BEGIN PGM MDI MM\n{blocks}\nEND PGM MDI MM\n");
            let program = Program::from_bytes("$MDI", text.into_bytes());
            return Ok(Opened::Program(Arc::new(program)));
        }
        let name = self.program.as_ref();
        let name = name.ok_or(Message::Plain(MessageId::ProgramNotFound))?;
        Opened::of(name, programs, start)
    }
}
