//! Reads the channels of `machine.toml` beside the first one, and the axes that go from one to another.

use std::collections::BTreeSet;

use bahn_exchange::{Bit, BitArea, Number};
use bahn_machine::{ChannelFolder, HandOverFolder, Machine, MachineFolder};
use bahn_parameters::{ControlModel, PLC_AXES, ParameterList, PerPlcAxis};
use bahn_path::Axis;
use bahn_tnc::{AxisId, ChannelError, HandOver, Window};

use super::channel::{Channels, LoadedChannel, letter_of};
use super::load::Loader;

/// The axes of a list by their indices: the letters of those that there are.
fn letters(list: &ParameterList) -> PerPlcAxis<Option<Axis>> {
    let mut letters = PerPlcAxis::splat(None);
    for (index, letter) in (0u8..).zip(&mut letters) {
        let axis = list.axis_parameters(index);
        *letter = axis.letter.filter(|_| axis.active);
    }
    letters
}

/// The number and the letter of an axis at an index of a channel.
type Owner = Option<(u8, Axis)>;

/// What is at each index of a channel.
fn owners(list: &ParameterList, ids: PerPlcAxis<Option<AxisId>>) -> PerPlcAxis<Owner> {
    let mut owners = PerPlcAxis::splat(None);
    for ((owner, letter), id) in owners.iter_mut().zip(letters(list)).zip(ids) {
        *owner = id.map(AxisId::number).zip(letter);
    }
    owners
}

