//! Tools: their definitions and their calls.
//!
//! Decision: The tip of another tool stands elsewhere without a movement: at TOOL CALL on a machine the position in
//! the tool axis changes by the difference of the lengths; in a test run the tool is lifted out; M91 positions the
//! spindle nose
//!
//! Decision: A tool that is nowhere defined counts as L0 R0 with a warning; with a tool table or strict checking it
//! is an error

use std::collections::BTreeMap;

use bahn_parameters::{MessageId, technology};
use bahn_path::{Axis, Blank, Curve, FeedRate, Function, Plane, Position, ToolCall, ToolShape};
use bahn_program::Value;

use crate::availability::{Feature, words};
use crate::context::Context;
use crate::error::{Fault, WarningKind};
use crate::modal::Modal;
use crate::numbers::Numbers;
use crate::pen::Pen;
use crate::settings::{Settings, ToolState, ToolTable, tool_key};
use crate::status::Tool;
use crate::tilting;

/// A tool number is meant to have an index when it is as near as this to a tenth.
const INDEX_TOLERANCE: f64 = 1e-9;

/// The tools of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tools {
    /// Those defined by TOOL DEF.
    defined: BTreeMap<u32, ToolShape>,
    /// The tool was replaced, and the path is still to come back to where it was, programmed and moved.
    pub comes_back: Option<(Position, Position)>,
}

impl Tools {
    /// Tools that TOOL DEF has defined.
    pub fn definitions(&self) -> usize {
        self.defined.len()
    }

    /// TOOL DEF: tool data, or with a tool table and without data the pre-selection of the next tool
    /// [003:1803-1840] [003:1931-1933].
    pub fn define(
        &mut self,
        c: &mut Context<'_>,
        tool: Value,
        length: Option<Value>,
        radius: Option<Value>,
    ) -> Result<(), Fault> {
        let number = tool_number(c.numbers, tool, c.settings)?;
        if length.is_none() && radius.is_none() {
            // What TOOL CALL will call is made ready (inferred).
            let next = usable(number, 0, c.settings).map_or(number, |(next, _)| next);
            return c.output_function(Function::NextTool(next), technology::Block::ToolDef);
        }
        let length = length
            .map(|length| c.numbers.length(length))
            .transpose()?
            .unwrap_or(0.0);
        let radius = radius
            .map(|radius| c.numbers.length(radius))
            .transpose()?
            .unwrap_or(0.0);
        let max = c.settings.model.limits().coordinate_max;
        if !(0.0..=max).contains(&radius) || length.abs() > max {
            return Err(Fault::new(
                MessageId::EntryValueIncorrect,
                format!("R takes 0 to {max}, L up to {max} mm"),
            ));
        }
        if number == 0 && (length != 0.0 || radius != 0.0) {
            // Tool 0 has length and radius 0 [003:1814-1816].
            return Err(Fault::new(
                MessageId::EntryValueIncorrect,
                "tool 0 has length and radius 0",
            ));
        }
        self.defined.insert(
            number,
            ToolShape {
                length,
                radius,
                corner_radius: 0.0,
                point_angle_deg: c
                    .settings
                    .point_angles_deg
                    .get(&number)
                    .copied()
                    .unwrap_or_default(),
                ..ToolShape::default()
            },
        );
        Ok(())
    }

    /// TOOL CALL: selects compensation data, tool axis and speed; a call may change only the speed
    /// [003:1917-1952] [003:2188].
    pub fn call(
        &mut self,
        c: &mut Context<'_>,
        blank: Option<&Blank>,
        tool: Option<Value>,
        axis: Option<Axis>,
        speed: Option<Value>,
        oversize: [Option<Value>; 2],
    ) -> Result<(), Fault> {
        if let Some(speed) = speed {
            c.modal.speed_rpm = checked_speed(c.numbers, speed, c.settings)?;
        }
        let Some(tool) = tool else {
            if let Some(axis) = axis {
                c.pen.finish_contour()?;
                set_tool_axis(c.modal, c.numbers, c.settings, axis)?;
            }
            let speed = Function::SpindleSpeed(c.modal.speed_rpm);
            return c.output_function(speed, technology::Block::SpindleSpeed);
        };
        c.pen.finish_contour()?;
        let (number, index) = indexed_tool_number(c.numbers, tool, c.settings)?;
        let (number, index) = usable(number, index, c.settings)?;
        let (shape, defined) = self.shape(c, number, index)?;
        let has_oversize = oversize.iter().any(Option::is_some);
        let executed = !has_oversize || c.executes(Feature::Word(words::OVERSIZE))?;
        let mut delta = [0.0; 2];
        for (delta, value) in delta.iter_mut().zip(oversize) {
            if let Some(value) = value.filter(|_| executed) {
                *delta = c.numbers.length(value)?;
            }
        }
        let axis = axis.or(c.modal.tool.map(|tool| tool.axis)).unwrap_or(Axis::Z);
        set_tool_axis(c.modal, c.numbers, c.settings, axis)?;
        let tool = Tool::new(number, axis, (shape, defined), delta);
        insert_tool(c, blank, tool, false)
    }

