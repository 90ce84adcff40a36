//! FN functions and assignments of formulas to Q parameters.

use bahn_parameters::MessageId::{BlockNotKnown, EntryValueIncorrect};

use super::cursor::{Cursor, Parsed};
use super::formula::expression;
use super::label::label_number;
use crate::{Calculation, Condition, Operation, Value};

/// Most items of FN15 PRINT [003:4371-4385].
pub(crate) const MAX_PRINT_ITEMS: usize = 6;
/// Value of an operand that a function does not have.
const NO_OPERAND: Value = Value::Number(0.0);

/// Reads `FN n: ...`, a Q parameter function.
pub(super) fn function(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    if !c.keyword("FN") {
        return Ok(None);
    }
    let Some(number) = c.integer(start)? else {
        c.go_to(start);
        return Ok(None);
    };
    let number_end = c.position();
    c.accept(b':');
    let operation = match number {
        0..=8 | 13 => calculation(c, number)?,
        9..=12 => jump(c, number)?,
        14 => error_number(c)?,
        15 => print(c)?,
        19 => plc(c)?,
        _ => {
            c.go_to(number_end);
            return c.fault_from(start, BlockNotKnown, "no control here knows this function");
        }
    };
    Ok(Some(operation))
}

/// FN 0-8 and 13: `Q5 = +60`, `Q1 = -Q2 + -5`, `Q20 = SQRT 4`, `Q10 = +5 LEN +4` [003:4149-4276].
fn calculation(c: &mut Cursor, number: u32) -> Parsed<Operation> {
    c.skip_blanks();
    let start = c.position();
    if c.peek_upper() != b'Q' {
        return c.number_missing(start, "the Q parameter for the result is missing");
    }
    let target = c.parameter(start)?;
    expect(c, "=")?;
    let infix = |c: &mut Cursor, operator| -> Parsed<(Value, Value)> {
        let a = c.required_value(c.position())?;
        expect(c, operator)?;
        Ok((a, c.required_value(c.position())?))
    };
    let prefix = |c: &mut Cursor, name| -> Parsed<(Value, Value)> {
        expect(c, name)?;
        Ok((c.required_value(c.position())?, NO_OPERAND))
    };
    let (function, (a, b)) = match number {
        1 => (Calculation::Add, infix(c, "+")?),
        2 => (Calculation::Subtract, infix(c, "-")?),
        3 => (Calculation::Multiply, infix(c, "*")?),
        4 => (Calculation::Divide, infix(c, "DIV")?),
        5 => (Calculation::SquareRoot, prefix(c, "SQRT")?),
        6 => (Calculation::Sine, prefix(c, "SIN")?),
        7 => (Calculation::Cosine, prefix(c, "COS")?),
        8 => (Calculation::Length, infix(c, "LEN")?),
        13 => (Calculation::Angle, infix(c, "ANG")?),
        _ => (Calculation::Assign, (c.required_value(c.position())?, NO_OPERAND)),
    };
    Ok(Operation::Calculate {
        function,
        target,
        a,
        b,
    })
}

/// FN 9-12: `IF +Q1 EQU +Q3 GOTO LBL 5` [003:4301-4315].
fn jump(c: &mut Cursor, number: u32) -> Parsed<Operation> {
    let (condition, word) = match number {
        9 => (Condition::Equal, "EQU"),
        10 => (Condition::NotEqual, "NE"),
        11 => (Condition::Greater, "GT"),
        _ => (Condition::Less, "LT"),
    };
    expect(c, "IF")?;
    let a = c.required_value(c.position())?;
    expect(c, word)?;
    let b = c.required_value(c.position())?;
    expect(c, "GOTO")?;
    expect(c, "LBL")?;
    Ok(Operation::Jump {
        condition,
        a,
        b,
        label: label_number(c)?,
    })
}

/// FN 14: `ERROR = 254` [003:4352-4362].
fn error_number(c: &mut Cursor) -> Parsed<Operation> {
    expect(c, "ERROR")?;
    c.accept(b'=');
    Ok(Operation::ErrorNumber(c.required_value(c.position())?))
}

