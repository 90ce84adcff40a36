//! Where a channel acts, and what the functions of a program do there when the path comes to them.

use bahn_exchange::Exchange;
use bahn_kernel::{Acting, AxisId, Chain, Now, Outputs, OwnAxes, RunFamily};
use bahn_motion::FunctionOutput;
use bahn_parameters::technology::{ControlAction, Output, Technology};
use bahn_path::{Axis, ControlFunction, Direction, Function, LiveData, Position, ToolCall, Voltage};

use crate::command::Mode;
use crate::handshake::{Handshakes, Transfer};
use crate::magazine::Magazine;
use crate::markers::TOOL_AXIS;
use crate::message::{Message, Messages};
use crate::positioning::PlcPositioning;
use crate::q_transfer::QTransfer;
use crate::spindle::SpindleUnit;
use crate::tools::Tools;

/// Where a channel acts: its axes, its spindle and tools, its part of the PLC's memory, the messages. Who
/// executes blocks or functions is given this, and nothing else of machine and channel.
pub(crate) struct Site<'a> {
    pub mode: Mode,
    pub now: Now,
    pub axes: OwnAxes<'a>,
    pub spindle: &'a mut SpindleUnit,
    pub tools: &'a mut Tools,
    pub magazine: &'a Magazine,
    pub chain: &'a mut Chain,
    pub handshakes: &'a mut Handshakes,
    pub positioning: &'a mut PlcPositioning,
    pub exchange: &'a mut Exchange,
    pub messages: &'a mut Messages,
}

impl<'a> Site<'a> {
    /// Axes and spindle, where a run acts on them.
    pub fn acting(&mut self) -> Acting<'_, 'a> {
        Acting {
            axes: &mut self.axes,
            chain: self.chain,
            spindle: &mut self.spindle.drive,
            now: &self.now,
        }
    }

    /// The path position at which the axes stand: no program knows the slave of a gantry or an axis of the PLC, which would
    /// count as parallel axes.
    pub fn here(&self) -> Position {
        self.chain.to_path(&self.axes.programmed_position())
    }

    /// Where a program that begins finds the axes: it begins upright, however the path stands that was broken off before.
    pub fn upright(&self) -> Position {
        self.chain.upright().to_path(&self.axes.programmed_position())
    }

    /// Outputs a function: its effect in the control, and what goes to the PLC. FN19 says whether its program is
    /// in inches. Whether it is taken: a speed that the spindle does not have is refused.
    pub fn output(&mut self, function: &Function, inch: bool) -> bool {
        match function {
            Function::M(code) => {
                // Each that goes to the PLC has a code of two digits [000:7206].
                if let Ok(code) = u8::try_from(*code) {
                    self.handshakes.push(Transfer::M(code));
                }
            }
            Function::Control(function) => self.control(*function),
            Function::Tool(call) => return self.tool(call),
            Function::NextTool(tool) => {
                if let Some(transfer) = self.tools.define(*tool, self.magazine) {
                    self.handshakes.push(transfer);
                }
            }
            Function::SpindleSpeed(rpm) => return self.speed(*rpm, true),
            Function::OrientationAngle(angle) => self.spindle.set_cycle_angle(*angle, self.exchange),
            Function::Plc(values) => self.handshakes.push(Transfer::Plc {
                values: values.map(|value| value.map(|value| value.round() as i32)),
                inch,
            }),
            Function::Print(line) => self.messages.print(line),
            Function::Superimpose(range) => self.chain.superimposed.set_range(*range),
            // A stop has its barrier; it is the PLC that orients the spindle, with M19 or another M function;
            // the blank concerns nothing that moves;
            // a voltage belongs to the path;
            // parameters and branches of a System 900 are in no program of a TNC.
            Function::Stop
            | Function::SpindleOrientation(_)
            | Function::Synchronise
            | Function::Voltage(_)
            | Function::Blank(_)
            | Function::Write { .. }
            | Function::Shift { .. }
            | Function::Branch { .. }
            | Function::Residual => {}
        }
        true
    }

    /// What acts here and never reaches the PLC.
    fn control(&mut self, function: ControlFunction) {
        match function {
            ControlFunction::SecondServoSet(second) => {
                for unit in self.axes.iter_mut() {
                    unit.servo.set_second_set(second.is_on());
                }
            }
            ControlFunction::ReplaceWornTools(replaces) => self.tools.replaces_worn = replaces.is_on(),
            ControlFunction::TakeLargerTools(takes) => self.tools.takes_larger = takes.is_on(),
        }
    }

