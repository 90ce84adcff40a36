//! A file: its blocks and their numbers.
//!
//! Decision: Block numbers of a `.900` program ascend, each stands once: the control finds a block by its number, and a
//! jump whose number nobody has is a fault of its block. M24 jumps back, or to its own block

use std::path::Path;
use std::sync::{Arc, OnceLock};

use bahn_text::{Diagnostic, Severity, Span};

use super::block::{self, Block, MFunction, Reading, Word, WordKind};
use super::line;
use super::plain;
use super::rules;
use crate::block::number;
use crate::line::{Glyph, LineFault, fault_at};
use crate::program::{Fault, MAX_FAULTS};
use crate::source::{MAX_LINES, Source};

/// A program or cycle that was read: its lines, and where its numbers are. Blocks are read when somebody asks.
#[derive(Clone, Debug)]
pub struct Program {
    source: Source,
    /// Found when somebody asks: most programs jump nowhere.
    numbers: OnceLock<Numbers>,
}

/// The numbers of the blocks.
#[derive(Clone, Debug)]
struct Numbers {
    /// With their lines, in the order of the file.
    all: Vec<(u32, u32)>,
    /// Whether the numbers ascend, so that they can be searched.
    is_ascending: bool,
}

impl Numbers {
    fn of(source: &Source) -> Numbers {
        let mut all: Vec<(u32, u32)> = Vec::new();
        for line in 1..=source.line_count() {
            let text = source.line(line);
            let own =
                plain::number(text).or_else(|| name_of(text).and_then(|name| name.get(1..)?.parse().ok()));
            all.extend(own.map(|number| (number, line)));
        }
        let is_ascending = all.windows(2).all(|pair| match pair {
            [(before, _), (after, _)] => before < after,
            _ => true,
        });
        Numbers { all, is_ascending }
    }
}

/// What is wrong with a file, and what looks so.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Findings {
    /// No run executes these blocks.
    pub faults: Vec<Fault>,
    /// Blocks that some channel may execute.
    pub warnings: Vec<Fault>,
}

impl Program {
    /// Reads a file; whatever is wrong with it is told by [`Program::findings`].
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Program {
        Program {
            source: Source::from_bytes(name, bytes),
            numbers: OnceLock::new(),
        }
    }

    fn found(&self) -> &Numbers {
        self.numbers.get_or_init(|| Numbers::of(&self.source))
    }

    /// Name of the file.
    pub fn name(&self) -> &Arc<str> {
        self.source.name()
    }

    /// Number of its lines.
    pub fn line_count(&self) -> u32 {
        self.source.line_count()
    }

    /// A line without its ending, from 1; empty where there is none.
    pub fn line(&self, number: u32) -> &str {
        self.source.line(number)
    }

    /// Its text by lines.
    pub(super) fn source(&self) -> &Source {
        &self.source
    }

    /// A text in the bytes that the file is written in, as one that takes its place has them.
    pub fn encoded(&self, text: &str) -> Vec<u8> {
        self.source.encoded(text)
    }

    /// Number of lines that are blocks.
    pub fn block_count(&self) -> u32 {
        let blocks = (1..=self.line_count()).filter(|line| self.glyphs(*line).is_some());
        u32::try_from(blocks.count()).unwrap_or(u32::MAX)
    }

    /// The name of a block in reports: its number, else its line, `#12`.
    pub fn block_name(&self, line: u32) -> Arc<str> {
        name_of(self.line(line)).unwrap_or_else(|| format!("#{line}").into())
    }

    /// The line, from 1, of the block with a number.
    pub fn line_of(&self, number: u32) -> Option<u32> {
        let Numbers { all, is_ascending } = self.found();
        let place = match is_ascending {
            true => all.binary_search_by_key(&number, |(own, _)| *own).ok(),
            false => all.iter().position(|(own, _)| *own == number),
        };
        all.get(place?).map(|(_, line)| *line)
    }

    /// The number of the block in a line, where it has one.
    pub fn number_in(&self, line: u32) -> Option<u32> {
        let all = &self.found().all;
        let place = all.binary_search_by_key(&line, |(_, own)| *own).ok();
        all.get(place?).map(|(number, _)| *number)
    }

    /// The numbers of its blocks with their lines, in the order of the file.
    pub fn numbers(&self) -> &[(u32, u32)] {
        &self.found().all
    }

    /// The block of a line, from 1; `None` of a line that orders nothing.
    ///
    /// # Errors
    /// What is wrong with it, where no run may execute it.
    pub fn block(&self, line: u32) -> Option<Result<Block, Vec<Fault>>> {
        let mut block = Block::default();
        Some(self.block_into(line, &mut block)?.map(|()| block))
    }

    /// The same into a block whose room is used again.
    ///
    /// # Errors
    /// What is wrong with it, where no run may execute it.
    pub fn block_into(&self, line: u32, block: &mut Block) -> Option<Result<(), Vec<Fault>>> {
        if plain::read(line, self.line(line), block).is_some() {
            return Some(Ok(()));
        }
        let reading = self.read(line)?;
        if !reading.faults.is_empty() {
            let faults = reading.faults.into_iter();
            return Some(Err(faults.map(|fault| self.fault(line, fault)).collect()));
        }
        *block = reading.block;
        Some(Ok(()))
    }

