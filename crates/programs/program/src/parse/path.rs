//! Path functions: L, C, CR, CT, LP, CP, CTP, single-axis blocks, CC, RND and chamfers.

use bahn_parameters::MessageId::{AxisDoubleProgrammed, BlockNotKnown, EntryValueIncorrect, UnexpectedText};
use bahn_path::{Axis, Sense};

use super::cursor::{Cursor, Parsed};
use super::m_function::m_function;
use crate::text::is_blank;
use crate::{Compensation, Coordinates, Feed, MFunctions, Motion, MotionKind, Operation, Value, Word};

/// Reads what opens a positioning block; `None`, with nothing read, if it is another block.
#[inline]
pub(super) fn motion_kind(c: &mut Cursor) -> Option<MotionKind> {
    let start = c.position();
    let first = c.peek_upper();
    let second = c.peek_at(1).to_ascii_uppercase();
    let third = c.peek_at(2).to_ascii_uppercase();
    let (length, kind) = match (first, second, third) {
        (b'L', b'P', _) => (2, MotionKind::LinePolar),
        (b'L', b'N', _) => (2, MotionKind::LineNormal),
        (b'L', b'B', b'L') => return None,
        // A bare number makes it a chamfer.
        (b'L', ..) if !value_follows(c) => (1, MotionKind::Line),
        (b'C', b'C' | b'H', _) | (b'C', b'A', b'L') | (b'C', b'Y', b'C') => return None,
        (b'C', b'P', _) => (2, MotionKind::CirclePolar),
        (b'C', b'R', _) => (2, MotionKind::CircleRadius),
        (b'C', b'T', b'P') => (3, MotionKind::CircleTangentialPolar),
        (b'C', b'T', _) => (2, MotionKind::CircleTangential),
        (b'C', ..) if !value_follows(c) => (1, MotionKind::Circle),
        (b'I', ..) if Axis::from_letter(second).is_some() => (0, MotionKind::Paraxial),
        _ if Axis::from_letter(first).is_some() && value_follows(c) => (0, MotionKind::Paraxial),
        _ => return None,
    };
    c.advance(length);
    // A letter that begins no word of a path block makes it the word of a later control (LT, CTL ...).
    let touching = c.peek_upper();
    if length > 0
        && touching.is_ascii_alphabetic()
        && !b"XYZABCUVWIPRFMDQ".contains(&touching)
        && !(kind == MotionKind::LineNormal && touching == b'N')
    {
        c.go_to(start);
        return None;
    }
    Some(kind)
}

/// Whether a value follows the letter at the position.
#[inline]
fn value_follows(c: &Cursor) -> bool {
    let mut offset = 1;
    while c.remains(offset) && is_blank(c.peek_at(offset)) {
        offset += 1;
    }
    match c.peek_at(offset) {
        b'+' | b'-' | b'0'..=b'9' | b'Q' | b'q' => true,
        b'.' | b',' => c.peek_at(offset + 1).is_ascii_digit(),
        _ => false,
    }
}

/// A chamfer, which is `L` with a bare number [003:2685].
pub(super) fn chamfer_line(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    c.advance(1);
    if !c.peek().is_ascii_alphabetic() || c.peek_upper() == b'Q' {
        let length = c.required_value(start)?;
        return chamfer(c, length).map(Some);
    }
    c.go_to(start);
    Ok(None)
}

/// `CHF length`, a synonym of the chamfer `L length` [003:7964].
pub(super) fn chamfer_word(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    if !c.keyword("CHF") {
        return Ok(None);
    }
    let length = c.required_value(start)?;
    chamfer(c, length).map(Some)
}

fn chamfer(c: &mut Cursor, length: Value) -> Parsed<Operation> {
    Ok(Operation::Chamfer {
        length,
        feed: lone_feed(c)?,
    })
}

/// `RND [R]radius [F]` [003:3042] [003:3060].
pub(super) fn rounding(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    if !c.keyword("RND") {
        return Ok(None);
    }
    c.accept(b'R');
    let radius = c.required_value(start)?;
    Ok(Some(Operation::Rounding {
        radius,
        feed: lone_feed(c)?,
    }))
}

