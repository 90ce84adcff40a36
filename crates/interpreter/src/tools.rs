//! Tools and the blank.

use bahn_parameters::{MessageId, technology};
use bahn_path::{Axis, Blank, Curve, FeedRate, Function, Plane, Position, ToolCall, ToolShape};
use bahn_program::{Coordinates, Value};

use crate::availability::{Feature, words};
use crate::error::{Cause, Fault, WarningKind};
use crate::numbers::known;
use crate::run::Run;
use crate::settings::{Settings, ToolState, ToolTable, tool_key};
use crate::status::Tool;

/// A tool number is meant to have an index when it is as near as this to a tenth.
const INDEX_TOLERANCE: f64 = 1e-9;

impl Run {
    /// TOOL DEF: tool data, or with a tool table and without data the pre-selection of the next tool
    /// [003:1803-1840] [003:1931-1933].
    pub(crate) fn tool_definition(
        &mut self,
        tool: Value,
        length: Option<Value>,
        radius: Option<Value>,
        settings: &Settings,
    ) -> Result<(), Fault> {
        let number = self.tool_number(tool, settings)?;
        if length.is_none() && radius.is_none() {
            // What TOOL CALL will call is made ready (inferred).
            let next = usable(number, 0, settings).map_or(number, |(next, _)| next);
            return self.pen.output_function(
                &self.modal,
                Function::NextTool(next),
                technology::Block::ToolDef,
                settings,
            );
        }
        let length = length
            .map(|length| self.numbers.length(length))
            .transpose()?
            .unwrap_or(0.0);
        let radius = radius
            .map(|radius| self.numbers.length(radius))
            .transpose()?
            .unwrap_or(0.0);
        let max = settings.model.limits().coordinate_max;
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
        self.tools.insert(
            number,
            ToolShape {
                length,
                radius,
                corner_radius: 0.0,
                point_angle_deg: settings
                    .point_angles_deg
                    .get(&number)
                    .copied()
                    .unwrap_or_default(),
            },
        );
        Ok(())
    }

    /// TOOL CALL: selects compensation data, tool axis and speed; a call may change only the speed
    /// [003:1917-1952] [003:2188].
    pub(crate) fn tool_call(
        &mut self,
        tool: Option<Value>,
        axis: Option<Axis>,
        speed: Option<Value>,
        oversize: [Option<Value>; 2],
        settings: &Settings,
    ) -> Result<(), Fault> {
        if let Some(speed) = speed {
            self.modal.speed_rpm = self.speed(speed, settings)?;
        }
        let Some(tool) = tool else {
            if let Some(axis) = axis {
                self.pen.finish_contour()?;
                self.set_tool_axis(axis)?;
            }
            let speed = Function::SpindleSpeed(self.modal.speed_rpm);
            return self
                .pen
                .output_function(&self.modal, speed, technology::Block::SpindleSpeed, settings);
        };
        self.pen.finish_contour()?;
        let (number, index) = self.indexed_tool_number(tool, settings)?;
        let (number, index) = usable(number, index, settings)?;
        let (shape, defined) = self.tool_shape(number, index, settings)?;
        let has_oversize = oversize.iter().any(Option::is_some);
        let executed = !has_oversize || self.executes(Feature::Word(words::OVERSIZE), settings)?;
        let mut delta = [0.0; 2];
        for (delta, value) in delta.iter_mut().zip(oversize) {
            if let Some(value) = value.filter(|_| executed) {
                *delta = self.numbers.length(value)?;
            }
        }
        let axis = axis.or(self.modal.tool.map(|tool| tool.axis)).unwrap_or(Axis::Z);
        self.set_tool_axis(axis)?;
        let tool = Tool::new(number, axis, (shape, defined), delta);
        self.insert_tool(tool, false, settings)
    }

    /// A tool comes into the spindle, by TOOL CALL or at the end of the life of the one before.
    fn insert_tool(&mut self, tool: Tool, at_end_of_life: bool, settings: &Settings) -> Result<(), Fault> {
        let Tool {
            number,
            axis,
            mut shape,
            radius,
            ..
        } = tool;
        if settings.machine || self.modal.tool.is_some_and(|tool| tool.number == number) {
            self.change_length(axis, shape.length);
        } else {
            self.modal.length_mm = Some(shape.length);
            self.lift_out(axis, &settings.tool_change);
        }
        self.modal.tool = Some(tool);
        // The graphics take no notice of a radius that must not be used.
        shape.radius = shape.radius.max(0.0);
        self.numbers.preassign_tool(shape.length, radius);
        let call = ToolCall {
            tool: number,
            axis,
            speed_rpm: self.modal.speed_rpm,
            shape,
            at_end_of_life,
        };
        self.pen.output_function(
            &self.modal,
            Function::Tool(call),
            technology::Block::ToolCall,
            settings,
        )
    }

