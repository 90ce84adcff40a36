//! A program block by block in the other language.
//!
//! Decision: A block that the other language cannot say becomes an ERROR block, as a control stores what it could not
//! read, unless the whole program can be unrolled to its path (also `convert/src/unroll.rs`)

use bahn_parameters::MessageId;
use bahn_path::Plane;
use bahn_program::{
    Block, BlockError, Compensation, CycleWord, FormatOptions, InvalidBlock, NumberedBlock, Operation,
    Program, format_block,
};

use crate::canonical::{canonical, decorated, spread};
use crate::flow::{Flow, States};
use crate::lower::{State, lower};
use crate::reason::reason;
use crate::to_iso::{Planes, cycle_block, encoded, expected, goes_on};
use crate::{Language, Listed};

/// How a program is written in the other language.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// How blocks are written.
    pub format: FormatOptions,
    /// Most characters of a block.
    pub characters_max: Option<u32>,
    /// Another program in DIN/ISO calls this one, and may leave other G functions in force for it.
    pub called: bool,
    /// How a called program is named from now on; `None` keeps its name.
    pub renamed: &'a dyn Fn(&str) -> Option<String>,
    /// Whether a called program is in DIN/ISO, and may leave other G functions in force.
    pub is_iso: &'a dyn Fn(&str) -> bool,
}

impl Default for Options<'_> {
    fn default() -> Self {
        Options {
            format: FormatOptions {
                decimal_comma: false,
                iso_step: 1,
            },
            characters_max: None,
            called: false,
            renamed: &|_| None,
            is_iso: &|_| false,
        }
    }
}

/// A program in the other language.
#[derive(Clone, Debug)]
pub struct Converted {
    /// The program, block by block.
    pub text: String,
    /// How many blocks it has.
    pub blocks: u32,
    /// Blocks that cannot be said: ERROR blocks stand in their place, which end a run that comes to them.
    pub refused: Vec<Listed>,
    /// Comments that are too long for a block: they go on in the next ones.
    pub wrapped: u32,
}

/// Writes a program in another language than its own, block by block.
///
/// A block that cannot be said becomes an ERROR block, as a control stores one that it could not read, so that no
/// machine moves on without it.
pub fn convert(program: &Program, language: Language, options: &Options<'_>) -> Converted {
    let mut writer = Writer {
        program,
        language,
        options,
        made: Converted {
            text: String::new(),
            blocks: 0,
            refused: Vec::new(),
            wrapped: 0,
        },
    };
    match language {
        Language::Plain => to_plain(program, &mut writer),
        Language::Iso => to_iso(program, &mut writer),
    }
    writer.made
}

/// What a block of the source becomes in plain language.
fn to_plain(program: &Program, writer: &mut Writer<'_>) {
    let entry = match writer.options.called {
        true => States::UNKNOWN,
        false => States::start(),
    };
    let flow = Flow::of(program, entry, writer.options.is_iso);
    for (place, numbered) in program.blocks().enumerate() {
        let operations = match lowered(&numbered.block.operation, flow.before(place)) {
            Ok(operations) => operations,
            Err(reason) => {
                writer.refuse(&[numbered], reason.to_owned());
                continue;
            }
        };
        let operations: Vec<Operation> = operations.into_iter().flat_map(spread).map(decorated).collect();
        writer.blocks(&[numbered], &operations, &|operation| vec![operation.clone()]);
    }
}

/// The operations of a block, where they are the same whatever is in force.
fn lowered(operation: &Operation, states: States) -> Result<Vec<Operation>, &'static str> {
    if !matches!(operation, Operation::Motion(_) | Operation::Modal(_)) {
        return Ok(vec![operation.clone()]);
    }
    let mut found: Option<Vec<Operation>> = None;
    for mut state in states.each() {
        let mut operations = Vec::new();
        lower(operation, &mut state, &mut operations)?;
        match &found {
            Some(other) if *other != operations => {
                return Err("the G functions in force differ by where the block is reached from");
            }
            Some(_) => {}
            None => found = Some(operations),
        }
    }
    Ok(found.unwrap_or_default())
}

/// What the blocks of the source become in DIN/ISO; those of a cycle are gathered.
fn to_iso(program: &Program, writer: &mut Writer<'_>) {
    let lengthens = program.blocks().any(|numbered| match &numbered.block.operation {
        Operation::Motion(motion) => matches!(
            motion.compensation,
            Some(Compensation::Lengthen | Compensation::Shorten)
        ),
        _ => false,
    });
    let mut open: Vec<NumberedBlock> = Vec::new();
    let mut aside: Vec<NumberedBlock> = Vec::new();
    let mut planes = Planes::start();
    for numbered in program.blocks() {
        planes.take(&numbered.block.operation);
        let operations = operations_of(&open);
        let next = &numbered.block;
        if !open.is_empty() && matches!(next.operation, Operation::Comment(_)) {
            aside.push(numbered);
            continue;
        }
        let skip = open.first().map(|first| first.block.skip);
        if goes_on(&operations, &next.operation) && skip == Some(next.skip) {
            open.push(numbered);
            continue;
        }
        cycle_to_iso(&mut open, &mut aside, writer);
        if cycle_block(&numbered.block.operation).is_some() {
            open.push(numbered);
        } else {
            block_to_iso(&[numbered], lengthens, planes.centre, writer);
        }
    }
    cycle_to_iso(&mut open, &mut aside, writer);
}

