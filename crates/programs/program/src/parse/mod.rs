//! The plain-language parser: the text of a block to a [`Block`]. It never fails; what cannot be read
//! becomes [`Operation::Invalid`].

mod blank;
mod block_number;
pub(crate) mod cursor;
mod cycle;
mod decoration;
mod dialog;
mod faults;
mod foreign;
mod formula;
mod header;
mod label;
mod m_function;
mod number;
mod path;
mod probe;
mod q_parameter;
mod tool;
mod unknown;
mod words;

use bahn_parameters::MessageId;

use crate::lines::{BlockText, lines, stands_alone};
use crate::text::{character_count, to_text, trim, trim_continuation};
use crate::{Block, BlockError, InvalidBlock, Operation};
use cursor::{Cursor, Fault, Parsed, code_length, with_help};
pub(crate) use faults::{faults, language_faults};
pub(crate) use foreign::{is_din_iso, whole_program};
pub(crate) use formula::FUNCTIONS;
pub use m_function::m_words;
pub(crate) use m_function::{m_function, rest_of_word};
pub(crate) use path::empty_motion;
pub(crate) use q_parameter::formula;
pub(crate) use words::block_words;

pub(crate) use block_number::{prefix, renumber};

/// Reads a block into a place where one, best [`Block::EMPTY`], stands already, so that the large positioning blocks
/// are not copied. `BEGIN PGM` is a fault where it is not permitted.
#[inline]
pub(crate) fn read_block(text: BlockText<'_>, may_begin: bool, block: &mut Block) {
    if text.joined {
        *block = parse_joined(text.bytes, may_begin);
    } else {
        parse_line(text.bytes, may_begin, block);
    }
}

/// Reads a block that stands in one line.
#[inline]
fn parse_line(line: &[u8], may_begin: bool, block: &mut Block) {
    let mut c = Cursor::new(line);
    block.skip = prefix(&mut c);
    block.comment = None;
    let start = c.position();
    let read = if let Some(kind) = path::motion_kind(&mut c) {
        block.operation = Operation::Motion(path::empty_motion(kind));
        match &mut block.operation {
            Operation::Motion(motion) => path::motion_words(&mut c, motion),
            _ => Ok(()),
        }
    } else {
        other_operation(&mut c, may_begin, &mut block.operation)
    };
    match read {
        Ok(()) if c.peek() == b';' => block.comment = comment_text(c.rest()),
        Ok(()) => {}
        Err(fault) => block.operation = invalid(line, start, &fault),
    }
}

/// Reads a block that is no positioning block up to its end, or what stands alone in a line.
fn other_operation(c: &mut Cursor, may_begin: bool, operation: &mut Operation) -> Parsed<()> {
    *operation = match decoration_only(c) {
        Some(comment) => {
            c.advance(c.rest().len());
            comment
        }
        None => complete_operation(c, may_begin)?,
    };
    Ok(())
}

/// The invalid block of a line whose code begins at `start`.
#[cold]
fn invalid(line: &[u8], start: usize, fault: &Fault) -> Operation {
    let text = to_text(trim_continuation(line.get(start..).unwrap_or_default())).into_boxed_str();
    let error = located(fault, 0, line, fault.start, fault.end);
    Operation::Invalid(Box::new(InvalidBlock { text, error }))
}

/// Whether a block is BEGIN PGM.
pub(crate) fn frames_begin(first_block: &[u8]) -> bool {
    let mut block = Block::EMPTY;
    parse_line(first_block, true, &mut block);
    matches!(block.operation, Operation::Begin(_))
}

/// Whether a line may be LBL, BEGIN or END by its first letters.
#[inline]
pub(crate) fn frames_or_labels(line: &[u8]) -> bool {
    let letter_from = |start: usize| {
        let rest = line.get(start..).unwrap_or_default();
        let found = rest.iter().position(|b| b.is_ascii_alphabetic());
        found.map_or(line.len(), |found| start + found)
    };
    let mut first = letter_from(0);
    if matches!(line.get(first..), Some([b'N' | b'n', b'0'..=b'9', ..])) {
        first = letter_from(first + 1);
    }
    let at = |offset: usize| line.get(first + offset).map_or(b' ', u8::to_ascii_uppercase);
    match at(0) {
        b'L' => at(1) == b'B' && at(2) == b'L',
        b'B' => at(1) == b'E',
        b'E' => at(1) == b'N',
        _ => false,
    }
}

