//! A block: the words of a line.

use std::sync::Arc;

use bahn_path::Axis;

use crate::command::{self, Order};
use crate::cursor::Cursor;
use crate::expression::{
    Expression, Reference, expression, is_function, parameter_number, reference, variable_begins,
};
use crate::line::{Glyph, LineFault, Macros, fault_at, quoted};
use crate::unit::FunctionLetter;

/// What a line orders, as it is read.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Block {
    pub words: Vec<Word>,
}

/// A word and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct Word {
    pub column: u32,
    pub length: u32,
    pub kind: WordKind,
}

/// Words are the same when they say the same, wherever they stand.
impl PartialEq for Word {
    fn eq(&self, other: &Word) -> bool {
        self.kind == other.kind
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum WordKind {
    /// G function, one of [`G_FUNCTIONS`].
    G(u16),
    /// Coordinate of an axis.
    Axis(Axis, Expression),
    /// `X[..]` with functions of the axis.
    AxisBracket(Axis, Vec<Word>),
    /// `S2[..]` with functions of the spindle.
    SpindleBracket(Arc<str>, Vec<Word>),
    /// M or H function with its additive value.
    Function(FunctionLetter, Expression, Option<Expression>),
    /// Spindle speed: `S1000`, in brackets `REV1000`.
    Speed(Expression),
    /// `POS` of a spindle or of an axis on its own.
    Place(Expression),
    /// Feed: F, in brackets `FEED`.
    Feed(Expression),
    /// `INDP`: the axis moves on its own.
    Independent,
    /// I, J, K, by 0, 1, 2: centre of a circle.
    Centre(usize, Expression),
    /// R: radius of a circle.
    Radius(Expression),
    /// A value without address after G04.
    Bare(Expression),
    SetParameter(Expression, Expression),
    SetVariable(Reference, Expression),
    /// `"NAME" = "TEXT"`: the name stands for the text in what follows.
    Define(String, String),
    /// `L name`, in the same file only `LL name` (public).
    Call {
        local: bool,
        name: String,
    },
    Command(Order),
}

/// G functions that are read, each with the number of its group: of one group one stands in a block.
/// G04, G107 and G108 act in their block only.
const G_FUNCTIONS: [(u16, u8); 15] = [
    (0, 0),
    (1, 0),
    (2, 0),
    (3, 0),
    (4, 0),
    (17, 1),
    (18, 1),
    (19, 1),
    (40, 2),
    (41, 2),
    (42, 2),
    (90, 3),
    (91, 3),
    (107, 4),
    (108, 4),
];

/// Most words of a block.
pub(crate) const MAX_WORDS: usize = 200;

/// The programmed number of a block without leading zeros, taken off the line. `None` without one.
pub(crate) fn number(line: &[Glyph]) -> (Option<Arc<str>>, &[Glyph]) {
    let mut cursor = Cursor::new(line);
    if !cursor.eat('N') {
        return (None, line);
    }
    cursor.skip_blanks();
    let digits = cursor.take_while(|c| c.is_ascii_digit());
    if digits.is_empty() {
        return (None, line);
    }
    let short = match digits.trim_start_matches('0') {
        "" => "0",
        short => short,
    };
    (Some(format!("N{short}").into()), cursor.rest())
}

/// The definitions of macros of a line: `"NAME" = "TEXT"`, one or more. `None` of another line.
pub(crate) fn definitions(line: &[Glyph]) -> Result<Option<Block>, LineFault> {
    let (_, line) = number(line);
    let mut cursor = Cursor::new(line);
    cursor.skip_blanks();
    if cursor.peek() != Some('"') {
        return Ok(None);
    }
    let mut words = Vec::new();
    while !cursor.is_done() {
        let mark = cursor.mark();
        if cursor.peek() != Some('"') {
            let word = cursor.word();
            return Err(cursor.fault(
                mark,
                format!("unknown word {word} beside the definition of a macro"),
            ));
        }
        let (name, end) = quoted(line, mark)?;
        cursor.advance(end - mark);
        if !cursor.eat('=') {
            // A macro that is used.
            return match words.is_empty() {
                true => Ok(None),
                false => Err(cursor.fault(
                    mark,
                    format!("macro \"{name}\" beside the definition of another one"),
                )),
            };
        }
        cursor.skip_blanks();
        let text = cursor.mark();
        if cursor.peek() != Some('"') {
            return Err(cursor.fault(mark, format!("macro \"{name}\" needs its text in quotes")));
        }
        let (value, end) = quoted(line, text)?;
        cursor.advance(end - text);
        let (column, length) = cursor.span(mark);
        words.push(Word {
            column,
            length,
            kind: WordKind::Define(name, value),
        });
    }
    Ok(Some(Block { words }))
}

/// Reads a line, whose macros are known.
pub(crate) fn read(line: &[Glyph], macros: &Macros) -> Result<Block, LineFault> {
    if let Some(definitions) = definitions(line)? {
        return Ok(definitions);
    }
    if let Some(label) = label(line) {
        return Err(label);
    }
    let (_, line) = number(line);
    let line = macros.expand(line)?;
    let mut cursor = Cursor::new(&line);
    let mut block = Block::default();
    while !cursor.is_done() {
        let mark = cursor.mark();
        let dwells = matches!(
            block.words.last(),
            Some(Word {
                kind: WordKind::G(4),
                ..
            })
        );
        let kind = word(&mut cursor, dwells)?;
        let (column, length) = cursor.span(mark);
        if block.words.len() >= MAX_WORDS {
            return Err(fault_at(
                column,
                length,
                format!("more than {MAX_WORDS} words in a block"),
            ));
        }
        block.words.push(Word { column, length, kind });
    }
    one_of_each_group(&block)?;
    Ok(block)
}

/// A number of a block that is a label: `N20:`.
fn label(line: &[Glyph]) -> Option<LineFault> {
    let (name, rest) = number(line);
    name?;
    let mut cursor = Cursor::new(line);
    cursor.skip_blanks();
    let mark = cursor.mark();
    cursor.go_to(line.len() - rest.len());
    let is_label = cursor.eat(':');
    is_label.then(|| cursor.fault(mark, format!("unknown word {} (a label)", cursor.text(mark))))
}

fn one_of_each_group(block: &Block) -> Result<(), LineFault> {
    let mut seen: Vec<(u8, u16)> = Vec::new();
    for word in &block.words {
        let WordKind::G(g) = word.kind else { continue };
        let Some(group) = group(g) else { continue };
        if let Some((_, first)) = seen.iter().find(|(other, _)| *other == group) {
            let message = format!("G{g:02} beside G{first:02}: one of them counts in a block");
            return Err(fault_at(word.column, word.length, message));
        }
        seen.push((group, g));
    }
    Ok(())
}

fn group(g: u16) -> Option<u8> {
    G_FUNCTIONS
        .iter()
        .find(|(known, _)| *known == g)
        .map(|(_, group)| *group)
}

/// One word of a block; `dwells` after G04, which takes a value without address.
fn word(cursor: &mut Cursor, dwells: bool) -> Result<WordKind, LineFault> {
    let mark = cursor.mark();
    let Some(first) = cursor.peek() else {
        return Err(cursor.fault(mark, "a word is missing"));
    };
    match first {
        '#' => return Ok(WordKind::Command(command::read(cursor)?)),
        '$' => return Err(cursor.unknown(mark, "control statement")),
        '0'..='9' | '.' | '+' | '-' | '[' | '\'' if dwells => return Ok(WordKind::Bare(expression(cursor)?)),
        '/' => return Err(cursor.fault(mark, "unknown word / (a block that may be skipped)")),
        '\\' => return Err(cursor.fault(mark, "unknown word \\ (a block of several lines)")),
        _ => {}
    }
    if variable_begins(cursor) {
        return variable(cursor, dwells);
    }
    let letters = cursor.letters();
    if let Some(call) = call(cursor, &letters)? {
        return Ok(call);
    }
    let mut ahead = cursor.clone();
    ahead.advance(letters.len());
    let alone = letters.len() == 1 || is_value(letters.get(1..).unwrap_or_default(), &mut ahead);
    if !alone || !first.is_ascii_alphabetic() {
        return Err(cursor.unknown(mark, "word"));
    }
    if first == 'P' && letters.len() == 1 {
        return parameter(cursor, dwells);
    }
    address(cursor, first)
}

/// Whether what stands after the first letter of an address is a value: `XP1`, `XV.G.RW`, `XSIN[30]`.
fn is_value(rest: &str, after: &mut Cursor) -> bool {
    match rest {
        "P" => after.peek().is_some_and(|c| c.is_ascii_digit() || c == '['),
        "V" => after.peek() == Some('.'),
        name => is_function(name),
    }
}

/// A word of an address and its value.
fn address(cursor: &mut Cursor, letter: char) -> Result<WordKind, LineFault> {
    let mark = cursor.mark();
    cursor.advance(1);
    match letter {
        'G' => g_function(cursor, mark),
        'M' => function(cursor, FunctionLetter::M),
        'H' => function(cursor, FunctionLetter::H),
        'S' => spindle(cursor, mark),
        'F' => Ok(WordKind::Feed(value(cursor)?)),
        'I' => Ok(WordKind::Centre(0, value(cursor)?)),
        'J' => Ok(WordKind::Centre(1, value(cursor)?)),
        'K' => Ok(WordKind::Centre(2, value(cursor)?)),
        'R' => Ok(WordKind::Radius(value(cursor)?)),
        _ => match u8::try_from(letter).ok().and_then(Axis::from_letter) {
            Some(axis) => coordinate(cursor, axis, mark),
            None => Err(cursor.unknown(mark, "word")),
        },
    }
}

/// A value after its address; `=` may stand between (inferred).
fn value(cursor: &mut Cursor) -> Result<Expression, LineFault> {
    cursor.eat('=');
    expression(cursor)
}

fn g_function(cursor: &mut Cursor, mark: usize) -> Result<WordKind, LineFault> {
    let digits = cursor.take_while(|c| c.is_ascii_digit());
    let ends = !matches!(cursor.peek(), Some('.' | '[' | '='));
    match digits.parse().ok().filter(|g| ends && group(*g).is_some()) {
        Some(g) => Ok(WordKind::G(g)),
        None => Err(cursor.unknown(mark, "G function")),
    }
}

/// M or H after its letter, with its additive value [004:105].
fn function(cursor: &mut Cursor, letter: FunctionLetter) -> Result<WordKind, LineFault> {
    let number = expression(cursor)?;
    let value = match cursor.eat('=') {
        true => Some(expression(cursor)?),
        false => None,
    };
    Ok(WordKind::Function(letter, number, value))
}

/// A coordinate, or in brackets functions of the axis [004:102]. What is neither M, H nor INDP is an expression (public).
fn coordinate(cursor: &mut Cursor, axis: Axis, mark: usize) -> Result<WordKind, LineFault> {
    cursor.skip_blanks();
    if cursor.peek() == Some('[') {
        let mut inside = cursor.clone();
        inside.advance(1);
        inside.skip_blanks();
        let name = inside.letters();
        let is_list = matches!(
            name.as_str(),
            "M" | "H" | "MP" | "HP" | "G" | "INDP" | "FEED" | "POS"
        );
        if is_list || inside.peek() == Some(']') {
            let words = list(cursor, axis.letter().to_string().as_str(), false)?;
            return Ok(WordKind::AxisBracket(axis, words));
        }
    }
    let mut ahead = cursor.clone();
    if !ahead.take_while(|c| c.is_ascii_digit()).is_empty() && ahead.eat('=') {
        return Err(cursor.unknown(mark, "axis"));
    }
    Ok(WordKind::Axis(axis, value(cursor)?))
}

/// S after its letter: a speed, or a spindle and its brackets [004:105] [004:162].
fn spindle(cursor: &mut Cursor, mark: usize) -> Result<WordKind, LineFault> {
    let mut ahead = cursor.clone();
    let digits = ahead.take_while(|c| c.is_ascii_digit());
    ahead.skip_blanks();
    match ahead.peek() {
        Some('[') => {
            cursor.advance(digits.len());
            let name = format!("S{digits}");
            let words = list(cursor, &name, true)?;
            Ok(WordKind::SpindleBracket(name.into(), words))
        }
        Some('=') if !digits.is_empty() => Err(cursor.unknown(mark, "word")),
        _ => Ok(WordKind::Speed(value(cursor)?)),
    }
}

/// The words of an axis or a spindle in brackets, parted by blanks [004:102-108].
fn list(cursor: &mut Cursor, of: &str, spindle: bool) -> Result<Vec<Word>, LineFault> {
    cursor.skip_blanks();
    let open = cursor.mark();
    cursor.advance(1);
    let mut words = Vec::new();
    while !cursor.eat(']') {
        if cursor.is_done() {
            return Err(cursor.fault(open, format!("bracket [ of {of} is not closed")));
        }
        let mark = cursor.mark();
        let kind = listed(cursor, of, spindle)?;
        let (column, length) = cursor.span(mark);
        if words.len() >= MAX_WORDS {
            return Err(fault_at(
                column,
                length,
                format!("more than {MAX_WORDS} words in the brackets of {of}"),
            ));
        }
        words.push(Word { column, length, kind });
    }
    match words.is_empty() {
        true => Err(cursor.fault(open, format!("the brackets of {of} are empty"))),
        false => Ok(words),
    }
}

fn listed(cursor: &mut Cursor, of: &str, spindle: bool) -> Result<WordKind, LineFault> {
    let mark = cursor.mark();
    let letters = cursor.letters();
    let mut ahead = cursor.clone();
    ahead.advance(letters.len());
    let takes = |cursor: &mut Cursor, name: &str| {
        cursor.advance(name.len());
        value(cursor)
    };
    // `REV1000`, `REV 1000`, `REVP1`.
    let keyword = |name: &str| letters == name || letters.strip_prefix(name) == Some("P");
    match letters.chars().next() {
        Some('R') if spindle && keyword("REV") => Ok(WordKind::Speed(takes(cursor, "REV")?)),
        Some('P') if keyword("POS") => Ok(WordKind::Place(takes(cursor, "POS")?)),
        Some('F') if !spindle && keyword("FEED") => Ok(WordKind::Feed(takes(cursor, "FEED")?)),
        Some('I') if !spindle && letters == "INDP" => {
            cursor.advance(letters.len());
            Ok(WordKind::Independent)
        }
        Some('G') if !spindle && letters.len() == 1 => {
            cursor.advance(1);
            match g_function(cursor, mark)? {
                WordKind::G(g @ (0 | 1 | 90 | 91)) => Ok(WordKind::G(g)),
                _ => Err(cursor.unknown(mark, &format!("word in the brackets of {of}:"))),
            }
        }
        Some(letter @ ('M' | 'H'))
            if letters.len() == 1 || is_value(letters.get(1..).unwrap_or_default(), &mut ahead) =>
        {
            cursor.advance(1);
            match letter {
                'M' => function(cursor, FunctionLetter::M),
                _ => function(cursor, FunctionLetter::H),
            }
        }
        _ => Err(cursor.unknown(mark, &format!("word in the brackets of {of}:"))),
    }
}

/// `P1=567`, or the value of a parameter after G04.
fn parameter(cursor: &mut Cursor, dwells: bool) -> Result<WordKind, LineFault> {
    let mark = cursor.mark();
    cursor.advance(1);
    let number = parameter_number(cursor)?;
    if cursor.eat('=') {
        return Ok(WordKind::SetParameter(number, expression(cursor)?));
    }
    if dwells {
        cursor.go_to(mark);
        return Ok(WordKind::Bare(expression(cursor)?));
    }
    Err(cursor.fault(mark, "a parameter that is given no value"))
}

/// `V.G.RW = 5`, or the value of a variable after G04.
fn variable(cursor: &mut Cursor, dwells: bool) -> Result<WordKind, LineFault> {
    let mark = cursor.mark();
    let variable = reference(cursor)?;
    if cursor.eat('=') {
        return Ok(WordKind::SetVariable(variable, expression(cursor)?));
    }
    if dwells {
        cursor.go_to(mark);
        return Ok(WordKind::Bare(expression(cursor)?));
    }
    Err(cursor.fault(mark, "a variable that is given no value"))
}

/// `L Laser_on.sub` [004:114], `LL name` (public): a blank parts the name from the letter, and nothing follows it.
fn call(cursor: &mut Cursor, letters: &str) -> Result<Option<WordKind>, LineFault> {
    let mark = cursor.mark();
    let local = match letters {
        "L" => false,
        "LL" => true,
        _ => return Ok(None),
    };
    cursor.advance(letters.len());
    if cursor.peek().is_some_and(|c| !c.is_whitespace()) {
        return Err(cursor.unknown(mark, "word"));
    }
    cursor.skip_blanks();
    let name: String = cursor
        .rest()
        .iter()
        .map(|glyph| glyph.character)
        .take_while(|c| !c.is_whitespace())
        .collect();
    cursor.advance(name.chars().count());
    if name.is_empty() {
        return Err(cursor.fault(mark, format!("{letters} needs the name of a subroutine")));
    }
    if name.to_ascii_uppercase().starts_with("CYCLE[")
        || name.eq_ignore_ascii_case("CYCLE") && cursor.eat('[')
    {
        cursor.go_to(mark);
        cursor.take_while(|c| c != '[');
        return Err(cursor.fault(mark, format!("unknown word {letters} CYCLE (a cycle)")));
    }
    if cursor.is_done() {
        return Ok(Some(WordKind::Call { local, name }));
    }
    let after = cursor.mark();
    let word = cursor.word();
    Err(cursor.fault(after, format!("unknown word {word} after {letters} {name}")))
}

impl Word {
    /// Whether a V.E. variable is read to execute it.
    pub fn reads_external(&self) -> bool {
        match &self.kind {
            WordKind::Axis(_, value)
            | WordKind::Speed(value)
            | WordKind::Place(value)
            | WordKind::Feed(value)
            | WordKind::Centre(_, value)
            | WordKind::Radius(value)
            | WordKind::Bare(value) => value.reads_external(),
            WordKind::AxisBracket(_, words) | WordKind::SpindleBracket(_, words) => {
                words.iter().any(Word::reads_external)
            }
            WordKind::Function(_, number, value) => {
                number.reads_external() || value.as_ref().is_some_and(Expression::reads_external)
            }
            WordKind::SetParameter(number, value) => number.reads_external() || value.reads_external(),
            WordKind::SetVariable(variable, value) => {
                variable.index_reads_external() || value.reads_external()
            }
            WordKind::Command(order) => order.reads_external(),
            WordKind::G(_) | WordKind::Independent | WordKind::Define(..) | WordKind::Call { .. } => false,
        }
    }
}
