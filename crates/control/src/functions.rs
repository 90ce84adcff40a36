//! What the functions of a program do when the path comes to them.

use bahn_exchange::Exchange;
use bahn_parameters::technology::{Deed, Output, Technology};
use bahn_path::{Axis, ControlFunction, Function, ToolCall};

use crate::axes::AxisUnit;
use crate::feeder::Offsets;
use crate::handshake::{Handshakes, Transfer};
use crate::markers::TOOL_AXIS;
use crate::spindle::SpindleUnit;
use crate::tools::Tools;

/// The parts of the control that functions act on.
pub(crate) struct Target<'a> {
    pub spindle: &'a mut SpindleUnit,
    pub tools: &'a mut Tools,
    pub offsets: &'a mut Offsets,
    pub handshakes: &'a mut Handshakes,
    pub exchange: &'a mut Exchange,
    pub axes: &'a mut [AxisUnit],
    /// The program is in inches.
    pub inch: bool,
}

impl Target<'_> {
    /// Outputs a function: its effect in the control, and what goes to the PLC.
    pub fn output(&mut self, function: &Function) {
        match function {
            Function::M(code) => {
                // Each that goes to the PLC has a code of two digits [000:7206].
                if let Ok(code) = u8::try_from(*code) {
                    self.handshakes.push(Transfer::M(code));
                }
            }
            Function::Control(function) => self.control(*function),
            Function::Tool(call) => self.tool(call),
            Function::NextTool(tool) => {
                if let Some(transfer) = self.tools.define(*tool) {
                    self.handshakes.push(transfer);
                }
            }
            Function::SpindleSpeed(rpm) => self.speed(*rpm, true),
            Function::OrientationAngle(angle) => self.spindle.set_cycle_angle(*angle, self.exchange),
            Function::Plc(values) => self.handshakes.push(Transfer::Plc {
                values: values.map(|value| value.map(|value| value.round() as i32)),
                inch: self.inch,
            }),
            // A stop has its barrier; it is the PLC that orients the spindle, with M19 or another M function;
            // printing and the blank concern nothing that moves.
            Function::Stop | Function::SpindleOrientation(_) | Function::Print(_) | Function::Blank(_) => {}
        }
    }

    /// What acts here and never reaches the PLC.
    fn control(&mut self, function: ControlFunction) {
        match function {
            ControlFunction::SecondServoSet(second) => {
                for unit in self.axes.iter_mut() {
                    unit.servo.set_second_set(second);
                }
            }
            ControlFunction::ReplaceWornTools(replaces) => self.tools.replaces_worn = replaces,
            ControlFunction::TakeLargerTools(takes) => self.tools.takes_larger = takes,
        }
    }

    /// An M function that the operator enters: to whom it goes says its row.
    pub fn m_by_hand(&mut self, technology: &Technology, code: u16) {
        for deed in technology.deeds() {
            if let Deed::Control(function) = deed {
                self.control(function);
            }
        }
        if technology.output == Output::Plc {
            self.output(&Function::M(code));
        }
    }

    /// TOOL CALL: the tool goes to the PLC, then its speed; length and axis count from here on.
    fn tool(&mut self, call: &ToolCall) {
        if !self.spindle.judge(call.speed_rpm, self.exchange) {
            // The call is refused as a whole.
            return;
        }
        let before = (self.offsets.tool_length, self.offsets.tool_axis);
        self.tools.call(call, self.exchange, self.handshakes);
        self.tools.hold_geometry(before.0, before.1);
        self.offsets.tool_axis = call.axis;
        self.offsets.tool_length = call.shape.length;
        let axes = [Axis::X, Axis::Y, Axis::Z];
        for (place, marker) in TOOL_AXIS.iter().enumerate() {
            let set = axes
                .get(place)
                .map_or(!axes.contains(&call.axis), |axis| *axis == call.axis);
            if self.exchange.nc().bit(*marker) != set {
                self.exchange.nc_set(*marker, set);
            }
        }
        self.speed(call.speed_rpm, true);
    }

    /// A speed: gear range or S code, by MP3010.
    pub fn speed(&mut self, rpm: f64, tool_call: bool) {
        if let Some(transfer) = self.spindle.program(rpm, tool_call, self.exchange) {
            self.handshakes.push(transfer);
        }
    }
}
