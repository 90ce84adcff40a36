//! A block: the words of a line.
//!
//! Decision: Letters that are no other address name axes of the channel, whose names are those of q110 to q141; one
//! beyond A, B, C, U, V, W, X, Y, Z is warned of, since nobody here knows the channel
//!
//! Decision: M functions have the numbers 0 to 9999; those that no table of the machine defines are refused by whoever
//! runs the program
//!
//! Decision: What is compared is a whole number, decimal or hexadecimal, or the content of a parameter, since the point
//! parts it from the target; a condition stands alone in its block
//!
//! Decision: A word takes the content of a parameter after a colon only

use bahn_text::Span;

use super::table::{self, Part};
use super::value::{self, Number, Parameter, Value};
use crate::block::{MAX_WORDS, number};
use crate::cursor::Cursor;
use crate::line::{Glyph, LineFault};

/// What a line orders. Parameters are written before its other words act [002:1524-1532] [002:4350-4352].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Block {
    /// `/` stands before it: P8810 may skip it.
    pub may_be_skipped: bool,
    /// Its programmed number.
    pub number: Option<u32>,
    /// Its words in the order of the text, as far as they could be read.
    pub words: Vec<Word>,
}

impl Block {
    /// Makes it empty; its room stays.
    pub(super) fn clear(&mut self) {
        (self.may_be_skipped, self.number) = (false, None);
        self.words.clear();
    }

    /// The parameters that it writes, before all else.
    pub fn writes(&self) -> impl Iterator<Item = (Parameter, Option<Value>)> {
        self.words.iter().filter_map(|word| match word.kind {
            WordKind::Write { parameter, value } => Some((parameter, value)),
            _ => None,
        })
    }
}

/// A word and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Word {
    /// Its place in the file.
    pub span: Span,
    /// What it says.
    pub kind: WordKind,
}

/// What a word says.
#[derive(Clone, Debug, PartialEq)]
pub enum WordKind {
    /// A G function by its number.
    G(u16),
    /// An M function.
    M(MFunction),
    /// Coordinate of an axis: `X200`, `Y3:5`.
    Axis(AxisName, Value),
    /// Feed F.
    Feed(Value),
    /// `S1000`, `S2:500`: the spindle word, from 1, with the speed.
    Speed(u8, Value),
    /// `T2`: the group number of a tool.
    Tool(Value),
    /// I, J, K, by 0, 1, 2: centre of a circle.
    Centre(u8, Value),
    /// R: radius of a circle.
    Radius(Value),
    /// `P7950:1`; `--` clears the parameter.
    Write {
        /// What is written.
        parameter: Parameter,
        /// What it gets; `None` clears it.
        value: Option<Value>,
    },
    /// `P7960<10.110`.
    Jump(Condition),
}

/// An M function with its extensions: `M24.110.5`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MFunction {
    /// Its number.
    pub number: u16,
    /// Number of the block to jump to.
    pub target: Option<u32>,
    /// How often.
    pub count: Option<u32>,
}

/// Name of an axis in the channel descriptor: letter and extension (q110 to q141).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AxisName {
    /// In capitals.
    pub letter: char,
    /// 0 without one.
    pub extension: u8,
}

impl std::fmt::Display for AxisName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.extension {
            0 => write!(f, "{}", self.letter),
            extension => write!(f, "{}{extension}", self.letter),
        }
    }
}

/// A jump that a parameter decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Condition {
    /// What is compared.
    pub parameter: Parameter,
    /// When it jumps.
    pub relation: Relation,
    /// What it is compared with.
    pub with: Value,
    /// Number of the block to jump to.
    pub target: u32,
}

/// Comparison of a condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// `<`
    Less,
    /// `=`
    Equal,
    /// `>` (inferred)
    Greater,
}

/// What reading a line has found.
#[derive(Clone, Debug, Default)]
pub(super) struct Reading {
    pub block: Block,
    pub faults: Vec<LineFault>,
    pub warnings: Vec<LineFault>,
}

/// Largest number of a block: P8901 shows it, in four bytes.
const MAX_NUMBER: u32 = i32::MAX.cast_unsigned();

/// Greatest number of an M function.
const MAX_M: u16 = 9999;

/// Letters that name axes by custom.
const USUAL_AXES: &str = "ABCUVWXYZ";

