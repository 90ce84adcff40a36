//! The views of a part.

/// How a part is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PartView {
    Plan,
    ThreePlanes,
    Solid,
}
