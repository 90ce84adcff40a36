//! What stands after a name: numbers, constants, names, and remarks that mean nothing.

use bahn_path::Synchronisation;

use super::Value;
use super::line::Fault;
use super::table::{Kind, Owner, SynchRow};
use crate::synch::Synch;

/// A value and what is odd about it.
pub(super) struct Read {
    pub value: Value,
    /// Characters of the value without its remark.
    pub length: usize,
    pub odd: Vec<String>,
}

impl Read {
    fn new(value: Value, length: usize) -> Read {
        Read {
            value,
            length,
            odd: Vec::new(),
        }
    }
}

/// Reads a value; faults have columns from `column` on, where the text begins.
pub(super) fn read(kind: Kind, text: &str, column: usize) -> Result<Read, Fault> {
    if text.is_empty() {
        return Err((column, 1, "the value is missing".to_owned()));
    }
    match kind {
        Kind::Synch(owner) => synch(owner, text, column),
        Kind::Number { min, max } => {
            let token = token(text);
            let fault = |message: String| (column, token.chars().count().max(1), message);
            let number = number(token).map_err(fault)?;
            if number < i64::from(min) || number > i64::from(max) {
                return Err(fault(format!("{token} is not within {min} to {max}")));
            }
            let value = u32::try_from(number).unwrap_or_default();
            Ok(Read::new(Value::Number(value), token.chars().count()))
        }
        Kind::Flag => {
            let token = token(text);
            let length = token.chars().count().max(1);
            let is_word = |word: &str| token.eq_ignore_ascii_case(word);
            match number(token) {
                Ok(0) => Ok(Read::new(Value::Flag(false), length)),
                Ok(1) => Ok(Read::new(Value::Flag(true), length)),
                Ok(_) => Err((column, length, format!("{token} is not within 0 to 1"))),
                // As the manual says it of P-CHAN-00069 [004:201].
                Err(_) if is_word("TRUE") => Ok(Read::new(Value::Flag(true), length)),
                Err(_) if is_word("FALSE") => Ok(Read::new(Value::Flag(false), length)),
                Err(message) => Err((column, length, message)),
            }
        }
        Kind::Name { max } => name(text, column, max),
        Kind::Functions => functions(text, column),
    }
}

/// A word ends at a blank, a remark in parentheses or a comment.
fn token(text: &str) -> &str {
    let end = text.find(|c: char| c.is_whitespace() || matches!(c, '#' | ';' | '(' | '|'));
    end.and_then(|end| text.get(..end)).unwrap_or(text)
}

/// A whole number, decimal or `0x`.
fn number(token: &str) -> Result<i64, String> {
    let (sign, digits) = match token.strip_prefix('-') {
        Some(digits) => (-1, digits),
        None => (1, token.strip_prefix('+').unwrap_or(token)),
    };
    let hexadecimal = digits.strip_prefix("0x").or(digits.strip_prefix("0X"));
    let radix = if hexadecimal.is_some() { 16 } else { 10 };
    let digits = hexadecimal.unwrap_or(digits);
    if digits.is_empty() || !digits.chars().all(|c| c.is_digit(radix)) {
        return Err(format!("`{token}` is no whole number"));
    }
    // What is too long is out of every range.
    Ok(sign * i64::from_str_radix(digits, radix).unwrap_or(i64::MAX))
}

/// A name without quotation marks [004:198].
fn name(text: &str, column: usize, max: usize) -> Result<Read, Fault> {
    let token = token(text);
    let length = token.chars().count();
    let fault = |message: String| (column, length.max(1), message);
    let is_name = token.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && token
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '-'));
    if !is_name {
        return Err(fault(format!("`{token}` is no name")));
    }
    if length > max {
        return Err(fault(format!(
            "`{token}` has {length} characters; {max} are the most"
        )));
    }
    Ok(Read::new(Value::Name(token.to_owned()), length))
}

/// A constant or number between the signs `|`, with its offset in characters.
struct Term<'a> {
    text: &'a str,
    offset: usize,
}