/// Reads a block that is no function: comment, structuring, or nothing but a block number.
fn decoration_only(c: &mut Cursor) -> Option<Operation> {
    let text = match c.peek() {
        b';' => c.rest().get(1..).unwrap_or_default(),
        b'*' => c.rest(),
        _ if c.at_end() => c.rest(),
        _ => return None,
    };
    Some(Operation::Comment(to_text(trim(text)).into_boxed_str()))
}

/// Reads a function up to the end of the block.
fn complete_operation(c: &mut Cursor, may_begin: bool) -> Parsed<Operation> {
    let start = c.position();
    let operation = operation(c)?;
    if !may_begin && matches!(operation, Operation::Begin(_)) {
        let fault = c.fault_from(start, MessageId::UnexpectedText, "the program has begun already");
        return with_help(
            fault,
            "Keep one BEGIN PGM; put a second program into a file of its own.",
        );
    }
    if c.at_end() { Ok(operation) } else { c.unexpected() }
}

/// What to do about a block that nobody knows.
const CORRECT_THE_WORD: &str =
    "Correct the spelling, or write the block with functions of the controls here if a later one wrote it.";

/// Reads a function by its first letters.
fn operation(c: &mut Cursor) -> Parsed<Operation> {
    if let Some(kind) = path::motion_kind(c) {
        let mut motion = path::empty_motion(kind);
        path::motion_words(c, &mut motion)?;
        return Ok(Operation::Motion(motion));
    }
    let found = match (c.peek_upper(), c.peek_at(1).to_ascii_uppercase()) {
        (b'B', b'E') => header::begin(c),
        (b'B', b'L') => blank::blank_form(c),
        (b'C', b'A') => label::call(c),
        (b'C', b'C') => path::circle_centre(c),
        (b'C', b'H') => path::chamfer_word(c),
        (b'C', b'Y') => cycle::cycle(c),
        (b'D', _) => dialog::dialog(c),
        (b'E', b'N') => header::end(c),
        (b'E', b'R') => header::stored_error(c),
        (b'F', b'N') => q_parameter::function(c),
        (b'L', b'B') => label::label(c),
        (b'L', _) => path::chamfer_line(c),
        (b'M', _) => m_function::block(c),
        (b'P', _) => label::program_call(c),
        (b'Q', _) => q_parameter::formula(c),
        (b'R', _) => path::rounding(c),
        (b'S', _) => tool::stop(c),
        (b'T', b'O') if c.peek_at(2).eq_ignore_ascii_case(&b'O') => tool::tool(c),
        (b'T', _) => probe::probe(c),
        _ => Ok(None),
    };
    match found? {
        Some(operation) => Ok(operation),
        None if let Some(what) = foreign::belongs_to(c) => {
            c.fault_at_word(MessageId::BlockNotSupported, foreign::not_supported(what))
        }
        None if c.peek().is_ascii_alphabetic() || c.peek() == b'%' => {
            let fault = c.fault_at_word(MessageId::BlockNotKnown, "no control here knows this block");
            with_help(fault, CORRECT_THE_WORD)
        }
        None => c.fault_at_word(MessageId::UnexpectedText, "a block cannot begin like this"),
    }
}

/// What follows `;`, if anything.
#[cold]
pub(crate) fn comment_text(rest: &[u8]) -> Option<Box<str>> {
    let text = trim_continuation(trim(rest.get(1..).unwrap_or_default()));
    let text = trim(text);
    (!text.is_empty()).then(|| to_text(text).into_boxed_str())
}

/// The error of a fault that lies from `start` to `end` in a line.
#[cold]
pub(crate) fn located(
    fault: &Fault,
    line_in_block: u32,
    line: &[u8],
    start: usize,
    end: usize,
) -> BlockError {
    let start = start.min(line.len());
    let covered = line.get(start..end.clamp(start, line.len())).unwrap_or_default();
    BlockError {
        message: fault.message,
        line: line_in_block,
        column: character_count(line.get(..start).unwrap_or_default()).saturating_add(1),
        length: character_count(trim(covered)).max(1),
        detail: fault.detail.as_ref().into(),
        help: fault.help,
    }
}

/// One line of a block of several.
struct Piece<'a> {
    line: &'a [u8],
    /// Where its code begins in the line.
    code_start: usize,
    /// Where its code begins in the joined code.
    joined_start: usize,
}