/// The F word of a block that takes nothing else; rapid traverse has no sense there.
fn lone_feed(c: &mut Cursor) -> Parsed<Option<Value>> {
    while !c.at_end() && c.peek_upper() == b'F' {
        let start = c.position();
        c.advance(1);
        match feed_word(c)? {
            Some(Feed::Value(value)) => return Ok(Some(value)),
            Some(Feed::Max) => return c.fault_from(start, UnexpectedText, "this block takes no FMAX"),
            None => {}
        }
    }
    Ok(None)
}

/// `CC`, with two coordinates or none [003:2754] [003:2781].
pub(super) fn circle_centre(c: &mut Cursor) -> Parsed<Option<Operation>> {
    c.advance(2);
    Ok(Some(Operation::CircleCentre(coordinates(c)?)))
}

/// Axis words up to the first word that is none.
pub(super) fn coordinates(c: &mut Cursor) -> Parsed<Coordinates> {
    let mut coordinates = Coordinates::default();
    while !c.at_end() {
        let start = c.position();
        let incremental = c.peek_upper() == b'I';
        if incremental {
            c.advance(1);
        }
        let Some(axis) = Axis::from_letter(c.peek()) else {
            c.go_to(start);
            break;
        };
        coordinate(c, start, axis, incremental, &mut coordinates)?;
    }
    Ok(coordinates)
}

/// Reads axis letter and value of the word that begins at `start`.
#[inline]
fn coordinate(
    c: &mut Cursor,
    start: usize,
    axis: Axis,
    incremental: bool,
    coordinates: &mut Coordinates,
) -> Parsed<()> {
    c.advance(1);
    let value = c.required_value(start)?;
    if coordinates.axes().contains(axis) {
        return c.fault_from(
            start,
            AxisDoubleProgrammed,
            "the axis has two values in this block",
        );
    }
    coordinates.set(axis, Word { value, incremental });
    Ok(())
}

/// A positioning block without words.
#[inline]
pub(crate) fn empty_motion(kind: MotionKind) -> Motion {
    Motion {
        kind,
        coordinates: Coordinates::default(),
        polar_radius: None,
        polar_angle: None,
        radius: None,
        direction: None,
        compensation: None,
        feed: None,
        normal: None,
        m: MFunctions::default(),
        modal: None,
    }
}

/// Reads the words of a positioning block up to the end of the block.
#[inline]
pub(super) fn motion_words(c: &mut Cursor, motion: &mut Motion) -> Parsed<()> {
    let mut normal = None;
    while !c.at_end() {
        let start = c.position();
        let letter = c.peek_upper();
        match letter {
            b'X' | b'Y' | b'Z' | b'A' | b'B' | b'C' | b'U' | b'V' | b'W' => {
                axis_word(c, start, letter, false, motion)?;
            }
            b'F' => {
                c.advance(1);
                let feed = feed_word(c)?;
                set_once(c, start, feed, &mut motion.feed)?;
            }
            b'R' => radius_word(c, start, motion)?,
            b'M' => m_function(c, &mut motion.m)?,
            b'I' => {
                c.advance(1);
                let letter = c.peek_upper();
                match letter {
                    b'P' => polar_word(c, start, true, motion)?,
                    _ => axis_word(c, start, letter, true, motion)?,
                }
            }
            b'P' => polar_word(c, start, false, motion)?,
            b'D' => direction_word(c, start, motion)?,
            b'N' if motion.kind == MotionKind::LineNormal => normal = Some(normal_words(c, start, normal)?),
            _ => return c.unexpected(),
        }
    }
    if motion.kind == MotionKind::LineNormal {
        take_normal(c, normal, motion)?;
    }
    Ok(())
}

