//! What a part-program language has to say: one trait, and the table of file types.

use std::fmt;
use std::ops::Range;

use bahn_parameters::Limits;

use crate::dialect::DinLanguage;
use crate::format::FormatOptions;
use crate::lines::{BlockText, Lines, RawBlock};
use crate::{Block, BlockError, Header, Operation};

/// A way of writing part programs. All of them lower to the same [`Operation`]s.
///
/// A language says how its text falls into blocks, what a block does, what is wrong with it, where its words
/// stand, and how a block is written. The rest of this room, and all above it, is the same for every language.
///
/// ```
/// use bahn_program::{Language, Operation, PlainLanguage, WordKind};
///
/// let read = PlainLanguage.parse_block("12 L X+10 FOO Y+1..5 R0 ; up");
/// assert!(matches!(read.block.operation, Operation::Invalid(_)));
/// let places: Vec<_> = read.faults.iter().map(|fault| (fault.column, fault.length)).collect();
/// assert_eq!(places, [(11, 3), (16, 5)]); // FOO and +1..5
///
/// let text = "12 L X+10 R0";
/// let words = PlainLanguage.parse_block(text).words;
/// let kinds: Vec<_> = words.iter().map(|word| (&text[word.span.clone()], word.kind)).collect();
/// assert_eq!(kinds[1..3], [("L", WordKind::Function), ("X+10", WordKind::Address)]);
/// assert_eq!(&text[words[2].value.clone()], "+10");
/// ```
pub trait Language: fmt::Debug + Send + Sync {
    /// Its name, for people.
    fn name(&self) -> &'static str;

    /// Why a program with this first block is certainly none of this language.
    fn refuses(&self, first_block: BlockText<'_>) -> Option<String>;

    /// The next block of a text, whose lines are read; lines without text are no blocks.
    fn next_block(&self, lines: &mut Lines<'_>) -> Option<RawBlock>;

    /// What the index of a program wants to know of a block.
    fn landmark(&self, text: BlockText<'_>) -> Option<Landmark>;

    /// Reads a block into a place where one, best [`Block::EMPTY`], stands already, so that large blocks are not
    /// copied. It never fails: what cannot be read is [`Operation::Invalid`]. A block that begins the program is
    /// a fault where it may not.
    fn read(&self, text: BlockText<'_>, may_begin: bool, block: &mut Block);

    /// All that is wrong with a block's text, in the order of its words; the first is that of
    /// [`Operation::Invalid`].
    fn faults(&self, text: BlockText<'_>, may_begin: bool) -> Vec<BlockError>;

    /// The words of a block in order.
    fn words(&self, text: BlockText<'_>) -> Vec<WordSpan>;

    /// Whether the block is nothing but a comment.
    fn stands_alone(&self, text: BlockText<'_>) -> bool;

    /// Writes a block as the normalised listing shows it, without number and line end.
    fn write(&self, block: &Block, options: FormatOptions, text: &mut String);

    /// Appends a block's text with another number before it; a language with numbers of its own multiplies it by the
    /// step, and writes none with step 0.
    fn write_number(&self, text: BlockText<'_>, number: u32, step: u32, new: &mut Vec<u8>);

    /// What stands before a block of the normalised listing, whose number there is `number`.
    fn write_line_number(&self, number: u32, block: &Block, options: FormatOptions, text: &mut String);

    /// The number that a block is programmed with, where that is what its reports call it.
    fn number(&self, _text: BlockText<'_>) -> Option<u32> {
        None
    }

    /// Whether blocks have numbers of their own, which are part of the program: [`Language::number`].
    fn has_numbers(&self) -> bool {
        false
    }

    /// Whether a block begins a subroutine of the file, in which no run begins; `false` where it begins a program, `None`
    /// where it begins nothing.
    fn begins_subroutine(&self, _text: BlockText<'_>) -> Option<bool> {
        None
    }

    /// Most characters of a block, where the control counts them.
    fn characters_max(&self, _limits: &Limits) -> Option<u32> {
        None
    }

    /// The dialect of DIN 66025 that it is, whose blocks no language of the control reads; `None` for a language of the
    /// control.
    fn dialect(&self) -> Option<DinLanguage> {
        None
    }

    /// How the blocks that frame a program are called.
    fn frames(&self) -> [&'static str; 2];

    /// Reads one block by itself, as an editor or a dialogue wants it. Lines after the first block are not
    /// looked at.
    fn parse_block(&self, text: &str) -> ParsedBlock {
        let raw = self.next_block(&mut Lines::new(text.as_bytes(), 1));
        let mut block = Block::EMPTY;
        let Some(raw) = raw else {
            block.operation = Operation::Comment("".into());
            return ParsedBlock {
                block,
                faults: Vec::new(),
                words: Vec::new(),
            };
        };
        let text = raw.text(text.as_bytes());
        self.read(text, true, &mut block);
        let mut words = self.words(text);
        for word in &mut words {
            for range in [&mut word.span, &mut word.value] {
                *range = range.start + raw.start..range.end + raw.start;
            }
        }
        ParsedBlock {
            faults: self.faults(text, true),
            block,
            words,
        }
    }
}

/// A block that the index of a program keeps in mind.
#[derive(Clone, Debug, PartialEq)]
pub enum Landmark {
    /// It sets a label; 0 ends a subprogram.
    Label(u16),
    /// It begins the program.
    Begin(Box<Header>),
    /// It begins the program, or ends it once that has begun.
    Frame(Box<Header>),
    /// It ends the program.
    End(Box<Header>),
}

/// One block that was read by itself.
#[derive(Clone, Debug, PartialEq)]
pub struct ParsedBlock {
    /// What it does, with its comment.
    pub block: Block,
    /// What is wrong with it; the first is that of [`Operation::Invalid`].
    pub faults: Vec<BlockError>,
    /// Where its words stand, in their order.
    pub words: Vec<WordSpan>,
}

/// Where a word stands in the text of its block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WordSpan {
    /// Address, number, name, comment or the like.
    pub kind: WordKind,
    /// Bytes of the whole word.
    pub span: Range<usize>,
    /// Bytes of the value after the address; empty where there is none.
    pub value: Range<usize>,
}

/// Kinds of words, which editors colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WordKind {
    /// The number in front of the block.
    Number,
    /// The `/` of an optional block.
    Skip,
    /// What opens the block and says what it does, with its numbers: `L`, `TOOL CALL`, `CYCL DEF 1.1`.
    Function,
    /// An address, mostly with a value: `X+10`, `R0`, `DL-0.1`, `FMAX`.
    Address,
    /// A value by itself.
    Value,
    /// A name of a program or cycle, or decoration.
    Text,
    /// A comment with its `;` or `*`, or annotation after dots.
    Comment,
}
