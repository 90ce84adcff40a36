//! The reader of ISO blocks: the text of a block to a [`Block`]. It never fails; what cannot be read becomes
//! [`Operation::Invalid`].

use bahn_parameters::MessageId::{AngleReferenceMissing, BlockNotKnown, UnexpectedText};
use bahn_path::{Axis, AxisSet};

use super::code::{coordinate, distance, end, g_code, once, plane, split, without_end, without_star};
use super::frame::{frame_or_call, frame_words};
use super::special::special;
use crate::lines::BlockText;
use crate::parse::cursor::{Cursor, Fault, Parsed};
use crate::parse::{comment_text, empty_motion, formula, located, m_function, prefix};
use crate::text::{is_blank, to_text, trim};
use crate::{
    Block, Compensation, Coordinates, Distance, Feed, InvalidBlock, MFunctions, ModalBlock, Modality, Motion,
    MotionKind, Operation, PathFunction, Value, Word,
};

/// Reads a block into a place where one stands already.
#[inline]
pub(super) fn read_block(text: BlockText<'_>, may_begin: bool, block: &mut Block) {
    let (code, comment) = split(text.bytes);
    let mut c = Cursor::new(code);
    block.skip = prefix(&mut c);
    block.comment = None;
    if !comment.is_empty() {
        block.comment = comment_text(without_end(comment));
    }
    let start = c.position();
    if c.rest().is_empty() {
        let text = block.comment.take().unwrap_or_default();
        block.operation = Operation::Comment(text);
        return;
    }
    if let Err(fault) = operation(&mut c, may_begin, &mut block.operation) {
        block.operation = invalid(text.bytes, start, &fault);
        block.comment = None;
    }
    // Nothing but empty words of the screen.
    if let Operation::Comment(text) = &mut block.operation {
        *text = block.comment.take().unwrap_or_default();
    }
}

/// The invalid block of a line whose code begins at `start`.
#[cold]
fn invalid(line: &[u8], start: usize, fault: &Fault) -> Operation {
    let text = to_text(trim(without_star(line.get(start..).unwrap_or_default()))).into_boxed_str();
    let error = located(fault, 0, line, fault.start, fault.end);
    Operation::Invalid(Box::new(InvalidBlock { text, error }))
}

/// Reads what a block does, up to the end of its code.
#[inline]
pub(super) fn operation(c: &mut Cursor, may_begin: bool, operation: &mut Operation) -> Parsed<()> {
    let next = c.peek_at(1);
    match c.peek_upper() {
        b'%' => *operation = frame_or_call(c, may_begin)?,
        b'D' if next.is_ascii_digit() => *operation = super::function::function(c)?,
        b'L' if next.is_ascii_digit() => *operation = super::special::call(c)?,
        b'Q' => {
            *operation = match formula(c)? {
                Some(formula) => formula,
                None => return c.unexpected(),
            };
        }
        _ => return positioning(c, operation),
    }
    if end(c) { Ok(()) } else { c.unexpected() }
}

/// What a positioning block may have beside its movement.
#[derive(Default)]
struct Beside {
    centre: Coordinates,
    /// Axes of the centre whose word stands before any G90 or G91.
    centre_open: AxisSet,
    tool: Option<Value>,
    speed: Option<Value>,
    delta_length: Option<Value>,
    delta_radius: Option<Value>,
}

impl Beside {
    fn calls_tool(&self) -> bool {
        self.tool.is_some()
            || self.speed.is_some()
            || self.delta_length.is_some()
            || self.delta_radius.is_some()
    }
}

/// Reads a block of words: a movement, a tool call, a centre, or all of them; and the G functions that stand alone.
#[inline]
fn positioning(c: &mut Cursor, operation: &mut Operation) -> Parsed<()> {
    let start = c.position();
    let mut motion = Motion {
        modal: Some(Modality::default()),
        ..empty_motion(MotionKind::Line)
    };
    let mut beside = None;
    let Some(code) = words(c, &mut motion, &mut beside)? else {
        check(c, start, &motion)?;
        *operation = assembled(motion, beside);
        return Ok(());
    };
    c.go_to(start);
    *operation = special(c, code)?;
    Ok(())
}