/// One of `NX`, `NY` and `NZ`.
fn normal_words(
    c: &mut Cursor,
    start: usize,
    normal: Option<[Option<Value>; 3]>,
) -> Parsed<[Option<Value>; 3]> {
    let mut normal = normal.unwrap_or_default();
    c.advance(1);
    let slot = match c.peek_upper() {
        b'X' => normal.first_mut(),
        b'Y' => normal.get_mut(1),
        b'Z' => normal.get_mut(2),
        _ => None,
    };
    let Some(slot) = slot else {
        c.go_to(start);
        return c.unexpected();
    };
    c.advance(1);
    let value = c.required_value(start)?;
    set_once(c, start, Some(value), slot)?;
    Ok(normal)
}

fn take_normal(c: &Cursor, normal: Option<[Option<Value>; 3]>, motion: &mut Motion) -> Parsed<()> {
    let normal = normal.unwrap_or_default();
    let [Some(x), Some(y), Some(z)] = normal else {
        let missing = ["NX", "NY", "NZ"]
            .into_iter()
            .zip(normal)
            .find(|(_, value)| value.is_none());
        let detail = format!(
            "{} of the surface normal is missing",
            missing.map_or("NX", |(name, _)| name)
        );
        return c.fault_from(c.position(), EntryValueIncorrect, detail);
    };
    motion.normal = Some(Box::new([x, y, z]));
    Ok(())
}

#[inline]
fn axis_word(c: &mut Cursor, start: usize, letter: u8, incremental: bool, motion: &mut Motion) -> Parsed<()> {
    let Some(axis) = Axis::from_letter(letter) else {
        c.go_to(start);
        return c.unexpected();
    };
    coordinate(c, start, axis, incremental, &mut motion.coordinates)?;
    if motion.kind == MotionKind::Paraxial && motion.coordinates.axes().len() > 1 {
        return c.fault_from(
            start,
            UnexpectedText,
            "a block that opens with an axis moves this axis only",
        );
    }
    Ok(())
}

fn set_once<T>(c: &Cursor, start: usize, value: Option<T>, slot: &mut Option<T>) -> Parsed<()> {
    match value {
        Some(_) if slot.is_some() => {
            c.fault_from(start, UnexpectedText, "the word stands twice in the block")
        }
        Some(value) => {
            *slot = Some(value);
            Ok(())
        }
        None => Ok(()),
    }
}

/// `FMAX`, `F value` or an empty `F`, after the letter [003:303] [003:2142].
#[inline]
pub(super) fn feed_word(c: &mut Cursor) -> Parsed<Option<Feed>> {
    let after = c.position();
    if let Some(value) = c.value()? {
        return Ok(Some(Feed::Value(value)));
    }
    if c.keyword("MAX") {
        return Ok(Some(Feed::Max));
    }
    if c.word("AUTO") {
        let start = after.saturating_sub(1);
        return c.fault_from(
            start,
            BlockNotKnown,
            "no control here takes the feed from the tool call",
        );
    }
    // `FM3` is an empty F before M3; `FU`, `FZ` are feeds of later controls.
    if c.peek().is_ascii_alphabetic() && c.peek_upper() != b'M' {
        c.go_to(after.saturating_sub(1));
        return c.not_known();
    }
    Ok(None)
}

/// `R0`, `RL`, `RR`, `R+`, `R-`, the radius of CR, or an empty `R`.
fn radius_word(c: &mut Cursor, start: usize, motion: &mut Motion) -> Parsed<()> {
    c.advance(1);
    let touches = c.peek().is_ascii_alphabetic();
    c.skip_blanks();
    let compensation = match c.peek_upper() {
        b'L' => Some(Compensation::Left),
        b'R' => Some(Compensation::Right),
        b'0' if !matches!(c.peek_at(1), b'0'..=b'9' | b'.' | b',') || annotation_after(c) => {
            Some(Compensation::Off)
        }
        b'+' if !value_after_sign(c) => Some(Compensation::Lengthen),
        b'-' if !value_after_sign(c) => Some(Compensation::Shorten),
        _ => None,
    };
    if let Some(compensation) = compensation {
        c.advance(1);
        let single_axis = matches!(compensation, Compensation::Lengthen | Compensation::Shorten);
        if single_axis != (motion.kind == MotionKind::Paraxial) && compensation != Compensation::Off {
            let detail = "R+ and R- belong to single-axis blocks, RL and RR to all others";
            return c.fault_from(start, UnexpectedText, detail);
        }
        return set_once(c, start, Some(compensation), &mut motion.compensation);
    }
    let value = c.value()?;
    match value {
        Some(_) if motion.kind != MotionKind::CircleRadius => {
            c.fault_from(start, UnexpectedText, "only CR has a radius")
        }
        Some(_) => set_once(c, start, value, &mut motion.radius),
        None if touches => {
            c.go_to(start);
            c.unexpected()
        }
        None => Ok(()),
    }
}