    /// The replacement tool takes the place of the one in the spindle, whose axis and oversizes count for it, too.
    /// After it the path [comes back](Tools::come_back).
    pub fn replace(&mut self, c: &mut Context<'_>, blank: Option<&Blank>, number: u32) -> Result<(), Fault> {
        let Some(old) = c.modal.tool else {
            return Ok(());
        };
        let data = self.shape(c, number, 0)?;
        self.comes_back = Some((c.modal.nominal, c.modal.actual));
        insert_tool(c, blank, Tool::new(number, old.axis, data, old.oversize), true)
    }

    /// From wherever the axes stand after a change that no block has programmed, the path comes back to where it was,
    /// the tool axis last (inferred: the blocks that follow count on it, and need not move all axes).
    pub fn come_back(&mut self, modal: &mut Modal, pen: &mut Pen) {
        let (Some((nominal, actual)), Some(tool)) = (self.comes_back.take(), modal.tool) else {
            return;
        };
        (modal.nominal, modal.actual) = (nominal, actual);
        let mut beside = actual;
        beside[tool.axis] = f64::NAN;
        for end in [beside, actual] {
            let element = pen.element(Curve::Line, Position::UNKNOWN, end, FeedRate::Rapid);
            pen.out.push(element, None);
        }
    }

    /// Radius of a tool that is not in use, mm.
    pub fn radius_of(&self, c: &mut Context<'_>, tool: f64) -> Result<f64, Fault> {
        let number = tool_number(c.numbers, Value::Number(tool), c.settings)?;
        Ok(self.shape(c, number, 0)?.0.radius)
    }

    /// Tool data: from the program, from the table, zero for tool 0. With a table a missing tool is an
    /// error; without one old programs rely on a table that is not at hand, so zero is taken with a
    /// warning, unless checking is strict.
    fn shape(&self, c: &mut Context<'_>, number: u32, index: u8) -> Result<(ToolShape, bool), Fault> {
        let key = tool_key(number, index);
        let in_table = || c.settings.tools.as_ref().and_then(|table| table.get(&key));
        if let Some(shape) = self.defined.get(&key).or_else(in_table) {
            return Ok((*shape, true));
        }
        if number == 0 {
            return Ok((ToolShape::default(), true));
        }
        if c.settings.strict || c.settings.tools.is_some() {
            return Err(Fault::new(MessageId::ToolNotDefined, format!("tool {number}")));
        }
        c.warn(WarningKind::ToolNotDefined { tool: number });
        Ok((ToolShape::default(), false))
    }
}

/// A tool comes into the spindle, by TOOL CALL or at the end of the life of the one before.
fn insert_tool(
    c: &mut Context<'_>,
    blank: Option<&Blank>,
    tool: Tool,
    at_end_of_life: bool,
) -> Result<(), Fault> {
    let Tool {
        number,
        axis,
        mut shape,
        radius,
        ..
    } = tool;
    if c.settings.machine || c.modal.tool.is_some_and(|tool| tool.number == number) {
        tilting::change_tool(c, axis, shape.length, change_length);
    } else {
        c.modal.length_mm = Some(shape.length);
        lift_out(c.modal, blank, axis, &c.settings.tool_change);
    }
    c.modal.tool = Some(tool);
    tilting::take_tool(c);
    // The graphics take no notice of a radius that must not be used.
    shape.radius = shape.radius.max(0.0);
    c.numbers.preassign_tool(shape.length, radius);
    let call = ToolCall {
        tool: number,
        axis,
        speed_rpm: c.modal.speed_rpm,
        shape,
        at_end_of_life,
    };
    c.output_function(Function::Tool(call), technology::Block::ToolCall)
}

/// The axes stand still at a tool change, so the tip of a longer tool stands lower: the position in the
/// tool axis changes by the difference of the lengths, and the next block starts there.
fn change_length(modal: &mut Modal, axis: Axis, length: f64) {
    let old_axis = modal.tool.map_or(axis, |tool| tool.axis);
    let Some(before) = modal.length_mm.replace(length) else {
        return;
    };
    if old_axis != axis || before != length {
        for position in [&mut modal.nominal, &mut modal.actual] {
            position[old_axis] += before;
            position[axis] -= length;
        }
    }
}

/// Without a machine nobody knows where tools are changed: another tool is lifted out of the workpiece
/// until its axis is positioned (inferred).
fn lift_out(modal: &mut Modal, blank: Option<&Blank>, tool_axis: Axis, change_at: &Position) {
    let top = blank.zip(tool_axis.main()).map_or(f64::NAN, |(blank, main)| {
        blank.max.get(main.index()).copied().unwrap_or(f64::NAN)
    });
    for position in [&mut modal.nominal, &mut modal.actual] {
        // An axis without a position keeps none; f64::max would give it that of the blank.
        if position[tool_axis] < top {
            position[tool_axis] = top;
        }
        for axis in change_at.known().iter() {
            position[axis] = change_at[axis];
        }
    }
}