/// Reads words up to the end, or up to a G function that makes another block of it, which is handed back.
#[inline]
fn words(c: &mut Cursor, motion: &mut Motion, beside: &mut Option<Box<Beside>>) -> Parsed<Option<u16>> {
    let mut modality = Modality::default();
    while !end(c) {
        let start = c.position();
        let letter = c.peek_upper();
        match letter {
            b'X' | b'Y' | b'Z' | b'A' | b'B' | b'C' | b'U' | b'V' | b'W' => {
                if let Some(axis) = Axis::from_letter(letter) {
                    coordinate(
                        c,
                        axis,
                        &mut motion.coordinates,
                        &mut modality.open,
                        modality.distance,
                    )?;
                }
            }
            b'G' => {
                let code = g_code(c)?;
                if !g_function(c, start, code, &mut modality, motion)? {
                    return Ok(Some(code));
                }
            }
            b'F' => {
                c.advance(1);
                let feed = feed(c, start)?;
                once(c, start, &mut motion.feed, feed)?;
            }
            b'M' => m_function(c, &mut motion.m)?,
            b'R' | b'H' => {
                c.advance(1);
                let word = Word {
                    value: c.required_value(start)?,
                    incremental: modality.distance == Some(Distance::Incremental),
                };
                let (slot, open) = match letter {
                    b'R' => (&mut motion.polar_radius, &mut modality.open_radius),
                    _ => (&mut motion.polar_angle, &mut modality.open_angle),
                };
                *open = modality.distance.is_none();
                once(c, start, slot, word)?;
            }
            b'I' | b'J' | b'K' => {
                let beside = beside.get_or_insert_default();
                let axis = match letter {
                    b'I' => Axis::X,
                    b'J' => Axis::Y,
                    _ => Axis::Z,
                };
                coordinate(
                    c,
                    axis,
                    &mut beside.centre,
                    &mut beside.centre_open,
                    modality.distance,
                )?;
            }
            b'T' | b'S' | b'D' => tool_word(c, start, beside.get_or_insert_default())?,
            b'%' => return super::frame::misplaced(c),
            b'E' if c.word("ERROR") => return stored_error(c, start),
            _ if letter.is_ascii_alphabetic() => {
                return c.fault_at_word(BlockNotKnown, "no control here knows this word");
            }
            _ => return c.unexpected(),
        }
    }
    motion.modal = Some(modality);
    if let Some(function) = modality.function {
        motion.kind = function.kind();
    }
    Ok(None)
}

/// What a control stores for a block that it could not read [000:17761].
#[cold]
fn stored_error<T>(c: &mut Cursor, start: usize) -> Parsed<T> {
    c.code();
    c.fault_from(
        start,
        bahn_parameters::MessageId::ErrorBlock,
        "a control could not read this block",
    )
}

/// `T1`, `S1000`, `DL+0.1`, `DR-0.1`.
fn tool_word(c: &mut Cursor, start: usize, beside: &mut Beside) -> Parsed<()> {
    let slot = match (c.peek_upper(), c.peek_at(1).to_ascii_uppercase()) {
        (b'T', _) => &mut beside.tool,
        (b'S', _) => &mut beside.speed,
        (_, b'L' | b'R') => {
            c.advance(1);
            match c.peek_upper() {
                b'L' => &mut beside.delta_length,
                _ => &mut beside.delta_radius,
            }
        }
        _ => return c.unexpected(),
    };
    c.advance(1);
    let value = c.required_value(start)?;
    once(c, start, slot, value)
}