    /// The replacement tool takes the place of the one in the spindle, whose axis and oversizes count for it, too.
    /// Behind it the path [comes back](Run::come_back).
    pub(crate) fn replace_tool(&mut self, number: u32, settings: &Settings) -> Result<(), Fault> {
        let Some(old) = self.modal.tool else {
            return Ok(());
        };
        let data = self.tool_shape(number, 0, settings)?;
        self.comes_back = Some((self.modal.nominal, self.modal.actual));
        self.insert_tool(Tool::new(number, old.axis, data, old.oversize), true, settings)
    }

    /// From wherever the axes stand behind a change that no block has programmed, the path comes back to where it was,
    /// the tool axis last (inferred: the blocks that follow count on it, and need not move all axes).
    pub(crate) fn come_back(&mut self) {
        let (Some((nominal, actual)), Some(tool)) = (self.comes_back.take(), self.modal.tool) else {
            return;
        };
        (self.modal.nominal, self.modal.actual) = (nominal, actual);
        let mut beside = actual;
        beside[tool.axis] = f64::NAN;
        for end in [beside, actual] {
            let element = self
                .pen
                .element(Curve::Line, Position::UNKNOWN, end, FeedRate::Rapid);
            self.pen.out.push(element, None);
        }
    }

    /// The axes stand still at a tool change, so the tip of a longer tool stands lower: the position in the
    /// tool axis changes by the difference of the lengths, and the next block starts there.
    fn change_length(&mut self, axis: Axis, length: f64) {
        let old_axis = self.modal.tool.map_or(axis, |tool| tool.axis);
        let Some(before) = self.modal.length_mm.replace(length) else {
            return;
        };
        if old_axis != axis || before != length {
            for position in [&mut self.modal.nominal, &mut self.modal.actual] {
                position[old_axis] += before;
                position[axis] -= length;
            }
        }
    }

    /// Without a machine nobody knows where tools are changed: another tool is lifted out of the workpiece
    /// until its axis is positioned (inferred).
    fn lift_out(&mut self, tool_axis: Axis, change_at: &Position) {
        let top = self
            .blank
            .zip(tool_axis.main())
            .map_or(f64::NAN, |(blank, main)| {
                blank.max.get(main.index()).copied().unwrap_or(f64::NAN)
            });
        for position in [&mut self.modal.nominal, &mut self.modal.actual] {
            // An axis without a position keeps none; f64::max would give it that of the blank.
            if position[tool_axis] < top {
                position[tool_axis] = top;
            }
            for axis in change_at.known().iter() {
                position[axis] = change_at[axis];
            }
        }
    }

