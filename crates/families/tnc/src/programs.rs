//! Where programs come from, and which of them a channel has selected.

use std::sync::Arc;

use bahn_interpreter::Library;
use bahn_parameters::MessageId;
use bahn_program::Program;
use bahn_reader::{Reader, Start};

use crate::message::Message;

/// Where programs come from. The control asks by name, as written in CALL PGM and chosen by the operator.
pub trait Programs: Send + Sync {
    /// The program of a name; `Ok(None)` when there is none.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn open(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String>;

    /// A program in a language that the control does not read itself, ready to run from its first block; `Ok(None)` when
    /// it is none of those: then it is [opened](Programs::open). There are none by default.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn reader(&self, _name: &str, _start: &Start) -> Result<Option<Box<dyn Reader>>, String> {
        Ok(None)
    }

    /// A cycle of the machine builder in the EPROM of the PLC; there is none by default.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn open_in_eprom(&self, _name: &str, _caller: &str) -> Result<Option<Arc<Program>>, String> {
        Ok(None)
    }

    /// What a program is opened by that is not here, but counts as if it lay here: those that it calls do.
    fn name_here(&self, name: &str) -> String {
        name.to_owned()
    }

    /// Keeps a program that was digitized, whole or not at all; the control itself calls this never, whoever drives it
    /// does.
    ///
    /// # Errors
    /// Why it cannot be kept.
    fn store(&self, name: &str, _pieces: &[Arc<[u8]>]) -> Result<(), String> {
        Err(format!("{name}: these programs cannot be added to"))
    }
}

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

/// Programs as the interpreter asks for those that are called.
pub struct CalledPrograms(pub Arc<dyn Programs>);

impl Library for CalledPrograms {
    fn find(&mut self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        self.0.open(name, caller)
    }

    fn find_in_eprom(&mut self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        self.0.open_in_eprom(name, caller)
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