/// Takes a G function that stays in force; `false` for one that makes another block of it.
#[inline]
fn g_function(
    c: &mut Cursor,
    start: usize,
    code: u16,
    modality: &mut Modality,
    motion: &mut Motion,
) -> Parsed<bool> {
    let row = PathFunction::ALL.iter().find(|(number, _)| *number == code);
    if let Some((_, function)) = row {
        once(c, start, &mut modality.function, *function)?;
        return Ok(true);
    }
    let compensation = match code {
        17..=20 => {
            let plane = plane(c, start, code)?;
            once(c, start, &mut modality.plane, plane)?;
            return Ok(true);
        }
        90 | 91 => {
            modality.distance = Some(distance(code));
            return Ok(true);
        }
        40 => Compensation::Off,
        41 => Compensation::Left,
        42 => Compensation::Right,
        43 => Compensation::Lengthen,
        44 => Compensation::Shorten,
        _ if super::special::is_special(code) => return Ok(false),
        50 | 70 | 71 => {
            return c.fault_from(
                start,
                UnexpectedText,
                "this G function belongs after the program's name",
            );
        }
        _ => return c.fault_from(start, BlockNotKnown, "no control here knows this G function"),
    };
    once(c, start, &mut motion.compensation, compensation)?;
    Ok(true)
}

/// A feed after its letter.
fn feed(c: &mut Cursor, start: usize) -> Parsed<Feed> {
    if c.keyword("MAX") {
        return Ok(Feed::Max);
    }
    Ok(Feed::Value(c.required_value(start)?))
}

/// Refuses words that the path function of the block has not.
#[inline]
fn check(c: &mut Cursor, start: usize, motion: &Motion) -> Parsed<()> {
    let Some(function) = motion.modal.and_then(|modal| modal.function) else {
        return Ok(());
    };
    if motion.coordinates.is_empty() && motion.polar_radius.is_none() && motion.polar_angle.is_none() {
        return without_end_point(c, start, function);
    }
    let arc = function.kind() == MotionKind::Circle;
    let radius = motion.polar_radius.is_some() && !function.is_polar() && !arc;
    let angle = motion.polar_angle.is_some() && !function.is_polar();
    if radius || angle {
        find(c, start, if radius { b"R" } else { b"H" });
        return c.fault_at_word(
            UnexpectedText,
            "R and H belong to polar functions, R to arcs as well",
        );
    }
    let single = function == PathFunction::Paraxial;
    if single && motion.coordinates.axes().len() > 1 {
        find(c, start, b"");
        return c.fault_at_word(UnexpectedText, "G07 moves one axis");
    }
    let paraxial = matches!(
        motion.compensation,
        Some(Compensation::Lengthen | Compensation::Shorten)
    );
    let contour = matches!(
        motion.compensation,
        Some(Compensation::Left | Compensation::Right)
    );
    if (paraxial && !single) || (contour && single) {
        find(c, start, b"");
        return c.fault_at_word(
            UnexpectedText,
            "G43 and G44 belong to G07, G41 and G42 to all others",
        );
    }
    Ok(())
}

/// A block that says a path function and no end point: a straight line may so come into force for the blocks after it, as
/// in `G00 G40 G90`; every other function needs its end point where it stands, as its block in plain language does.
fn without_end_point(c: &mut Cursor, start: usize, function: PathFunction) -> Parsed<()> {
    let message = match function {
        PathFunction::Rapid | PathFunction::Line => return Ok(()),
        PathFunction::Paraxial => (UnexpectedText, "G07 moves one axis"),
        function if function.is_polar() => (AngleReferenceMissing, "H is missing"),
        _ => (AngleReferenceMissing, "the end point of the arc is missing"),
    };
    c.go_to(start);
    let is_it = |c: &mut Cursor| {
        let at = c.position();
        let number = if c.peek_upper() == b'G' {
            g_code(c).ok()
        } else {
            None
        };
        c.go_to(at);
        number.is_some_and(|number| PathFunction::ALL.contains(&(number, function)))
    };
    while !c.rest().is_empty() && !is_it(c) {
        c.advance(1);
    }
    c.fault_at_word(message.0, message.1)
}

