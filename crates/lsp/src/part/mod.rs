//! Part programs: plain language and DIN/ISO.

mod complete;
mod convert;
mod examine;
mod hover;
mod mentions;
mod outline;
mod shelf;
mod words;

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};

use bahn_parameters::ControlModel;
use bahn_program::{
    Block, BlockText, FormatOptions, Language, Lines, Operation, Program, WordKind, WordSpan, format_program,
};

use crate::language::{
    Analysis, Completion, Conversion, Elsewhere, Examined, Fold, Hover, Mention, Symbol, Target, Thing, Token,
};
use crate::text::Text;
use crate::world::World;

/// The block of a cycle that names a program: `CYCL DEF 12.1` [003:6476-6490].
const PROGRAM_CYCLE: (u16, u16) = (12, 1);

/// A part program as the editor has it.
pub(crate) struct PartProgram {
    path: PathBuf,
    text: Arc<Text>,
    model: ControlModel,
    program: Arc<Program>,
    /// The bytes of each line as programs count them, from line 1 on.
    lines: Vec<Range<usize>>,
    blocks: Vec<Place>,
    mentions: OnceLock<Vec<Mention>>,
}

/// A block in the text.
#[derive(Clone, Debug)]
struct Place {
    /// Its number in the normalised listing.
    number: u32,
    bytes: Range<usize>,
    joined: bool,
}

/// A block that was read.
struct ReadBlock<'a> {
    place: &'a Place,
    operation: Operation,
    /// Its words, as bytes of the whole text.
    words: Vec<WordSpan>,
}

impl PartProgram {
    pub(crate) fn new(path: &Path, text: Arc<Text>, world: &World) -> PartProgram {
        let name = path.to_string_lossy().into_owned();
        let program = Program::from_bytes(name, text.text.as_bytes().to_vec());
        // Line ends may be settled otherwise, byte by byte.
        let bytes = program.to_bytes();
        let front = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
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

    fn language(&self) -> &'static dyn Language {
        self.program.language()
    }

    fn is_iso(&self) -> bool {
        self.language().name() != bahn_program::PlainLanguage.name()
    }

    /// The block around a byte.
    fn block_at(&self, at: usize) -> Option<&Place> {
        let index = self.blocks.partition_point(|place| place.bytes.end < at);
        self.blocks.get(index).filter(|place| place.bytes.start <= at)
    }

    fn read<'a>(&self, place: &'a Place) -> ReadBlock<'a> {
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
    fn each(&self) -> impl Iterator<Item = ReadBlock<'_>> {
        self.blocks.iter().map(|place| self.read(place))
    }

    /// The words of a part of the text in capitals, one blank between them.
    fn capitals(&self, range: &Range<usize>) -> String {
        let text = self.text.get(range.clone()).to_uppercase();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// The line of the editor in which a byte lies.
    fn line_of(&self, at: usize) -> usize {
        self.text.lines.line_of(at)
    }
}

/// Where the blocks of a program stand. Text around the program is none.
fn places(program: &Program, body: &[u8], front: usize) -> Vec<Place> {
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

impl Analysis for PartProgram {
    fn examine(&self, world: &World, interrupt: &AtomicBool) -> Examined {
        examine::examine(self, world, interrupt)
    }

    fn hover(&self, at: usize, examined: Option<&Examined>) -> Option<Hover> {
        hover::hover(self, at, examined)
    }

    fn hover_waits(&self, at: usize) -> bool {
        let mention = crate::language::mention_at(self.mentions(), at);
        mention.is_some_and(|mention| matches!(mention.thing, Thing::Q(_)))
    }

    fn mentions(&self) -> &[Mention] {
        self.mentions.get_or_init(|| mentions::mentions(self))
    }

    fn elsewhere(&self, thing: &Thing, world: &World) -> Option<Elsewhere> {
        match thing {
            Thing::File(name) => world.files.called(name, &self.path).map(Elsewhere::front),
            _ => None,
        }
    }

    fn symbols(&self) -> Vec<Symbol> {
        outline::symbols(self)
    }

    fn folds(&self) -> Vec<Fold> {
        outline::folds(self)
    }

    fn completions(&self, at: usize, world: &World) -> Vec<Completion> {
        complete::completions(self, at, world)
    }

    fn formatted(&self, world: &World) -> Result<String, String> {
        if !self.program.begins_with_header() {
            let [begin, _] = self.language().frames();
            return Err(format!(
                "the text does not begin with {begin}, so it may be no program"
            ));
        }
        let options = FormatOptions {
            decimal_comma: world.settings.comma,
            iso_step: world.settings.iso_step,
        };
        Ok(format_program(&self.program, options).to_string())
    }

    fn can_rename(&self, thing: &Thing) -> bool {
        matches!(thing, Thing::Label(_))
    }

    fn renamed(&self, thing: &Thing, new: &str, _: &World) -> Result<Vec<(Range<usize>, String)>, String> {
        let max = self.model.limits().label_max;
        let number = new.parse::<u16>().ok();
        let number = number.filter(|number| (1..=max).contains(&u32::from(*number)));
        let number = number.ok_or_else(|| format!("label numbers go from 1 to {max}"))?;
        if let Some(block) = self.program.label(number) {
            let block = self.program.number_of(block);
            return Err(format!("label {number} is set in block {block} already"));
        }
        let places = crate::language::mentions_of(self.mentions(), thing);
        Ok(places
            .map(|place| (place.range.clone(), number.to_string()))
            .collect())
    }

    fn targets(&self) -> Vec<Target> {
        convert::targets(self)
    }

    fn converted(&self, target: &str, world: &World) -> Result<Conversion, String> {
        convert::converted(self, target, world)
    }

    fn tokens(&self) -> Vec<(Range<usize>, Token)> {
        let words = self.each().flat_map(|block| block.words);
        let mut tokens = Vec::new();
        for word in words {
            let own = match word.kind {
                WordKind::Number => Token::Label,
                WordKind::Skip | WordKind::Function => Token::Keyword,
                WordKind::Address => Token::Parameter,
                WordKind::Value => Token::Number,
                WordKind::Text => Token::Text,
                WordKind::Comment => Token::Comment,
            };
            if word.kind == WordKind::Address && !word.value.is_empty() && word.value.start > word.span.start
            {
                let value = self.text.get(word.value.clone());
                let is_q = value.contains(['Q', 'q']);
                tokens.push((word.span.start..word.value.start, own));
                tokens.push((word.value, if is_q { Token::Variable } else { Token::Number }));
            } else {
                tokens.push((word.span, own));
            }
        }
        tokens
    }
}