/// Whether annotation follows the byte at the position.
fn annotation_after(c: &Cursor) -> bool {
    let mut after = c.clone();
    after.advance(1);
    after.at_annotation()
}

/// Whether a number or Q parameter follows the sign at the position.
fn value_after_sign(c: &Cursor) -> bool {
    let mut after = c.clone();
    after.advance(1);
    after.skip_blanks();
    let digit_follows = after.peek_at(1).is_ascii_digit();
    match after.peek_upper() {
        b'0'..=b'9' | b'Q' => true,
        b'.' | b',' => digit_follows,
        _ => false,
    }
}

/// `PR` or `PA` of the polar forms.
fn polar_word(c: &mut Cursor, start: usize, incremental: bool, motion: &mut Motion) -> Parsed<()> {
    let polar = matches!(
        motion.kind,
        MotionKind::LinePolar | MotionKind::CirclePolar | MotionKind::CircleTangentialPolar
    );
    let slot = match c.peek_at(1).to_ascii_uppercase() {
        b'R' if polar => &mut motion.polar_radius,
        b'A' if polar => &mut motion.polar_angle,
        _ => {
            c.go_to(start);
            return c.unexpected();
        }
    };
    c.advance(2);
    let value = c.required_value(start)?;
    set_once(c, start, Some(Word { value, incremental }), slot)
}

/// `DR+` or `DR-` of the arcs.
fn direction_word(c: &mut Cursor, start: usize, motion: &mut Motion) -> Parsed<()> {
    let arc = matches!(
        motion.kind,
        MotionKind::Circle | MotionKind::CircleRadius | MotionKind::CirclePolar
    );
    if !c.keyword("DR") || !arc {
        c.go_to(start);
        return c.unexpected();
    }
    let direction = sense(c, start)?;
    set_once(c, start, Some(direction), &mut motion.direction)
}

/// The sign after `DR`.
pub(super) fn sense(c: &mut Cursor, start: usize) -> Parsed<Sense> {
    if c.accept(b'+') {
        Ok(Sense::CounterClockwise)
    } else if c.accept(b'-') {
        Ok(Sense::Clockwise)
    } else if c.peek().is_ascii_alphanumeric() && c.position() == start + 2 {
        c.go_to(start);
        c.fault_at_word(BlockNotKnown, "no control here knows this word")
    } else {
        c.fault_from(start, EntryValueIncorrect, "DR needs a sign")
    }
}

#[cfg(test)]
mod tests {
    use super::super::test::{fault, m, operation, q, words};
    use super::*;
    use Value::Number;

    fn motion(text: &str) -> Motion {
        match operation(text) {
            Operation::Motion(motion) => motion,
            other => panic!("{text}: {other:?}"),
        }
    }

    fn absolute(value: Value) -> Option<Word> {
        Some(Word {
            value,
            incremental: false,
        })
    }

    fn incremental(value: Value) -> Option<Word> {
        Some(Word {
            value,
            incremental: true,
        })
    }