/// Reads a block of several lines joined by `~`. Its comments become one.
#[cold]
fn parse_joined(bytes: &[u8], may_begin: bool) -> Block {
    let mut pieces = Vec::new();
    let mut joined = Vec::new();
    let mut comments = String::new();
    let mut skip = false;
    for (index, line) in lines(bytes).enumerate() {
        let mut c = Cursor::new(line);
        if index == 0 {
            skip = prefix(&mut c);
        } else {
            c.skip_blanks();
            joined.push(b' ');
        }
        let code_start = c.position();
        pieces.push(Piece {
            line,
            code_start,
            joined_start: joined.len(),
        });
        let rest = trim_continuation(c.rest());
        let (code, after) = rest.split_at_checked(code_length(rest)).unwrap_or_default();
        joined.extend_from_slice(trim_continuation(code));
        if after.first() == Some(&b';')
            && let Some(comment) = comment_text(after)
        {
            if !comments.is_empty() {
                comments.push_str(" ; ");
            }
            comments.push_str(&comment);
        }
    }
    if stands_alone(bytes) {
        return Block {
            skip,
            operation: Operation::Comment(continued_comment(&pieces)),
            comment: None,
        };
    }
    let mut c = Cursor::new(&joined);
    c.skip_blanks();
    if c.at_end() {
        return Block {
            skip,
            operation: Operation::Comment(comments.into()),
            comment: None,
        };
    }
    match complete_operation(&mut c, may_begin) {
        Ok(operation) => {
            let comment = (!comments.is_empty()).then(|| comments.into());
            Block {
                skip,
                operation,
                comment,
            }
        }
        Err(fault) => {
            let error = located_in_pieces(&fault, &pieces);
            let operation = Operation::Invalid(Box::new(InvalidBlock {
                text: pieces_text(&pieces),
                error,
            }));
            Block {
                skip,
                operation,
                comment: None,
            }
        }
    }
}

/// The text of a comment of several lines, with single blanks where they met.
fn continued_comment(pieces: &[Piece]) -> Box<str> {
    let mut text = String::new();
    for piece in pieces {
        let line = trim(trim_continuation(
            piece.line.get(piece.code_start..).unwrap_or_default(),
        ));
        if !text.is_empty() && !line.is_empty() {
            text.push(' ');
        }
        text.push_str(&to_text(line));
    }
    match text.strip_prefix(';') {
        Some(comment) => comment.trim_start().into(),
        None => text.into(),
    }
}

/// The text of an invalid block of several lines: each trimmed, with `~` at all ends but the last.
fn pieces_text(pieces: &[Piece]) -> Box<str> {
    let mut text = String::new();
    for piece in pieces {
        if !text.is_empty() || piece.joined_start != 0 {
            text.push_str(" ~\n");
        }
        text.push_str(&to_text(trim_continuation(
            piece.line.get(piece.code_start..).unwrap_or_default(),
        )));
    }
    while let Some(shorter) = text.strip_suffix(" ~\n") {
        text.truncate(shorter.len());
    }
    text.into()
}

fn located_in_pieces(fault: &Fault, pieces: &[Piece]) -> BlockError {
    let index = pieces
        .partition_point(|piece| piece.joined_start <= fault.start)
        .saturating_sub(1);
    let Some(piece) = pieces.get(index) else {
        return located(fault, 0, &[], 0, 0);
    };
    let in_line = |joined: usize| joined.saturating_sub(piece.joined_start) + piece.code_start;
    let line = trim_continuation(piece.line);
    let line_in_block = u32::try_from(index).unwrap_or(u32::MAX);
    located(
        fault,
        line_in_block,
        line,
        in_line(fault.start),
        in_line(fault.end),
    )
}

/// Helpers of the parsers' tests.
#[cfg(test)]
mod test {
    use super::*;
    use crate::{Coordinates, MFunctions, Value};

    pub(super) fn block(text: &str) -> Block {
        let joined = text.contains('\n');
        let text = BlockText {
            bytes: text.as_bytes(),
            joined,
        };
        let mut block = Block::EMPTY;
        read_block(text, true, &mut block);
        block
    }

    /// What the text does; it must be a valid block.
    pub(super) fn operation(text: &str) -> Operation {
        let operation = block(text).operation;
        assert!(
            !matches!(operation, Operation::Invalid(_)),
            "{text}: {operation:?}"
        );
        operation
    }

