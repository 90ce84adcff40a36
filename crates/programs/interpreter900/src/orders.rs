//! What happens when the path comes to a block and is no function of the machine.

/// What is to be done when the path comes to the element of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// A real-time parameter is written, before the M functions of the block [002:268-273].
    Write {
        /// The system parameter.
        q: u32,
        /// What it gets; `None` clears it.
        value: Option<f64>,
    },
    /// The M function branches: acknowledged, it ends the movement of the block and goes on at a block [002:5484-5491].
    Branch {
        /// Its number.
        m: u16,
        /// The number of the block to go on with.
        target: u32,
    },
}