    /// An M function that the operator enters: to whom it goes says its row.
    pub fn m_by_hand(&mut self, technology: &Technology, code: u16) {
        for action in technology.actions() {
            if let ControlAction::Control(function) = action {
                self.control(function);
            }
        }
        if technology.output == Output::Plc {
            self.output(&Function::M(code), false);
        }
    }

    /// TOOL CALL: the tool goes to the PLC, then its speed; length and axis count from here on. A wrong speed refuses the
    /// call as a whole.
    fn tool(&mut self, call: &ToolCall) -> bool {
        if !self.spindle.judge(call.speed_rpm, self.exchange) {
            return false;
        }
        let before = (self.chain.offsets.tool_length, self.chain.offsets.tool_axis);
        self.tools
            .call(call, self.magazine, self.exchange, self.handshakes);
        self.tools.hold_geometry(before.0, before.1);
        self.chain.offsets.tool_axis = call.axis;
        self.chain.offsets.tool_length = call.shape.length;
        let axes = [Axis::X, Axis::Y, Axis::Z];
        for (place, marker) in TOOL_AXIS.iter().enumerate() {
            let set = axes
                .get(place)
                .map_or(!axes.contains(&call.axis), |axis| *axis == call.axis);
            self.exchange.nc_put(*marker, set);
        }
        self.speed(call.speed_rpm, true)
    }

    /// Module 9150 without a program: the TOOL CALL is executed at once; a wrong one is passed over without a message
    /// [000:16063-16075].
    pub fn call_inserted_tool(&mut self) {
        let Some(inserted) = self.tools.inserted_call.take() else {
            return;
        };
        let modal = (self.chain.offsets.tool_axis, self.spindle.state().programmed_rpm);
        let Some(call) = self.tools.tool_call(&inserted, modal, self.magazine) else {
            return;
        };
        let called = inserted.tool.is_some() && call.tool != 0;
        if called && !self.magazine.may_be_called(call.tool) {
            return;
        }
        let _taken = match inserted.tool {
            Some(_) => self.tool(&call),
            None => inserted.speed.is_none() || self.speed(call.speed_rpm, true),
        };
    }

    /// A speed: gear range or S code, by MP3010. Whether the spindle has it.
    pub fn speed(&mut self, rpm: f64, tool_call: bool) -> bool {
        if !self.spindle.judge(rpm, self.exchange) {
            return false;
        }
        if let Some(transfer) = self.spindle.program(rpm, tool_call, self.exchange) {
            self.handshakes.push(transfer);
        }
        true
    }

    /// The message of an axis that a block would lead beyond its limit.
    pub fn limit_message(&mut self, axis: Axis, direction: Direction) -> Message {
        let id = self.axes.iter_mut().find(|unit| unit.axis == axis).map(|unit| {
            unit.at_limit = Some(direction);
            unit.id
        });
        Message::limit(id.unwrap_or(AxisId::FIRST), direction)
    }
}

/// Where the functions of the path go: to a site, with a strobe for each block.
pub(crate) struct PathOutputs<'a, 'b> {
    pub site: &'a mut Site<'b>,
    pub q_transfer: &'a mut QTransfer,
    /// The program is in inches.
    pub inch: bool,
}

impl<'a, 'b> PathOutputs<'a, 'b> {
    /// Those of a program, which may be in inches.
    pub fn new(site: &'a mut Site<'b>, q_transfer: &'a mut QTransfer, inch: bool) -> Self {
        PathOutputs {
            site,
            q_transfer,
            inch,
        }
    }
}

impl<'b> RunFamily<'b> for PathOutputs<'_, 'b> {
    fn acting(&mut self) -> Acting<'_, 'b> {
        self.site.acting()
    }

    fn has_transferred(&self) -> bool {
        self.site.handshakes.is_idle()
    }

    /// With the Q parameters that the PLC has written.
    fn answer(&mut self) -> LiveData {
        self.q_transfer.answer()
    }
}

impl Outputs for PathOutputs<'_, '_> {
    fn begin(&mut self, _: &FunctionOutput) {
        self.q_transfer.strobe();
    }

    fn output(&mut self, function: &Function) -> bool {
        self.site.output(function, self.inch)
    }

    fn voltage(&mut self, order: Voltage, sequence: u64) {
        self.site.spindle.set_voltage(order, sequence);
    }
}