/// Terms that are joined by `|`, how many characters they take, and the remark after.
fn terms(text: &str, column: usize) -> Result<(Vec<Term<'_>>, usize, &str), Fault> {
    let mut found = Vec::new();
    let mut rest = text;
    loop {
        let offset = text.chars().count() - rest.chars().count();
        let word = token(rest);
        if word.is_empty() {
            return Err((column + offset, 1, "a constant is missing at `|`".to_owned()));
        }
        found.push(Term { text: word, offset });
        let after = rest.get(word.len()..).unwrap_or_default();
        match after.trim_start().strip_prefix('|') {
            Some(next) => rest = next.trim_start(),
            None => return Ok((found, offset + word.chars().count(), after.trim())),
        }
    }
}

/// A synchronisation type with its bits [004:204-210].
fn synch(owner: Owner, text: &str, column: usize) -> Result<Read, Fault> {
    let (terms, length, remark) = terms(text, column)?;
    let mut bits = 0_u32;
    for term in &terms {
        let fault = |message: String| (column + term.offset, term.text.chars().count(), message);
        bits |= match Synch::constant(term.text) {
            Some(bits) => bits,
            None if term
                .text
                .starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') =>
            {
                return Err(fault(format!("`{}` is no synchronisation type", term.text)));
            }
            None => match number(term.text).map_err(fault)? {
                -1 => Synch::NOT_VALID,
                number => u32::try_from(number)
                    .map_err(|_| fault(format!("{} is not within 0 to 0xFFFFFFFF", term.text)))?,
            },
        };
    }
    let fault = |message: String| (column, length, message);
    if bits == Synch::NOT_VALID {
        return match owner {
            Owner::M | Owner::H => Ok(Read::new(Value::Synch(None), length)),
            Owner::Spindle | Owner::Tool => {
                Err(fault(format!("NOT_VALID is not allowed for {}", owner.text())))
            }
        };
    }
    let synch = Synch::from_bits(bits).map_err(|error| fault(error.to_string()))?;
    let is_allowed = SynchRow::find(synch.kind.name()).is_some_and(|row| row.is_for(owner));
    if !is_allowed {
        return Err(fault(format!(
            "{} is not allowed for {}",
            synch.kind,
            owner.text()
        )));
    }
    let bits_without = SynchRow::all()
        .iter()
        .filter(|row| row.is_bit && !row.is_for(owner));
    let mut odd: Vec<String> = bits_without
        .filter(|row| bits & row.bits != 0)
        .map(|row| format!("{} has no effect for {}", row.name, owner.text()))
        .collect();
    odd.extend(contradiction(synch, remark));
    Ok(Read {
        value: Value::Synch(Some(synch)),
        length,
        odd,
    })
}

/// A remark that names another type than the value; the value counts [004:213].
fn contradiction(synch: Synch, remark: &str) -> Option<String> {
    let word = token(remark.trim_start_matches(['(', '#', ';']).trim_start());
    let said = if word.starts_with(|c: char| c.is_ascii_digit()) {
        number(word).ok().and_then(|bits| u32::try_from(bits).ok())?
    } else {
        Synch::constant(word)?
    };
    let other = Synch::from_bits(said).ok()?;
    let differs = if word.starts_with("0x") || word.starts_with("0X") {
        other != synch
    } else {
        other.kind != Synchronisation::NoSynch && other.kind != synch.kind
    };
    differs.then(|| format!("the remark says {other}, the value is {synch}: the value counts"))
}

/// Functions of the path preparation [004:231-234].
fn functions(text: &str, column: usize) -> Result<Read, Fault> {
    let (terms, length, _) = terms(text, column)?;
    let mut functions = Vec::new();
    for term in &terms {
        let name = term.text.to_ascii_uppercase();
        let is_name =
            name.starts_with("FCT_") && name.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_');
        if !is_name {
            let message = format!("`{}` is no constant FCT_...", term.text);
            return Err((column + term.offset, term.text.chars().count(), message));
        }
        functions.push(name);
    }
    Ok(Read::new(Value::Functions(functions), length))
}

#[cfg(test)]
mod tests {
    use super::*;

    const M: Kind = Kind::Synch(Owner::M);

    fn value(kind: Kind, text: &str) -> Value {
        let read = read(kind, text, 1).unwrap();
        assert_eq!(read.odd, Vec::<String>::new(), "{text}");
        read.value
    }

    fn message(kind: Kind, text: &str) -> (usize, usize, String) {
        read(kind, text, 1).map(|read| read.value).unwrap_err()
    }