impl Loader<'_> {
    /// Reads the channels; `None` when something of them is wrong.
    pub(super) fn channels(
        &mut self,
        folder: &MachineFolder,
        model: ControlModel,
        first: &ParameterList,
        plant: Option<&Machine>,
    ) -> Option<Channels> {
        if folder.channels.len() >= ChannelError::CHANNELS_MAX {
            let line = folder.channels.last().map_or(1, |channel| channel.lines.0);
            let most = ChannelError::CHANNELS_MAX;
            self.fault_at_line(line, format!("a control has at most {most} channels"));
        }
        let mut taken: BTreeSet<u8> = (0u8..)
            .zip(letters(first))
            .filter(|(_, axis)| axis.is_some())
            .map(|(index, _)| index)
            .collect();
        let before = self.faults.len();
        let mut channels = Vec::new();
        for channel in &folder.channels {
            let axes = self.channel_axes(channel, &mut taken);
            let window = self.window(channel);
            self.station(channel, plant);
            let line = line_of(channel, "parameters");
            let Some(parameters) = self.list_at(line, &channel.parameters, model) else {
                continue;
            };
            if self.to_be_entered.as_ref() == Some(&channel.parameters) {
                // Nothing is known of it yet.
                continue;
            }
            let loaded = LoadedChannel {
                folder: channel.clone(),
                parameters,
                axes,
                window,
            };
            self.channel_fits(&loaded, folder);
            channels.push(loaded);
        }
        if folder.channels.is_empty() && folder.program.is_some() {
            let message = "`program` is for machines with several channels: `bahn run` names it with one";
            self.fault_at_key("program", message);
        }
        if self.to_be_entered.is_some() || channels.len() < folder.channels.len() {
            // Which axes go from one to another shows when all lists are whole.
            let complete = self.to_be_entered.is_some() && self.faults.len() == before;
            return complete.then_some(Channels {
                channels,
                hand_overs: Vec::new(),
            });
        }
        let mut owners = vec![self::owners(first, PerPlcAxis::from_fn(AxisId::new))];
        owners.extend(
            channels
                .iter()
                .map(|own: &LoadedChannel| self::owners(&own.parameters, own.axes)),
        );
        let hand_overs = folder.hand_overs.iter();
        let hand_overs =
            hand_overs.filter_map(|one| self.hand_over(one, folder.channels.len() + 1, &taken, &owners));
        let hand_overs = hand_overs.collect();
        let complete = self.faults.len() == before;
        complete.then_some(Channels { channels, hand_overs })
    }

    /// The numbers of its axes: each axis of the machine has one, and belongs to one channel.
    fn channel_axes(
        &mut self,
        channel: &ChannelFolder,
        taken: &mut BTreeSet<u8>,
    ) -> PerPlcAxis<Option<AxisId>> {
        let mut axes = PerPlcAxis::splat(None);
        let line = line_of(channel, "axes");
        if channel.axes.len() > PLC_AXES {
            self.fault_at_line(line, format!("a channel has at most {PLC_AXES} axes"));
        }
        for (number, place) in channel.axes.iter().zip(&mut axes) {
            // Those of the first channel are 0 to 4, whichever of them its list has.
            let first = usize::from(*number) < PLC_AXES;
            *place = AxisId::new(*number).filter(|_| !first);
            if place.is_none() {
                let last = AxisId::COUNT - 1;
                let message = format!("axes of further channels have numbers from 6 to {last}, not {number}");
                self.fault_at_line(line, message);
            } else if !taken.insert(*number) {
                self.fault_at_line(line, format!("axis {number} belongs to another channel already"));
            }
        }
        axes
    }

    /// Its axes are those of its list, and its datum is one of them or of those that it may get.
    fn channel_fits(&mut self, channel: &LoadedChannel, folder: &MachineFolder) {
        let letters = letters(&channel.parameters);
        let own = &channel.folder;
        for (index, (id, letter)) in channel.axes.iter().zip(letters).enumerate() {
            let message = match (id, letter) {
                (None, Some(letter)) => {
                    format!(
                        "axis {} of its list (index {index}) has no number",
                        letter.letter()
                    )
                }
                (Some(id), None) => format!("its list has no axis for {} (index {index})", id.number()),
                _ => continue,
            };
            self.fault_at_line(line_of(own, "axes"), message);
        }
        let guests: Vec<char> = folder
            .hand_overs
            .iter()
            .filter_map(|one| one.letter.chars().next())
            .collect();
        for (letter, _) in &own.datum {
            let known = letters.iter().flatten().any(|axis| axis.letter() == *letter);
            if !known && !guests.contains(letter) {
                self.fault_at_line(line_of(own, "datum"), format!("the channel has no axis {letter}"));
            }
        }
    }

    /// The keys of its operator.
    fn station(&mut self, channel: &ChannelFolder, plant: Option<&Machine>) {
        let Some(plant) = plant else { return };
        let keys: Vec<&str> = plant.keys().collect();
        let operator = &channel.operator;
        for name in operator.tool_change.iter().chain([&operator.start]) {
            if !name.is_empty() && !keys.contains(&name.as_str()) {
                let message = format!("the machine has no key `{name}`; there are {}", keys.join(", "));
                self.fault_at_line(line_of(channel, "operator"), message);
            }
        }
    }

    /// `M2448-M2511 = M300` or `W260 = W128`, each with its line.
    fn window(&mut self, channel: &ChannelFolder) -> Window {
        channel.window.iter().fold(Window::default(), |window, (line, text)| {
            entry(text, window.clone()).unwrap_or_else(|| {
                let message = format!(
                    "`{text}` is no part of a window: it is written \"M2448-M2511 = M300\" for markers of the channel \
                     and where the first of them stands for the PLC, or \"W260 = W128\""
                );
                self.fault_at_line(*line, message);
                window
            })
        })
    }

    fn hand_over(
        &mut self,
        one: &HandOverFolder,
        channels: usize,
        axes: &BTreeSet<u8>,
        owners: &[PerPlcAxis<Owner>],
    ) -> Option<HandOver> {
        let line = |key: &str| one.lines.1.get(key).copied().unwrap_or(one.lines.0);
        let before = self.faults.len();
        let axis = AxisId::new(one.axis).filter(|_| axes.contains(&one.axis));
        if axis.is_none() {
            self.fault_at_line(line("axis"), format!("no channel has an axis {}", one.axis));
        }
        let to = usize::from(one.to).checked_sub(1).filter(|to| *to < channels);
        if to.is_none() {
            self.fault_at_line(line("to"), format!("there is no channel {}", one.to));
        }
        let mut letter = one.letter.chars();
        let letter = letter
            .next()
            .filter(|_| letter.next().is_none())
            .and_then(letter_of);
        if letter.is_none() && !one.letter.is_empty() {
            self.fault_at_line(line("letter"), format!("`{}` is no axis", one.letter));
        }
        let mut marker = |key: &str, text: &str| {
            let bit = text.parse::<Bit>().ok().filter(|bit| bit.area() == BitArea::M);
            if bit.is_none() && !text.is_empty() {
                self.fault_at_line(line(key), format!("`{text}` is no marker"));
            }
            bit
        };
        let (order, done) = (marker("order", &one.order), marker("done", &one.done));
        let index = usize::from(one.index);
        if let Some((owners, letter)) = to.and_then(|to| owners.get(to)).zip(letter) {
            let other = |(place, owner): (usize, &Owner)| {
                owner.is_some_and(|(number, own)| number != one.axis && (place == index || own == letter))
            };
            if owners.iter().enumerate().any(other) {
                let message = format!(
                    "channel {} has an axis {} or index {index} of its own",
                    one.to, one.letter
                );
                self.fault_at_line(line("letter"), message);
            }
        }
        (self.faults.len() == before).then_some(HandOver {
            axis: axis?,
            to: to?,
            letter: letter?,
            index,
            order: order?,
            done: done?,
        })
    }
}

/// The line of a key of a channel.
fn line_of(channel: &ChannelFolder, key: &str) -> usize {
    channel.lines.1.get(key).copied().unwrap_or(channel.lines.0)
}

/// Adds an entry to a window; `None` when it is none.
fn entry(text: &str, window: Window) -> Option<Window> {
    let (own, at) = text.split_once('=')?;
    let (own, at) = (own.trim(), at.trim());
    let (first, last) = own.split_once('-').unwrap_or((own, own));
    let marker = |text: &str| {
        text.trim()
            .parse::<Bit>()
            .ok()
            .filter(|bit| bit.area() == BitArea::M)
    };
    if let (Some(first), Some(last), Some(at)) = (marker(first), marker(last), marker(at)) {
        let count = last.number().checked_sub(first.number())?.checked_add(1)?;
        // The last of them must exist, too.
        Bit::new(BitArea::M, at.number().checked_add(count - 1)?)?;
        return Some(window.markers(first, at, count));
    }
    let (own, at): (Number, Number) = (own.parse().ok()?, at.parse().ok()?);
    (own.size() == at.size()).then(|| window.number(own, at))
}