    /// Message, column and length of the fault of an invalid block.
    pub(super) fn fault(text: &str) -> (MessageId, u32, u32) {
        match block(text).operation {
            Operation::Invalid(invalid) => {
                (invalid.error.message, invalid.error.column, invalid.error.length)
            }
            other => panic!("{text}: {other:?}"),
        }
    }

    /// The value of Qn, negative for `-Qn`.
    pub(super) fn q(number: i32) -> Value {
        Value::Q {
            number: number.unsigned_abs() as u16,
            negative: number < 0,
        }
    }

    pub(super) fn m(codes: &[u16]) -> MFunctions {
        let mut m = MFunctions::default();
        assert!(codes.iter().all(|&code| m.push(code)));
        m
    }

    /// The coordinates that a text of words gives.
    pub(super) fn words(text: &str) -> Coordinates {
        path::coordinates(&mut Cursor::new(text.as_bytes())).unwrap()
    }

    #[test]
    fn numbers_comments_and_skips() {
        for text in [
            "L X+5",
            "7 L X+5",
            "  0007  L X+5",
            "7L X+5",
            "N7 L X+5",
            "n0070L X+5",
            "L X+5.....up",
            "L X+5 \0\0\x1a",
        ] {
            let plain = block(text);
            assert_eq!((plain.skip, plain.comment), (false, None), "{text}");
            assert_eq!(plain.operation, operation("L X+5"), "{text}");
        }
        for text in [
            "/L X+5",
            "/ 7 L X+5",
            "7 / L X+5",
            "7 /L X+5",
            "/7L X+5",
            "N7 /L X+5",
        ] {
            assert!(block(text).skip, "{text}");
            assert_eq!(block(text).operation, operation("L X+5"), "{text}");
        }
        let commented = block("L X+5 ;  up ; and away ");
        assert_eq!(commented.comment.as_deref(), Some("up ; and away"));
        assert_eq!(block("L X+5 ;").comment, None);
        assert_eq!(block("L X+5 ; H\u{f6}he").comment.as_deref(), Some("Höhe"));
    }

    #[test]
    fn comments_and_structure_are_blocks() {
        let comment = |text: &str| Operation::Comment(text.into());
        assert_eq!(operation("; outside"), comment("outside"));
        assert_eq!(operation("12 ;outside"), comment("outside"));
        assert_eq!(operation("12 ;"), comment(""));
        assert_eq!(operation("12 * - Finish ; it"), comment("* - Finish ; it"));
        assert_eq!(operation("12"), comment(""));
        assert_eq!(operation("....print"), comment("....print"));
    }

    #[test]
    fn joined_lines_are_one_block() {
        let cycle = block("5 CYCL DEF 200 DRILLING ~\n  Q200=2 ;SET-UP ~\r\n  Q201=-20 ;DEPTH");
        assert_eq!(
            cycle.operation,
            operation("CYCL DEF 200 DRILLING Q200=2 Q201=-20")
        );
        assert_eq!(cycle.comment.as_deref(), Some("SET-UP ; DEPTH"));
        assert_eq!(operation("L X+5 ~\nY+6 ~\n"), operation("L X+5 Y+6"));
        assert_eq!(
            operation("12 ; all of this ~\n   is one ~\ncomment"),
            Operation::Comment("all of this is one comment".into())
        );
        let Operation::Invalid(invalid) = block("3 L X+5 ~\n  Y+6 oops ; c ~\n Z+1").operation else {
            panic!("oops is no word")
        };
        assert_eq!(
            (invalid.error.line, invalid.error.column, invalid.error.length),
            (1, 7, 4)
        );
        assert_eq!(&*invalid.text, "L X+5 ~\nY+6 oops ; c ~\nZ+1");
    }

    #[test]
    fn invalid_blocks_keep_their_text() {
        let Operation::Invalid(invalid) = block("12 FN16: F-PRINT A.A / B ; log ").operation else {
            panic!("FN16 is not known")
        };
        assert_eq!(&*invalid.text, "FN16: F-PRINT A.A / B ; log");
        assert_eq!((invalid.error.column, invalid.error.length), (4, 4));
        assert_eq!(fault("H\u{f6}he 5").1, 1);
        assert_eq!(fault("= 5").0, MessageId::UnexpectedText);
    }
}