/// Reads a line whose words are all read, whatever is wrong with one of them.
pub(super) fn read(line: u32, glyphs: &[Glyph]) -> Reading {
    let mut reading = Reading::default();
    let mut cursor = Cursor::new(glyphs);
    reading.block.may_be_skipped = cursor.eat('/');
    match block_number(&mut cursor) {
        Ok(number) => reading.block.number = number,
        Err(fault) => {
            reading.faults.push(fault);
            leave(&mut cursor);
        }
    }
    while !cursor.is_done() {
        let mark = cursor.mark();
        match word(&mut cursor) {
            Ok(kind) => {
                let (column, length) = cursor.span(mark);
                if reading.block.words.len() >= MAX_WORDS {
                    let message = format!("more than {MAX_WORDS} words in a block");
                    reading.faults.push(cursor.fault(mark, message));
                    return reading;
                }
                reading.warnings.extend(doubt(&cursor, mark, &kind));
                let span = Span { line, column, length };
                reading.block.words.push(Word { span, kind });
            }
            Err(fault) => {
                reading.faults.push(fault);
                if cursor.mark() == mark {
                    cursor.advance(1);
                }
                leave(&mut cursor);
            }
        }
    }
    reading
}

/// Leaves a word that cannot be read: what is glued to it is not judged.
fn leave(cursor: &mut Cursor) {
    cursor.take_while(|c| !c.is_whitespace());
}

/// What looks wrong with a word that can be read.
fn doubt(cursor: &Cursor, mark: usize, kind: &WordKind) -> Option<LineFault> {
    let message = match kind {
        WordKind::Axis(axis, _) if !USUAL_AXES.contains(axis.letter) => {
            format!("{axis} is an axis only where the channel names one so (q110 to q141)")
        }
        WordKind::G(number) if table::g_function(*number)?.part == Part::NamedOnly => {
            format!("G{number} is named in the manual and not explained: no run executes it")
        }
        _ => return None,
    };
    Some(cursor.fault(mark, message))
}

/// The number of the block, where it has one.
fn block_number(cursor: &mut Cursor) -> Result<Option<u32>, LineFault> {
    cursor.skip_blanks();
    let mark = cursor.mark();
    if cursor.peek() != Some('N') {
        return Ok(None);
    }
    let rest = cursor.rest();
    let (name, after) = number(rest);
    cursor.advance(rest.len() - after.len());
    let Some(name) = name else {
        cursor.advance(1);
        return Err(cursor.fault(mark, "N needs the number of the block"));
    };
    let number = name.get(1..).and_then(|digits| digits.parse().ok());
    match number.filter(|number| *number <= MAX_NUMBER) {
        Some(number) => Ok(Some(number)),
        None => Err(cursor.fault(mark, format!("{name} is more than N{MAX_NUMBER}"))),
    }
}

/// One word of a block.
fn word(cursor: &mut Cursor) -> Result<WordKind, LineFault> {
    let mark = cursor.mark();
    let letter = cursor.peek().unwrap_or_default();
    if !letter.is_ascii_alphabetic() || cursor.letters().len() > 1 {
        return Err(cursor.unknown(mark, "word"));
    }
    match letter {
        'G' => g_function(cursor),
        'M' => m_function(cursor).map(WordKind::M),
        'P' => parameter(cursor),
        'F' => Ok(WordKind::Feed(positive(cursor, "F")?)),
        'S' => speed(cursor),
        'T' => tool(cursor),
        'I' | 'J' | 'K' => {
            let index = u32::from(letter) - u32::from('I');
            let value = operand(cursor, letter.encode_utf8(&mut [0; 4]))?;
            Ok(WordKind::Centre(u8::try_from(index).unwrap_or_default(), value))
        }
        'R' => Ok(WordKind::Radius(operand(cursor, "R")?)),
        'N' => {
            cursor.unknown(mark, "word");
            Err(cursor.fault(mark, "the number of a block stands at its beginning"))
        }
        'Q' => {
            cursor.unknown(mark, "word");
            Err(cursor.fault(
                mark,
                "programs have no q parameters: those from q1000 on are P11000 to P18399",
            ))
        }
        _ => coordinate(cursor, letter),
    }
}

/// The digits after a letter, which is taken with them.
fn digits(cursor: &mut Cursor) -> String {
    cursor.advance(1);
    cursor.take_while(|c| c.is_ascii_digit())
}