/// FN 15: `PRINT 1/Q1/2/Q2` [003:4371-4385].
fn print(c: &mut Cursor) -> Parsed<Operation> {
    expect(c, "PRINT")?;
    let mut items = vec![c.required_value(c.position())?];
    while c.accept(b'/') {
        let start = c.position();
        items.push(c.required_value(start)?);
        if items.len() > MAX_PRINT_ITEMS {
            return c.fault_from(start, EntryValueIncorrect, "PRINT takes at most six items");
        }
    }
    Ok(Operation::Print(items.into()))
}

/// FN 19: `PLC = +10/+Q3` [003:4387-4395].
fn plc(c: &mut Cursor) -> Parsed<Operation> {
    expect(c, "PLC")?;
    c.accept(b'=');
    let a = c.required_value(c.position())?;
    let b = if c.accept(b'/') {
        Some(c.required_value(c.position())?)
    } else {
        None
    };
    Ok(Operation::Plc { a, b })
}

/// `Q1 = formula` of the TNC 415 [000:744].
pub(crate) fn formula(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    if c.peek_at(1).is_ascii_alphabetic() {
        return Ok(None);
    }
    let target = c.parameter(start)?;
    expect(c, "=")?;
    let expression = Box::new(expression(c)?);
    Ok(Some(Operation::Formula { target, expression }))
}

/// Reads a word that has to stand here; a division may also be written `/`.
fn expect(c: &mut Cursor, word: &'static str) -> Parsed<()> {
    if c.keyword(word) || (word == "DIV" && c.keyword("/")) {
        return Ok(());
    }
    c.fault_at_word(EntryValueIncorrect, format!("{word} is missing"))
}

#[cfg(test)]
mod tests {
    use super::super::test::{fault, operation, q};
    use super::*;
    use Value::Number;
    use bahn_parameters::MessageId::UnexpectedText;

    fn calculate(function: Calculation, target: u16, a: Value, b: Value) -> Operation {
        Operation::Calculate {
            function,
            target,
            a,
            b,
        }
    }

    #[test]
    fn calculations_as_printed() {
        use Calculation::*;
        for (text, expected) in [
            ("FN0: Q5 = +60", calculate(Assign, 5, Number(60.0), NO_OPERAND)),
            ("FN0: Q5 = 6", calculate(Assign, 5, Number(6.0), NO_OPERAND)),
            ("FN0 : Q1 = +5", calculate(Assign, 1, Number(5.0), NO_OPERAND)),
            ("FN 0: Q1=5", calculate(Assign, 1, Number(5.0), NO_OPERAND)),
            ("FN0:Q1 = Q2", calculate(Assign, 1, q(2), NO_OPERAND)),
            (
                "FN 0: Q10 = + 25",
                calculate(Assign, 10, Number(25.0), NO_OPERAND),
            ),
            ("FN1: Q1 = -Q2 + -5", calculate(Add, 1, q(-2), Number(-5.0))),
            ("FN1: Q1 = Q1 + 10", calculate(Add, 1, q(1), Number(10.0))),
            ("FN1:Q1=+Q2++5", calculate(Add, 1, q(2), Number(5.0))),
            (
                "FN2: Q1 = +10 - +5",
                calculate(Subtract, 1, Number(10.0), Number(5.0)),
            ),
            ("FN2: Q1 = Q20-Q10", calculate(Subtract, 1, q(20), q(10))),
            (
                "FN3: Q2 = +3 * +3",
                calculate(Multiply, 2, Number(3.0), Number(3.0)),
            ),
            ("FN4: Q4 = +8 DIV +Q2", calculate(Divide, 4, Number(8.0), q(2))),
            (
                "3 FN4: Q50 = +360 DIV + Q1",
                calculate(Divide, 50, Number(360.0), q(1)),
            ),
            (
                "FN5: Q20 = SQRT 4",
                calculate(SquareRoot, 20, Number(4.0), NO_OPERAND),
            ),
            ("FN6: Q20 = SIN -Q5", calculate(Sine, 20, q(-5), NO_OPERAND)),
            ("FN7: Q21 = COS-Q5", calculate(Cosine, 21, q(-5), NO_OPERAND)),
            (
                "FN8: Q10 = +5 LEN +4",
                calculate(Length, 10, Number(5.0), Number(4.0)),
            ),
            (
                "FN13: Q20 = +10 ANG -Q1",
                calculate(Angle, 20, Number(10.0), q(-1)),
            ),
        ] {
            assert_eq!(operation(text), expected, "{text}");
        }
    }

