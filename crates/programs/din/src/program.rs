//! A file: its lines, and the programs and subroutines that stand in it.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use bahn_path::{Axis, AxisSet};
use bahn_text::Span;

use crate::block::{self, WordKind};
use crate::line::{self, Glyph, LineFault, Macros};
use crate::source::{MAX_LINES, Source};
use crate::words::{SpanKind, words};

/// A file that was read.
#[derive(Clone, Debug)]
pub struct Program {
    source: Source,
    /// Lines that comments of several lines touch, with blanks in their place.
    uncommented: BTreeMap<u32, String>,
    sections: Vec<Section>,
    /// What is wrong with heads of programs.
    heads: Vec<Fault>,
}

/// A program or subroutine of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// Its name; empty for what stands before the first head.
    pub name: String,
    /// Whether it is a subroutine of this file (`%L name`).
    pub is_subroutine: bool,
    /// Line of its head, from 1; its first line where it has none.
    pub line: u32,
    /// Its lines after the head, from 1, the last one not included.
    pub(crate) lines: (u32, u32),
}

/// What is wrong in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Its place.
    pub span: Span,
    /// The block: its number, else its line: `N40`, `#12`.
    pub block: Arc<str>,
    /// What is wrong, with the name of what is not known.
    pub message: String,
}

/// What reading every block of a file has found.
#[derive(Clone, Debug, Default)]
pub(crate) struct Judged {
    pub faults: Vec<Fault>,
    /// Calls, each with the fault that it is if there is no such subroutine.
    pub calls: Vec<Call>,
    /// Names of macros that the file defines.
    pub macros: BTreeSet<String>,
    /// Macros that are used where the file has not defined them, each with the fault that it is if nobody else does.
    pub unknown_macros: Vec<(String, Fault)>,
}

/// A block that calls a subroutine.
#[derive(Clone, Debug)]
pub(crate) struct Call {
    pub local: bool,
    pub name: String,
    pub fault: Fault,
}

/// A subroutine that is not there.
pub(crate) fn not_found(name: &str) -> String {
    format!("subroutine {name} is not found")
}

/// Something to go to in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Landmark {
    /// Beginning of a program or subroutine, or number of a block.
    pub kind: LandmarkKind,
    /// Its name, `N40` of a number.
    pub name: String,
    /// Line in the file, from 1.
    pub line: u32,
}

/// What an editor lists and goes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LandmarkKind {
    /// `%name`: beginning of the main program.
    Program,
    /// `%L name`: beginning of a subroutine.
    Subroutine,
    /// The number of a block.
    Number,
}

/// Most faults of a file that are told.
pub const MAX_FAULTS: usize = 1000;

/// What a line is before its words are read.
enum Line<'a> {
    Blank,
    Head { is_subroutine: bool, name: &'a str },
    Block,
}

