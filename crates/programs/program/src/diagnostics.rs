//! All faults of a program in one pass.

use std::collections::BTreeSet;
use std::path::Path;

use bahn_parameters::ControlModel;
use bahn_parameters::MessageId::{
    self, BlockNotSupported, CyclIncomplete, EndOfProgramMissing, JumpToLabelZeroNotPermitted,
    LabelNumberAllocated, LabelNumberNotAllocated, UnexpectedText,
};
use bahn_text::{Diagnostic, Severity, Span};

use crate::lines::lines;
use crate::program::Places;
use crate::sequence::{Sequence, SequenceFault};
use crate::text::trim_continuation;
use crate::{BlockError, CycleWord, Header, NumberedBlock, Operation, Program, Reading, check_limits};

/// Most diagnostics of one program; with more it is not a program at all.
pub const MAX_DIAGNOSTICS: usize = 1000;

/// A fault of a program and its place in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// The control's message.
    pub message: MessageId,
    /// How bad it is.
    pub severity: Severity,
    /// Block number in the normalised listing.
    pub block: u32,
    /// Place in the file; it covers at least one character.
    pub span: Span,
    /// What exactly, in a few words for people.
    pub detail: Box<str>,
    /// What to do about it.
    pub help: &'static str,
}

impl Fault {
    /// In the words of a control, as people and programs get it. Warnings say themselves what to do.
    pub fn diagnostic(&self, program: &Program, model: ControlModel, file: &Path) -> Diagnostic {
        let is_error = self.severity == Severity::Error;
        let help = Some(self.help).filter(|help| is_error && !help.is_empty());
        Diagnostic {
            severity: self.severity,
            ..Diagnostic::error(self.span, self.message.text(model))
                .with_code(self.message.name())
                .in_block(program.number_of(self.block).to_string())
                .with_detail(&*self.detail)
                .with_help(help)
                .at(file, program.text_of_line(self.span.line))
        }
    }
}

/// Faults that were counted only, beyond [`MAX_DIAGNOSTICS`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Uncounted {
    /// How many of them are errors.
    pub errors: usize,
    /// How many of them are warnings.
    pub warnings: usize,
}

/// Missing labels of one list that are named.
const LABELS_NAMED: usize = 12;

impl Program {
    /// All faults that can be seen without running the program, in the order of its blocks, at most
    /// [`MAX_DIAGNOSTICS`]: blocks that cannot be read, labels set twice or missing, cycles with missing or
    /// unordered blocks, a missing or unlike BEGIN and END, text around the program; with the limits of a
    /// control model also what that control does not take.
    ///
    /// ```
    /// use bahn_parameters::MessageId;
    /// use bahn_program::Program;
    /// use bahn_text::Span;
    ///
    /// let program = Program::from_bytes("1.H", b"BEGIN PGM 1 MM\n  CALL LBL 7\nEND PGM 1 MM".to_vec());
    /// let faults = program.diagnostics(None);
    /// assert_eq!(faults[0].message, MessageId::LabelNumberNotAllocated);
    /// assert_eq!((faults[0].block, faults[0].span), (1, Span::new(2, 12, 1)));
    /// ```
    pub fn diagnostics(&self, reading: Option<Reading<'_>>) -> Vec<Fault> {
        self.counted_diagnostics(reading).0
    }

    /// [`Program::diagnostics`], and how many more there are.
    pub fn counted_diagnostics(&self, reading: Option<Reading<'_>>) -> (Vec<Fault>, Uncounted) {
        let mut pass = Pass {
            program: self,
            reading,
            sequence: Sequence::default(),
            found: Vec::new(),
            more: Uncounted::default(),
            places: None,
        };
        if let Some(reason) = self.refused() {
            // One line says all.
            pass.error(BlockNotSupported, 1, "", reason);
            return (pass.found, pass.more);
        }
        pass.around_the_front();
        for numbered in self.blocks() {
            pass.block(&numbered);
        }
        pass.around_the_end();
        pass.found.sort_by_key(|diagnostic| diagnostic.block);
        (pass.found, pass.more)
    }

    /// The line of a block, and what of it cannot be read if that is so.
    pub fn span_of(&self, block: u32) -> Span {
        let chunk = self.decode(block / Program::CHUNK_SIZE);
        let own = chunk.blocks.get((block % Program::CHUNK_SIZE) as usize);
        match own.map(|own| &own.operation) {
            Some(Operation::Invalid(invalid)) => invalid.error.span(self.line_of(block)),
            _ => Span::line(self.line_of(block) as usize),
        }
    }

    /// A fault of a block that was found elsewhere, with its place: the value after an address, or the whole
    /// block without one.
    pub fn diagnostic(
        &self,
        message: MessageId,
        severity: Severity,
        block: u32,
        address: &str,
        detail: &str,
    ) -> Fault {
        let text = self.text_of(block);
        let (line, column, length) = locate(&text, address);
        Fault {
            message,
            severity,
            block,
            span: Span {
                line: self.line_of(block).saturating_add(line),
                column,
                length,
            },
            detail: detail.into(),
            help: message.remedy(),
        }
    }
}

