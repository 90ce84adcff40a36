//! Input limits of a control model: what its dialogs would not take.

use bahn_parameters::MessageId::{self, BlockNotKnown, EntryValueIncorrect};
use bahn_parameters::{InchFeed, Limits};

use crate::{
    Calculation, Coordinates, CycleBlock, CycleFunction, CycleWord, Expression, Feed, Motion, MotionKind,
    Operation, Quantity, Unit, Value, cycle,
};

/// Greatest Q parameter number of any control; a greater one is a fault whatever the model.
pub(crate) const ANY_Q_MAX: u16 = 1999;
/// Greatest label number of any control.
pub(crate) const ANY_LABEL_MAX: u16 = 65_534;
/// Cycles of the machine builder [003:4904-4906].
const OEM_CYCLES: std::ops::RangeInclusive<u16> = 68..=99;

/// What programs are read for: the limits of a control model, and what F counts in a program in inches.
#[derive(Clone, Copy, Debug)]
pub struct Reading<'a> {
    /// Limits of the control model.
    pub limits: &'a Limits,
    /// What F counts in a program in inches.
    pub inch_feed: InchFeed,
}

impl<'a> From<&'a Limits> for Reading<'a> {
    /// F counts what it counts on the model.
    fn from(limits: &'a Limits) -> Reading<'a> {
        Reading {
            limits,
            inch_feed: limits.inch_feed,
        }
    }
}

/// What a control model does not take.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitFault {
    /// What the control says to such a block.
    pub message: MessageId,
    /// Address or keyword of the word, to find it in the block.
    pub address: Box<str>,
    /// What exactly, in a few words for people.
    pub detail: Box<str>,
}

/// Checks the numbers of a block against the input limits of a control model, and whether the model knows
/// the function at all. Values of Q parameters are known only when the program runs. The first fault is
/// returned.
///
/// ```
/// use bahn_parameters::{ControlModel, MessageId};
/// use bahn_program::{Program, Unit, check_limits};
///
/// let program = Program::from_bytes("1.H", b"TOOL CALL 1 Z S100000".to_vec());
/// let limits = ControlModel::Tnc360.limits();
/// let fault = check_limits(&program.decode(0).blocks[1].operation, Unit::Mm, limits).unwrap();
/// assert_eq!((fault.message, &*fault.address), (MessageId::EntryValueIncorrect, "S"));
/// ```
pub fn check_limits<'a>(
    operation: &Operation,
    unit: Unit,
    reading: impl Into<Reading<'a>>,
) -> Option<LimitFault> {
    let Reading { limits, inch_feed } = reading.into();
    let check = Check {
        unit,
        limits,
        inch_feed,
    };
    operation.parts().iter().find_map(|part| {
        let unknown = check.unknown_cycle(part).or_else(|| check.parameters(part));
        unknown.or_else(|| check.operation(part))
    })
}

struct Check<'a> {
    unit: Unit,
    limits: &'a Limits,
    inch_feed: InchFeed,
}

