//! A channel beside the first one, as it is loaded.

use bahn_machine::ChannelFolder;
use bahn_parameters::{ParameterList, PerPlcAxis};
use bahn_path::{Axis, Position};
use bahn_tnc::{AxisId, HandOver, Window};

/// A channel beside the first one.
#[derive(Clone)]
pub struct LoadedChannel {
    /// What `machine.toml` says of it.
    pub folder: ChannelFolder,
    /// Its own list of machine parameters with the values.
    pub parameters: ParameterList,
    /// The number on the machine of each of its axes, by their indices.
    pub axes: PerPlcAxis<Option<AxisId>>,
    /// Where its markers and words stand in the memory of the PLC.
    pub window: Window,
}

impl LoadedChannel {
    /// Its datum of `machine.toml`, for the axes that it names.
    pub fn datum(&self) -> Position {
        position(&self.folder.datum)
    }
}

/// What there is of channels and hand-overs besides the first channel.
pub(super) struct Channels {
    pub channels: Vec<LoadedChannel>,
    pub hand_overs: Vec<HandOver>,
}

pub(super) fn letter_of(letter: char) -> Option<Axis> {
    u8::try_from(letter).ok().and_then(Axis::from_letter)
}

/// Values of axes as a position; all others are 0.
pub(super) fn position(values: &[(char, f64)]) -> Position {
    let mut position = Position::ZERO;
    for (letter, value) in values {
        if let Some(axis) = letter_of(*letter) {
            position[axis] = *value;
        }
    }
    position
}