impl Program {
    /// Reads a file; whatever is wrong with it is told by [`Program::faults`]. A file that is no UTF-8 has one
    /// character for each byte.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Program {
        let mut program = Program {
            source: Source::from_bytes(name, bytes),
            uncommented: BTreeMap::new(),
            sections: Vec::new(),
            heads: Vec::new(),
        };
        program.find_comments();
        program.find_sections();
        if program.source.is_too_long() {
            let message = format!("more than {MAX_LINES} lines in a file");
            let last = program.line_count();
            program
                .heads
                .push(program.fault(last, line::fault_at(1, 1, message)));
        }
        program
    }

    /// Name of the file, as calls name it.
    pub fn name(&self) -> &Arc<str> {
        self.source.name()
    }

    /// The axes that its blocks name.
    pub fn axes(&self) -> AxisSet {
        let lines = (1..=self.line_count()).map(|number| self.line(number));
        lines.fold(AxisSet::EMPTY, |axes, line| {
            let words = words(line).into_iter();
            let addresses = words.filter(|word| (word.kind, word.length) == (SpanKind::Address, 1));
            let letters = addresses.filter_map(|word| line.chars().nth(word.column as usize - 1));
            let letters = letters.filter_map(|letter| u8::try_from(letter).ok());
            letters.filter_map(Axis::from_letter).fold(axes, AxisSet::with)
        })
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
    pub(crate) fn source(&self) -> &Source {
        &self.source
    }

    /// A text in the bytes that the file is written in, as one that takes its place has them.
    pub fn encoded(&self, text: &str) -> Vec<u8> {
        self.source.encoded(text)
    }

    /// Whether comments of several lines touch a line.
    pub(crate) fn is_commented(&self, number: u32) -> bool {
        self.uncommented.contains_key(&number)
    }

    /// Its programs and subroutines in their order.
    pub fn sections(&self) -> &[Section] {
        &self.sections
    }

    /// Its programs without the subroutines: what can be run. A file of subroutines alone has none.
    pub fn mains(&self) -> impl Iterator<Item = &Section> {
        self.sections.iter().filter(|section| !section.is_subroutine)
    }

    /// Whether a line, from 1, stands in a subroutine of the file, which begins with its head.
    pub fn is_in_subroutine(&self, line: u32) -> bool {
        let section = self.sections.iter().rfind(|section| section.line <= line);
        section.is_some_and(|section| section.is_subroutine)
    }

    /// A subroutine of the file.
    pub fn subroutine(&self, name: &str) -> Option<&Section> {
        self.sections
            .iter()
            .find(|section| section.is_subroutine && section.name == name)
    }

    /// Number of lines that are blocks.
    pub fn block_count(&self) -> u32 {
        let blocks = (1..=self.line_count()).filter(|line| matches!(self.kind(*line), Line::Block));
        u32::try_from(blocks.count()).unwrap_or(u32::MAX)
    }

    /// Programs, subroutines and block numbers with their lines.
    pub fn landmarks(&self) -> Vec<Landmark> {
        let mut landmarks: Vec<Landmark> = self
            .sections
            .iter()
            .filter(|section| !section.name.is_empty())
            .map(|section| Landmark {
                kind: match section.is_subroutine {
                    true => LandmarkKind::Subroutine,
                    false => LandmarkKind::Program,
                },
                name: section.name.clone(),
                line: section.line,
            })
            .collect();
        landmarks.extend((1..=self.line_count()).filter_map(|line| {
            let name = self.number(line)?.to_string();
            Some(Landmark {
                kind: LandmarkKind::Number,
                name,
                line,
            })
        }));
        landmarks.sort_by_key(|landmark| landmark.line);
        landmarks
    }

    /// The programmed number of a block without leading zeros.
    pub(crate) fn number(&self, line: u32) -> Option<Arc<str>> {
        let text = self.code(line);
        if !text.trim_start().starts_with(['N', 'n']) {
            return None;
        }
        block::number(&line::glyphs(text)).0
    }

    /// The name of a block in reports: its number, else its line.
    pub fn block_name(&self, line: u32) -> Arc<str> {
        self.number(line).unwrap_or_else(|| format!("#{line}").into())
    }

    /// The characters of a block; `None` of a line that orders nothing.
    pub(crate) fn glyphs(&self, line: u32) -> Option<Vec<Glyph>> {
        match self.kind(line) {
            Line::Block => Some(line::glyphs(self.code(line))),
            Line::Blank | Line::Head { .. } => None,
        }
    }

    /// Whether a line is a block.
    pub(crate) fn is_block(&self, line: u32) -> bool {
        matches!(self.kind(line), Line::Block)
    }

    /// What is wrong in the file, as far as it can be said without executing it, at most [`MAX_FAULTS`]. Macros count as
    /// defined from their line on; what uses one that only its caller may define is not judged.
    pub fn faults(&self) -> Vec<Fault> {
        self.judged().faults
    }

    /// Reads every block without executing it.
    pub(crate) fn judged(&self) -> Judged {
        let mut judged = Judged {
            faults: self.heads.clone(),
            ..Judged::default()
        };
        let mut macros = Macros::default();
        for line in 1..=self.line_count() {
            if judged.faults.len() >= MAX_FAULTS {
                break;
            }
            if let Err(fault) = self.judge(line, &mut macros, &mut judged) {
                judged.faults.push(self.fault(line, fault));
            }
        }
        judged.faults.sort_by_key(|fault| fault.span);
        judged.faults.truncate(MAX_FAULTS);
        judged
    }

    fn judge(&self, line: u32, macros: &mut Macros, judged: &mut Judged) -> Result<(), LineFault> {
        let Some(glyphs) = self.glyphs(line) else {
            return Ok(());
        };
        if block::definitions(&glyphs)?.is_none()
            && let Some((unknown, name)) = macros.first_unknown(&glyphs)?
        {
            // What stands before it is judged all the same.
            let before = glyphs.get(..unknown).unwrap_or_default();
            let column = glyphs.get(unknown).map_or(1, |glyph| glyph.column);
            return match block::read(before, macros) {
                Err(fault) if fault.column < column && fault.names_unknown() => Err(fault),
                _ => {
                    let fault = self.fault(line, line::unknown_macro(column, &name));
                    judged.unknown_macros.push((name, fault));
                    Ok(())
                }
            };
        }
        for word in block::read(&glyphs, macros)?.words {
            match word.kind {
                WordKind::Define(name, text) => {
                    let reported = macros.define(&name, &text);
                    reported.map_err(|message| line::fault_at(word.column, word.length, message))?;
                    judged.macros.insert(name);
                }
                WordKind::Call { local, name } => {
                    let message = not_found(&name);
                    let fault = self.fault(line, line::fault_at(word.column, word.length, message));
                    judged.calls.push(Call { local, name, fault });
                }
                _ => {}
            }
        }
        Ok(())
    }

    pub(crate) fn fault(&self, line: u32, fault: LineFault) -> Fault {
        Fault {
            span: fault.span(line),
            block: self.block_name(line),
            message: fault.message,
        }
    }

    fn kind(&self, number: u32) -> Line<'_> {
        kind(self.code(number))
    }

    /// A line without comments of several lines.
    fn code(&self, number: u32) -> &str {
        self.uncommented
            .get(&number)
            .map_or_else(|| self.line(number), String::as_str)
    }

    /// `#COMMENT BEGIN` and `#COMMENT END` (public), each with what stands beside it in its line.
    fn find_comments(&mut self) {
        let mut begin = None;
        for number in 1..=self.line_count() {
            let mut line = self.line(number).to_owned();
            let mut is_touched = begin.is_some();
            let mut at = 0;
            loop {
                let open = begin.is_some();
                let mark = if open {
                    Some(at)
                } else {
                    line::command(&line, at, "#COMMENT BEGIN")
                };
                let Some(mark) = mark else { break };
                begin = begin.or(Some((number, mark)));
                is_touched = true;
                let after = if open { mark } else { mark + "#COMMENT BEGIN".len() };
                let end = find_end(&line, after);
                line::blank(&mut line, mark, end.unwrap_or(usize::MAX));
                match end {
                    Some(end) => (begin, at) = (None, end),
                    None => break,
                }
            }
            if is_touched {
                self.uncommented.insert(number, line);
            }
        }
        if let Some((line, column)) = begin {
            let column = u32::try_from(column).unwrap_or(u32::MAX).saturating_add(1);
            let message = "#COMMENT BEGIN is not closed by #COMMENT END".into();
            let fault = self.fault(
                line,
                line::fault_at(column, "#COMMENT BEGIN".len() as u32, message),
            );
            self.heads.push(fault);
        }
    }

    fn find_sections(&mut self) {
        let mut sections: Vec<Section> = Vec::new();
        let mut heads = Vec::new();
        for line in 1..=self.line_count() {
            let (is_subroutine, name) = match self.kind(line) {
                Line::Head { is_subroutine, name } => (is_subroutine, name.to_owned()),
                Line::Block if sections.is_empty() => (false, String::new()),
                Line::Block | Line::Blank => continue,
            };
            if is_subroutine && name.is_empty() {
                heads.push(self.head_fault(line, "%L needs the name of a subroutine".into()));
            }
            if is_subroutine
                && sections
                    .iter()
                    .any(|other| other.is_subroutine && other.name == name)
            {
                heads.push(self.head_fault(line, format!("subroutine {name} stands twice in the file")));
            }
            if let Some(before) = sections.last_mut() {
                before.lines.1 = line;
            }
            // What stands before the first head begins in its first line.
            let first = match self.kind(line) {
                Line::Head { .. } => line + 1,
                _ => line,
            };
            let lines = (first, self.line_count() + 1);
            sections.push(Section {
                name,
                is_subroutine,
                line,
                lines,
            });
        }
        if sections.is_empty() {
            // A file without blocks is a program that does nothing.
            let lines = (1, self.line_count() + 1);
            sections.push(Section {
                name: String::new(),
                is_subroutine: false,
                line: 1,
                lines,
            });
        }
        self.sections = sections;
        self.heads.extend(heads);
    }

    fn head_fault(&self, line: u32, message: String) -> Fault {
        let text = self.line(line);
        let blanks = text.chars().take_while(|c| c.is_whitespace()).count() as u32;
        let length = text.trim().chars().count() as u32;
        self.fault(line, line::fault_at(blanks + 1, length, message))
    }
}