struct Pass<'a> {
    program: &'a Program,
    reading: Option<Reading<'a>>,
    sequence: Sequence,
    found: Vec<Fault>,
    more: Uncounted,
    /// Those of the piece that is looked at.
    places: Option<Places<'a>>,
}

impl Pass<'_> {
    fn around_the_front(&mut self) {
        if let Some(line) = self.program.frame.leading {
            let [begin, _] = self.program.language().frames();
            self.at_line(0, line, &format!("text before {begin} is no part of the program"));
        }
        if let Some(unit) = self.program.begin().and_then(Header::unknown_unit) {
            let detail = format!("{unit} is no unit: the program is taken to be in mm");
            self.at_word(UnexpectedText, Severity::Warning, 0, "", &detail);
        }
        if self.program.begin().is_none() {
            let [begin, _] = self.program.language().frames();
            self.at_line(0, 1, &format!("the program does not begin with {begin}"));
        }
    }

    fn around_the_end(&mut self) {
        let last = self.program.block_count().saturating_sub(1);
        let [_, end] = self.program.language().frames();
        match (self.program.begin(), self.program.end()) {
            (_, None) if self.program.is_growing() => {}
            (_, None) => {
                let detail = format!("the program does not end with {end}");
                self.at_word(EndOfProgramMissing, Severity::Warning, last, "", &detail);
            }
            (Some(begin), Some(end)) if !begin.name.eq_ignore_ascii_case(&end.name) => {
                let detail = format!("the program began as \"{}\"", begin.name);
                self.at_word(UnexpectedText, Severity::Warning, last, "", &detail);
            }
            (Some(begin), Some(end)) if begin.unit != end.unit => {
                let [begin, end] = self.program.language().frames();
                let detail = format!("{end} names another unit than {begin}");
                self.at_word(UnexpectedText, Severity::Warning, last, "", &detail);
            }
            _ => {}
        }
        if let Some(line) = self.program.trailing_line() {
            let [_, end] = self.program.language().frames();
            self.at_line(last, line, &format!("text after {end} is no part of the program"));
        }
    }

    fn block(&mut self, numbered: &NumberedBlock) {
        let NumberedBlock { number, line, block } = numbered;
        for part in block.operation.parts() {
            if let Some(fault) = self.sequence.next(*number, part) {
                self.sequence_fault(fault);
            }
        }
        self.length(*number, *line);
        if let Operation::Invalid(invalid) = &block.operation {
            self.unreadable(*number, *line, &invalid.error);
            return;
        }
        for part in block.operation.parts() {
            self.labels(*number, part);
        }
        let unit = self.program.unit();
        let fault = self
            .reading
            .and_then(|reading| check_limits(&block.operation, unit, reading));
        if let Some(fault) = fault {
            self.error(fault.message, *number, &fault.address, &fault.detail);
        }
    }

    /// A block may be longer than the control takes.
    fn length(&mut self, number: u32, line: u32) {
        let language = self.program.language();
        let max = self
            .reading
            .and_then(|reading| language.characters_max(reading.limits));
        let Some(max) = max else { return };
        let places = match self.places.take() {
            Some(places) if places.of(number).is_some() => Some(places),
            _ => self.program.places_of(number),
        };
        let fault = places.as_ref().and_then(|places| places.too_long(number, max));
        self.places = places;
        let Some(error) = fault.filter(|_| !self.is_full(Severity::Error)) else {
            return;
        };
        self.found.push(Fault {
            message: error.message,
            severity: Severity::Error,
            block: number,
            span: error.span(line),
            detail: error.detail,
            help: error.message.remedy(),
        });
    }

    /// The labels that a block sets, calls or lists.
    fn labels(&mut self, number: u32, operation: &Operation) {
        match operation {
            Operation::Label(label) if *label > 0 => {
                if let Some(first) = self.program.label(*label).filter(|first| *first != number) {
                    let first = self.program.number_of(first);
                    let detail = format!("label {label} is set in block {first} already");
                    self.error(LabelNumberAllocated, number, "LBL", &detail);
                }
            }
            Operation::CallLabel { label, .. } | Operation::Jump { label, .. } => {
                self.called(number, *label, "LBL");
            }
            Operation::Cycle(block) => {
                for word in &block.words {
                    if let CycleWord::Labels(labels) = word {
                        self.subcontours(number, labels);
                    }
                }
            }
            _ => {}
        }
    }

    /// The faults of a block that cannot be read; the first is known.
    fn unreadable(&mut self, number: u32, line: u32, first: &BlockError) {
        let place = self.program.place(number);
        let mut faults = place.map_or_else(Vec::new, |(piece, raw)| {
            let text = raw.text(piece.text());
            self.program.language().faults(text, number == 0)
        });
        if faults.is_empty() {
            faults.push(first.clone());
        }
        for error in faults {
            if self.is_full(Severity::Error) {
                continue;
            }
            self.found.push(Fault {
                message: error.message,
                severity: Severity::Error,
                block: number,
                span: error.span(line),
                help: error.help.unwrap_or(error.message.remedy()),
                detail: error.detail,
            });
        }
    }

    /// The labels of cycle 14: one fault names all that are missing, so that a long list is read once.
    fn subcontours(&mut self, block: u32, labels: &[u16]) {
        if labels.contains(&0) {
            self.called(block, 0, "14.1");
        }
        let is_missing = |label: &&u16| **label != 0 && self.program.label(**label).is_none();
        let missing: BTreeSet<u16> = labels.iter().filter(is_missing).copied().collect();
        if missing.is_empty() {
            return;
        }
        let mut named: Vec<String> = missing.iter().take(LABELS_NAMED).map(u16::to_string).collect();
        if missing.len() > LABELS_NAMED {
            named.push(format!("and {} more", missing.len() - LABELS_NAMED));
        }
        let plural = if missing.len() > 1 { "s" } else { "" };
        let detail = format!("no block sets label{plural} {}", named.join(", "));
        self.error(LabelNumberNotAllocated, block, "14.1", &detail);
    }

    /// A label that is called or jumped to.
    fn called(&mut self, block: u32, label: u16, address: &str) {
        if label == 0 {
            self.error(
                JumpToLabelZeroNotPermitted,
                block,
                address,
                "label 0 only ends subprograms",
            );
        } else if self.program.label(label).is_none() {
            self.error(
                LabelNumberNotAllocated,
                block,
                address,
                &format!("no block sets label {label}"),
            );
        }
    }

    fn sequence_fault(&mut self, fault: SequenceFault) {
        self.error(CyclIncomplete, fault.block, "", &fault.detail);
    }

    fn error(&mut self, message: MessageId, block: u32, address: &str, detail: &str) {
        self.at_word(message, Severity::Error, block, address, detail);
    }

    /// A diagnostic at the value after an address in a block; without it at the whole block.
    fn at_word(&mut self, message: MessageId, severity: Severity, block: u32, address: &str, detail: &str) {
        if !self.is_full(severity) {
            let found = self.program.diagnostic(message, severity, block, address, detail);
            self.found.push(found);
        }
    }

    /// Whether there is no room for another fault, which then is counted.
    fn is_full(&mut self, severity: Severity) -> bool {
        let full = self.found.len() >= MAX_DIAGNOSTICS;
        match severity {
            _ if !full => {}
            Severity::Error => self.more.errors += 1,
            Severity::Warning => self.more.warnings += 1,
        }
        full
    }

    /// A warning about the text that begins in a line.
    fn at_line(&mut self, block: u32, line: u32, detail: &str) {
        if self.is_full(Severity::Warning) {
            return;
        }
        let text = self.program.text_of_line(line);
        let (_, column, length) = locate(&text, "");
        self.found.push(Fault {
            message: UnexpectedText,
            severity: Severity::Warning,
            block,
            span: Span { line, column, length },
            detail: detail.into(),
            help: UnexpectedText.remedy(),
        });
    }
}

