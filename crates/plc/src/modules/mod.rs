//! Internal modules 9000 to 9255: called with CM, arguments and results on the data stack
//! [000:14733-16160].

mod memory;

use bahn_exchange::{Image, signal};

use crate::run::DataStack;
use crate::{Nc, PlcError};

/// A module of the control.
#[derive(Clone, Copy)]
pub struct Module {
    /// The number behind CM.
    pub number: u16,
    /// What it does.
    pub name: &'static str,
    run: Run,
}

/// The work of a module: pulls its arguments, does its work, pushes its results.
type Run = fn(&mut Call<'_>) -> Result<Outcome, PlcError>;

/// How a call ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    /// M3171 becomes 0.
    Done,
    /// M3171 becomes 1.
    Failed,
}

/// All modules by number.
pub fn modules() -> &'static [Module] {
    MODULES
}

const MODULES: &[Module] = &[
    Module {
        number: 9000,
        name: "copy in marker range",
        run: memory::copy_markers,
    },
    Module {
        number: 9001,
        name: "copy in word range",
        run: memory::copy_bytes,
    },
    Module {
        number: 9010,
        name: "read byte",
        run: memory::read_byte,
    },
    Module {
        number: 9011,
        name: "read word",
        run: memory::read_word,
    },
    Module {
        number: 9012,
        name: "read doubleword",
        run: memory::read_double,
    },
    Module {
        number: 9020,
        name: "write byte",
        run: memory::write_byte,
    },
    Module {
        number: 9021,
        name: "write word",
        run: memory::write_word,
    },
    Module {
        number: 9022,
        name: "write doubleword",
        run: memory::write_double,
    },
];

impl Module {
    /// The module of a number.
    pub fn find(number: u16) -> Option<&'static Module> {
        MODULES.iter().find(|module| module.number == number)
    }
}

impl std::fmt::Debug for Module {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.number, self.name)
    }
}

/// A call of a module: what it may reach.
pub(crate) struct Call<'a> {
    pub(crate) image: &'a mut Image,
    pub(crate) stack: &'a mut DataStack,
    #[expect(dead_code, reason = "the modules of this table need memory only")]
    pub(crate) nc: &'a mut dyn Nc,
    /// Whether a submit job calls; many modules may be called from there only.
    #[expect(dead_code, reason = "the modules of this table may be called from anywhere")]
    pub(crate) from_submit: bool,
}

impl Call<'_> {
    /// Runs a module and sets the error status M3171 [000:14739].
    pub(crate) fn run(&mut self, number: u16) -> Result<(), PlcError> {
        let module = Module::find(number).ok_or(PlcError::ModuleNotDefined)?;
        let outcome = (module.run)(self)?;
        self.image
            .set_bit(signal::MODULE_ERROR, outcome == Outcome::Failed);
        Ok(())
    }

    /// Pulls the arguments; they are given in the order of the manual, in which the program pushed them.
    fn arguments<const N: usize>(&mut self) -> Result<[i32; N], PlcError> {
        let mut arguments = [0; N];
        for argument in arguments.iter_mut().rev() {
            *argument = self.stack.pull()?;
        }
        Ok(arguments)
    }

    /// Pushes a result. With several, the one that the program pulls first is pushed last.
    fn result(&mut self, value: i32) -> Result<(), PlcError> {
        self.stack.push(value)
    }
}
