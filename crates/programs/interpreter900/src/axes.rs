//! The axes of a channel, and which axis of the path each is.

use bahn_din::system900::AxisName;
use bahn_path::{Axis, PerAxis};
use bahn_system900::{AxisWord, Memory, slots};

/// An axis of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChannelAxis {
    /// The axis of the path.
    pub slot: Axis,
    /// Its logical number, from 1 on.
    pub logical: u8,
    /// The physical axis, from 1 on.
    pub physical: u8,
    /// How programs name it.
    pub name: AxisName,
}

/// Which logical and physical axis each axis of the path is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ChannelAxes(PerAxis<Option<ChannelAxis>>);

/// The name that programs write; an extension is a digit, or the byte of one (q110 to q141).
fn name_of(word: AxisWord) -> AxisName {
    let extension = match word.extension {
        digit @ b'0'..=b'9' => digit - b'0',
        other => other,
    };
    AxisName {
        letter: char::from(word.letter).to_ascii_uppercase(),
        extension,
    }
}

impl ChannelAxes {
    /// Those of a channel; without any descriptor X, Y, Z are the logical axes 1 to 3.
    ///
    /// # Errors
    /// When one of its axes has no place on the path, in words.
    pub fn of(memory: &Memory, channel: u8) -> Result<ChannelAxes, String> {
        let mut axes = ChannelAxes::default();
        let slots = slots(memory, channel);
        let data = memory.path_data(channel);
        for (logical, word) in data.axes().filter(|(_, word)| word.letter != 0) {
            let slot = slots.get(usize::from(logical) - 1).copied().flatten();
            let name = name_of(word);
            let Some(slot) = slot else {
                return Err(format!(
                    "{name} of channel {channel} has no place on a path of nine axes"
                ));
            };
            axes.0[slot] = Some(ChannelAxis {
                slot,
                logical,
                physical: word.physical,
                name,
            });
        }
        Ok(axes)
    }

    /// All of them in the order of the path.
    pub fn iter(&self) -> impl Iterator<Item = &ChannelAxis> {
        Axis::ALL.into_iter().filter_map(|slot| self.0[slot].as_ref())
    }

    /// What an axis of the path is in the channel.
    pub fn of_slot(&self, slot: Axis) -> Option<&ChannelAxis> {
        self.0[slot].as_ref()
    }

    /// The axis of a logical number.
    pub fn of_logical(&self, logical: u8) -> Option<&ChannelAxis> {
        self.iter().find(|axis| axis.logical == logical)
    }

    /// The axis that a program names.
    pub fn named(&self, name: AxisName) -> Option<&ChannelAxis> {
        let own = u8::try_from(name.letter).ok().and_then(Axis::from_letter);
        let own = own.and_then(|slot| self.of_slot(slot));
        own.filter(|axis| axis.name == name)
            .or_else(|| self.iter().find(|axis| axis.name == name))
    }
}