/// Goes to the first word from `start` on that begins with one of the letters, or stays at `start`.
#[cold]
fn find(c: &mut Cursor, start: usize, letters: &[u8]) {
    c.go_to(start);
    let found = c
        .rest()
        .iter()
        .position(|b| letters.contains(&b.to_ascii_uppercase()));
    c.advance(found.unwrap_or(0));
}

/// What the words of a block do.
#[inline]
fn assembled(motion: Motion, beside: Option<Box<Beside>>) -> Operation {
    match beside {
        None => alone(motion),
        Some(beside) => together(motion, &beside),
    }
}

/// A block without anything beside its movement.
#[inline]
fn alone(motion: Motion) -> Operation {
    match says_nothing(&motion) {
        true if motion.m.is_empty() => Operation::Comment("".into()),
        true => Operation::Miscellaneous(motion.m),
        false => Operation::Motion(motion),
    }
}

/// Whether there is nothing but M functions.
#[inline]
fn says_nothing(motion: &Motion) -> bool {
    motion.modal == Some(Modality::default())
        && motion.coordinates.is_empty()
        && motion.polar_radius.is_none()
        && motion.polar_angle.is_none()
        && motion.compensation.is_none()
        && motion.feed.is_none()
}

#[cold]
fn together(mut motion: Motion, beside: &Beside) -> Operation {
    let mut operations = Vec::new();
    if beside.calls_tool() {
        let mut axis = None;
        if beside.tool.is_some() {
            axis = motion.modal.as_mut().and_then(|modal| modal.plane.take());
        }
        operations.push(Operation::ToolCall {
            tool: beside.tool,
            axis,
            speed: beside.speed,
            delta_length: beside.delta_length,
            delta_radius: beside.delta_radius,
        });
    }
    if !beside.centre.is_empty() {
        operations.push(Operation::CircleCentre(beside.centre));
    }
    let mut modality = Modality {
        open: beside.centre_open,
        ..Modality::default()
    };
    let distance_only = Modality {
        distance: None,
        ..motion.modal.unwrap_or_default()
    };
    let distance = motion.modal.and_then(|modal| modal.distance);
    let bare = Motion {
        modal: Some(distance_only),
        m: MFunctions::default(),
        ..motion.clone()
    };
    if says_nothing(&bare) && motion.m.is_empty() {
        modality.distance = distance;
    } else {
        operations.push(Operation::Motion(motion));
    }
    match &operations[..] {
        [tool @ Operation::ToolCall { .. }] if modality == Modality::default() => tool.clone(),
        _ => Operation::Modal(Box::new(ModalBlock {
            code: None,
            modality,
            operations: operations.into(),
        })),
    }
}

/// What is wrong with the code of a block, and where its code begins; `None` if nothing is.
pub(super) fn fault(code: &[u8], may_begin: bool) -> Option<(usize, Box<Fault>)> {
    let mut c = Cursor::new(code);
    prefix(&mut c);
    let start = c.position();
    if end(&mut c) {
        return None;
    }
    let mut read = Operation::Label(0);
    operation(&mut c, may_begin, &mut read)
        .err()
        .map(|fault| (start, fault))
}

/// Whether a line frames the program or sets a label, by its first letters.
#[inline]
pub(super) fn may_be_landmark(line: &[u8]) -> bool {
    let mut rest = line;
    loop {
        rest = match rest {
            [b'%', ..] => return frame_words(rest),
            [b'G' | b'g', b'9', b'8', ..] => return true,
            [b'G' | b'g', ..] => return false,
            [b'N' | b'n', after @ ..] => after,
            [byte, after @ ..] if is_blank(*byte) || *byte == b'/' || byte.is_ascii_digit() => after,
            _ => return false,
        };
    }
}