    #[test]
    fn lines() {
        let full = motion("L IX-50 Y+10 Z-20 RR F100 M3");
        assert_eq!(full.kind, MotionKind::Line);
        assert_eq!(full.coordinates, words("IX-50 Y10 Z-20"));
        assert_eq!(full.compensation, Some(Compensation::Right));
        assert_eq!(full.feed, Some(Feed::Value(Number(100.0))));
        assert_eq!(full.m, m(&[3]));
        for text in [
            "L IX-50 Y10 Z-20 RR F 100 M03",
            "12 L IX-50Y10Z-20RRF100M3",
            "l ix-50 y10,0 z -20. rr f100 m3",
            "\tL  IX - 50 Y + 10 Z-20.000 RR F100 M3 ; comment",
            "LIX-50 Y+10 Z-20 M3 F100 RR....milling",
        ] {
            assert_eq!(motion(text), full, "{text}");
        }
        assert_eq!(motion("LY+5").coordinates, words("Y5"));
        assert_eq!(motion("LB+90").coordinates, words("B90"));
        assert_eq!(motion("L X+Q1 Y-Q2 FQ20").coordinates, words("XQ1 Y-Q2"));
        assert_eq!(motion("L X+Q1 Y-Q2 FQ20").feed, Some(Feed::Value(q(20))));
        assert_eq!(
            motion("L A+1 B+2 C+3 U+4 V+5 W+6").coordinates,
            words("A1 B2 C3 U4 V5 W6")
        );
    }

    #[test]
    fn the_feed_of_the_tool_call_is_not_known_however_it_is_written() {
        assert_eq!(fault("L X+5 FAUTO"), (BlockNotKnown, 7, 5));
        assert_eq!(fault("L X+5 F AUTO M3"), (BlockNotKnown, 7, 6));
    }

    #[test]
    fn lines_without_coordinates() {
        assert_eq!(motion("L M99").m, m(&[99]));
        assert_eq!(motion("L R0 F500 M3").compensation, Some(Compensation::Off));
        assert_eq!(motion("L").coordinates, Coordinates::default());
        assert_eq!(motion("LFMAX").feed, Some(Feed::Max));
    }

    #[test]
    fn placeholders_of_the_screen() {
        assert_eq!(motion("L X+5 R F5000 M"), motion("L X+5 F5000"));
        assert_eq!(motion("L X+5 R F M"), motion("L X+5"));
        assert_eq!(motion("L X+5 R0 F MAX M"), motion("L X+5 R0 FMAX"));
        assert_eq!(motion("L X+5 F M3"), motion("L X+5 M3"));
        assert_eq!(motion("L X+5 R0 FMAXM3"), motion("L X+5 R0 FMAX M3"));
        assert_eq!(motion("L X+5 M3 M8").m, m(&[3, 8]));
    }

    #[test]
    fn chamfers() {
        let chamfer = |length, feed| Operation::Chamfer { length, feed };
        for text in ["L5", "L 5", "CHF 5", "CHF5", "L +5", "chf 5,0"] {
            assert_eq!(operation(text), chamfer(Number(5.0), None), "{text}");
        }
        assert_eq!(operation("L 10"), chamfer(Number(10.0), None));
        assert_eq!(operation("L Q5"), chamfer(q(5), None));
        assert_eq!(operation("CHF 5 F200"), chamfer(Number(5.0), Some(Number(200.0))));
        assert_eq!(fault("L5 X+10"), (UnexpectedText, 4, 4));
    }

    #[test]
    fn arcs() {
        let c = motion("C IX+5 Y-5 DR-");
        assert_eq!(
            (c.kind, c.direction),
            (MotionKind::Circle, Some(Sense::Clockwise))
        );
        assert_eq!(c.coordinates, words("IX5 Y-5"));
        let cr = motion("CR X+10 Y+2 R-5 DR- RL");
        assert_eq!(
            (cr.kind, cr.radius),
            (MotionKind::CircleRadius, Some(Number(-5.0)))
        );
        assert_eq!(cr.compensation, Some(Compensation::Left));
        assert_eq!(motion("CR X+1 Y+2 R0.5 DR+ R0").radius, Some(Number(0.5)));
        assert_eq!(motion("CR X+1 Y+2 R+Q11 DR+").radius, Some(q(11)));
        assert_eq!(motion("CR X+1 Y+2 R+2,5 DR+").radius, Some(Number(2.5)));
        let ct = motion("CT IX+50 IY-10 RR");
        assert_eq!(
            (ct.kind, ct.compensation),
            (MotionKind::CircleTangential, Some(Compensation::Right))
        );
        assert_eq!(motion("CX+5Y+5DR+").kind, MotionKind::Circle);
        assert_eq!(motion("C C+90 DR+").coordinates, words("C90"));
    }

