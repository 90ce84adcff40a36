//! ISO blocks in listings: always with `*`, numbers by MP7220 [000:6885].
//!
//! Decision: A listing in DIN/ISO ends with N99999, or N99999999 where the numbers reach that; a block without N is
//! called by its place (also `program/src/program.rs`)

use bahn_path::{AxisSet, Sense};

use super::function::{CALCULATIONS, CONDITIONS};
use crate::format::number::{push_integer, push_signed, push_unsigned};
use crate::format::{FormatOptions, formula_text};
use crate::parse::rest_of_word;
use crate::{
    Block, Calculation, Compensation, Coordinates, CycleBlock, CycleFunction, Distance, Feed, Header,
    MFunctions, ModalBlock, Modality, Motion, MotionKind, Operation, PathFunction, Unit, Value, Word,
};

/// Number of the last block, as long as those before it are smaller; else the greatest that a control takes.
const LAST: [u64; 2] = [99_999, 99_999_999];

/// The number before a block of the listing; none before the first.
pub(super) fn write_number(number: u32, block: &Block, options: FormatOptions, text: &mut String) {
    if options.iso_step == 0 {
        // Without a number of its own what cannot be read could lose its first word.
        if let Operation::Invalid(invalid) = &block.operation
            && invalid
                .text
                .starts_with(|c: char| c == '/' || c.is_ascii_digit() || c.eq_ignore_ascii_case(&'N'))
        {
            text.push_str("N0 ");
        }
        return;
    }
    let counted = u64::from(number) * u64::from(options.iso_step);
    let number = match &block.operation {
        Operation::Begin(_) => return,
        Operation::End(_) => last_number(number, options.iso_step.into()),
        _ => counted,
    };
    text.push('N');
    push_integer(text, number, 1);
    text.push(' ');
}

/// The number of the last block.
pub(super) fn last_number(number: u32, step: u32) -> u64 {
    let [usual, greatest] = LAST;
    match u64::from(number) * u64::from(step) < usual {
        true => usual,
        false => greatest,
    }
}

/// A block without number and line end.
pub(super) fn write_block(block: &Block, options: FormatOptions, text: &mut String) {
    let mut out = Output {
        text: std::mem::take(text),
        comma: options.decimal_comma,
    };
    if block.skip {
        out.text.push_str("/ ");
    }
    let start = out.text.len();
    out.operation(&block.operation);
    // Words begin with a blank; the first one needs none.
    if out.text.get(start..).is_some_and(|own| own.starts_with(' ')) {
        out.text.remove(start);
    }
    if let Some(comment) = &block.comment {
        out.text.push_str(" ; ");
        out.text.push_str(comment);
    }
    out.text.push_str(" *");
    *text = out.text;
}

/// Text being written. Every word begins with a blank.
pub(super) struct Output {
    pub(super) text: String,
    comma: bool,
}

/// The words whose G90 or G91 differs: open ones come first, what stays in force last.
pub(super) struct Distances {
    pub(super) last: Option<Distance>,
}

impl Output {
    fn operation(&mut self, operation: &Operation) {
        match operation {
            Operation::Begin(header) | Operation::End(header) => self.header(header),
            Operation::Motion(motion) => self.motion(motion, None),
            Operation::Modal(block) => self.modal(block),
            Operation::Miscellaneous(m) => self.m_functions(m),
            Operation::Comment(text) => {
                self.word(";");
                if !text.is_empty() {
                    self.word(text);
                }
            }
            Operation::Invalid(invalid) => self.word(&invalid.text),
            Operation::Label(label) => {
                self.word("G98 L");
                self.integer(*label);
            }
            Operation::CallLabel { label, repeats } => {
                self.word("L");
                self.integer(*label);
                self.text.push(',');
                self.unsigned(repeats.unwrap_or(Value::Number(0.0)));
            }
            Operation::CallProgram(name) => {
                self.word("%");
                self.text.push_str(name);
            }
            Operation::Stop(m) => {
                self.word("G38");
                self.m_functions(m);
            }
            Operation::CycleCall(m) => {
                self.word("G79");
                self.m_functions(m);
            }
            Operation::ToolDefinition { tool, length, radius } => {
                let code = if length.is_none() && radius.is_none() {
                    "G51 T"
                } else {
                    "G99 T"
                };
                self.word(code);
                self.unsigned(*tool);
                self.signed_word("L", *length);
                self.signed_word("R", *radius);
            }
            other => self.of_several(other),
        }
    }

