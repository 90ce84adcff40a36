//! Commands in plain text, which begin with `#`.

use crate::cursor::Cursor;
use crate::expression::{Expression, Values, expression};
use crate::line::{LineFault, fault_at};
use crate::unit::Command;

/// A command whose values are still to be found.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Order {
    what: What,
    /// Values by the place of their name in the table.
    values: Vec<(&'static str, Option<Expression>)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum What {
    ExplicitSynchronisation,
    Flush,
    FlushWait,
    ChannelSet,
    VectorLimitOn,
    VectorLimitOff,
}

/// A command as it is written: its words, the word that its brackets begin with, and what may stand after it, with `=`
/// where it takes a value.
struct Form {
    words: &'static str,
    what: What,
    first: Option<&'static str>,
    values: &'static [(&'static str, bool)],
}

/// The commands that are read [004:75] [004:126] [004:138] [004:144].
const FORMS: [Form; 6] = [
    Form {
        words: "EXPL SYN",
        what: What::ExplicitSynchronisation,
        first: None,
        values: &[],
    },
    Form {
        words: "FLUSH WAIT",
        what: What::FlushWait,
        first: None,
        values: &[],
    },
    Form {
        words: "FLUSH",
        what: What::Flush,
        first: None,
        values: &[],
    },
    Form {
        words: "CHANNEL SET",
        what: What::ChannelSet,
        first: Some("M_PRE_OUTPUT"),
        values: &[("E", true), ("F", true), ("VECTOR_LIMIT_OFF", false)],
    },
    Form {
        words: "VECTOR LIMIT ON",
        what: What::VectorLimitOn,
        first: None,
        values: &[("VEL", true), ("ACC", true), ("DEC", true)],
    },
    Form {
        words: "VECTOR LIMIT OFF",
        what: What::VectorLimitOff,
        first: None,
        values: &[],
    },
];

/// The commands as they are written, without `#`.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    FORMS.iter().map(|form| form.words)
}

/// Reads a command, from its `#` on.
pub(crate) fn read(cursor: &mut Cursor) -> Result<Order, LineFault> {
    let mark = cursor.mark();
    let mut words = String::new();
    cursor.advance(1);
    let mut end = cursor.mark();
    loop {
        let word = cursor.take_while(|c| c.is_ascii_alphanumeric() || c == '_');
        if word.is_empty() {
            break;
        }
        if !words.is_empty() {
            words.push(' ');
        }
        words += &word;
        end = cursor.mark();
        cursor.skip_blanks();
    }
    cursor.go_to(end);
    let Some(form) = FORMS.iter().find(|form| form.words == words) else {
        return Err(cursor.fault(mark, format!("unknown command {}", cursor.text(mark))));
    };
    let mut order = Order {
        what: form.what,
        values: Vec::new(),
    };
    cursor.skip_blanks();
    if cursor.peek() == Some('[') && !form.values.is_empty() {
        bracket(cursor, form, &mut order)?;
    } else if !form.values.is_empty() {
        return Err(cursor.fault(mark, format!("#{words} needs its brackets [ ]")));
    } else {
        cursor.go_to(end);
    }
    Ok(order)
}

fn bracket(cursor: &mut Cursor, form: &Form, order: &mut Order) -> Result<(), LineFault> {
    let open = cursor.mark();
    cursor.advance(1);
    cursor.skip_blanks();
    let mut expected = form.first;
    while !cursor.eat(']') {
        if cursor.is_done() {
            return Err(cursor.fault(open, format!("bracket [ of #{} is not closed", form.words)));
        }
        let mark = cursor.mark();
        let name = cursor.take_while(|c| c.is_ascii_alphabetic() || c == '_');
        if let Some(first) = expected.take() {
            if name != first {
                return Err(cursor.unknown(mark, &format!("word in #{}:", form.words)));
            }
            continue;
        }
        let Some((name, takes)) = form.values.iter().find(|(known, _)| *known == name) else {
            return Err(cursor.unknown(mark, &format!("word in #{}:", form.words)));
        };
        let value = match takes {
            true => {
                cursor.eat('=');
                Some(expression(cursor)?)
            }
            false => None,
        };
        if order.values.iter().any(|(seen, _)| seen == name) {
            return Err(cursor.fault(mark, format!("{name} stands twice in #{}", form.words)));
        }
        order.values.push((name, value));
    }
    if let Some(first) = expected {
        return Err(cursor.fault(open, format!("#{} needs {first} in its brackets", form.words)));
    }
    if form.what == What::VectorLimitOn && order.values.is_empty() {
        let (column, length) = cursor.span(open);
        return Err(fault_at(
            column,
            length,
            "#VECTOR LIMIT ON needs VEL, ACC or DEC".into(),
        ));
    }
    Ok(())
}

impl Order {
    pub fn reads_external(&self) -> bool {
        let mut values = self.values.iter().filter_map(|(_, value)| value.as_ref());
        values.any(Expression::reads_external)
    }

    /// The command with its values.
    pub fn command(&self, values: &mut Values) -> Result<Command, String> {
        Ok(match self.what {
            What::ExplicitSynchronisation => Command::ExplicitSynchronisation,
            What::Flush => Command::Flush { wait: false },
            What::FlushWait => Command::Flush { wait: true },
            What::ChannelSet => Command::MicroJoint {
                entry_mm_min: self.positive("E", values)?,
                feed_mm_min: self.positive("F", values)?,
                vector_limit_off: self.values.iter().any(|(name, _)| *name == "VECTOR_LIMIT_OFF"),
            },
            What::VectorLimitOn => Command::VectorLimit {
                velocity_mm_min: self.positive("VEL", values)?,
                acceleration_mm_s2: self.positive("ACC", values)?,
                deceleration_mm_s2: self.positive("DEC", values)?,
            },
            What::VectorLimitOff => Command::VectorLimit {
                velocity_mm_min: None,
                acceleration_mm_s2: None,
                deceleration_mm_s2: None,
            },
        })
    }

    fn positive(&self, name: &str, values: &mut Values) -> Result<Option<f64>, String> {
        let Some((_, Some(value))) = self.values.iter().find(|(known, _)| *known == name) else {
            return Ok(None);
        };
        match value.value(values)? {
            // A block may begin at standstill, not be driven at it.
            value if value > 0.0 || (value == 0.0 && name == "E") => Ok(Some(value)),
            value => Err(format!("{name}={value} is not greater than 0")),
        }
    }
}
