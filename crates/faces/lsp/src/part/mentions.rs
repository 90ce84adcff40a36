//! Labels, Q parameters, tools and programs that a program names.

use std::ops::Range;

use bahn_program::{CycleBlock, CycleWord, Operation, WordKind, WordSpan};

use super::{PROGRAM_CYCLE, PartProgram, ReadBlock};
use crate::language::{Mention, Role, Thing};

pub(super) fn mentions(program: &PartProgram) -> Vec<Mention> {
    let mut found = Vec::new();
    for block in program.each() {
        let mut finder = Finder {
            program,
            block: &block,
            found: &mut found,
        };
        match program.is_iso() {
            false => finder.plain(),
            true => finder.iso(),
        }
        finder.parameters();
    }
    found.sort_by_key(|mention| (mention.range.start, mention.range.end));
    found.dedup();
    found
}

struct Finder<'a> {
    program: &'a PartProgram,
    block: &'a ReadBlock<'a>,
    found: &'a mut Vec<Mention>,
}

impl Finder<'_> {
    fn text(&self, range: &Range<usize>) -> &str {
        self.program.text.get(range.clone())
    }

    /// The words after the one that opens the block, and that one in capitals, without its numbers.
    fn opened(&self) -> Option<(String, &[WordSpan])> {
        let place = self
            .block
            .words
            .iter()
            .position(|word| word.kind == WordKind::Function)?;
        let word = self.block.words.get(place)?;
        let end = match word.value.is_empty() {
            true => word.span.end,
            false => word.value.start,
        };
        let after = self.block.words.get(place + 1..)?;
        Some((self.program.capitals(&(word.span.start..end)), after))
    }

    fn plain(&mut self) {
        let Some((function, words)) = self.opened() else {
            return;
        };
        let words = words.to_vec();
        match function.as_str() {
            "LBL" => self.label(words.first(), Role::Sets),
            "CALL LBL" => self.label(words.first(), Role::Uses),
            "FN" => {
                let jump = words.iter().find(|word| self.starts(word, "LBL"));
                self.label(jump, Role::Uses);
            }
            "TOOL DEF" => self.tool(words.first(), Role::Sets),
            "TOOL CALL" => {
                let number = words.first().filter(|word| word.kind == WordKind::Value);
                self.tool(number, Role::Uses);
            }
            "CALL PGM" => {
                let name: Vec<_> = words
                    .iter()
                    .filter(|word| word.kind != WordKind::Comment)
                    .collect();
                if let (Some(first), Some(last)) = (name.first(), name.last()) {
                    self.file(first.span.start..last.span.end);
                }
            }
            "CYCL DEF" => self.cycle(&words),
            _ => {}
        }
    }

    /// Labels of a contour, the program of cycle 12.
    fn cycle(&mut self, words: &[WordSpan]) {
        let Operation::Cycle(cycle) = &self.block.operation else {
            return;
        };
        let has = |what: fn(&CycleWord) -> bool| cycle.words.iter().any(what);
        if has(|word| matches!(word, CycleWord::Labels(_))) {
            let values = words.iter().filter(|word| word.kind != WordKind::Comment);
            values.for_each(|word| self.label(Some(word), Role::Uses));
        } else if (cycle.number, cycle.sub) == PROGRAM_CYCLE {
            let named = words.iter().find(|word| !word.value.is_empty());
            let named = named.or(words.iter().find(|word| word.kind == WordKind::Text));
            if let Some(word) = named {
                let name = if word.value.is_empty() {
                    &word.span
                } else {
                    &word.value
                };
                self.file(name.clone());
            }
        }
    }

    fn iso(&mut self) {
        let words = &self.block.words;
        let functions: Vec<String> = words
            .iter()
            .filter(|word| word.kind == WordKind::Function)
            .map(|word| self.program.capitals(&word.span))
            .collect();
        let has = |name: &str| functions.iter().any(|function| function == name);
        let calls = self
            .block
            .operation
            .parts()
            .iter()
            .any(|part| matches!(part, Operation::CallLabel { .. }));
        let jumps = self
            .block
            .operation
            .parts()
            .iter()
            .any(|part| matches!(part, Operation::Jump { .. }));
        let (sets_label, defines, contour, program) = (has("G98"), has("G99"), has("G37"), has("G39"));
        let is_frame = matches!(self.block.operation, Operation::Begin(_) | Operation::End(_));
        for word in words.clone() {
            let address = self
                .program
                .capitals(&(word.span.start..word.value.start.max(word.span.start)));
            match address.as_str() {
                "L" if sets_label => self.label(Some(&word), Role::Sets),
                "L" if calls => self.label(Some(&word), Role::Uses),
                "P03" | "P3" if jumps => self.label(Some(&word), Role::Uses),
                "P01" if program => self.file(word.value.clone()),
                "T" => self.tool(Some(&word), if defines { Role::Sets } else { Role::Uses }),
                "%" if !is_frame => self.file(word.value.clone()),
                _ if contour && address.starts_with('P') => self.label(Some(&word), Role::Uses),
                _ => {}
            }
        }
    }

    /// Q parameters anywhere in the block.
    fn parameters(&mut self) {
        let end = self.block.place.bytes.end;
        let targets = targets(&self.block.operation);
        let words = self
            .block
            .words
            .iter()
            .filter(|word| word.kind != WordKind::Comment);
        let mut spans: Vec<Range<usize>> = Vec::new();
        for word in words.filter(|word| word.kind != WordKind::Number) {
            for (at, number) in parameters_in(self.text(&word.span)) {
                spans.push(word.span.start + at.start..word.span.start + at.end);
                let range = word.span.start + at.start..word.span.start + at.end;
                let assigned = self.text(&(range.end..end)).trim_start().starts_with('=');
                // The first parameter of D00 to D08 takes the result.
                let is_first =
                    spans.len() == 1 && is_calculation(&self.block.operation) && self.program.is_iso();
                let role = match assigned || is_first || targets.contains(&number) {
                    true => Role::Sets,
                    false => Role::Uses,
                };
                self.push(range, Thing::Q(number), role);
            }
        }
    }

    fn starts(&self, word: &WordSpan, address: &str) -> bool {
        self.program.capitals(&word.span).starts_with(address)
    }

    /// The label number in a word: its value, up to the repetitions of DIN/ISO.
    fn label(&mut self, word: Option<&WordSpan>, role: Role) {
        self.number(
            word,
            |number| {
                u16::try_from(number)
                    .ok()
                    .filter(|label| *label > 0)
                    .map(Thing::Label)
            },
            role,
        );
    }

    fn tool(&mut self, word: Option<&WordSpan>, role: Role) {
        self.number(word, |number| Some(Thing::Tool(number)), role);
    }

    fn number(&mut self, word: Option<&WordSpan>, thing: impl Fn(u32) -> Option<Thing>, role: Role) {
        let Some(word) = word else { return };
        let text = self.text(&word.value);
        let skipped = text.len() - text.trim_start().len();
        let digits = text.trim_start().bytes().take_while(u8::is_ascii_digit).count();
        let start = word.value.start + skipped;
        let range = start..start + digits;
        if let Some(thing) = self.text(&range).parse().ok().and_then(thing) {
            self.push(range, thing, role);
        }
    }

    fn file(&mut self, range: Range<usize>) {
        let text = self.text(&range);
        let name = text.trim().to_owned();
        let start = range.start + text.len() - text.trim_start().len();
        if !name.is_empty() {
            self.push(start..start + name.len(), Thing::File(name), Role::Uses);
        }
    }

    fn push(&mut self, range: Range<usize>, thing: Thing, role: Role) {
        self.found.push(Mention { range, thing, role });
    }
}