impl Check<'_> {
    fn operation(&self, operation: &Operation) -> Option<LimitFault> {
        match operation {
            Operation::BlankMin(corner, _)
            | Operation::BlankMax(corner)
            | Operation::CircleCentre(corner) => self.coordinates(corner),
            Operation::ToolDefinition { tool, length, radius } => self
                .tool("DEF", *tool)
                .or_else(|| self.length("L", *length))
                .or_else(|| self.length("R", *radius)),
            Operation::ToolCall {
                tool,
                speed,
                delta_length,
                delta_radius,
                ..
            } => tool
                .and_then(|tool| self.tool("CALL", tool))
                .or_else(|| self.speed(*speed))
                .or_else(|| self.length("DL", *delta_length))
                .or_else(|| self.length("DR", *delta_radius)),
            Operation::Motion(motion) => self.motion(motion),
            Operation::Rounding { radius, feed } => self
                .length("RND", Some(*radius))
                .or_else(|| self.feed(feed.map(Feed::Value))),
            Operation::Chamfer { length, feed } => self
                .length("L", Some(*length))
                .or_else(|| self.feed(feed.map(Feed::Value))),
            Operation::Label(label) => self.label(*label),
            Operation::CallLabel { label, repeats } => self
                .label(*label)
                .or_else(|| repeats.and_then(|repeats| self.repeats(repeats))),
            Operation::Jump { label, .. } => self.label(*label),
            Operation::ErrorNumber(number) => {
                self.within("ERROR", *number, 0.0, f64::from(self.limits.fn14_max), 1.0)
            }
            Operation::Cycle(block) => self.cycle(block),
            _ => None,
        }
    }

    fn motion(&self, motion: &Motion) -> Option<LimitFault> {
        let angle = match motion.kind {
            MotionKind::LinePolar => self.limits.polar_angle_max_deg,
            _ => self.limits.circle_angle_max_deg,
        };
        let polar_angle = motion.polar_angle.map(|word| word.value);
        let polar_radius = motion.polar_radius.map(|word| word.value);
        let circle = self.limits.circle_radius_max_mm;
        self.coordinates(&motion.coordinates)
            .or_else(|| self.length("PR", polar_radius))
            .or_else(|| polar_angle.and_then(|value| self.within("PA", value, -angle, angle, 1.0)))
            .or_else(|| {
                motion
                    .radius
                    .and_then(|value| self.within("R", value, -circle, circle, self.mm()))
            })
            .or_else(|| self.feed(motion.feed))
    }

    /// A cycle that the control does not know; what its parameters may be nobody knows then.
    fn unknown_cycle(&self, operation: &Operation) -> Option<LimitFault> {
        let Operation::Cycle(block) = operation else {
            return None;
        };
        if self.limits.has_cycle(u32::from(block.number)) || OEM_CYCLES.contains(&block.number) {
            return None;
        }
        let detail = format!("the control has no cycle {}", block.number);
        fault(BlockNotKnown, "DEF", detail)
    }

    fn cycle(&self, block: &CycleBlock) -> Option<LimitFault> {
        let cycle = cycle(CycleFunction::Definition, block.number);
        // Parameters of machining cycles are judged at their call.
        let acting = cycle.filter(|cycle| cycle.acts_at_definition);
        let parameters = acting.map_or(&[][..], |cycle| cycle.block(block.sub));
        let quantity = parameters.first().map(|parameter| parameter.quantity);
        block.words.iter().find_map(|word| match word {
            CycleWord::Feed(feed) => self.feed(Some(*feed)),
            CycleWord::Coordinate(axis, word) => {
                let max = self.limits.coordinate_max;
                let scale = if axis.is_rotary() { 1.0 } else { self.mm() };
                self.within(&axis.to_string(), word.value, -max, max, scale)
            }
            CycleWord::Centre(axis, value) => {
                let max = self.limits.coordinate_max;
                self.within(&axis.to_string(), *value, -max, max, self.mm())
            }
            CycleWord::AxisFactor(axis, value) => {
                let [min, max] = self.limits.scaling_range;
                self.within(&axis.to_string(), *value, min, max, 1.0)
            }
            CycleWord::Labels(labels) => self.contour_labels(labels),
            CycleWord::Number(value) => {
                let [min, max] = match quantity? {
                    Quantity::Dwell => [0.0, self.limits.dwell_max_s],
                    Quantity::Rotation => [-self.limits.rotation_max_deg, self.limits.rotation_max_deg],
                    Quantity::Factor => self.limits.scaling_range,
                    _ => return None,
                };
                let address = format!("{}.{}", block.number, block.sub);
                self.within(&address, *value, min, max, 1.0)
            }
            _ => None,
        })
    }

    fn contour_labels(&self, labels: &[u16]) -> Option<LimitFault> {
        let max = usize::from(self.limits.contour_labels_max);
        if labels.len() > max {
            return fault(
                EntryValueIncorrect,
                "14.1",
                format!("at most {max} subcontours are allowed"),
            );
        }
        labels.iter().find_map(|&label| self.label(label))
    }

    fn coordinates(&self, coordinates: &Coordinates) -> Option<LimitFault> {
        let max = self.limits.coordinate_max;
        coordinates.iter().find_map(|(axis, word)| {
            let scale = if axis.is_rotary() { 1.0 } else { self.mm() };
            self.within(
                axis.letter().encode_utf8(&mut [0; 4]),
                word.value,
                -max,
                max,
                scale,
            )
        })
    }

    /// A length, between the limits of coordinates.
    fn length(&self, address: &str, value: Option<Value>) -> Option<LimitFault> {
        let max = self.limits.coordinate_max;
        self.within(address, value?, -max, max, self.mm())
    }

    fn feed(&self, feed: Option<Feed>) -> Option<LimitFault> {
        let Some(Feed::Value(value)) = feed else {
            return None;
        };
        let max = self.unit.feed_max(self.inch_feed, self.limits.feed_max_mm_min);
        self.within("F", value, 0.0, max, 1.0)
    }

    fn speed(&self, speed: Option<Value>) -> Option<LimitFault> {
        self.within("S", speed?, 0.0, self.limits.spindle_speed_max_rpm, 1.0)
    }

    fn tool(&self, address: &str, tool: Value) -> Option<LimitFault> {
        self.within(address, tool, 0.0, f64::from(self.limits.tool_max), 1.0)
    }

    fn repeats(&self, repeats: Value) -> Option<LimitFault> {
        self.within("REP", repeats, 1.0, f64::from(self.limits.repeat_max), 1.0)
    }

    fn label(&self, label: u16) -> Option<LimitFault> {
        let max = self.limits.label_max;
        if u32::from(label) <= max {
            return None;
        }
        fault(
            EntryValueIncorrect,
            "LBL",
            format!("label numbers go from 0 to {max}"),
        )
    }

    /// Checks a number that is `scale` times as large in the unit of the limits.
    fn within(&self, address: &str, value: Value, min: f64, max: f64, scale: f64) -> Option<LimitFault> {
        let Value::Number(number) = value else { return None };
        if (min..=max).contains(&(number * scale)) {
            return None;
        }
        let (min, max) = (min / scale, max / scale);
        fault(
            EntryValueIncorrect,
            address,
            format!("values from {min} to {max} are allowed"),
        )
    }

    fn mm(&self) -> f64 {
        self.unit.mm()
    }

    /// Functions of Q parameters, and Q parameters anywhere.
    fn parameters(&self, operation: &Operation) -> Option<LimitFault> {
        if let Some(function) = function_number(operation)
            && !self.limits.has_fn(function)
        {
            return fault(BlockNotKnown, "FN", format!("the control has no FN{function}"));
        }
        if matches!(operation, Operation::Formula { .. }) && !self.limits.formulas {
            return fault(BlockNotKnown, "Q", "the control has no formulas".to_owned());
        }
        let max = self.limits.q_max;
        let mut greatest = 0;
        each_parameter(operation, &mut |number| greatest = greatest.max(number));
        if greatest <= max {
            return None;
        }
        fault(
            EntryValueIncorrect,
            &format!("Q{greatest}"),
            format!("Q parameters go from 0 to {max}"),
        )
    }
}

