//! BEGIN PGM, END PGM, and the ERROR blocks that a control stores.

use bahn_parameters::MessageId;

use super::cursor::{Cursor, Parsed};
use crate::{Header, Operation, Unit};

/// `BEGIN PGM name MM|INCH [P]`; name and unit may be missing.
pub(super) fn begin(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    let header = if c.keyword("BEGIN") {
        header(c, start)
    } else {
        None
    };
    Ok(header.map(|header| Operation::Begin(Box::new(header))))
}

/// `END PGM name MM|INCH [P]`.
pub(super) fn end(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    let header = if c.keyword("END") { header(c, start) } else { None };
    Ok(header.map(|header| Operation::End(Box::new(header))))
}

/// `ERROR = ...`, which a control stores for a block that it could not read [000:17761].
pub(super) fn stored_error(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    if !c.word("ERROR") {
        return Ok(None);
    }
    c.code();
    c.fault_from(
        start,
        MessageId::ErrorBlock,
        "a control could not read this block",
    )
}

/// What follows BEGIN or END; `None` if that, which begins at `start`, is part of a longer word.
fn header(c: &mut Cursor, start: usize) -> Option<Header> {
    let keyword_end = c.position();
    if !c.keyword("PGM") && c.peek().is_ascii_alphanumeric() {
        c.go_to(start);
        return None;
    }
    if c.position() != keyword_end && c.peek().is_ascii_alphanumeric() {
        // `BEGIN PGMX`: the program's name is PGMX.
        c.go_to(keyword_end);
    }
    let mut name = c.name().into_string();
    let protected = name.to_ascii_uppercase().ends_with(" MM P")
        || name.to_ascii_uppercase().ends_with(" INCH P")
        || name.to_ascii_uppercase().ends_with(" IN P")
        || ["MM P", "INCH P"]
            .iter()
            .any(|all| name.eq_ignore_ascii_case(all));
    if protected {
        name.truncate(name.len() - " P".len());
    }
    let last = name.rsplit(' ').next().unwrap_or_default();
    let unit = match last.to_ascii_uppercase().as_str() {
        "MM" => Some(Unit::Mm),
        "INCH" => Some(Unit::Inch),
        // A name of its own it may be, a unit only after one.
        "IN" if last.len() < name.len() => Some(Unit::Inch),
        _ => None,
    };
    if unit.is_some() {
        name.truncate((name.len() - last.len()).saturating_sub(1));
    }
    Some(Header {
        name: name.into(),
        unit,
        protected,
    })
}

#[cfg(test)]
mod tests {
    use super::super::test::{fault, operation};
    use super::*;

    fn header(name: &str, unit: Option<Unit>, protected: bool) -> Box<Header> {
        Box::new(Header {
            name: name.into(),
            unit,
            protected,
        })
    }

    #[test]
    fn begin_with_and_without_name_and_unit() {
        let begin = |text: &str| match operation(text) {
            Operation::Begin(header) => header,
            other => panic!("{text}: {other:?}"),
        };
        assert_eq!(
            begin("0 BEGIN PGM 360511 MM"),
            header("360511", Some(Unit::Mm), false)
        );
        assert_eq!(
            begin("BEGIN PGM DATA INCH P"),
            header("DATA", Some(Unit::Inch), true)
        );
        assert_eq!(begin("BEGIN PGM MM"), header("", Some(Unit::Mm), false));
        assert_eq!(begin("BEGIN PGM MM P"), header("", Some(Unit::Mm), true));
        assert_eq!(
            begin("begin pgm part-7 mm"),
            header("part-7", Some(Unit::Mm), false)
        );
        assert_eq!(begin("BEGIN 360519 MM"), header("360519", Some(Unit::Mm), false));
        assert_eq!(begin("BEGIN PGM 360522 M"), header("360522 M", None, false));
        assert_eq!(begin("BEGIN PGM"), header("", None, false));
        assert_eq!(begin("BEGIN PGM T IN"), header("T", Some(Unit::Inch), false));
        assert_eq!(begin("BEGIN PGM T IN P"), header("T", Some(Unit::Inch), true));
        assert_eq!(begin("BEGIN PGM IN"), header("IN", None, false));
        assert_eq!(begin("BEGIN PGM P"), header("P", None, false));
    }

    #[test]
    fn end_and_stored_errors() {
        assert_eq!(
            operation("99 END PGM 1 MM"),
            Operation::End(header("1", Some(Unit::Mm), false))
        );
        assert_eq!(operation("END"), Operation::End(header("", None, false)));
        assert_eq!(
            fault("7 ERROR = CYCL DEF 68.0 HOLES"),
            (MessageId::ErrorBlock, 3, 27)
        );
        assert_eq!(fault("ENDE PGM").0, MessageId::BlockNotKnown);
    }
}