fn operations_of(blocks: &[NumberedBlock]) -> Vec<Operation> {
    blocks
        .iter()
        .map(|numbered| numbered.block.operation.clone())
        .collect()
}

/// Writes the cycle that was gathered, and the comment blocks that came up in it: those before it that stood inside.
fn cycle_to_iso(open: &mut Vec<NumberedBlock>, aside: &mut Vec<NumberedBlock>, writer: &mut Writer<'_>) {
    let last = open.last().map_or(0, |last| last.number);
    let (inside, after): (Vec<_>, Vec<_>) = aside.drain(..).partition(|comment| comment.number < last);
    let open = std::mem::take(open);
    for comment in inside {
        writer.comment(&comment.block);
    }
    if !open.is_empty() {
        block_to_iso(&open, false, Plane::XY, writer);
    }
    for comment in after {
        writer.comment(&comment.block);
    }
}

fn block_to_iso(source: &[NumberedBlock], lengthens: bool, plane: Plane, writer: &mut Writer<'_>) {
    if let [numbered] = source
        && matches!(numbered.block.operation, Operation::Comment(_))
    {
        return writer.comment(&numbered.block);
    }
    let operations = operations_of(source);
    let Some(encoded) = encoded(&operations, lengthens, plane) else {
        return;
    };
    let expected = expected(&operations, &encoded);
    writer.blocks(source, &[encoded], &|_| expected.clone());
}

/// What takes the blocks of the target.
struct Writer<'a> {
    program: &'a Program,
    language: Language,
    options: &'a Options<'a>,
    made: Converted,
}

/// Characters that stand before and after the text of a comment in a block of its own.
const COMMENT_FRAME: u32 = 16;