    fn tool_number(&self, tool: Value, settings: &Settings) -> Result<u32, Fault> {
        let number = self.numbers.q.value(tool)?;
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
    fn indexed_tool_number(&self, tool: Value, settings: &Settings) -> Result<(u32, u8), Fault> {
        let number = self.numbers.q.value(tool)?;
        let index = (number.fract() * 10.0).round();
        let in_table = |table: &ToolTable| table.contains_key(&tool_key(number as u32, index as u8));
        // Tenths only, and only a tool that a table has: no control here knows them otherwise.
        let exact = ((number.trunc() + index / 10.0) - number).abs() < INDEX_TOLERANCE;
        if index > 0.0 && exact && settings.tools.as_ref().is_some_and(in_table) {
            return Ok((
                self.tool_number(Value::Number(number.trunc()), settings)?,
                index as u8,
            ));
        }
        Ok((self.tool_number(tool, settings)?, 0))
    }

    /// Tool data: from the program, from the table, zero for tool 0. With a table a missing tool is an
    /// error; without one old programs rely on a table that is not at hand, so zero is taken with a
    /// warning, unless checking is strict.
    fn tool_shape(
        &mut self,
        number: u32,
        index: u8,
        settings: &Settings,
    ) -> Result<(ToolShape, bool), Fault> {
        let key = tool_key(number, index);
        let in_table = || settings.tools.as_ref().and_then(|table| table.get(&key));
        if let Some(shape) = self.tools.get(&key).or_else(in_table) {
            return Ok((*shape, true));
        }
        if number == 0 {
            return Ok((ToolShape::default(), true));
        }
        if settings.strict || settings.tools.is_some() {
            return Err(Fault::new(MessageId::ToolNotDefined, format!("tool {number}")));
        }
        self.warn(WarningKind::ToolNotDefined { tool: number });
        Ok((ToolShape::default(), false))
    }

    /// A speed within the entry range. What the spindle has is judged by the spindle itself where there is
    /// one: it tells the PLC with M2092 [000:5653].
    fn speed(&self, speed: Value, settings: &Settings) -> Result<f64, Fault> {
        let speed = self.numbers.q.value(speed)?;
        let entry = settings.model.limits().spindle_speed_max_rpm;
        let max = if settings.machine {
            entry
        } else {
            entry.min(settings.rules.speed_max_rpm)
        };
        if !(0.0..=max).contains(&speed) {
            return Err(Fault::new(MessageId::WrongRpm, format!("S takes 0 to {max} rpm")));
        }
        Ok(speed)
    }

    /// The tool axis decides the working plane [003:2733-2738]. It must not change while a rotation is
    /// active [003:7973-7975].
    fn set_tool_axis(&mut self, axis: Axis) -> Result<(), Fault> {
        let Some(plane) = Plane::of_tool_axis(axis) else {
            return Err(Fault::new(
                MessageId::WrongAxisProgrammed,
                "a rotary axis cannot be the tool axis",
            ));
        };
        if plane != self.modal.plane && self.modal.frame.rotation_deg != 0.0 {
            return Err(Fault::new(MessageId::PlaneWronglyDefined, "a rotation is active"));
        }
        self.modal.take_plane(plane);
        self.numbers.preassign_tool_axis(axis);
        Ok(())
    }

    // Blank.

    /// BLK FORM 0.1: tool axis and least corner, absolute only [003:2113-2114].
    pub(crate) fn blank_min(&mut self, coordinates: &Coordinates, axis: Option<Axis>) -> Result<(), Fault> {
        if !coordinates.incremental().is_empty() {
            return Err(Fault::new(
                MessageId::BlkFormDefinitionIncorrect,
                "the MIN corner is absolute",
            ));
        }
        let Some(plane) = Plane::of_tool_axis(axis.unwrap_or(Axis::Z)) else {
            return Err(MessageId::BlkFormDefinitionIncorrect.into());
        };
        self.modal.blank_min = Some((plane, self.corner(coordinates, [0.0; 3])?));
        Ok(())
    }

    /// BLK FORM 0.2: greatest corner, absolute or incremental from the least one [003:2113-2121].
    pub(crate) fn blank_max(&mut self, coordinates: &Coordinates, settings: &Settings) -> Result<(), Fault> {
        let wrong = |detail: String| Fault::new(MessageId::BlkFormDefinitionIncorrect, detail);
        let Some((plane, min)) = self.modal.blank_min.take() else {
            return Err(wrong("BLK FORM 0.1 is missing".into()).because(Cause::NoBlankMin));
        };
        let max = self.corner(coordinates, min)?;
        let limits = settings.model.limits();
        let sides = [max[0] - min[0], max[1] - min[1], max[2] - min[2]];
        let longest = sides.iter().copied().fold(0.0, f64::max);
        let shortest = sides.iter().copied().fold(f64::INFINITY, f64::min);
        if shortest == 0.0 && longest == 0.0 {
            // Written by programs that want no graphics.
            self.warn(WarningKind::BlankEmpty);
            return Ok(());
        }
        if shortest <= 0.0 {
            return Err(wrong(
                "the MAX corner must be greater than the MIN corner on every axis".into(),
            ));
        }
        if longest > limits.blank_side_max_mm {
            return Err(wrong(format!(
                "a side is longer than {} mm",
                limits.blank_side_max_mm
            )));
        }
        if longest / shortest >= limits.blank_ratio_limit {
            return Err(wrong(format!(
                "the ratio of the sides must stay below {}:1",
                limits.blank_ratio_limit
            )));
        }
        if self.at.in_called_program() {
            if self.blank.is_none() {
                self.warn(WarningKind::BlankInCalledProgram);
            }
            return Ok(());
        }
        let blank = Blank { plane, min, max };
        self.blank.get_or_insert(blank);
        self.pen.output_function(
            &self.modal,
            Function::Blank(blank),
            technology::Block::Blank,
            settings,
        )
    }

    fn corner(&self, coordinates: &Coordinates, base: [f64; 3]) -> Result<[f64; 3], Fault> {
        let mut corner = base;
        for (slot, axis) in corner.iter_mut().zip([Axis::X, Axis::Y, Axis::Z]) {
            let Some(word) = coordinates.get(axis) else {
                return Err(Fault::new(
                    MessageId::BlkFormDefinitionIncorrect,
                    format!("{axis} is missing"),
                ));
            };
            let value = known(self.numbers.length(word.value)?);
            *slot = if word.incremental { *slot + value } else { value };
        }
        Ok(corner)
    }
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