fn g_function(cursor: &mut Cursor) -> Result<WordKind, LineFault> {
    let mark = cursor.mark();
    let digits = digits(cursor);
    let ends = !matches!(cursor.peek(), Some('.' | ':' | '='));
    let known = |number: &u16| ends && table::g_function(*number).is_some();
    match digits.parse().ok().filter(known) {
        Some(number) => Ok(WordKind::G(number)),
        None => Err(cursor.unknown(mark, "G function")),
    }
}

/// An M function with its extensions [002:5218-5224] [002:5499].
fn m_function(cursor: &mut Cursor) -> Result<MFunction, LineFault> {
    let mark = cursor.mark();
    let digits = digits(cursor);
    let Some(number) = digits.parse().ok().filter(|number| *number <= MAX_M) else {
        return Err(cursor.unknown(mark, "M function"));
    };
    let mut extensions = [None; 2];
    for extension in &mut extensions {
        if cursor.peek() == Some('.') {
            *extension = Some(extended(cursor, mark)?);
        }
    }
    if cursor.peek() == Some('.') {
        cursor.take_while(|c| c == '.' || c.is_ascii_digit());
        let text = cursor.text(mark);
        return Err(cursor.fault(mark, format!("{text} has more than two extensions")));
    }
    let [target, count] = extensions;
    Ok(MFunction {
        number,
        target,
        count,
    })
}

/// A whole number after its point.
fn extended(cursor: &mut Cursor, mark: usize) -> Result<u32, LineFault> {
    let digits = digits(cursor);
    let number = digits.parse().ok().filter(|number| *number <= MAX_NUMBER);
    number.ok_or_else(|| {
        let text = cursor.text(mark);
        cursor.fault(
            mark,
            format!("{text} needs a number after the point, up to {MAX_NUMBER}"),
        )
    })
}

/// A write of a parameter, or a condition.
fn parameter(cursor: &mut Cursor) -> Result<WordKind, LineFault> {
    let mark = cursor.mark();
    let parameter = value::parameter(cursor)?;
    cursor.skip_blanks();
    let relation = match cursor.peek() {
        Some(':') => {
            cursor.advance(1);
            let value = written(cursor, mark, parameter)?;
            return Ok(WordKind::Write { parameter, value });
        }
        Some('<') => Relation::Less,
        Some('=') => Relation::Equal,
        Some('>') => Relation::Greater,
        _ => {
            let message =
                format!("{parameter} needs `:` and a value, or a condition as `{parameter}<10.110`");
            return Err(cursor.fault(mark, message));
        }
    };
    cursor.advance(1);
    if let Some(second @ ('<' | '=' | '>')) = cursor.peek() {
        let first = cursor.text(mark);
        cursor.advance(1);
        return Err(cursor.fault(
            mark,
            format!("unknown comparison {first}{second}: <, = and > are read"),
        ));
    }
    let with = compared(cursor, parameter)?;
    if cursor.peek() != Some('.') {
        let text = cursor.text(mark);
        return Err(cursor.fault(
            mark,
            format!("{text} needs its target, as in `{parameter}<10.110`"),
        ));
    }
    let target = extended(cursor, mark)?;
    Ok(WordKind::Jump(Condition {
        parameter,
        relation,
        with,
        target,
    }))
}

/// What a parameter gets; `None` clears it.
fn written(cursor: &mut Cursor, mark: usize, parameter: Parameter) -> Result<Option<Value>, LineFault> {
    let start = cursor.mark();
    cursor.skip_blanks();
    match (cursor.peek(), cursor.peek_at(1)) {
        (Some('-'), Some('-')) => {
            cursor.advance(2);
            Ok(None)
        }
        (Some('$'), _) => {
            let bits = value::hexadecimal(cursor, &parameter.to_string())?;
            Ok(Some(Value::Number(bits)))
        }
        (Some('P'), _) => Ok(Some(Value::Content(value::parameter(cursor)?))),
        _ => {
            cursor.go_to(start);
            let number = value::number(cursor, mark, &parameter.to_string())?;
            Ok(Some(Value::Number(number)))
        }
    }
}

