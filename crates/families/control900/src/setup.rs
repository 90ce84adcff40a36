//! What a control is told beside its parameters.

use crate::language::{Language, language};
use crate::plc_run::Plc900;

/// What answers in the place of a PLC, one PLC cycle after its cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StandardAnswers {
    /// P8700 and P8701 are 1; P8709 is when all axes of the channel are referenced.
    pub enable: bool,
    /// The mode that is asked for is given: P8683 to P8703.
    pub mode: bool,
    /// A start or stop that is asked for is given: P8684 to P8704.
    pub start: bool,
    /// M functions with stop are acknowledged: P8706. Not branches.
    pub m: bool,
    /// After M6 the tool is changed: P8047 and P8045.
    pub tools: bool,
}

impl Default for StandardAnswers {
    fn default() -> StandardAnswers {
        StandardAnswers::ALL
    }
}

impl StandardAnswers {
    /// All of them.
    pub const ALL: StandardAnswers = StandardAnswers {
        enable: true,
        mode: true,
        start: true,
        m: true,
        tools: true,
    };
    /// None: somebody else is the PLC.
    pub const NONE: StandardAnswers = StandardAnswers {
        enable: false,
        mode: false,
        start: false,
        m: false,
        tools: false,
    };
}

/// What a control is told beside its parameters.
#[derive(Clone, Debug)]
pub struct Setup {
    /// What answers in the place of a PLC.
    pub answers: StandardAnswers,
    /// The cycle of the PLC, µs.
    pub plc_us: u32,
    /// Its PLC program; `None` where nothing but the answers stands there.
    pub plc: Option<Plc900>,
    /// The language of its programs; without one they see no parameters.
    pub language: Option<Language>,
}

impl Default for Setup {
    /// All standard answers, in a cycle of 10 ms (inferred), and the language of the control.
    fn default() -> Setup {
        Setup {
            answers: StandardAnswers::ALL,
            plc_us: 10_000,
            plc: None,
            language: Some(language()),
        }
    }
}
