//! Signals that can be recorded, like those of the control's oscilloscope.

use std::fmt;
use std::str::FromStr;

use bahn_exchange::{Bit, Number};
use bahn_kernel::{AxisUnit, RunState, path_positions};
use bahn_servo::NOMINALS;

use crate::channel::Channel;
use crate::machine::MachineSide;
use crate::setup::ChannelError;
use bahn_kernel::Clock;

/// What of an axis is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisSignal {
    /// `actual`: actual position in machine coordinates, mm or degrees.
    Actual,
    /// `nominal`: nominal position in machine coordinates, mm or degrees.
    Nominal,
    /// `lag`: servo lag, mm or degrees.
    Lag,
    /// `speed`: actual speed, mm/min.
    Speed,
    /// `nominal-speed`: nominal speed, mm/min.
    NominalSpeed,
    /// `volts`: nominal value output, V.
    Volts,
    /// `n-actual`: speed of the motor by its encoder, mm/min; 0 where the control closes no speed loop.
    MotorSpeed,
    /// `n-nominal`: the speed that the position loop asks of the digital speed controller, mm/min.
    NominalMotorSpeed,
    /// `n-int`: the difference of both in the digital speed controller, mm/min.
    SpeedDifference,
    /// `displayed`: actual position as it is displayed, from the workpiece datum with the tool length in the tool axis,
    /// mm or degrees.
    Displayed,
    /// `ref`: actual position as the display REF shows it, from the machine datum, mm or degrees within the modulo value
    /// of a rotary axis.
    Ref,
    /// `distance`: distance to go in the block, mm or degrees.
    Distance,
    /// `probed`: the coordinate that the TOUCH PROBE menu shows as DATUM, mm.
    Probed,
}

/// What of the touch probe is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProbeSignal {
    /// `probe.length`: calibrated effective length, mm.
    Length,
    /// `probe.radius`: calibrated effective radius of the ball, mm.
    Radius,
    /// `probe.angle`: basic rotation, degrees.
    Angle,
    /// `probe.touches`: touches of the function that is chosen.
    Touches,
    /// `probe.circle`: radius PR of the circle that was probed, mm.
    Circle,
}

/// A signal: `X.lag`, `path.speed`, `S.rpm`, `S.volts`, `M2045`, `W260`.
///
/// ```
/// use bahn_tnc::Signal;
/// assert_eq!("X.lag".parse::<Signal>()?.to_string(), "X.lag");
/// assert_eq!("M2045".parse::<Signal>()?.to_string(), "M2045");
/// assert!("X.temperature".parse::<Signal>().is_err());
/// # Ok::<(), bahn_tnc::SignalError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    /// Of an axis by its letter.
    Axis(char, AxisSignal),
    /// `path.speed`: nominal speed along the path, mm/min.
    PathSpeed,
    /// `path.block`: number of the block that is executed.
    Block,
    /// `S.rpm`: actual speed of the spindle, rpm.
    SpindleRpm,
    /// `S.volts`: voltage of the spindle, V.
    SpindleVolts,
    /// `S.angle`: angle of the spindle since power-on with all turns, degrees; positive as M03.
    SpindleAngle,
    /// `path.distance`: distance to the end of the element that is executed, mm; below 0 where a thread waits after it.
    PathDistance,
    /// `mode`: the operating mode as W272 codes it: manual 1, handwheel 2, mdi 3, single 4, full 5, reference 7.
    Mode,
    /// `run`: idle 0, running 1, interrupted 2, stopped 3, block-end 4.
    Run,
    /// `tool`: number of the tool in the spindle.
    Tool,
    /// `probe.length`, `probe.angle` ..: of the touch probe and its menu.
    Probe(ProbeSignal),
    /// `Q5`: a Q parameter at the block that is executed, not as far as blocks are read ahead.
    Q(u16),
    /// `output.1` to `output.5`, `output.S`, `output.7` ..: the voltage at an analogue output, V.
    Output(usize),
    /// `X41/34`: the output "control is ready", 0 or 1.
    ReadyOutput,
    /// `X42/4`: its acknowledgement, 0 or 1.
    ReadyInput,
    /// A marker, input, output, timer or counter as the PLC sees it, 0 or 1.
    Bit(Bit),
    /// A byte, word or doubleword as the PLC sees it.
    Number(Number),
}

