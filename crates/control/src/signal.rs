//! Signals that can be recorded, like those of the control's oscilloscope.

use std::fmt;
use std::str::FromStr;

use bahn_exchange::{Bit, Number};

use crate::axis::AxisUnit;
use crate::channel::Channel;
use crate::machine::MachineSide;
use crate::setup::ChannelError;

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
}

/// A signal: `X.lag`, `path.speed`, `S.rpm`, `S.volts`, `M2045`, `W260`.
///
/// ```
/// use bahn_control::Signal;
/// assert_eq!("X.lag".parse::<Signal>()?.to_string(), "X.lag");
/// assert_eq!("M2045".parse::<Signal>()?.to_string(), "M2045");
/// assert!("X.temperature".parse::<Signal>().is_err());
/// # Ok::<(), bahn_control::SignalError>(())
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
    /// A marker, input, output, timer or counter as the PLC sees it, 0 or 1.
    Bit(Bit),
    /// A byte, word or doubleword as the PLC sees it.
    Number(Number),
}

/// A signal of a channel: `X.actual` and `1:X.actual` of the first one, `2:X.actual` of the second.
///
/// ```
/// use bahn_control::ChannelSignal;
/// let second: ChannelSignal = "2:X.lag".parse()?;
/// assert_eq!((second.channel, second.to_string().as_str()), (1, "2:X.lag"));
/// assert_eq!("1:M2045".parse::<ChannelSignal>()?.to_string(), "M2045");
/// # Ok::<(), bahn_control::SignalError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChannelSignal {
    /// Which channel, from 0.
    pub channel: usize,
    /// What of it; operands of the PLC are those of its window.
    pub signal: Signal,
}

impl FromStr for ChannelSignal {
    type Err = SignalError;

    fn from_str(text: &str) -> Result<ChannelSignal, SignalError> {
        let (channel, signal) = split_channel(text);
        Ok(ChannelSignal {
            channel: channel.unwrap_or(0),
            signal: signal.parse()?,
        })
    }
}

impl fmt::Display for ChannelSignal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.channel > 0 {
            write!(f, "{}:", self.channel + 1)?;
        }
        self.signal.fmt(f)
    }
}

impl From<Signal> for ChannelSignal {
    /// That of the first channel.
    fn from(signal: Signal) -> ChannelSignal {
        ChannelSignal { channel: 0, signal }
    }
}

/// The channel before the colon, from 0, and what stands behind it: `2:X.actual`, `2: mode full`. Without channel the
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
    "`{0}` is no signal: there are X.actual, X.nominal, X.lag, X.speed, X.nominal-speed, X.volts for each axis, \
     path.speed, path.block, S.rpm, S.volts, S.angle, and operands of the PLC like M2045, I4, O2, W260, D356"
)]
pub struct SignalError(String);

const AXIS_SIGNALS: [(&str, AxisSignal); 6] = [
    ("actual", AxisSignal::Actual),
    ("nominal", AxisSignal::Nominal),
    ("lag", AxisSignal::Lag),
    ("speed", AxisSignal::Speed),
    ("nominal-speed", AxisSignal::NominalSpeed),
    ("volts", AxisSignal::Volts),
];

impl FromStr for Signal {
    type Err = SignalError;

    fn from_str(text: &str) -> Result<Signal, SignalError> {
        let wrong = || SignalError(text.to_owned());
        let text = text.trim();
        match text {
            "path.speed" => return Ok(Signal::PathSpeed),
            "path.block" => return Ok(Signal::Block),
            "S.rpm" => return Ok(Signal::SpindleRpm),
            "S.volts" => return Ok(Signal::SpindleVolts),
            "S.angle" => return Ok(Signal::SpindleAngle),
            _ => {}
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
            Signal::PathSpeed => write!(f, "path.speed"),
            Signal::Block => write!(f, "path.block"),
            Signal::SpindleRpm => write!(f, "S.rpm"),
            Signal::SpindleVolts => write!(f, "S.volts"),
            Signal::SpindleAngle => write!(f, "S.angle"),
            Signal::Bit(bit) => bit.fmt(f),
            Signal::Number(number) => number.fmt(f),
        }
    }
}

impl Signal {
    /// Unit of its values; empty for operands.
    pub fn unit(&self) -> &'static str {
        match self {
            Signal::Axis(_, AxisSignal::Actual | AxisSignal::Nominal | AxisSignal::Lag) => "mm",
            Signal::Axis(_, AxisSignal::Speed | AxisSignal::NominalSpeed) | Signal::PathSpeed => "mm/min",
            Signal::Axis(_, AxisSignal::Volts) | Signal::SpindleVolts => "V",
            Signal::SpindleRpm => "rpm",
            Signal::SpindleAngle => "degrees",
            Signal::Block | Signal::Bit(_) | Signal::Number(_) => "",
        }
    }
}

impl Signal {
    /// Its value now; an axis that the channel does not have reads 0.
    pub(crate) fn value(&self, channel: &Channel, machine: &MachineSide) -> f64 {
        let track = &channel.run.track;
        let plc = machine.memory.of(channel.number()).plc();
        let spindle = machine.spindles.of(channel.number());
        match self {
            Signal::Axis(letter, signal) => {
                let mut axes = machine.axes.owned(channel.number());
                axes.find(|unit| unit.axis.letter() == *letter)
                    .map_or(0.0, |unit| signal.value(unit))
            }
            Signal::PathSpeed => track.speed_mm_s() * 60.0,
            Signal::Block => {
                let element = track.path.element();
                element.map_or(0.0, |element| element.block.block.into())
            }
            Signal::SpindleRpm => spindle.state().actual_rpm,
            Signal::SpindleVolts => spindle.state().volts,
            Signal::SpindleAngle => spindle.turned_deg(),
            Signal::Bit(bit) => f64::from(u8::from(plc.bit(*bit))),
            Signal::Number(number) => plc.number(*number).into(),
        }
    }
}

impl AxisSignal {
    fn value(self, unit: &AxisUnit) -> f64 {
        match self {
            AxisSignal::Actual => unit.servo.actual_mm(),
            AxisSignal::Nominal => unit.servo.nominal_mm(),
            AxisSignal::Lag => unit.servo.lag_mm(),
            AxisSignal::Speed => unit.servo.actual_velocity_mm_min(),
            AxisSignal::NominalSpeed => unit.speed * 60.0,
            AxisSignal::Volts => unit.servo.volts(),
        }
    }
}
