//! The dialog blocks of OEM cycles.

use bahn_parameters::MessageId::EntryValueIncorrect;

use super::cursor::{Cursor, Parsed};
use crate::{Dialog, Operation};

/// Most dialog texts of an OEM cycle, its name and 14 parameters [000:17742].
const MAX_DIALOGS: usize = 15;
/// Greatest number of a dialog text [000:17742].
const MAX_DIALOG: u16 = 127;

/// `DLG-DEF 0/2/8` and `DLG-CALL 0/1/2` [000:17732-17744].
pub(super) fn dialog(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    let call = c.keyword("DLG-CALL");
    if !call && !c.keyword("DLG-DEF") {
        return Ok(None);
    }
    let mut texts = Vec::new();
    let mut gap = false;
    while !c.at_end() {
        c.accept(b'/');
        c.skip_blanks();
        // Behind the last text the places of those that are not there may stand: `/ / /` [001:2856].
        if c.at_end() || c.peek() == b'/' {
            gap = true;
            continue;
        }
        let item = c.position();
        if gap {
            return c.fault_from(item, EntryValueIncorrect, "the dialog text before it is missing");
        }
        texts.push(c.required_integer(item, MAX_DIALOG, "dialog texts have the numbers 0 to 127")?);
        if texts.len() > MAX_DIALOGS {
            return c.fault_from(start, EntryValueIncorrect, "a cycle has at most 15 dialog texts");
        }
    }
    Ok(Some(Operation::Dialog(Box::new(Dialog {
        call,
        texts: texts.into(),
    }))))
}

#[cfg(test)]
mod tests {
    use super::super::test::{fault, operation};
    use super::*;
    use bahn_parameters::MessageId::BlockNotKnown;

    #[test]
    fn dialog_blocks() {
        assert_eq!(
            operation("1 DLG-CALL 0/1/2"),
            Operation::Dialog(Box::new(Dialog {
                call: true,
                texts: [0, 1, 2].into()
            }))
        );
        // Places that have no text [001:2856].
        for text in ["DLG-DEF 0/1/2/ / /", "DLG-DEF 0/1/2///", "DLG-DEF 0/1/2"] {
            assert_eq!(
                operation(text),
                Operation::Dialog(Box::new(Dialog {
                    call: false,
                    texts: [0, 1, 2].into()
                })),
                "{text}"
            );
        }
        for text in ["DLG-DEF 0/ /2", "DLG-DEF 0/1//2"] {
            assert_eq!(fault(text).0, EntryValueIncorrect, "{text}");
        }
        assert_eq!(fault("DLG-DEF 0/200").0, EntryValueIncorrect);
        assert_eq!(fault("DLG-DOOR 0").0, BlockNotKnown);
    }
}