/// The channel before the colon, from 0, and what stands after it: `2:X.actual`, `2: mode full`. Without channel the
/// whole text.
pub fn split_channel(text: &str) -> (Option<usize>, &str) {
    let text = text.trim();
    let parts = text.split_once(':').and_then(|(channel, rest)| {
        let digits = channel.len() == 1 && channel.bytes().all(|byte| byte.is_ascii_digit());
        let number = channel.parse::<usize>().ok().filter(|_| digits)?;
        Some((number.checked_sub(1)?, rest.trim()))
    });
    match parts.filter(|(channel, _)| *channel < ChannelError::CHANNELS_MAX) {
        Some((channel, rest)) => (Some(channel), rest),
        None => (None, text),
    }
}

/// A text is no signal.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no signal: there are X.actual, X.nominal, X.lag, X.speed, X.nominal-speed, X.volts, X.displayed, X.ref, \
     X.distance, X.probed, X.n-actual, X.n-nominal, X.n-int for each axis, path.speed, path.block, path.distance, S.rpm, \
     S.volts, S.angle, output.1 to output.5, output.S, mode, run, tool, probe.length, probe.radius, probe.angle, \
     probe.touches, probe.circle, Q5, X41/34, X42/4, and operands of the PLC like M2045, I4, O2, W260, D356"
)]
pub struct SignalError(String);

impl SignalError {
    /// The text is none.
    pub fn of(text: &str) -> SignalError {
        SignalError(text.to_owned())
    }
}

const AXIS_SIGNALS: [(&str, AxisSignal); 13] = [
    ("actual", AxisSignal::Actual),
    ("nominal", AxisSignal::Nominal),
    ("lag", AxisSignal::Lag),
    ("speed", AxisSignal::Speed),
    ("nominal-speed", AxisSignal::NominalSpeed),
    ("volts", AxisSignal::Volts),
    ("displayed", AxisSignal::Displayed),
    ("ref", AxisSignal::Ref),
    ("distance", AxisSignal::Distance),
    ("n-actual", AxisSignal::MotorSpeed),
    ("n-nominal", AxisSignal::NominalMotorSpeed),
    ("n-int", AxisSignal::SpeedDifference),
    ("probed", AxisSignal::Probed),
];

/// Signals with a name of their own.
const NAMED: [(&str, Signal); 16] = [
    ("path.speed", Signal::PathSpeed),
    ("path.block", Signal::Block),
    ("path.distance", Signal::PathDistance),
    ("S.rpm", Signal::SpindleRpm),
    ("S.volts", Signal::SpindleVolts),
    ("S.angle", Signal::SpindleAngle),
    ("mode", Signal::Mode),
    ("run", Signal::Run),
    ("tool", Signal::Tool),
    ("probe.length", Signal::Probe(ProbeSignal::Length)),
    ("probe.radius", Signal::Probe(ProbeSignal::Radius)),
    ("probe.angle", Signal::Probe(ProbeSignal::Angle)),
    ("probe.touches", Signal::Probe(ProbeSignal::Touches)),
    ("probe.circle", Signal::Probe(ProbeSignal::Circle)),
    ("X41/34", Signal::ReadyOutput),
    ("X42/4", Signal::ReadyInput),
];

/// The output S among the analogue outputs.
const OUTPUT_S: usize = 5;

/// `1` to `5`, `S`, `7` ..
fn output(name: &str) -> Option<usize> {
    let number = match name {
        "S" => OUTPUT_S,
        "6" => return None,
        name => name.parse::<usize>().ok()?.checked_sub(1)?,
    };
    (number < NOMINALS).then_some(number)
}

impl FromStr for Signal {
    type Err = SignalError;

