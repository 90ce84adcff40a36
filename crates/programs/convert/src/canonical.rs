//! What of operations counts: names beside the words of a cycle are decoration and differ between languages.

use bahn_program::{
    CycleBlock, CycleFunction, CycleWord, Operation, Quantity, Value, cycle, cycle_parameters,
};

/// Number of the datum shift, whose words may stand in one block or in several.
const DATUM_SHIFT: u16 = 7;

/// The operations without decoration, to be compared.
pub(crate) fn canonical(operations: &[Operation]) -> Vec<Operation> {
    let mut bare: Vec<Operation> = operations.iter().map(without_names).collect();
    let shift = |operation: &Operation| match operation {
        Operation::Cycle(block) => block.number == DATUM_SHIFT,
        _ => false,
    };
    if bare.len() > 1 && bare.iter().all(shift) {
        bare = one_shift(&bare);
    }
    assigned(&bare).map_or(bare, |block| vec![Operation::Cycle(Box::new(block))])
}

/// Parameters that stand in one block of a cycle definition in listings of plain language [000:17958-17962].
const ASSIGNMENTS_PER_BLOCK: usize = 3;

/// The blocks of a cycle whose words are values of Q parameters, as one: DIN/ISO has them in one block, plain language in
/// several.
fn assigned(blocks: &[Operation]) -> Option<CycleBlock> {
    let mut all: Option<CycleBlock> = None;
    for operation in blocks {
        let Operation::Cycle(block) = operation else {
            return None;
        };
        let all = all.get_or_insert_with(|| CycleBlock {
            number: block.number,
            sub: 0,
            words: Vec::new(),
        });
        let assigns = |word: &CycleWord| matches!(word, CycleWord::Assignment(..));
        if block.number != all.number || !block.words.iter().all(assigns) {
            return None;
        }
        all.words.extend(block.words.iter().cloned());
    }
    all.filter(|all| !all.words.is_empty())
}

/// The blocks of plain language for one of DIN/ISO with values of Q parameters; other operations are themselves.
pub(crate) fn spread(operation: Operation) -> Vec<Operation> {
    let one = std::slice::from_ref(&operation);
    let Some(all) = assigned(one).filter(|all| all.number < ONE_BLOCK_FROM) else {
        return vec![operation];
    };
    let block = |(words, sub): (&[CycleWord], u16)| {
        Operation::Cycle(Box::new(CycleBlock {
            number: all.number,
            sub,
            words: words.to_vec(),
        }))
    };
    let values = all.words.chunks(ASSIGNMENTS_PER_BLOCK).zip(1..);
    std::iter::once((&[][..], 0)).chain(values).map(block).collect()
}

/// Cycles from here on have their parameters in block 0 in plain language, too (public: later controls).
const ONE_BLOCK_FROM: u16 = 200;

/// Without the names beside the words of a cycle.
pub(crate) fn without_names(operation: &Operation) -> Operation {
    let bare = |function, block: &CycleBlock| {
        let mut block = block.clone();
        let named = cycle_parameters(function, block.number, block.sub);
        let program = named.iter().any(|of| of.quantity == Quantity::Program) && block.sub > 0;
        block.words.retain(|word| match word {
            CycleWord::Text(text) => program || says(text),
            _ => true,
        });
        Box::new(block)
    };
    match operation {
        Operation::Cycle(block) => Operation::Cycle(bare(CycleFunction::Definition, block)),
        Operation::Probe(block) => Operation::Probe(bare(CycleFunction::Probe, block)),
        other => other.clone(),
    }
}

/// Texts that are no decoration: an incremental rotation, the line of a datum table.
fn says(text: &str) -> bool {
    matches!(text, "IROT" | "#")
}

/// The words of a datum shift in one block, in the order of the axes.
fn one_shift(blocks: &[Operation]) -> Vec<Operation> {
    let words = blocks.iter().flat_map(|operation| match operation {
        Operation::Cycle(block) => block.words.clone(),
        _ => Vec::new(),
    });
    let mut words: Vec<CycleWord> = words.collect();
    words.sort_by_key(|word| match word {
        CycleWord::Coordinate(axis, _) => axis.index(),
        _ => 0,
    });
    vec![Operation::Cycle(Box::new(CycleBlock {
        number: DATUM_SHIFT,
        sub: 0,
        words,
    }))]
}

/// With the names that a listing in plain language has beside the words of cycles.
pub(crate) fn decorated(operation: Operation) -> Operation {
    match operation {
        Operation::Cycle(block) => Operation::Cycle(named(CycleFunction::Definition, block)),
        Operation::Probe(block) => Operation::Probe(named(CycleFunction::Probe, block)),
        other => other,
    }
}

fn named(function: CycleFunction, mut block: Box<CycleBlock>) -> Box<CycleBlock> {
    let Some(known) = cycle(function, block.number) else {
        return block;
    };
    if block.sub == 0 {
        block.words.insert(0, CycleWord::Text(known.name.into()));
        return block;
    }
    let mut parameters = known.block(block.sub).iter();
    let mut words = Vec::with_capacity(2 * block.words.len());
    for word in std::mem::take(&mut block.words) {
        let taken = parameters.find(|parameter| match &word {
            CycleWord::Number(Value::Number(_) | Value::Q { .. }) => parameter.quantity.is_number(),
            CycleWord::Labels(_) => parameter.quantity == Quantity::Labels,
            _ => true,
        });
        let nameless = matches!(word, CycleWord::Number(_) | CycleWord::Labels(_));
        if let Some(parameter) = taken.filter(|parameter| nameless && !parameter.name.is_empty())
            && !matches!(words.last(), Some(CycleWord::Text(_)))
        {
            words.push(CycleWord::Text(parameter.name.into()));
        }
        words.push(word);
    }
    block.words = words;
    block
}
