//! What is known of a program that grows.

/// What a program that is still coming has besides its known blocks.
#[derive(Clone, Debug, Default)]
pub(crate) struct Growth {
    /// Text from the block on that may go on in what comes.
    pub(super) pending: Vec<u8>,
    /// BEGIN has come, or will not.
    pub(super) began: bool,
}
