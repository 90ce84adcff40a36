//! Whose dialect of DIN 66025 a program is in.

/// Whose dialect of DIN 66025 a program is in: each line with text is a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DinLanguage {
    /// `.nc`, subroutines of any name.
    Tf5200,
    /// `.900`.
    System900,
}