/// The parameters into which cycles and probe functions put their results.
fn targets(operation: &Operation) -> Vec<u16> {
    let of = |block: &CycleBlock| {
        let words = block.words.iter().filter_map(|word| match word {
            CycleWord::Target(number) => Some(*number),
            _ => None,
        });
        words.collect()
    };
    match operation {
        Operation::Probe(block) | Operation::Cycle(block) => of(block),
        _ => Vec::new(),
    }
}

fn is_calculation(operation: &Operation) -> bool {
    operation
        .parts()
        .iter()
        .any(|part| matches!(part, Operation::Calculate { .. }))
}

/// `Q5` in a text, with its number; letters before it belong to another word but for an address.
fn parameters_in(text: &str) -> Vec<(Range<usize>, u16)> {
    let bytes = text.as_bytes();
    let mut found = Vec::new();
    for (at, byte) in bytes.iter().enumerate() {
        if !byte.eq_ignore_ascii_case(&b'Q') {
            continue;
        }
        let digits = bytes
            .iter()
            .skip(at + 1)
            .take_while(|byte| byte.is_ascii_digit())
            .count();
        let end = at + 1 + digits;
        if let Some(number) = text.get(at + 1..end).and_then(|digits| digits.parse().ok()) {
            found.push((at..end, number));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_found_after_addresses_and_signs() {
        let numbers = |text: &str| {
            parameters_in(text)
                .into_iter()
                .map(|(_, number)| number)
                .collect::<Vec<_>>()
        };
        assert_eq!(numbers("IX-Q5"), [5]);
        assert_eq!(numbers("Q1 * q22 + Q"), [1, 22]);
        assert_eq!(numbers("EQU Q99999999"), [0; 0]);
    }
}