impl Writer<'_> {
    /// Writes operations for blocks of the source, or refuses these where any does not come back; `meant` is what an
    /// operation has to come back as.
    fn blocks(
        &mut self,
        source: &[NumberedBlock],
        operations: &[Operation],
        meant: &dyn Fn(&Operation) -> Vec<Operation>,
    ) {
        let Some(first) = source.first() else { return };
        let skip = first.block.skip;
        let mut comments = source
            .iter()
            .filter_map(|numbered| numbered.block.comment.clone());
        let comment = comments.next();
        let aside: Vec<Box<str>> = comments.collect();
        for operation in operations {
            if !self.comes_back(operation, &meant(operation)) {
                return self.refuse(source, reason(&operations_of(source), self.language));
            }
        }
        for text in aside {
            self.own_comment(&text);
        }
        let mut blocks: Vec<Block> = operations
            .iter()
            .map(|operation| Block {
                skip,
                operation: self.renamed(operation),
                comment: None,
            })
            .collect();
        match blocks.first_mut() {
            Some(first) => first.comment = comment,
            None => comment.iter().for_each(|text| self.own_comment(text)),
        }
        if blocks.iter().any(|block| self.is_too_long(block, None)) {
            let reason = format!(
                "the block would have more than {} characters",
                self.options.characters_max.unwrap_or_default()
            );
            return self.refuse(source, reason);
        }
        for mut block in blocks {
            if let Some(text) = block.comment.clone()
                && self.is_too_long(&block, Some(&text))
            {
                block.comment = None;
                self.own_comment(&text);
            }
            self.push(&block);
        }
    }

    /// Whether what is written for an operation reads as what is meant.
    fn comes_back(&self, operation: &Operation, meant: &[Operation]) -> bool {
        if let Operation::Begin(_) | Operation::End(_) | Operation::Comment(_) = operation {
            return true;
        }
        if matches!(operation, Operation::Invalid(_)) {
            return false;
        }
        let block = Block {
            operation: operation.clone(),
            ..Block::EMPTY
        };
        let language = self.language.of();
        let mut text = String::new();
        language.write(&block, self.options.format, &mut text);
        let read = language.parse_block(&text).block.operation;
        let mut back = Vec::new();
        let mut state = State::default();
        lower(&read, &mut state, &mut back).is_ok() && canonical(&back) == canonical(meant)
    }

    fn renamed(&self, operation: &Operation) -> Operation {
        let mut operation = operation.clone();
        let blocks: &mut [Operation] = match &mut operation {
            Operation::Modal(block) => &mut block.operations,
            other => std::slice::from_mut(other),
        };
        for part in blocks {
            match part {
                Operation::CallProgram(name) => {
                    if let Some(new) = (self.options.renamed)(name) {
                        *name = new.into();
                    }
                }
                Operation::Cycle(cycle) if cycle.number == 12 && cycle.sub == 1 => {
                    for word in &mut cycle.words {
                        if let CycleWord::Text(name) = word
                            && let Some(new) = (self.options.renamed)(name)
                        {
                            *name = new.into();
                        }
                    }
                }
                _ => {}
            }
        }
        operation
    }

    /// Lists blocks of the source and puts a block in their place that ends the run.
    fn refuse(&mut self, source: &[NumberedBlock], reason: String) {
        let Some(first) = source.first() else { return };
        for numbered in source {
            if let Some(comment) = &numbered.block.comment {
                self.own_comment(comment);
            }
        }
        let texts: Vec<String> = source
            .iter()
            .map(|numbered| self.source_text(&numbered.block))
            .collect();
        self.made.refused.push(Listed {
            block: self.program.number_of(first.number),
            line: first.line,
            text: texts.join(" / "),
            reason,
        });
        for text in texts {
            let mut text: String = format!("ERROR = {}", text.replace(['\n', '\r', ';'], " "));
            if let Some(max) = self.options.characters_max {
                text = text
                    .chars()
                    .take(max.saturating_sub(COMMENT_FRAME) as usize)
                    .collect();
            }
            let error = BlockError {
                message: MessageId::ErrorBlock,
                line: 0,
                column: 1,
                length: 1,
                detail: "".into(),
                help: None,
            };
            let text = text.trim_end().into();
            self.push(&Block {
                skip: first.block.skip,
                operation: Operation::Invalid(Box::new(InvalidBlock { text, error })),
                comment: None,
            });
        }
    }

    /// A block of the source as it is written there, without number and comment.
    fn source_text(&self, block: &Block) -> String {
        let block = Block {
            skip: false,
            comment: None,
            ..block.clone()
        };
        match &block.operation {
            Operation::Invalid(invalid) => invalid.text.to_string(),
            Operation::Modal(_) | Operation::Motion(_) => {
                let mut text = String::new();
                let language = self.program.language();
                language.write(&block, self.options.format, &mut text);
                text.trim_end_matches([' ', '*']).to_owned()
            }
            _ => format_block(&block, self.options.format),
        }
    }

    /// A block that is a comment, in several where it is too long.
    fn comment(&mut self, block: &Block) {
        match &block.operation {
            Operation::Comment(text) if self.is_too_long(block, None) => self.own_comment(text),
            _ => self.push(block),
        }
    }

    /// A comment in blocks of its own, as many as it needs.
    fn own_comment(&mut self, text: &str) {
        let max = self.options.characters_max.map_or(usize::MAX, |max| {
            max.saturating_sub(COMMENT_FRAME).max(1) as usize
        });
        let pieces = wrapped(text, max);
        self.made.wrapped += u32::from(pieces.len() > 1);
        for piece in pieces {
            self.push(&Block {
                operation: Operation::Comment(piece.into()),
                ..Block::EMPTY
            });
        }
    }

    fn is_too_long(&self, block: &Block, comment: Option<&str>) -> bool {
        let Some(max) = self.options.characters_max else {
            return false;
        };
        let block = Block {
            comment: comment.map(Into::into),
            ..block.clone()
        };
        self.line(&block).chars().count() > max as usize
    }

    fn line(&self, block: &Block) -> String {
        let mut text = String::new();
        let language = self.language.of();
        language.write_line_number(self.made.blocks, block, self.options.format, &mut text);
        language.write(block, self.options.format, &mut text);
        text
    }

    fn push(&mut self, block: &Block) {
        let line = self.line(block);
        self.made.text.push_str(&line);
        self.made.text.push('\n');
        self.made.blocks += 1;
    }
}

/// A text in pieces of so many characters at most, parted between words where that can be.
fn wrapped(text: &str, max: usize) -> Vec<String> {
    let characters: Vec<char> = text.chars().collect();
    let mut rest = characters.as_slice();
    let mut pieces = Vec::new();
    while rest.len() > max {
        let begin = rest.iter().take(max + 1);
        let blank = begin.rev().position(|c| *c == ' ').map(|back| max - back);
        let word = rest.iter().position(|c| *c != ' ').unwrap_or(0);
        let cut = blank.filter(|at| *at > word).unwrap_or(max);
        let (piece, after) = rest.split_at(cut);
        pieces.push(piece.iter().collect());
        rest = after.strip_prefix(&[' ']).unwrap_or(after);
    }
    pieces.push(rest.iter().collect());
    pieces
}