/// Where a comment of several lines ends, in characters: after its `#COMMENT END`.
fn find_end(line: &str, from: usize) -> Option<usize> {
    const END: &str = "#COMMENT END";
    let characters: Vec<char> = line.chars().collect();
    let rest = characters.get(from..)?;
    let found = rest.windows(END.len()).position(|window| {
        window
            .iter()
            .zip(END.chars())
            .all(|(a, b)| a.eq_ignore_ascii_case(&b))
    });
    found.map(|place| from + place + END.len())
}

/// What a line is: a head begins with `%` [004:60], `%L name` is one of a subroutine (public).
fn kind(line: &str) -> Line<'_> {
    let text = line.trim();
    if text.is_empty() {
        return Line::Blank;
    }
    let Some(head) = text.strip_prefix('%') else {
        let is_comment = text.starts_with([';', '('])
            && line::glyphs(text)
                .iter()
                .all(|glyph| glyph.character.is_whitespace());
        return match is_comment {
            true => Line::Blank,
            false => Line::Block,
        };
    };
    let head = head.split([';', '(']).next().unwrap_or_default().trim();
    let mut words = head.splitn(2, char::is_whitespace);
    match (words.next(), words.next()) {
        (Some("L" | "l"), name) => Line::Head {
            is_subroutine: true,
            name: name.unwrap_or_default().trim(),
        },
        _ => Line::Head {
            is_subroutine: false,
            name: head,
        },
    }
}
