//! Names in a text: what they are of, and whether they are set there. Going to a definition, references, highlights and
//! renaming all follow from these.

use std::ops::Range;

/// What a name stands for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Thing {
    /// A label of a part program.
    Label(u16),
    /// A Q parameter by its number.
    Q(u16),
    /// A tool by its number.
    Tool(u32),
    /// A part program, or a source file.
    File(String),
    /// A subroutine of the file.
    Subroutine(String),
    /// A block by its number.
    Block(u32),
    /// A variable or parameter of DIN 66025.
    Variable(String),
    /// A label of a PLC program.
    PlcLabel(String),
    /// An operand of the PLC.
    Operand(String),
    /// A machine parameter by its number, such as `4110.2`.
    MachineParameter(String),
}

/// What is done to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// It is set or written.
    Sets,
    /// It is called or read.
    Uses,
}

/// A name at its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Mention {
    pub(crate) range: Range<usize>,
    pub(crate) thing: Thing,
    pub(crate) role: Role,
}

/// The name at a place; the cursor may stand after it.
pub(crate) fn at(mentions: &[Mention], offset: usize) -> Option<&Mention> {
    let inside = |mention: &&Mention| mention.range.contains(&offset);
    let after = |mention: &&Mention| mention.range.end == offset;
    mentions
        .iter()
        .find(inside)
        .or_else(|| mentions.iter().find(after))
}

/// All places of a thing.
pub(crate) fn of<'a>(mentions: &'a [Mention], thing: &'a Thing) -> impl Iterator<Item = &'a Mention> {
    mentions.iter().filter(move |mention| mention.thing == *thing)
}
