//! TOOL DEF, TOOL CALL and STOP.

use bahn_parameters::MessageId::{BlockNotKnown, UnexpectedText};
use bahn_path::Axis;

use super::cursor::{Cursor, Parsed};
use super::m_function::m_functions;
use crate::{Operation, Value};

/// `TOOL DEF` and `TOOL CALL`.
pub(super) fn tool(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    if c.keyword("TOOL") {
        if c.keyword("DEF") {
            return definition(c).map(Some);
        }
        if c.keyword("CALL") {
            return call(c).map(Some);
        }
    }
    c.go_to(start);
    Ok(None)
}

/// `TOOL DEF n [L R]` [003:1875] [003:1931].
fn definition(c: &mut Cursor) -> Parsed<Operation> {
    no_tool_name(c)?;
    let tool = c.required_value(c.position())?;
    let mut length = None;
    let mut radius = None;
    while !c.at_end() {
        let start = c.position();
        let slot = match c.peek_upper() {
            b'L' => &mut length,
            b'R' => &mut radius,
            _ => return c.unexpected(),
        };
        c.advance(1);
        set_once(c, start, slot)?;
    }
    Ok(Operation::ToolDefinition { tool, length, radius })
}

/// `TOOL CALL [n] [axis] [S]`, later also DL and DR [003:1929] [003:2188].
fn call(c: &mut Cursor) -> Parsed<Operation> {
    no_tool_name(c)?;
    let tool = c.value()?;
    let mut axis = None;
    let mut speed = None;
    let mut delta_length = None;
    let mut delta_radius = None;
    while !c.at_end() {
        let start = c.position();
        let slot = match (c.peek_upper(), c.peek_at(1).to_ascii_uppercase()) {
            (b'S', _) => {
                c.advance(1);
                &mut speed
            }
            (b'D', b'L') => {
                c.advance(2);
                &mut delta_length
            }
            (b'D', b'R') if !c.peek_at(2).is_ascii_digit() => {
                c.advance(2);
                &mut delta_radius
            }
            (b'F' | b'D', _) => return c.not_known(),
            (letter, _) if axis.is_none() => match Axis::from_letter(letter) {
                Some(found) if !found.is_rotary() => {
                    c.advance(1);
                    axis = Some(found);
                    continue;
                }
                _ => return c.unexpected(),
            },
            _ => return c.unexpected(),
        };
        set_once(c, start, slot)?;
    }
    Ok(Operation::ToolCall {
        tool,
        axis,
        speed,
        delta_length,
        delta_radius,
    })
}

/// Reads the value of a word that begins at `start`; an empty word is a placeholder of the screen.
fn set_once(c: &mut Cursor, start: usize, slot: &mut Option<Value>) -> Parsed<()> {
    let value = c.value()?;
    if value.is_some() && slot.is_some() {
        return c.fault_from(start, UnexpectedText, "the word stands twice in the block");
    }
    *slot = value.or(*slot);
    Ok(())
}

/// Tool names in quotes belong to later controls.
fn no_tool_name(c: &mut Cursor) -> Parsed<()> {
    c.skip_blanks();
    if c.peek() == b'"' {
        return c.fault_at_word(BlockNotKnown, "tools have numbers on the controls here");
    }
    Ok(())
}

/// Reads `STOP [M]` [003:2226].
pub(super) fn stop(c: &mut Cursor) -> Parsed<Option<Operation>> {
    if !c.word("STOP") && !stop_touches_m(c) {
        return Ok(None);
    }
    Ok(Some(Operation::Stop(m_functions(c)?)))
}