    fn of_several(&mut self, operation: &Operation) {
        match operation {
            Operation::ToolCall { .. } => self.tool_call(operation),
            Operation::CircleCentre(centre) if centre.is_empty() => self.word("G29"),
            Operation::CircleCentre(_) | Operation::BlankMax(_) => self.modal(&ModalBlock {
                code: matches!(operation, Operation::BlankMax(_)).then_some(31),
                modality: Modality {
                    distance: Some(Distance::Absolute),
                    ..Modality::default()
                },
                operations: [operation.clone()].into(),
            }),
            Operation::BlankMin(corner, axis) => {
                self.word("G30");
                if let Some(axis) = axis {
                    self.plane(*axis);
                }
                self.group(corner, corner.axes(), None);
            }
            Operation::Rounding { .. } => self.corner("G25 R", operation),
            Operation::Chamfer { .. } => self.corner("G24 R", operation),
            Operation::Cycle(block) => {
                self.cycle(None, CycleFunction::Definition, &[block], Modality::default())
            }
            Operation::Probe(block) => self.cycle(None, CycleFunction::Probe, &[block], Modality::default()),
            other => self.q_function(other),
        }
    }

    fn header(&mut self, header: &Header) {
        self.word("%");
        self.text.push_str(&header.name);
        match header.unit {
            Some(Unit::Mm) => self.word("G71"),
            Some(Unit::Inch) => self.word("G70"),
            None => {}
        }
        if header.protected {
            self.word("G50");
        }
    }

    fn tool_call(&mut self, operation: &Operation) {
        if let Operation::ToolCall {
            tool,
            axis,
            speed,
            delta_length,
            delta_radius,
        } = operation
        {
            self.unsigned_word("T", *tool);
            if let Some(axis) = axis {
                self.plane(*axis);
            }
            self.unsigned_word("S", *speed);
            self.signed_word("DL", *delta_length);
            self.signed_word("DR", *delta_radius);
        }
    }

    pub(super) fn plane(&mut self, axis: bahn_path::Axis) {
        self.word(match axis {
            bahn_path::Axis::Y => "G18",
            bahn_path::Axis::X => "G19",
            _ => "G17",
        });
    }

    fn corner(&mut self, address: &str, operation: &Operation) {
        if let Operation::Rounding { radius, feed } | Operation::Chamfer { length: radius, feed } = operation
        {
            self.signed_word(address, Some(*radius));
            self.unsigned_word("F", *feed);
        }
    }

    fn modal(&mut self, block: &ModalBlock) {
        let cycles = |function| -> Vec<&CycleBlock> {
            let own = block
                .operations
                .iter()
                .filter_map(move |part| match (part, function) {
                    (Operation::Cycle(cycle), CycleFunction::Definition)
                    | (Operation::Probe(cycle), CycleFunction::Probe) => Some(&**cycle),
                    _ => None,
                });
            own.collect()
        };
        for function in [CycleFunction::Definition, CycleFunction::Probe] {
            let blocks = cycles(function);
            if !blocks.is_empty() {
                return self.cycle(block.code, function, &blocks, block.modality);
            }
        }
        if let Some(code) = block.code {
            return self.special(code, block);
        }
        let centre = block.operations.iter().find_map(|part| match part {
            Operation::CircleCentre(centre) => Some((centre, block.modality.open)),
            _ => None,
        });
        block.operations.iter().for_each(|part| self.tool_call(part));
        let motion = block.operations.iter().find_map(|part| match part {
            Operation::Motion(motion) => Some(motion),
            _ => None,
        });
        match motion {
            Some(motion) => self.motion(motion, centre),
            None => {
                let mut groups = Distances {
                    last: block.modality.distance,
                };
                groups.write(self, |out, group| {
                    if let Some((centre, open)) = centre {
                        out.centre(centre, open, group);
                    }
                });
            }
        }
    }

    /// G24 to G31 with what is in force after them.
    fn special(&mut self, code: u16, block: &ModalBlock) {
        let Some(operation) = block.operations.first() else {
            return;
        };
        let modality = block.modality;
        self.word("G");
        push_integer(&mut self.text, u64::from(code), 2);
        if let Some(axis) = modality.plane {
            self.plane(axis);
        }
        let mut groups = Distances {
            last: modality.distance,
        };
        match operation {
            Operation::BlankMin(corner, axis) => {
                if let Some(axis) = axis {
                    self.plane(*axis);
                }
                groups.write(self, |out, group| out.group(corner, modality.open, group));
            }
            Operation::BlankMax(corner) => {
                groups.write(self, |out, group| out.group(corner, modality.open, group));
            }
            other => {
                groups.write(self, |_, _| {});
                self.corner("R", other);
            }
        }
    }

