//! Outline and folding: subprograms, tools, cycles, sections.

use std::ops::Range;

use bahn_program::{CycleFunction, Operation, cycle};

use super::{PartProgram, ReadBlock};
use crate::language::{Fold, Symbol, SymbolKind};

pub(super) fn symbols(program: &PartProgram) -> Vec<Symbol> {
    let mut flat = Vec::new();
    let mut last_cycle = None;
    for block in program.each() {
        let own = cycle_number(&block.operation);
        if own.is_none() || own != last_cycle {
            flat.extend(symbol(program, &block));
        } else if let Some(cycle) = flat
            .last_mut()
            .filter(|last: &&mut Symbol| last.kind == SymbolKind::Cycle)
        {
            cycle.range.end = block.place.bytes.end;
        }
        last_cycle = own;
    }
    let end = program.text.text.len();
    let Some(name) = program.program.begin().map(|begin| begin.name.to_string()) else {
        return nested(flat, end);
    };
    let first = program
        .blocks
        .first()
        .map(|first| first.bytes.clone())
        .unwrap_or_default();
    vec![Symbol {
        name: format!("PGM {name}"),
        detail: format!("{} blocks", program.program.block_count()),
        kind: SymbolKind::Program,
        range: first.start..end,
        selection: first.clone(),
        children: nested(flat, end),
    }]
}

/// Labels hold what follows up to the next label; sections and tools do so inside of them.
fn nested(flat: Vec<Symbol>, end: usize) -> Vec<Symbol> {
    let is_label = |symbol: &Symbol| symbol.kind == SymbolKind::Label;
    let mut top: Vec<Symbol> = Vec::new();
    for symbol in flat {
        let ends_label = is_label(&symbol) && symbol.name.ends_with(" 0");
        match top
            .last_mut()
            .filter(|last| is_label(last) && last.range.end == 0)
        {
            Some(open) if ends_label => open.range.end = symbol.range.end,
            Some(open) if !is_label(&symbol) => open.children.push(symbol),
            Some(open) => {
                // A label without LBL 0 before the next one: what is repeated.
                open.range.end = symbol.range.start;
                top.push(opened(symbol));
            }
            None if ends_label => {}
            None if is_label(&symbol) => top.push(opened(symbol)),
            None => top.push(symbol),
        }
    }
    if let Some(open) = top
        .last_mut()
        .filter(|last| is_label(last) && last.range.end == 0)
    {
        open.range.end = end;
    }
    top
}

/// A label whose end is not known yet.
fn opened(symbol: Symbol) -> Symbol {
    Symbol {
        range: symbol.range.start..0,
        ..symbol
    }
}

fn symbol(program: &PartProgram, block: &ReadBlock<'_>) -> Option<Symbol> {
    let bytes = block.place.bytes.clone();
    let text = program.text.get(bytes.clone());
    let comment = text.split_once(';').map_or("", |(_, comment)| comment.trim());
    let parts = block.operation.parts();
    let (name, detail, kind) = parts.iter().find_map(|part| match part {
        Operation::Label(number) => Some((format!("LBL {number}"), comment.to_owned(), SymbolKind::Label)),
        Operation::ToolCall { tool: Some(_), .. } => {
            Some((capital_line(program, block), comment.to_owned(), SymbolKind::Tool))
        }
        Operation::Cycle(own) if own.sub == 0 || program.is_iso() => {
            let name = cycle(CycleFunction::Definition, own.number).map_or("", |cycle| cycle.name);
            Some((
                format!("CYCL DEF {} {name}", own.number),
                String::new(),
                SymbolKind::Cycle,
            ))
        }
        Operation::CallProgram(name) => {
            Some((format!("CALL PGM {name}"), String::new(), SymbolKind::Program))
        }
        Operation::Comment(_) => {
            let section = text
                .trim_start()
                .trim_start_matches(|c: char| c.is_ascii_digit())
                .trim_start();
            let title = section
                .strip_prefix('*')?
                .trim_start_matches([' ', '-', '*'])
                .trim();
            (!title.is_empty()).then(|| (title.to_owned(), String::new(), SymbolKind::Section))
        }
        _ => None,
    })?;
    Some(Symbol {
        name,
        detail,
        kind,
        range: bytes.clone(),
        selection: bytes,
        children: Vec::new(),
    })
}

