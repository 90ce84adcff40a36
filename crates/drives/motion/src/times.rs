//! Time that is no movement: dwell, tool changes, the spindle, M functions.

use bahn_path::{Function, OverrideLaw, PathElement, SpindleOrder};

use crate::gate::{Gate, wait};

/// How long the machine needs for what is no movement, s. Only functions for which the axes wait take
/// time. A programmed stop takes none: waiting for the operator is no machining.
///
/// The control does not know these times, they are the machine's; the defaults are (inferred) those of
/// a mid-size machining centre.
#[derive(Clone, Debug, PartialEq)]
pub struct AuxiliaryTimes {
    /// Change to another tool. The repeated call of the same tool takes nothing. Default 6.
    pub tool_change_s: f64,
    /// Spindle start, M3, M4, M13 or M14 out of standstill. Default 1.
    pub spindle_start_s: f64,
    /// Spindle stop, M5, or part of a change of direction. Default 1.
    pub spindle_stop_s: f64,
    /// Other speed of the turning spindle. Default 0.5.
    pub spindle_speed_change_s: f64,
    /// Oriented spindle stop (cycle 13). Default 1.
    pub spindle_orientation_s: f64,
    /// Every M function, in addition. Default 0.
    pub m_function_s: f64,
}

impl Default for AuxiliaryTimes {
    fn default() -> Self {
        AuxiliaryTimes {
            tool_change_s: 6.0,
            spindle_start_s: 1.0,
            spindle_stop_s: 1.0,
            spindle_speed_change_s: 0.5,
            spindle_orientation_s: 1.0,
            m_function_s: 0.0,
        }
    }
}

/// Waiting before and after a movement, s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Waiting {
    pub(crate) before: f64,
    pub(crate) after: f64,
}

/// Adds up waiting, element by element in the order of the path.
#[derive(Clone, Debug)]
pub(crate) struct Stopwatch {
    times: AuxiliaryTimes,
    tool: Option<u32>,
    speed_rpm: f64,
    spindle: Spindle,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Spindle {
    Stopped,
    Clockwise,
    CounterClockwise,
}

impl Stopwatch {
    pub(crate) fn new(times: &AuxiliaryTimes) -> Stopwatch {
        Stopwatch {
            times: times.clone(),
            tool: None,
            speed_rpm: 0.0,
            spindle: Spindle::Stopped,
        }
    }

    #[inline]
    pub(crate) fn waiting(&mut self, element: &PathElement) -> Waiting {
        let mut waiting = Waiting {
            before: 0.0,
            after: element.dwell_s.max(0.0),
        };
        if element
            .thread()
            .is_some_and(|thread| thread.orientation_deg.is_some())
        {
            self.spindle = Spindle::Stopped;
            waiting.before += self.times.spindle_orientation_s;
        }
        // In a thread the spindle turns on its ramps, and nothing waits for its speed.
        let tapping = matches!(element.override_law, OverrideLaw::Tapping { .. });
        for function in element.functions() {
            let (ordered, time) = (self.spindle_time(function.spindle), self.time(&function.function));
            let time = if tapping { time } else { ordered + time }.max(0.0);
            match wait(function, element) {
                Some(Gate::Start) => waiting.before += time,
                Some(Gate::End) => waiting.after += time,
                None => {}
            }
        }
        waiting
    }

    fn time(&mut self, function: &Function) -> f64 {
        match function {
            Function::M(_) | Function::Branch { .. } => self.times.m_function_s,
            Function::Tool(call) if self.tool != Some(call.tool) => {
                self.tool = Some(call.tool);
                self.speed_rpm = call.speed_rpm;
                self.times.tool_change_s
            }
            Function::Tool(call) => self.speed_change(call.speed_rpm),
            Function::SpindleSpeed(rpm) => self.speed_change(*rpm),
            Function::SpindleOrientation(_) => {
                self.spindle = Spindle::Stopped;
                self.times.spindle_orientation_s
            }
            Function::Control(_)
            | Function::NextTool(_)
            | Function::OrientationAngle(_)
            | Function::Stop
            | Function::Print(_)
            | Function::Synchronise
            | Function::Voltage(_)
            | Function::Superimpose(_)
            | Function::Plc(_)
            | Function::Blank(_)
            | Function::Write { .. }
            | Function::Shift { .. }
            | Function::Residual => 0.0,
        }
    }

    /// Spindle functions act only when they change the state of the spindle [003:7463-7475].
    fn spindle_time(&mut self, order: Option<SpindleOrder>) -> f64 {
        let wanted = match order {
            None => return 0.0,
            Some(SpindleOrder::Clockwise) => Spindle::Clockwise,
            Some(SpindleOrder::CounterClockwise) => Spindle::CounterClockwise,
            Some(SpindleOrder::Stop) => Spindle::Stopped,
            // Stop and program end stop the spindle too, but are no machining time.
            Some(SpindleOrder::StopWithRun) => {
                self.spindle = Spindle::Stopped;
                return 0.0;
            }
        };
        let was = std::mem::replace(&mut self.spindle, wanted);
        match (was, wanted) {
            (a, b) if a == b => 0.0,
            (Spindle::Stopped, _) => self.times.spindle_start_s,
            (_, Spindle::Stopped) => self.times.spindle_stop_s,
            _ => self.times.spindle_stop_s + self.times.spindle_start_s,
        }
    }

    fn speed_change(&mut self, rpm: f64) -> f64 {
        let was = std::mem::replace(&mut self.speed_rpm, rpm);
        if was == rpm || self.spindle == Spindle::Stopped {
            0.0
        } else {
            self.times.spindle_speed_change_s
        }
    }
}
