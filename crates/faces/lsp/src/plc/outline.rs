//! Outline and folding: modules by their labels, fields, structures, comments.

use bahn_plc::{LineOperand, Nesting, nesting, split_comment};

use super::PlcSource;
use crate::language::{Fold, Symbol, SymbolKind};

/// Labels and fields, each up to the next.
pub(super) fn symbols(source: &PlcSource) -> Vec<Symbol> {
    let mut symbols: Vec<Symbol> = Vec::new();
    for (_, line, words) in source.words() {
        let kind = match words.instruction {
            "LBL" => SymbolKind::Label,
            "KFIELD" => SymbolKind::Field,
            "USES" => SymbolKind::Program,
            _ => continue,
        };
        let name = match &words.operand {
            LineOperand::Label(name) | LineOperand::File(name) | LineOperand::Field(name) => name.clone(),
            LineOperand::Module(number) => number.to_string(),
            _ => continue,
        };
        if let Some(last) = symbols.last_mut().filter(|last| last.kind != SymbolKind::Program) {
            last.range.end = line.bytes.start.saturating_sub(1).max(last.selection.end);
        }
        let comment = split_comment(source.text.get(line.bytes.clone())).1;
        symbols.push(Symbol {
            name: format!("{} {name}", words.instruction),
            detail: comment.trim_start_matches(';').trim().to_owned(),
            kind,
            range: line.bytes.clone(),
            selection: line.bytes.clone(),
            children: Vec::new(),
        });
    }
    if let Some(last) = symbols.last_mut().filter(|last| last.kind != SymbolKind::Program) {
        last.range.end = source.text.text.len();
    }
    symbols
}

pub(super) fn folds(source: &PlcSource) -> Vec<Fold> {
    let mut folds = Vec::new();
    let mut open = Vec::new();
    let mut module = None;
    for (number, _, words) in source.words() {
        match nesting(words.instruction) {
            Nesting::Opens => open.push(number),
            Nesting::Closes => folds.extend(open.pop().map(|first| fold(first, number))),
            Nesting::Both => {
                folds.extend(open.pop().map(|first| fold(first, number.saturating_sub(1))));
                open.push(number);
            }
            Nesting::Neither => {}
        }
        match words.instruction {
            "LBL" if module.is_none() => module = Some(number),
            "EM" => folds.extend(module.take().map(|first| fold(first, number))),
            _ => {}
        }
    }
    let is_comment = |line: &super::Line| source.text.get(line.bytes.clone()).trim_start().starts_with(';');
    let mut number = 0;
    for run in source.lines.chunk_by(|a, b| is_comment(a) == is_comment(b)) {
        if run.first().is_some_and(is_comment) && run.len() > 1 {
            folds.push(Fold {
                first: number,
                last: number + run.len() - 1,
                is_comment: true,
            });
        }
        number += run.len();
    }
    folds.sort_by_key(|fold| fold.first);
    folds
}

fn fold(first: usize, last: usize) -> Fold {
    Fold {
        first,
        last,
        is_comment: false,
    }
}