/// The block without number and comment.
fn capital_line(program: &PartProgram, block: &ReadBlock<'_>) -> String {
    use bahn_program::WordKind::{Comment, Number};
    let code = block
        .words
        .iter()
        .filter(|word| !matches!(word.kind, Number | Comment));
    let spans: Vec<&Range<usize>> = code.map(|word| &word.span).collect();
    match (spans.first(), spans.last()) {
        (Some(first), Some(last)) => program.capitals(&(first.start..last.end)),
        _ => String::new(),
    }
}

/// The cycle or probe function to which a block belongs.
fn cycle_number(operation: &Operation) -> Option<(bool, u16)> {
    match operation {
        Operation::Cycle(block) => Some((false, block.number)),
        Operation::Probe(block) => Some((true, block.number)),
        _ => None,
    }
}

pub(super) fn folds(program: &PartProgram) -> Vec<Fold> {
    let mut folds = Vec::new();
    let mut runs = Runs::default();
    let mut label = None;
    let mut tool = None;
    for block in program.each() {
        let bytes = &block.place.bytes;
        let (first, last) = (program.line_of(bytes.start), program.line_of(bytes.end));
        if first < last {
            folds.push(fold(first, last));
        }
        runs.take(&block, first, last, &mut folds);
        let calls_tool = block
            .operation
            .parts()
            .iter()
            .any(|part| matches!(part, Operation::ToolCall { tool: Some(_), .. }));
        let sets_label = block.operation.parts().iter().find_map(|part| match part {
            Operation::Label(number) => Some(*number),
            _ => None,
        });
        let ends = matches!(block.operation, Operation::End(_));
        if (calls_tool || ends || sets_label.is_some_and(|number| number > 0))
            && let Some(start) = tool.take()
        {
            folds.push(fold(start, first.saturating_sub(1)));
        }
        match sets_label {
            Some(0) => folds.extend(label.take().map(|start| fold(start, last))),
            Some(_) => label = Some(first),
            None if calls_tool => tool = Some(first),
            None => {}
        }
    }
    runs.end(&mut folds);
    folds.sort_by_key(|fold| (fold.first, std::cmp::Reverse(fold.last)));
    folds.dedup_by_key(|fold| fold.first);
    folds
}

fn fold(first: usize, last: usize) -> Fold {
    Fold {
        first,
        last,
        is_comment: false,
    }
}

/// Blocks of one cycle, or comments, one after the other.
#[derive(Default)]
struct Runs {
    open: Option<(Run, usize, usize)>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Run {
    Cycle { is_probe: bool, number: u16 },
    Comment,
}

impl Runs {
    fn take(&mut self, block: &ReadBlock<'_>, first: usize, last: usize, folds: &mut Vec<Fold>) {
        let own = match (&block.operation, cycle_number(&block.operation)) {
            (_, Some((is_probe, number))) => Some(Run::Cycle { is_probe, number }),
            (Operation::Comment(_), None) => Some(Run::Comment),
            _ => None,
        };
        match (&mut self.open, own) {
            (Some((run, _, end)), Some(own)) if *run == own => *end = last,
            (_, own) => {
                self.end(folds);
                self.open = own.map(|run| (run, first, last));
            }
        }
    }

    fn end(&mut self, folds: &mut Vec<Fold>) {
        if let Some((run, first, last)) = self.open.take()
            && first < last
        {
            folds.push(Fold {
                first,
                last,
                is_comment: run == Run::Comment,
            });
        }
    }
}
