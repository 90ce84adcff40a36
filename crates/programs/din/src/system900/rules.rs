//! What the words of a block may be beside each other.
//!
//! Decision: A word of a `.900` program stands once in a block, and so does one G function of each group, as the control
//! keeps one of each (P9340 ff.); M0, M1, M2, M6, M16, M26 and M30 take no target

use super::block::{Block, MFunction, Word, WordKind};
use super::table;
use crate::line::{LineFault, fault_at};

/// Fields of the block information: most G, M and S words of a block [002:5177-5228].
const MAX_EACH: usize = 8;

/// What is wrong with a block beside what is wrong with its words.
pub(super) fn faults(block: &Block) -> Vec<LineFault> {
    let mut faults = Vec::new();
    let words = &block.words;
    for (index, word) in words.iter().enumerate() {
        let before = words.get(..index).unwrap_or_default();
        let found = match &word.kind {
            WordKind::G(number) => beside(*number, before),
            WordKind::M(function) => extensions(*function),
            WordKind::Jump(_) if words.len() > 1 => Some("a condition stands alone in its block".to_owned()),
            _ => None,
        };
        let found = found
            .or_else(|| twice(word, before))
            .or_else(|| too_many(word, before));
        faults.extend(found.map(|message| at(word, message)));
    }
    faults.extend(dwell(words));
    faults
}

/// A fault of a word.
fn at(word: &Word, message: String) -> LineFault {
    fault_at(word.span.column, word.span.length, message)
}

/// A G function beside others of the block.
fn beside(number: u16, before: &[Word]) -> Option<String> {
    let row = table::g_function(number)?;
    let others = before.iter().filter_map(|word| match word.kind {
        WordKind::G(other) => Some(other),
        _ => None,
    });
    let excludes = |other: &u16| table::g_function(*other).is_some_and(|other| row.shares_group(other));
    let first = others
        .clone()
        .find(|other| *other == number)
        .or_else(|| others.clone().find(excludes))?;
    Some(match first == number {
        true => format!("G{number} stands twice in the block"),
        false => format!("G{number} beside G{first}: one of them counts in a block"),
    })
}

/// The extensions that an M function of the control takes [002:3884-3887] [002:4892-4893].
fn extensions(function: MFunction) -> Option<String> {
    let MFunction {
        number,
        target,
        count,
    } = function;
    match (number, target, count) {
        (22, Some(_), None) | (24, Some(_), Some(_)) => None,
        (22, ..) => Some("M22 needs its target alone, as in `M22.200`".to_owned()),
        (24, ..) => Some("M24 needs its target and how often, as in `M24.110.5`".to_owned()),
        (_, Some(_), _) if table::m_function(number).is_some() => Some(format!("M{number} takes no target")),
        _ => None,
    }
}

/// A word that has said before what it says.
fn twice(word: &Word, before: &[Word]) -> Option<String> {
    let name = match &word.kind {
        WordKind::Axis(axis, _) => axis.to_string(),
        WordKind::Feed(_) => "F".to_owned(),
        WordKind::Speed(1, _) => "S".to_owned(),
        WordKind::Speed(spindle, _) => format!("S{spindle}"),
        WordKind::Tool(_) => "T".to_owned(),
        WordKind::Radius(_) => "R".to_owned(),
        WordKind::Centre(index, _) => ["I", "J", "K"].get(usize::from(*index))?.to_string(),
        _ => return None,
    };
    if before.iter().any(|other| is_same(&other.kind, &word.kind)) {
        return Some(format!("{name} stands twice in the block"));
    }
    let is_centre = |word: &Word| matches!(word.kind, WordKind::Centre(..));
    let is_radius = |word: &Word| matches!(word.kind, WordKind::Radius(_));
    let both =
        is_centre(word) && before.iter().any(is_radius) || is_radius(word) && before.iter().any(is_centre);
    both.then(|| "the circle has its radius and its centre: one of them counts".to_owned())
}

/// Whether two words set the same.
fn is_same(one: &WordKind, other: &WordKind) -> bool {
    match (one, other) {
        (WordKind::Axis(a, _), WordKind::Axis(b, _)) => a == b,
        (WordKind::Speed(a, _), WordKind::Speed(b, _)) | (WordKind::Centre(a, _), WordKind::Centre(b, _)) => {
            a == b
        }
        (WordKind::Feed(_), WordKind::Feed(_))
        | (WordKind::Tool(_), WordKind::Tool(_))
        | (WordKind::Radius(_), WordKind::Radius(_)) => true,
        _ => false,
    }
}

/// The ninth G, M or S word.
fn too_many(word: &Word, before: &[Word]) -> Option<String> {
    let letter = letter(word)?;
    let same = before.iter().filter(|other| self::letter(other) == Some(letter));
    (same.count() >= MAX_EACH).then(|| format!("more than {MAX_EACH} {letter} words in a block"))
}

fn letter(word: &Word) -> Option<char> {
    match word.kind {
        WordKind::G(_) => Some('G'),
        WordKind::M(_) => Some('M'),
        WordKind::Speed(..) => Some('S'),
        _ => None,
    }
}

/// G4 has one time, by X or F, and nothing that moves (inferred).
fn dwell(words: &[Word]) -> Vec<LineFault> {
    let Some(dwell) = words.iter().find(|word| word.kind == WordKind::G(4)) else {
        return Vec::new();
    };
    let mut times = 0;
    let mut faults = Vec::new();
    for word in words {
        match &word.kind {
            WordKind::Feed(_) => times += 1,
            WordKind::Axis(axis, _) if axis.letter == 'X' && axis.extension == 0 => times += 1,
            WordKind::Axis(axis, _) => faults.push(at(word, format!("G4 moves no axis: {axis} beside it"))),
            _ => {}
        }
    }
    if times != 1 {
        faults.push(at(dwell, "G4 needs its time once: `G4 X2` or `G4 F2`".to_owned()));
    }
    faults
}