    fn from_str(text: &str) -> Result<Signal, SignalError> {
        let wrong = || SignalError(text.to_owned());
        let text = text.trim();
        if let Some((_, signal)) = NAMED.iter().find(|(name, _)| *name == text) {
            return Ok(*signal);
        }
        if let Some(name) = text.strip_prefix("output.") {
            return output(name).map(Signal::Output).ok_or_else(wrong);
        }
        if let Some(number) = text.strip_prefix('Q').and_then(|number| number.parse().ok()) {
            return Ok(Signal::Q(number));
        }
        if let Some((letter, name)) = text.split_once('.') {
            let mut letters = letter.chars();
            let (Some(letter), None) = (letters.next(), letters.next()) else {
                return Err(wrong());
            };
            let signal = AXIS_SIGNALS.iter().find(|(known, _)| *known == name);
            let axis = letter
                .is_ascii()
                .then(|| bahn_path::Axis::from_letter(letter as u8))
                .flatten();
            return match (axis, signal) {
                (Some(axis), Some((_, signal))) => Ok(Signal::Axis(axis.letter(), *signal)),
                _ => Err(wrong()),
            };
        }
        if let Ok(bit) = text.parse::<Bit>() {
            return Ok(Signal::Bit(bit));
        }
        text.parse::<Number>().map(Signal::Number).map_err(|_| wrong())
    }
}

impl Signal {
    /// Its name with the letters of a control: E17 and A7 where inputs and outputs are E and A, `old`, I17 and O7 elsewhere.
    pub fn name(&self, old: bool) -> String {
        match self {
            Signal::Bit(bit) => bit.name(old),
            signal => signal.to_string(),
        }
    }
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Signal::Axis(letter, signal) => {
                let name = AXIS_SIGNALS
                    .iter()
                    .find(|(_, of)| of == signal)
                    .map_or("", |(name, _)| *name);
                write!(f, "{letter}.{name}")
            }
            Signal::Q(number) => write!(f, "Q{number}"),
            Signal::Output(OUTPUT_S) => write!(f, "output.S"),
            Signal::Output(number) => write!(f, "output.{}", number + 1),
            Signal::Bit(bit) => bit.fmt(f),
            Signal::Number(number) => number.fmt(f),
            named => {
                let name = NAMED.iter().find(|(_, signal)| signal == named);
                f.write_str(name.map_or("", |(name, _)| name))
            }
        }
    }
}

impl Signal {
    /// Unit of its values; empty for operands.
    pub fn unit(&self) -> &'static str {
        match self {
            Signal::Axis(_, signal) if signal.is_speed() => "mm/min",
            Signal::PathSpeed => "mm/min",
            Signal::Axis(_, AxisSignal::Volts) | Signal::SpindleVolts | Signal::Output(_) => "V",
            Signal::Axis(..) | Signal::PathDistance => "mm",
            Signal::SpindleRpm => "rpm",
            Signal::SpindleAngle | Signal::Probe(ProbeSignal::Angle) => "degrees",
            Signal::Probe(ProbeSignal::Length | ProbeSignal::Radius | ProbeSignal::Circle) => "mm",
            _ => "",
        }
    }
}

impl Signal {
    /// Its value now; an axis that the channel does not have reads 0.
    pub(crate) fn value(&self, channel: &Channel, machine: &MachineSide, seam: &Clock) -> f64 {
        let (run, track) = (&channel.run, &channel.run.core.track);
        let plc = machine.memory.of(channel.number()).plc();
        let spindle = machine.spindles.of(channel.number());
        let bit = |bit: bool| f64::from(u8::from(bit));
        match self {
            Signal::Axis(letter, signal) => {
                let mut axes = machine.core.axes.owned(channel.number());
                axes.find(|unit| unit.axis.letter() == *letter)
                    .map_or(0.0, |unit| signal.value(unit, channel, machine))
            }
            Signal::PathSpeed => track.speed_mm_s() * 60.0,
            Signal::PathDistance => track.path.rest_mm(),
            Signal::Block => {
                let element = track.path.element();
                element.map_or(0.0, |element| element.block.block.into())
            }
            Signal::SpindleRpm => spindle.state().actual_rpm,
            Signal::SpindleVolts => spindle.state().volts,
            Signal::SpindleAngle => spindle.drive.turned_deg(),
            Signal::Mode => channel.desk().mode().code().into(),
            Signal::Run => match run.progress().state() {
                RunState::Idle => 0.0,
                RunState::Running => 1.0,
                RunState::Interrupted => 2.0,
                RunState::Stopped => 3.0,
                RunState::BlockEnd => 4.0,
            },
            Signal::Tool => channel.tools.number.into(),
            Signal::Q(number) => run.q_value(*number),
            Signal::Probe(signal) => signal.value(channel),
            Signal::Output(number) => {
                let command = seam.commands.axes.get(*number);
                command.map_or(0.0, |command| command.volts)
            }
            Signal::ReadyOutput => bit(seam.commands.control_ready),
            Signal::ReadyInput => bit(seam.measured.control_ready),
            Signal::Bit(operand) => bit(plc.bit(*operand)),
            Signal::Number(number) => plc.number(*number).into(),
        }
    }
}