    /// A positioning block, with the centre that stands in it.
    fn motion(&mut self, motion: &Motion, centre: Option<(&Coordinates, AxisSet)>) {
        let modality = motion.modal.unwrap_or_else(|| said(motion));
        if let Some(function) = modality.function {
            self.word("G");
            push_integer(&mut self.text, u64::from(function.code()), 2);
        }
        if let Some(axis) = modality.plane {
            self.plane(axis);
        }
        if let Some(compensation) = motion.compensation {
            self.word(match compensation {
                Compensation::Off => "G40",
                Compensation::Left => "G41",
                Compensation::Right => "G42",
                Compensation::Lengthen => "G43",
                Compensation::Shorten => "G44",
            });
        }
        let radius = motion.polar_radius.or(motion.radius.map(|value| Word {
            value,
            incremental: modality.distance == Some(Distance::Incremental),
        }));
        let mut groups = Distances {
            last: modality.distance,
        };
        groups.write(self, |out, group| {
            if let Some((centre, open)) = centre {
                out.centre(centre, open, group);
            }
            out.group(&motion.coordinates, modality.open, group);
            for (address, word, open) in [
                ("R", radius, modality.open_radius),
                ("H", motion.polar_angle, modality.open_angle),
            ] {
                if let Some(word) = word.filter(|word| group_of(*word, open) == group) {
                    out.signed_word(address, Some(word.value));
                }
            }
        });
        match motion.feed {
            Some(Feed::Value(value)) => self.unsigned_word("F", Some(value)),
            Some(Feed::Max) if motion.modal.is_some() => self.word("FMAX"),
            _ => {}
        }
        self.m_functions(&motion.m);
    }

    /// I, J and K of one group.
    fn centre(&mut self, centre: &Coordinates, open: AxisSet, group: Option<Distance>) {
        for (axis, word) in centre.iter() {
            if group_of(word, open.contains(axis)) == group {
                let letter = match axis {
                    bahn_path::Axis::X => "I",
                    bahn_path::Axis::Y => "J",
                    _ => "K",
                };
                self.signed_word(letter, Some(word.value));
            }
        }
    }

    /// Axis words of one group.
    pub(super) fn group(&mut self, coordinates: &Coordinates, open: AxisSet, group: Option<Distance>) {
        for (axis, word) in coordinates.iter() {
            if group_of(word, open.contains(axis)) == group {
                self.signed_word(axis.letter().encode_utf8(&mut [0; 4]), Some(word.value));
            }
        }
    }

    fn q_function(&mut self, operation: &Operation) {
        match operation {
            Operation::Calculate {
                function,
                target,
                a,
                b,
            } => {
                let row = CALCULATIONS.iter().find(|(_, listed)| listed == function);
                self.d(row.map_or(0, |(code, _)| *code));
                self.word("Q");
                self.integer(*target);
                self.p(1, *a);
                let single = matches!(
                    function,
                    Calculation::Assign | Calculation::SquareRoot | Calculation::Sine | Calculation::Cosine
                );
                if !single {
                    self.p(2, *b);
                }
            }
            Operation::Jump {
                condition,
                a,
                b,
                label,
            } => {
                let row = CONDITIONS.iter().find(|(_, listed)| listed == condition);
                self.d(row.map_or(9, |(code, _)| *code));
                self.p(1, *a);
                self.p(2, *b);
                self.word("P03 ");
                self.integer(*label);
            }
            Operation::ErrorNumber(number) => {
                self.d(14);
                self.unsigned_p(1, *number);
            }
            Operation::Print(items) => {
                self.d(15);
                for (number, item) in (1..).zip(items.iter()) {
                    self.unsigned_p(number, *item);
                }
            }
            Operation::Plc { a, b } => {
                self.d(19);
                self.p(1, *a);
                if let Some(b) = b {
                    self.p(2, *b);
                }
            }
            Operation::Formula { target, expression } => {
                self.word("Q");
                self.integer(*target);
                self.text.push_str(" = ");
                self.text.push_str(&formula_text(expression, self.comma));
            }
            _ => {}
        }
    }