/// A whole number or a parameter, up to the point before the target.
fn compared(cursor: &mut Cursor, parameter: Parameter) -> Result<Value, LineFault> {
    cursor.skip_blanks();
    let mark = cursor.mark();
    match cursor.peek() {
        Some('P') => return Ok(Value::Content(value::parameter(cursor)?)),
        Some('$') => return Ok(Value::Number(value::hexadecimal(cursor, &parameter.to_string())?)),
        Some('+' | '-') => cursor.advance(1),
        _ => {}
    }
    cursor.take_while(|c| c.is_ascii_digit());
    let text = cursor.text(mark);
    match text.parse() {
        Ok(mantissa) => Ok(Value::Number(Number {
            mantissa,
            decimals: 0,
        })),
        Err(_) => {
            let message = format!("{parameter} is compared with a whole number of four bytes or a parameter");
            Err(cursor.fault(mark, message))
        }
    }
}

/// A value after its address: a number, after a colon the content of a parameter, too.
fn operand(cursor: &mut Cursor, of: &str) -> Result<Value, LineFault> {
    let mark = cursor.mark();
    cursor.advance(1);
    value_of(cursor, mark, of)
}

fn value_of(cursor: &mut Cursor, mark: usize, of: &str) -> Result<Value, LineFault> {
    let start = cursor.mark();
    if !cursor.eat(':') {
        cursor.go_to(start);
        return Ok(Value::Number(value::number(cursor, mark, of)?));
    }
    let start = cursor.mark();
    cursor.skip_blanks();
    if cursor.peek() == Some('P') {
        return Ok(Value::Content(value::parameter(cursor)?));
    }
    cursor.go_to(start);
    Ok(Value::Number(value::number(cursor, mark, of)?))
}

/// A value that is not negative where it is a number.
fn positive(cursor: &mut Cursor, of: &str) -> Result<Value, LineFault> {
    let mark = cursor.mark();
    let value = operand(cursor, of)?;
    not_negative(cursor, mark, of, value)
}

fn not_negative(cursor: &Cursor, mark: usize, of: &str, value: Value) -> Result<Value, LineFault> {
    match value {
        Value::Number(number) if number.mantissa < 0 => {
            Err(cursor.fault(mark, format!("{of} takes no negative value")))
        }
        value => Ok(value),
    }
}

fn tool(cursor: &mut Cursor) -> Result<WordKind, LineFault> {
    let mark = cursor.mark();
    match positive(cursor, "T")? {
        Value::Number(number) if number.whole().is_none() => {
            Err(cursor.fault(mark, "T takes the whole group number of a tool"))
        }
        value => Ok(WordKind::Tool(value)),
    }
}

/// Digits and a colon after a letter: an extension of its name, which is taken up to the colon.
fn extension(cursor: &mut Cursor) -> Option<String> {
    let mut ahead = cursor.clone();
    let digits = digits(&mut ahead);
    let is_extension = !digits.is_empty() && ahead.peek() == Some(':');
    is_extension.then(|| {
        cursor.go_to(ahead.mark());
        digits
    })
}

/// S, S2 to S8 [002:858-881].
fn speed(cursor: &mut Cursor) -> Result<WordKind, LineFault> {
    let mark = cursor.mark();
    let (spindle, name) = match extension(cursor) {
        None => {
            cursor.advance(1);
            (1, "S".to_owned())
        }
        Some(digits) => match digits.parse() {
            Ok(spindle @ 2..=8) => (spindle, format!("S{spindle}")),
            _ => return Err(cursor.fault(mark, format!("S{digits} is no spindle: S, S2 to S8"))),
        },
    };
    let value = value_of(cursor, mark, &name)?;
    Ok(WordKind::Speed(
        spindle,
        not_negative(cursor, mark, &name, value)?,
    ))
}

/// A coordinate: `X200`, `X:100`, `Y3:5`.
fn coordinate(cursor: &mut Cursor, letter: char) -> Result<WordKind, LineFault> {
    let mark = cursor.mark();
    let extension = match extension(cursor) {
        None => {
            cursor.advance(1);
            0
        }
        Some(digits) => match digits.parse() {
            Ok(extension @ 1..) => extension,
            _ => {
                let message = format!("{letter}{digits} is no axis: an extension is 1 to 255");
                return Err(cursor.fault(mark, message));
            }
        },
    };
    let axis = AxisName { letter, extension };
    Ok(WordKind::Axis(axis, value_of(cursor, mark, &axis.to_string())?))
}