    /// The words of a line that could be read, whatever is wrong with others.
    pub fn words_read(&self, line: u32) -> Vec<Word> {
        self.read(line).unwrap_or_default().block.words
    }

    /// All that is wrong in the file, at most [`MAX_FAULTS`] of each, in the order of the text.
    pub fn findings(&self) -> Findings {
        let mut found = Findings::default();
        if self.source.is_too_long() {
            let message = format!("more than {MAX_LINES} lines in a file");
            found
                .faults
                .push(self.fault(self.line_count(), fault_at(1, 1, message)));
        }
        for line in 1..=self.line_count() {
            if found.faults.len() >= MAX_FAULTS {
                break;
            }
            let reading = self.read(line).unwrap_or_default();
            found
                .faults
                .extend(reading.faults.into_iter().map(|fault| self.fault(line, fault)));
            found
                .warnings
                .extend(reading.warnings.into_iter().map(|fault| self.fault(line, fault)));
        }
        found.faults.extend(self.order());
        for faults in [&mut found.faults, &mut found.warnings] {
            faults.sort_by_key(|fault| fault.span);
            faults.truncate(MAX_FAULTS);
        }
        found
    }

    /// Reads a line with all its rules; `None` of one that orders nothing.
    fn read(&self, line: u32) -> Option<Reading> {
        let mut reading = block::read(line, &self.glyphs(line)?);
        reading.faults.extend(rules::faults(&reading.block));
        reading.faults.extend(self.jumps(line, &reading.block));
        reading.faults.sort_by_key(|fault| fault.column);
        Some(reading)
    }

    /// The characters of a block; `None` of a line that orders nothing.
    fn glyphs(&self, line: u32) -> Option<Vec<Glyph>> {
        Some(line::glyphs(self.line(line))).filter(|glyphs| !line::is_blank(glyphs))
    }

    /// Jumps to blocks that are not there.
    fn jumps(&self, line: u32, block: &Block) -> Vec<LineFault> {
        let wrong = block.words.iter().filter_map(|word| {
            let (target, is_loop) = match word.kind {
                WordKind::Jump(condition) => (condition.target, false),
                WordKind::M(MFunction { number, target, .. }) => (target?, number == 24),
                _ => return None,
            };
            let message = match self.line_of(target) {
                None => format!("no block has the number N{target}"),
                Some(there) if is_loop && there > line => {
                    format!("M24 jumps back: N{target} comes after it")
                }
                Some(_) => return None,
            };
            Some(fault_at(word.span.column, word.span.length, message))
        });
        wrong.collect()
    }

    /// Numbers that do not ascend.
    fn order(&self) -> Vec<Fault> {
        let mut wrong = Vec::new();
        let mut greatest: Option<u32> = None;
        for (number, line) in self.numbers() {
            match greatest {
                Some(before) if *number <= before => {
                    let message = match *number == before {
                        true => format!("N{number} stands twice"),
                        false => format!("N{number} comes after N{before}: numbers ascend"),
                    };
                    let text = self.line(*line);
                    let blanks = text
                        .chars()
                        .take_while(|c| c.is_whitespace() || *c == '/')
                        .count();
                    let length = text
                        .chars()
                        .skip(blanks)
                        .take_while(|c| c.is_ascii_alphanumeric())
                        .count();
                    let Span { column, length, .. } = Span::new(1, blanks + 1, length.max(1));
                    wrong.push(self.fault(*line, fault_at(column, length, message)));
                }
                _ => greatest = Some(*number),
            }
            if wrong.len() >= MAX_FAULTS {
                break;
            }
        }
        wrong
    }

    /// A fault of one of its lines.
    pub(super) fn fault(&self, line: u32, fault: LineFault) -> Fault {
        Fault {
            span: fault.span(line),
            block: self.block_name(line),
            message: fault.message,
        }
    }

    /// A fault of this file as people and programs get it; `file` is where that lies.
    pub fn diagnostic(&self, severity: Severity, fault: &Fault, file: &Path) -> Diagnostic {
        let wrong = match severity {
            Severity::Error => Diagnostic::error(fault.span, fault.message.as_str()),
            Severity::Warning => Diagnostic::warning(fault.span, fault.message.as_str()),
        };
        let line = self.line(fault.span.line);
        fault.placed(wrong, line, fault.meant_number(line), file)
    }
}

/// The number of a block without leading zeros, as reports name it: `N40`.
fn name_of(line: &str) -> Option<Arc<str>> {
    let start = line.trim_start();
    let code = start.strip_prefix('/').unwrap_or(start);
    if !code.trim_start().starts_with(['N', 'n', '{']) {
        return None;
    }
    let glyphs = line::glyphs(line);
    let first = glyphs.iter().position(|glyph| !glyph.character.is_whitespace())?;
    let is_skipped = glyphs.get(first)?.character == '/';
    number(glyphs.get(first + usize::from(is_skipped)..)?).0
}