    pub(super) fn d(&mut self, code: u16) {
        self.word("D");
        push_integer(&mut self.text, u64::from(code), 2);
    }

    pub(super) fn p_index(&mut self, number: u16) {
        self.word("P");
        push_integer(&mut self.text, u64::from(number), 2);
        self.text.push(' ');
    }

    pub(super) fn p(&mut self, number: u16, value: Value) {
        self.p_index(number);
        self.signed(value);
    }

    pub(super) fn unsigned_p(&mut self, number: u16, value: Value) {
        self.p_index(number);
        self.unsigned(value);
    }

    /// The M functions, each with its words.
    fn m_functions(&mut self, m: &MFunctions) {
        for &code in m.codes() {
            self.word("M");
            self.integer(code);
            let own = m
                .arguments
                .iter()
                .flatten()
                .filter(|argument| argument.code == code);
            for argument in own {
                self.word("");
                self.text.push(argument.letter);
                self.text.push_str(rest_of_word(code, argument.letter));
                self.unsigned(argument.value);
            }
        }
    }

    pub(super) fn word(&mut self, word: &str) {
        self.text.push(' ');
        self.text.push_str(word);
    }

    pub(super) fn signed_word(&mut self, address: &str, value: Option<Value>) {
        if let Some(value) = value {
            self.word(address);
            self.signed(value);
        }
    }

    pub(super) fn unsigned_word(&mut self, address: &str, value: Option<Value>) {
        if let Some(value) = value {
            self.word(address);
            self.unsigned(value);
        }
    }

    pub(super) fn signed(&mut self, value: Value) {
        push_signed(&mut self.text, value, self.comma);
    }

    fn unsigned(&mut self, value: Value) {
        push_unsigned(&mut self.text, value, self.comma);
    }

    pub(super) fn integer(&mut self, number: u16) {
        push_integer(&mut self.text, u64::from(number), 1);
    }
}

impl Distances {
    /// Writes the open words, then those after the other function, then those after the one that stays.
    pub(super) fn write(&mut self, out: &mut Output, mut words: impl FnMut(&mut Output, Option<Distance>)) {
        words(out, None);
        let Some(last) = self.last else { return };
        let other = match last {
            Distance::Absolute => Distance::Incremental,
            Distance::Incremental => Distance::Absolute,
        };
        let before = out.text.len();
        out.word(g_of(other));
        let after = out.text.len();
        words(out, Some(other));
        if out.text.len() == after {
            out.text.truncate(before);
        }
        out.word(g_of(last));
        words(out, Some(last));
    }
}

fn g_of(distance: Distance) -> &'static str {
    match distance {
        Distance::Absolute => "G90",
        Distance::Incremental => "G91",
    }
}

/// Which function a word stands after; none if it is open.
fn group_of(word: Word, open: bool) -> Option<Distance> {
    match (open, word.incremental) {
        (true, _) => None,
        (false, true) => Some(Distance::Incremental),
        (false, false) => Some(Distance::Absolute),
    }
}

/// What a block of a language without functions in force says of them.
fn said(motion: &Motion) -> Modality {
    let clockwise = motion.direction == Some(Sense::Clockwise);
    let rapid = motion.feed == Some(Feed::Max);
    let function = match motion.kind {
        MotionKind::Line | MotionKind::LineNormal if rapid => PathFunction::Rapid,
        MotionKind::Line | MotionKind::LineNormal => PathFunction::Line,
        MotionKind::Circle | MotionKind::CircleRadius if clockwise => PathFunction::Clockwise,
        MotionKind::Circle | MotionKind::CircleRadius => PathFunction::CounterClockwise,
        MotionKind::CircleTangential => PathFunction::Tangential,
        MotionKind::LinePolar if rapid => PathFunction::PolarRapid,
        MotionKind::LinePolar => PathFunction::PolarLine,
        MotionKind::CirclePolar if clockwise => PathFunction::PolarClockwise,
        MotionKind::CirclePolar => PathFunction::PolarCounterClockwise,
        MotionKind::CircleTangentialPolar => PathFunction::PolarTangential,
        MotionKind::Paraxial => PathFunction::Paraxial,
    };
    Modality {
        function: Some(function),
        distance: Some(Distance::Absolute),
        ..Modality::default()
    }
}