#[cold]
fn fault(message: MessageId, address: &str, detail: String) -> Option<LimitFault> {
    Some(LimitFault {
        message,
        address: address.into(),
        detail: detail.into(),
    })
}

/// Number after `FN`; `None` of another block.
fn function_number(operation: &Operation) -> Option<u32> {
    Some(match operation {
        Operation::Calculate { function, .. } => match function {
            Calculation::Assign => 0,
            Calculation::Add => 1,
            Calculation::Subtract => 2,
            Calculation::Multiply => 3,
            Calculation::Divide => 4,
            Calculation::SquareRoot => 5,
            Calculation::Sine => 6,
            Calculation::Cosine => 7,
            Calculation::Length => 8,
            Calculation::Angle => 13,
        },
        Operation::Jump { .. } => 9,
        Operation::ErrorNumber(_) => 14,
        Operation::Print(_) => 15,
        Operation::Plc { .. } => 19,
        _ => return None,
    })
}

/// Calls a function with the number of each Q parameter in a block, those that it sets included.
pub fn each_parameter(operation: &Operation, found: &mut impl FnMut(u16)) {
    let mut value = |value: Value| {
        if let Value::Q { number, .. } = value {
            found(number);
        }
    };
    match operation {
        Operation::BlankMin(c, _) | Operation::BlankMax(c) | Operation::CircleCentre(c) => {
            in_coordinates(c, &mut value)
        }
        Operation::ToolDefinition { tool, length, radius } => {
            [Some(*tool), *length, *radius]
                .into_iter()
                .flatten()
                .for_each(value);
        }
        Operation::ToolCall {
            tool,
            speed,
            delta_length,
            delta_radius,
            ..
        } => {
            [*tool, *speed, *delta_length, *delta_radius]
                .into_iter()
                .flatten()
                .for_each(value);
        }
        Operation::Motion(motion) => {
            in_coordinates(&motion.coordinates, &mut value);
            let feed = match motion.feed {
                Some(Feed::Value(feed)) => Some(feed),
                _ => None,
            };
            let polar = [motion.polar_radius, motion.polar_angle].map(|word| word.map(|word| word.value));
            polar
                .into_iter()
                .chain([motion.radius, feed])
                .flatten()
                .chain(motion.normal.iter().flat_map(|normal| normal.iter().copied()))
                .for_each(value);
        }
        Operation::Rounding { radius: a, feed: b } | Operation::Chamfer { length: a, feed: b } => {
            [Some(*a), *b].into_iter().flatten().for_each(value);
        }
        Operation::CallLabel { repeats, .. } => repeats.iter().copied().for_each(value),
        Operation::Calculate { target, a, b, .. } => {
            value(*a);
            value(*b);
            found(*target);
        }
        Operation::Jump { a, b, .. } => [*a, *b].into_iter().for_each(value),
        Operation::ErrorNumber(number) => value(*number),
        Operation::Print(items) => items.iter().copied().for_each(value),
        Operation::Plc { a, b } => [Some(*a), *b].into_iter().flatten().for_each(value),
        Operation::Formula { target, expression } => {
            in_expression(expression, &mut value);
            found(*target);
        }
        Operation::Cycle(block) | Operation::Probe(block) => in_cycle(block, found),
        Operation::Modal(block) => block
            .operations
            .iter()
            .for_each(|part| each_parameter(part, found)),
        _ => {}
    }
}

fn in_coordinates(coordinates: &Coordinates, value: &mut impl FnMut(Value)) {
    if !coordinates.parameters().is_empty() {
        coordinates.iter().for_each(|(_, word)| value(word.value));
    }
}

fn in_expression(expression: &Expression, value: &mut impl FnMut(Value)) {
    match expression {
        Expression::Value(operand) => value(*operand),
        Expression::Unary(_, operand) => in_expression(operand, value),
        Expression::Binary(_, left, right) => {
            in_expression(left, value);
            in_expression(right, value);
        }
    }
}

fn in_cycle(block: &CycleBlock, found: &mut impl FnMut(u16)) {
    for word in &block.words {
        let value = match word {
            CycleWord::Number(value)
            | CycleWord::AxisFactor(_, value)
            | CycleWord::Centre(_, value)
            | CycleWord::Feed(Feed::Value(value)) => *value,
            CycleWord::Coordinate(_, word) => word.value,
            CycleWord::Assignment(target, value) => {
                found(*target);
                *value
            }
            CycleWord::Target(target) => {
                found(*target);
                continue;
            }
            _ => continue,
        };
        if let Value::Q { number, .. } = value {
            found(number);
        }
    }
}