impl ProbeSignal {
    fn value(self, channel: &Channel) -> f64 {
        let touch = &channel.touch;
        let calibration = touch.memory.calibration.unwrap_or_default();
        let shown = || touch.shown(&channel.chain().offsets);
        match self {
            ProbeSignal::Length => calibration.length_mm,
            ProbeSignal::Radius => calibration.radius_mm,
            ProbeSignal::Angle => touch.memory.basic_rotation_deg,
            ProbeSignal::Touches => shown().map_or(0.0, |shown| shown.touches as f64),
            ProbeSignal::Circle => shown().and_then(|shown| shown.radius_mm).unwrap_or(0.0),
        }
    }
}

impl AxisSignal {
    /// It is a speed, mm/min.
    pub fn is_speed(self) -> bool {
        matches!(
            self,
            AxisSignal::Speed
                | AxisSignal::NominalSpeed
                | AxisSignal::MotorSpeed
                | AxisSignal::NominalMotorSpeed
                | AxisSignal::SpeedDifference
        )
    }

    fn value(self, unit: &AxisUnit, channel: &Channel, machine: &MachineSide) -> f64 {
        match self {
            AxisSignal::Actual => unit.servo.actual_mm(),
            AxisSignal::Nominal => unit.servo.nominal_mm(),
            AxisSignal::Lag => unit.servo.lag_mm(),
            AxisSignal::Speed => unit.servo.actual_velocity_mm_min(),
            AxisSignal::NominalSpeed => unit.speed * 60.0,
            AxisSignal::Volts => unit.servo.volts(),
            AxisSignal::MotorSpeed => unit.servo.speed().map_or(0.0, |speed| speed.actual_mm_min),
            AxisSignal::NominalMotorSpeed => unit.servo.speed().map_or(0.0, |speed| speed.nominal_mm_min),
            AxisSignal::SpeedDifference => unit.servo.speed().map_or(0.0, |speed| speed.difference_mm_min),
            AxisSignal::Displayed => {
                let [actual, _] = path_positions(machine.core.axes.owned(channel.number()), channel.chain());
                unit.shown(actual[unit.axis])
            }
            AxisSignal::Ref => unit.shown(unit.servo.actual_mm()),
            AxisSignal::Probed => {
                let shown = channel.touch.shown(&channel.chain().offsets);
                shown
                    .and_then(|shown| shown.datum.get(unit.axis))
                    .unwrap_or(f64::NAN)
            }
            AxisSignal::Distance => channel.run.distance_to_go(unit, channel.chain()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_are_read_as_they_are_written() {
        for text in [
            "X.actual",
            "C.ref",
            "Z.displayed",
            "Y.distance",
            "Z.probed",
            "probe.angle",
            "path.distance",
            "S.angle",
            "mode",
            "run",
            "tool",
            "Q5",
            "output.1",
            "output.S",
            "output.7",
            "output.40",
            "X41/34",
            "X42/4",
            "M2045",
            "W260",
        ] {
            assert_eq!(
                text.parse::<Signal>().map(|signal| signal.to_string()),
                Ok(text.to_owned())
            );
        }
        for wrong in [
            "output.0",
            "output.6",
            "output.41",
            "Q",
            "Q-1",
            "Q70000",
            "X41/4",
            "X.q",
        ] {
            assert!(wrong.parse::<Signal>().is_err(), "{wrong}");
        }
    }
}