/// Line within the text of a block, column and length of the value after an address, or of the address
/// itself if that ends with its number; else of the code in the first line.
fn locate(text: &str, address: &str) -> (u32, u32, u32) {
    let lines = || lines(text.as_bytes()).map(|line| std::str::from_utf8(line).unwrap_or_default());
    if !address.is_empty() {
        for (number, line) in lines().enumerate() {
            if let Some((column, length)) = locate_in_line(line, address) {
                return (number as u32, column, length);
            }
        }
    }
    let first = lines().next().unwrap_or_default();
    let code = first
        .split(';')
        .next()
        .filter(|code| !code.trim().is_empty())
        .unwrap_or(first);
    let code = String::from_utf8_lossy(trim_continuation(code.as_bytes())).into_owned();
    let blanks = code
        .chars()
        .take_while(|c| c.is_ascii_whitespace() || c.is_ascii_control())
        .count();
    let length = code.chars().count().saturating_sub(blanks).max(1);
    (0, blanks as u32 + 1, length as u32)
}

fn locate_in_line(line: &str, address: &str) -> Option<(u32, u32)> {
    let line: Vec<char> = line.chars().map(|c| c.to_ascii_uppercase()).collect();
    let address: Vec<char> = address.chars().collect();
    let own_number = address.last().is_some_and(char::is_ascii_digit);
    (0..line.len()).find_map(|start| {
        let rest = line.get(start..)?.strip_prefix(address.as_slice())?;
        let before = start.checked_sub(1).and_then(|before| line.get(before));
        if before.is_some_and(char::is_ascii_alphabetic)
            && address.first().is_some_and(char::is_ascii_alphabetic)
        {
            // Only the I of incremental words may touch an address.
            if before != Some(&'I') {
                return None;
            }
        }
        let blanks = rest
            .iter()
            .take_while(|c| c.is_ascii_whitespace() || **c == '=')
            .count();
        let value = rest
            .get(blanks..)?
            .iter()
            .take_while(|c| is_of_value(**c))
            .count();
        let address_start = start as u32 + 1;
        if own_number && value == 0 {
            return Some((address_start, address.len() as u32));
        }
        let value_start = address_start + (address.len() + blanks) as u32;
        (value > 0).then_some((value_start, value as u32))
    })
}

fn is_of_value(c: char) -> bool {
    c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | ',' | 'Q')
}
