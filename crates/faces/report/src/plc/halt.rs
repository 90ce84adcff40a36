//! Why a PLC program does not go on.

use bahn_plc::RuntimeError;

/// Why there is no further scan.
#[derive(Debug)]
pub enum Halt {
    /// An error has stopped the PLC.
    Plc(RuntimeError),
    /// By `end` of the script.
    Ended,
    /// The machine cannot go on; why.
    Fault(String),
}

impl From<RuntimeError> for Halt {
    fn from(error: RuntimeError) -> Halt {
        Halt::Plc(error)
    }
}

impl std::fmt::Display for Halt {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Halt::Plc(error) => error.fmt(f),
            Halt::Ended => f.write_str("the script has ended the run"),
            Halt::Fault(what) => f.write_str(what),
        }
    }
}