    #[test]
    fn jumps() {
        let jump = |condition, a, b, label| Operation::Jump {
            condition,
            a,
            b,
            label,
        };
        for (text, expected) in [
            (
                "FN9: IF +Q1 EQU +Q3 GOTO LBL 5",
                jump(Condition::Equal, q(1), q(3), 5),
            ),
            (
                "FN 10: IF +Q6 NE +0 GOTO LBL 10",
                jump(Condition::NotEqual, q(6), Number(0.0), 10),
            ),
            (
                "FN11: IF+Q1GT+10GOTO LBL1",
                jump(Condition::Greater, q(1), Number(10.0), 1),
            ),
            (
                "FN12:IF Q37 LT Q7 GOTO LBL1",
                jump(Condition::Less, q(37), q(7), 1),
            ),
        ] {
            assert_eq!(operation(text), expected, "{text}");
        }
        assert_eq!(
            fault("FN9: IF +Q1 EQU +Q3 GOTO LBL \"A\""),
            (BlockNotKnown, 30, 3)
        );
        assert_eq!(
            fault("FN9: IF +Q1 NE +Q3 GOTO LBL 1"),
            (EntryValueIncorrect, 13, 2)
        );
    }

    #[test]
    fn outputs() {
        for text in ["FN14: ERROR = 254", "FN 14: ERROR=+254", "FN14:ERROR 254"] {
            assert_eq!(operation(text), Operation::ErrorNumber(Number(254.0)), "{text}");
        }
        assert_eq!(
            operation("FN15: PRINT 1/Q1/2/Q2"),
            Operation::Print([Number(1.0), q(1), Number(2.0), q(2)].into())
        );
        assert_eq!(
            operation("FN 15: PRINT 20"),
            Operation::Print([Number(20.0)].into())
        );
        assert_eq!(fault("FN15: PRINT 1/2/3/4/5/6/7").0, EntryValueIncorrect);
        assert_eq!(
            operation("FN19: PLC = +10/+Q3"),
            Operation::Plc {
                a: Number(10.0),
                b: Some(q(3))
            }
        );
        assert_eq!(
            operation("FN 19: PLC=10"),
            Operation::Plc {
                a: Number(10.0),
                b: None
            }
        );
    }

    #[test]
    fn faulty_functions() {
        assert_eq!(fault("FN16: F-PRINT A.A"), (BlockNotKnown, 1, 4));
        assert_eq!(fault("FN 18: SYSREAD Q1 = ID1"), (BlockNotKnown, 1, 5));
        assert_eq!(fault("FN0: Q1 +5"), (EntryValueIncorrect, 9, 2));
        assert_eq!(fault("FN1: Q1 = +5 * +6"), (EntryValueIncorrect, 14, 1));
        assert_eq!(fault("FN0: Q1 = +5 +6"), (UnexpectedText, 14, 2));
        assert_eq!(fault("FN0: Q2000 = +5"), (EntryValueIncorrect, 6, 5));
        assert_eq!(fault("FN0: QS1 = +5"), (BlockNotKnown, 6, 3));
        assert_eq!(fault("QS1 = \"TEXT\""), (BlockNotKnown, 1, 3));
        assert_eq!(fault("FN: Q1 = 5").0, BlockNotKnown);
    }
}