    #[test]
    fn circle_centres() {
        assert_eq!(
            operation("CC X+20 Y-10"),
            Operation::CircleCentre(words("X20 Y-10"))
        );
        assert_eq!(operation("CC"), Operation::CircleCentre(Coordinates::default()));
        assert_eq!(
            operation("CCIX+1 IZ+Q3"),
            Operation::CircleCentre(words("IX1 IZQ3"))
        );
        assert_eq!(fault("CC X+1 Y+1 F100"), (UnexpectedText, 12, 4));
    }

    #[test]
    fn roundings() {
        let rounding = |radius, feed| Operation::Rounding { radius, feed };
        assert_eq!(
            operation("RND 10 F 100"),
            rounding(Number(10.0), Some(Number(100.0)))
        );
        assert_eq!(operation("RND R20"), rounding(Number(20.0), None));
        assert_eq!(operation("RND R10"), rounding(Number(10.0), None));
        assert_eq!(operation("RND RQ16 FQ17"), rounding(q(16), Some(q(17))));
        assert_eq!(operation("RND2,5F"), rounding(Number(2.5), None));
        assert_eq!(fault("RND 5 FMAX"), (UnexpectedText, 7, 4));
        assert_eq!(fault("RND"), (EntryValueIncorrect, 1, 3));
    }

    #[test]
    fn polar_forms() {
        let lp = motion("LP PR+5 PA+30");
        assert_eq!(lp.kind, MotionKind::LinePolar);
        assert_eq!(
            (lp.polar_radius, lp.polar_angle),
            (absolute(Number(5.0)), absolute(Number(30.0)))
        );
        assert_eq!(motion("LP IPA-60").polar_angle, incremental(Number(-60.0)));
        assert_eq!(motion("7 LP PR +Q2 PA +Q60 R0 FMAX").polar_angle, absolute(q(60)));
        let cp = motion("CP PA+10 DR-");
        assert_eq!(
            (cp.kind, cp.direction),
            (MotionKind::CirclePolar, Some(Sense::Clockwise))
        );
        let ctp = motion("CTP PR+10 PA+80");
        assert_eq!(ctp.kind, MotionKind::CircleTangentialPolar);
        let helix = motion("CP IPA+1080 IZ+5 DR-RL");
        assert_eq!(helix.polar_angle, incremental(Number(1080.0)));
        assert_eq!(helix.coordinates, words("IZ5"));
        assert_eq!(helix.compensation, Some(Compensation::Left));
    }

    #[test]
    fn single_axis_blocks() {
        let x = motion("X+20 R+ F100 M3");
        assert_eq!(
            (x.kind, x.compensation),
            (MotionKind::Paraxial, Some(Compensation::Lengthen))
        );
        assert_eq!(motion("IY-5 R- FMAX").compensation, Some(Compensation::Shorten));
        assert_eq!(motion("12 X 20 R0 F100").coordinates, words("X20"));
        assert_eq!(motion("C+90 F100").kind, MotionKind::Paraxial);
        assert_eq!(motion("IC+90 F100").coordinates, words("IC90"));
        assert_eq!(motion("B-Q3").coordinates, words("B-Q3"));
        assert_eq!(fault("X+20 Y+10"), (UnexpectedText, 6, 4));
        assert_eq!(fault("X+20 RL"), (UnexpectedText, 6, 2));
        assert_eq!(fault("L X+20 R+ F100"), (UnexpectedText, 8, 2));
    }

