//! A part program, read for all questions about it.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use bahn_parameters::ControlModel;
use bahn_program::{Block, BlockText, Language, Lines, Operation, Program, WordSpan};
use bahn_text::MARK_BYTES;

use crate::language::Mention;
use crate::text::Text;
use crate::world::World;

/// The block of a cycle that names a program: `CYCL DEF 12.1` [003:6476-6490].
pub(super) const PROGRAM_CYCLE: (u16, u16) = (12, 1);

/// A part program as the editor has it.
pub(crate) struct PartProgram {
    pub(super) path: PathBuf,
    pub(super) text: Arc<Text>,
    pub(super) model: ControlModel,
    pub(super) program: Arc<Program>,
    /// The bytes of each line as programs count them, from line 1 on.
    pub(super) lines: Vec<Range<usize>>,
    pub(super) blocks: Vec<Place>,
    pub(super) mentions: OnceLock<Vec<Mention>>,
}

/// A block in the text.
#[derive(Clone, Debug)]
pub(super) struct Place {
    /// Its number in the normalised listing.
    pub(super) number: u32,
    pub(super) bytes: Range<usize>,
    pub(super) joined: bool,
}

/// A block that was read.
pub(super) struct ReadBlock<'a> {
    pub(super) place: &'a Place,
    pub(super) operation: Operation,
    /// Its words, as bytes of the whole text.
    pub(super) words: Vec<WordSpan>,
}

impl PartProgram {
    pub(crate) fn new(path: &Path, text: Arc<Text>, world: &World) -> PartProgram {
        let name = path.to_string_lossy().into_owned();
        let program = Program::from_bytes(name, text.text.as_bytes().to_vec());
        // Line ends may be settled otherwise, byte by byte.
        let bytes = program.to_bytes();
        let front = if bytes.starts_with(MARK_BYTES) {
            MARK_BYTES.len()
        } else {
            0
        };
        let body = bytes.get(front..).unwrap_or_default();
        let mut lines = Vec::new();
        let mut each = Lines::new(body, 1);
        while let Some((start, end)) = each.line() {
            lines.push(start + front..end + front);
        }
        let blocks = places(&program, body, front);
        PartProgram {
            path: path.to_owned(),
            model: world.model_of(path),
            program: Arc::new(program),
            lines,
            blocks,
            text,
            mentions: OnceLock::new(),
        }
    }

    pub(super) fn language(&self) -> &'static dyn Language {
        self.program.language()
    }

    pub(super) fn is_iso(&self) -> bool {
        self.language().name() != bahn_program::PlainLanguage.name()
    }

    /// The block around a byte.
    pub(super) fn block_at(&self, at: usize) -> Option<&Place> {
        let index = self.blocks.partition_point(|place| place.bytes.end < at);
        self.blocks.get(index).filter(|place| place.bytes.start <= at)
    }

    pub(super) fn read<'a>(&self, place: &'a Place) -> ReadBlock<'a> {
        let text = BlockText {
            bytes: self.text.get(place.bytes.clone()).as_bytes(),
            joined: place.joined,
        };
        let mut block = Block::EMPTY;
        self.language().read(text, place.number == 0, &mut block);
        let mut words = self.language().words(text);
        for word in &mut words {
            for range in [&mut word.span, &mut word.value] {
                *range = range.start + place.bytes.start..range.end + place.bytes.start;
            }
        }
        ReadBlock {
            place,
            operation: block.operation,
            words,
        }
    }

    /// All blocks, read one after the other.
    pub(super) fn each(&self) -> impl Iterator<Item = ReadBlock<'_>> {
        self.blocks.iter().map(|place| self.read(place))
    }

    /// The words of a part of the text in capitals, one blank between them.
    pub(super) fn capitals(&self, range: &Range<usize>) -> String {
        let text = self.text.get(range.clone()).to_uppercase();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// The line of the editor in which a byte lies.
    pub(super) fn line_of(&self, at: usize) -> usize {
        self.text.lines.line_of(at)
    }
}

/// Where the blocks of a program stand. Text around the program has no blocks.
pub(super) fn places(program: &Program, body: &[u8], front: usize) -> Vec<Place> {
    let language = program.language();
    let mut each = Lines::new(body, 1);
    let mut raws = std::iter::from_fn(|| language.next_block(&mut each)).peekable();
    let mut places = Vec::new();
    for numbered in program.blocks() {
        while raws.peek().is_some_and(|raw| raw.line < numbered.line) {
            raws.next();
        }
        // Implied blocks stand nowhere.
        if let Some(raw) = raws.next_if(|raw| raw.line == numbered.line) {
            places.push(Place {
                number: numbered.number,
                bytes: raw.start + front..raw.end + front,
                joined: raw.joined,
            });
        }
    }
    places
}
