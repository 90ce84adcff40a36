//! Input limits, which depend on the control model.

/// Greatest values that a control accepts in a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Greatest Q parameter number.
    pub q_parameter: u16,
    /// Greatest label number.
    pub label: u16,
}

impl Limits {
    /// What no control exceeds; beyond it a block is wrong whatever the model.
    pub const ANY_MODEL: Limits = Limits {
        q_parameter: 1999,
        label: 65_534,
    };
}