/// Whether M follows without a blank: `STOPM6`.
fn stop_touches_m(c: &mut Cursor) -> bool {
    let found = c
        .rest()
        .get(.."STOPM".len())
        .is_some_and(|word| word.eq_ignore_ascii_case(b"STOPM"));
    if found {
        c.advance("STOP".len());
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::test::{fault, m, operation, q};
    use super::*;
    use Value::Number;
    use bahn_parameters::MessageId::EntryValueIncorrect;

    #[test]
    fn definitions() {
        let tool = |tool, length, radius| Operation::ToolDefinition { tool, length, radius };
        assert_eq!(
            operation("TOOL DEF 5 L+10 R+5"),
            tool(Number(5.0), Some(Number(10.0)), Some(Number(5.0)))
        );
        assert_eq!(
            operation("TOOL DEF Q1 L+Q2 R-Q3"),
            tool(q(1), Some(q(2)), Some(q(-3)))
        );
        assert_eq!(
            operation("TOOL DEF 1 L0 R+2,5"),
            tool(Number(1.0), Some(Number(0.0)), Some(Number(2.5)))
        );
        assert_eq!(
            operation("TOOL DEF 5......Tool definition"),
            tool(Number(5.0), None, None)
        );
        assert_eq!(operation("TOOLDEF5L R"), tool(Number(5.0), None, None));
    }

    #[test]
    fn calls() {
        let tool = |tool, axis, speed| Operation::ToolCall {
            tool,
            axis,
            speed,
            delta_length: None,
            delta_radius: None,
        };
        assert_eq!(
            operation("TOOL CALL 5 Z S500"),
            tool(Some(Number(5.0)), Some(Axis::Z), Some(Number(500.0)))
        );
        assert_eq!(
            operation("TOOL CALL S1000"),
            tool(None, None, Some(Number(1000.0)))
        );
        assert_eq!(
            operation("TOOL CALL S 1000"),
            tool(None, None, Some(Number(1000.0)))
        );
        assert_eq!(
            operation("TOOL CALL 0 Z"),
            tool(Some(Number(0.0)), Some(Axis::Z), None)
        );
        assert_eq!(
            operation("TOOL CALL Q5 Z SQ6"),
            tool(Some(q(5)), Some(Axis::Z), Some(q(6)))
        );
        assert_eq!(
            operation("TOOL CALL 1 Z S1000 DL+0.1 DR-0.05"),
            Operation::ToolCall {
                tool: Some(Number(1.0)),
                axis: Some(Axis::Z),
                speed: Some(Number(1000.0)),
                delta_length: Some(Number(0.1)),
                delta_radius: Some(Number(-0.05)),
            }
        );
    }

    #[test]
    fn faulty_tool_blocks() {
        assert_eq!(fault("TOOL DEF"), (EntryValueIncorrect, 9, 1));
        assert_eq!(fault("TOOL DEF 1 L+0 R+x"), (EntryValueIncorrect, 17, 2));
        assert_eq!(fault("TOOL DEF 1 L+0 L+1"), (UnexpectedText, 16, 3));
        assert_eq!(fault("TOOL CALL \"MILL\" Z S10"), (BlockNotKnown, 11, 6));
        assert_eq!(fault("TOOL CALL 1 Z S10 F500"), (BlockNotKnown, 19, 4));
        assert_eq!(fault("TOOL CALL 1 Z S10 DR2+1"), (BlockNotKnown, 19, 5));
        assert_eq!(fault("TOOL CALL 1 C"), (UnexpectedText, 13, 1));
        assert_eq!(fault("TOOLS"), (BlockNotKnown, 1, 5));
    }

    #[test]
    fn stops() {
        assert_eq!(operation("STOP"), Operation::Stop(m(&[])));
        assert_eq!(operation("STOP M5"), Operation::Stop(m(&[5])));
        assert_eq!(operation("STOP M"), Operation::Stop(m(&[])));
        assert_eq!(operation("STOPM06"), Operation::Stop(m(&[6])));
        assert_eq!(fault("STOP X+5"), (UnexpectedText, 6, 3));
        assert_eq!(fault("SEL PGM \"A.H\"").0, BlockNotKnown);
    }
}