    #[test]
    fn faulty_numbers_are_located() {
        assert_eq!(fault("L Xnan"), (EntryValueIncorrect, 3, 4));
        assert_eq!(fault("L X1.2.3 Y5"), (EntryValueIncorrect, 4, 5));
        assert_eq!(fault("L X--5"), (EntryValueIncorrect, 4, 3));
        assert_eq!(fault("L X+ Y+5"), (EntryValueIncorrect, 4, 1));
        assert_eq!(fault("L X Y+5"), (EntryValueIncorrect, 3, 1));
        assert_eq!(fault("L X+5 Y+"), (EntryValueIncorrect, 8, 1));
        assert_eq!(fault("L Xinf"), (EntryValueIncorrect, 3, 4));
        assert_eq!(fault("L X123456789012345678901"), (EntryValueIncorrect, 4, 21));
        assert_eq!(fault("L X+Q2000"), (EntryValueIncorrect, 4, 6));
        assert_eq!(fault("C X+5 Y+5 DR"), (EntryValueIncorrect, 11, 2));
        assert_eq!(fault("C X+5 Y+5 DR RL"), (EntryValueIncorrect, 11, 2));
    }

    #[test]
    fn words_out_of_place_are_located() {
        assert_eq!(fault("L X+5 X+6"), (AxisDoubleProgrammed, 7, 3));
        assert_eq!(fault("L X+5 IX+6 R0"), (AxisDoubleProgrammed, 7, 4));
        assert_eq!(fault("CC X+5 X+5"), (AxisDoubleProgrammed, 8, 3));
        assert_eq!(fault("L X+5 Y+6 hop"), (UnexpectedText, 11, 3));
        assert_eq!(fault("L X+5 F100 F200"), (UnexpectedText, 12, 4));
        assert_eq!(fault("L PR+5"), (UnexpectedText, 3, 4));
        assert_eq!(fault("L X+5 R5"), (UnexpectedText, 7, 2));
        assert_eq!(fault("L X+5 DR+"), (UnexpectedText, 7, 3));
        assert_eq!(fault("L X+5 FZ0.1"), (BlockNotKnown, 7, 5));
        assert_eq!(fault("L X+5 RX"), (UnexpectedText, 7, 2));
        assert_eq!(fault("Höhe"), (BlockNotKnown, 1, 4));
    }

    #[test]
    fn lines_with_surface_normals() {
        let line = motion("LN X+31.7 Y+21.95 Z+33.16 NX+0.2637581 NY+0.0078922 NZ-0.8764339 R0 F1000 M107");
        assert_eq!(line.kind, MotionKind::LineNormal);
        let normal = line.normal.as_deref();
        assert_eq!(
            normal,
            Some(&[0.263_758_1, 0.007_892_2, -0.876_433_9].map(Value::Number))
        );
        assert_eq!(line.coordinates.axes().len(), 3);
        assert!(line.m.contains(107));
        assert_eq!(motion("LNX+1NXQ1NY0NZ1").coordinates, motion("L X+1").coordinates);
        for (text, message, column) in [
            ("LN X+1 NX+0 NY+0", EntryValueIncorrect, 17),
            ("LN X+1", EntryValueIncorrect, 7),
            ("LN X+1 NX+0 NX+1 NY+0 NZ+1", UnexpectedText, 13),
            ("LN X", EntryValueIncorrect, 4),
        ] {
            let (found, at, _) = fault(text);
            assert_eq!((found, at), (message, column), "{text}");
        }
        for text in ["LN X+1 NW+5", "L X+1 NX+0"] {
            fault(text);
        }
    }

    #[test]
    fn blocks_of_later_controls() {
        for text in [
            "PLANE SPATIAL SPA+45 SPB+0 SPC+0 STAY",
            "FUNCTION MODE TURN",
            "SEL PGM \"A.H\"",
            "SPL X+5 Y+5",
            "PATTERN DEF POS1 (X+1 Y+2 Z+0)",
            "DECLARE STRING QS1",
            "CALL SELECTED PGM",
            "SECTION",
            "WMAT \"STEEL\"",
        ] {
            assert_eq!(fault(text).0, BlockNotKnown, "{text}");
            assert_eq!(fault(text).1, 1, "{text}");
        }
    }
}
