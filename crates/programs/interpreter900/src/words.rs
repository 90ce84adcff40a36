//! A block with the values of its words.

use bahn_din::system900::{Block, MFunction, Value, WordKind};
use bahn_path::PerAxis;
use bahn_system900::{Memory, Name};

use crate::axes::ChannelAxes;
use crate::refusal::{Refusal, wrong};

/// What the words of a block say, once its parameters are written.
#[derive(Clone, Debug, Default)]
pub(crate) struct Words {
    /// G functions in the order of the text.
    pub g: Vec<u16>,
    pub m: Vec<MFunction>,
    /// By axes of the path.
    pub axes: PerAxis<Option<f64>>,
    pub has_axes: bool,
    pub feed: Option<f64>,
    /// Speeds by spindle words, from 1 on.
    pub speeds: Vec<(u8, f64)>,
    pub tool: Option<f64>,
    pub centre: [Option<f64>; 3],
    pub radius: Option<f64>,
    /// Radius and angle of G10.
    pub polar: [Option<f64>; 2],
    /// The word X of G4.
    pub time: Option<f64>,
}

/// What a value is now.
pub(crate) fn value_of(value: Value, memory: &Memory, channel: u8) -> Result<f64, Refusal> {
    match value {
        Value::Number(number) => Ok(number.value()),
        Value::Content(parameter) => {
            let cell = memory.cell(Name::P(channel, parameter.number().into()))?;
            cell.number()
                .ok_or_else(|| Refusal::Wrong(format!("{parameter} is cleared: it has no number to take")))
        }
    }
}

impl Words {
    /// Reads the words; `polar` names radius and angle where G10 is in force.
    pub fn of(
        block: &Block,
        memory: &Memory,
        channel: u8,
        axes: &ChannelAxes,
        polar: Option<[char; 2]>,
    ) -> Result<Words, Refusal> {
        let mut words = Words::default();
        let value = |value: Value| value_of(value, memory, channel);
        let not_negative = |name: &str, value: f64| match value >= 0.0 {
            true => Ok(value),
            false => wrong(format!("{name} takes no negative value")),
        };
        let is_dwell = block.words.iter().any(|word| word.kind == WordKind::G(4));
        for word in &block.words {
            match &word.kind {
                WordKind::G(number) => words.g.push(*number),
                WordKind::M(function) => words.m.push(*function),
                WordKind::Axis(name, of) => {
                    let of = value(*of)?;
                    let letters = polar.unwrap_or_default();
                    let place = letters
                        .iter()
                        .position(|letter| name.extension == 0 && *letter == name.letter);
                    if is_dwell {
                        words.time = Some(not_negative("G4", of)?);
                    } else if let Some(slot) = place.and_then(|place| words.polar.get_mut(place)) {
                        *slot = Some(of);
                    } else {
                        let Some(axis) = axes.named(*name) else {
                            return wrong(format!("{name} is no axis of channel {channel}, q110 to q141"));
                        };
                        words.axes[axis.slot] = Some(of);
                        words.has_axes = true;
                    }
                }
                WordKind::Feed(of) => {
                    let of = not_negative("F", value(*of)?)?;
                    match is_dwell {
                        true => words.time = Some(of),
                        false => words.feed = Some(of),
                    }
                }
                WordKind::Speed(spindle, of) => {
                    words.speeds.push((*spindle, not_negative("S", value(*of)?)?));
                }
                WordKind::Tool(of) => words.tool = Some(value(*of)?),
                WordKind::Centre(index, of) => {
                    if let Some(slot) = words.centre.get_mut(usize::from(*index)) {
                        *slot = Some(value(*of)?);
                    }
                }
                WordKind::Radius(of) => words.radius = Some(value(*of)?),
                WordKind::Write { .. } | WordKind::Jump(_) => {}
            }
        }
        Ok(words)
    }
}