fn tool_number(numbers: &Numbers, tool: Value, settings: &Settings) -> Result<u32, Fault> {
    let number = numbers.q.value(tool)?;
    let max = settings.model.limits().tool_max;
    if !(0.0..=f64::from(max)).contains(&number) || number.fract() != 0.0 {
        return Err(Fault::new(
            MessageId::EntryValueIncorrect,
            format!("tool numbers are 0 to {max}"),
        ));
    }
    Ok(number as u32)
}

/// Number and index of a tool: 253.1 is the first other cutting edge of tool 253 in the tables of later
/// controls.
fn indexed_tool_number(numbers: &Numbers, tool: Value, settings: &Settings) -> Result<(u32, u8), Fault> {
    let number = numbers.q.value(tool)?;
    let index = (number.fract() * 10.0).round();
    let in_table = |table: &ToolTable| table.contains_key(&tool_key(number as u32, index as u8));
    // Tenths only, and only a tool that a table has: no control here knows them otherwise.
    let exact = ((number.trunc() + index / 10.0) - number).abs() < INDEX_TOLERANCE;
    if index > 0.0 && exact && settings.tools.as_ref().is_some_and(in_table) {
        return Ok((
            tool_number(numbers, Value::Number(number.trunc()), settings)?,
            index as u8,
        ));
    }
    Ok((tool_number(numbers, tool, settings)?, 0))
}

/// A speed within the entry range. What the spindle has is judged by the spindle itself where there is
/// one: it tells the PLC with M2092 [000:5653].
fn checked_speed(numbers: &Numbers, speed: Value, settings: &Settings) -> Result<f64, Fault> {
    let speed = numbers.q.value(speed)?;
    let entry = settings.model.limits().spindle_speed_max_rpm;
    let max = if settings.machine {
        entry
    } else {
        entry.min(settings.rules.machine.speed_max_rpm)
    };
    if !(0.0..=max).contains(&speed) {
        return Err(Fault::new(MessageId::WrongRpm, format!("S takes 0 to {max} rpm")));
    }
    Ok(speed)
}

/// The tool axis decides the working plane [003:2733-2738]. It must not change while a rotation is
/// active [003:7973-7975], and is "X, Y, Z or the 4th axis", never the 5th [000:3410-3416].
pub(crate) fn set_tool_axis(
    modal: &mut Modal,
    numbers: &mut Numbers,
    settings: &Settings,
    axis: Axis,
) -> Result<(), Fault> {
    if settings.rules.fifth_axis == Some(axis) {
        return Err(Fault::new(
            MessageId::WrongAxisProgrammed,
            format!("{axis} is the 5th axis here (MP410.4): it cannot be the tool axis"),
        ));
    }
    let Some(plane) = Plane::of_tool_axis(axis) else {
        return Err(Fault::new(
            MessageId::WrongAxisProgrammed,
            "a rotary axis cannot be the tool axis",
        ));
    };
    if plane != modal.plane && modal.frame.turns() {
        return Err(Fault::new(MessageId::PlaneWronglyDefined, "a rotation is active"));
    }
    modal.take_plane(plane);
    numbers.preassign_tool_axis(axis);
    Ok(())
}

/// The tool that a TOOL CALL calls: the replacement tool of one whose life is over, or that one's. Refused is a
/// tool that the table locks, and one whose life is over without a replacement [000:9168-9172].
fn usable(number: u32, index: u8, settings: &Settings) -> Result<(u32, u8), Fault> {
    let mut called = (number, index);
    let fault = |message, (tool, _): (u32, u8), what: &str| {
        let of = match tool == number {
            true => String::new(),
            false => format!(", which replaces tool {number}"),
        };
        Err(Fault::new(message, format!("tool {tool}{of}: {what}")))
    };
    // In a longer chain a tool stands twice.
    for _ in 0..=settings.barred_tools.len() {
        let state = settings.barred_tools.get(&tool_key(called.0, called.1));
        called = match state.copied().unwrap_or_default() {
            ToolState::Usable => return Ok(called),
            ToolState::Replaced(replacement) => (replacement, 0),
            ToolState::Locked => {
                return fault(
                    MessageId::ToolLocked,
                    called,
                    "column TL of the tool table locks it",
                );
            }
            ToolState::Expired => {
                return fault(
                    MessageId::MaxToolLifeExpired,
                    called,
                    "CUR.TIME is greater than TIME2",
                );
            }
        };
    }
    fault(
        MessageId::MaxToolLifeExpired,
        (number, index),
        "its replacement tools replace each other, and the lives of all are over",
    )
}