    #[test]
    fn remarks_stand_after_values() {
        let svs = Value::Synch(Some(Synchronisation::MvsSvs.into()));
        for text in [
            "0x00000002 MVS_SVS",
            "MVS_SVS 0x00000002",
            "MVS_SVS",
            "2",
            "0X2# comment",
            "mvs_svs ;comment",
            "MVS_SVS(remark)",
            "0x2 (synchronisation MVS_SVS)",
        ] {
            assert_eq!(value(M, text), svs, "{text}");
        }
        let spindle = Kind::Synch(Owner::Spindle);
        let both = Value::Synch(Synch::from_bits(0x0002_0002).ok());
        for text in [
            "PLC_INFO | MVS_SVS 0x00020002",
            "PLC_INFO|MVS_SVS",
            "0x20002",
            "0x20000 | 2",
        ] {
            assert_eq!(value(spindle, text), both, "{text}");
        }
        let number = Kind::Number {
            min: 0,
            max: u32::MAX,
        };
        assert_eq!(value(number, "100000 in 0.1 um"), Value::Number(100_000));
        assert_eq!(value(number, "500 ;in 0.1 um"), Value::Number(500));
        assert_eq!(value(number, "4294967295"), Value::Number(u32::MAX));
        assert_eq!(value(Kind::Flag, "TRUE"), Value::Flag(true));
        assert_eq!(
            value(Kind::Name { max: 16 }, "S2 spindle"),
            Value::Name("S2".to_owned())
        );
        assert_eq!(
            value(Kind::Functions, "FCT_DEFAULT | FCT_M_PRE_OUTPUT # on"),
            Value::Functions(vec!["FCT_DEFAULT".to_owned(), "FCT_M_PRE_OUTPUT".to_owned()])
        );
        for text in ["NOT_VALID", "NOT_VAILD", "-1", "0xFFFFFFFF"] {
            assert_eq!(value(M, text), Value::Synch(None), "{text}");
        }
    }

    #[test]
    fn what_is_no_value_is_said_at_its_place() {
        assert_eq!(
            message(M, "MVS_SVX"),
            (1, 7, "`MVS_SVX` is no synchronisation type".to_owned())
        );
        assert_eq!(message(M, "MOS | XX").0, 7);
        assert_eq!(message(M, "MOS |").0, 6);
        assert!(message(M, "0x6").2.contains("MVS_SVS and MVS_SNS"));
        assert!(message(M, "MVS_SVS | MOS").2.contains("MOS and MVS_SVS"));
        assert!(message(M, "0x10").2.contains("0x00000010"));
        assert!(message(M, "0x2x").2.contains("no whole number"));
        assert!(message(M, "-2").2.contains("not within"));
        for name in ["MVS_SLM", "MVS_SLP", "MOS_TS"] {
            assert_eq!(
                message(Kind::Synch(Owner::H), name).2,
                format!("{name} is not allowed for an H function")
            );
        }
        for name in ["MEP_SVS", "MET_SVS", "MEP_MOS", "MET_MOS", "NOT_VALID"] {
            assert_eq!(
                message(Kind::Synch(Owner::Spindle), name).2,
                format!("{name} is not allowed for a spindle")
            );
        }
        let number = Kind::Number { min: 50, max: 200 };
        assert_eq!(message(number, "49").2, "49 is not within 50 to 200");
        assert_eq!(
            message(number, "99999999999999999999").2,
            "99999999999999999999 is not within 50 to 200"
        );
        assert!(message(number, "50.5").2.contains("no whole number"));
        assert!(message(number, "# nothing").2.contains("no whole number"));
        assert!(message(number, "").2.contains("missing"));
        assert!(message(Kind::Flag, "2").2.contains("0 to 1"));
        assert!(message(Kind::Name { max: 2 }, "ABC").2.contains("3 characters"));
        assert!(message(Kind::Name { max: 16 }, "5").2.contains("no name"));
        assert!(message(Kind::Functions, "0x3").2.contains("FCT_"));
    }

    #[test]
    fn a_remark_that_says_something_else_is_odd() {
        let odd = |text: &str| read(M, text, 1).unwrap().odd;
        assert_eq!(odd("0x2 MVS_SNS").len(), 1);
        assert_eq!(odd("MVS_SVS 0x4").len(), 1);
        assert_eq!(odd("0x2 Laser on"), Vec::<String>::new());
        assert!(odd("0x20002 MVS_SVS")[0].contains("PLC_INFO has no effect for an M function"));
    }
}
