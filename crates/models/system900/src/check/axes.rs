//! Axes of channels, and what names them: planes, spindles, couplings.

use std::collections::{BTreeSet, HashMap};

use bahn_text::Diagnostic;
use serde::Serialize;

use crate::file::DataFile;
use crate::name::Name;
use crate::numbers::{
    AXES, AXIS_WORDS, COUPLING_BLOCK, COUPLINGS, COUPLINGS_MAX, FURTHER_PLANES, PLANES, SPINDLE_WORDS,
    SPINDLES,
};

/// The highest key of an axis [002:718-825].
const KEY_MAX: u8 = 79;

/// The axes of a channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Channel {
    /// Its number, from 1 on.
    pub channel: u8,
    /// Its axes that are there.
    pub axes: Vec<ChannelAxis>,
}

/// An axis of a channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelAxis {
    /// Its logical number, from 1 on.
    pub logical: u8,
    /// What programs call it; empty for one whose position is not shown.
    pub name: String,
    /// The physical axis, from 1 on.
    pub physical: u8,
    /// The key that chooses it; 0 for none.
    pub key: u8,
}

/// The axes of a channel that are there.
pub(super) fn named(file: &DataFile, channel: u8) -> Vec<ChannelAxis> {
    let axes = file.memory().descriptor(channel).axes();
    let axes = axes.filter(|(_, word)| word.is_there());
    axes.map(|(logical, word)| ChannelAxis {
        logical,
        name: word.name(),
        physical: word.physical,
        key: word.key,
    })
    .collect()
}

/// What is wrong with the axes of a channel.
pub(super) fn of_channel(file: &DataFile, channel: u8) -> Vec<Diagnostic> {
    let mut faults = words(file, channel);
    let memory = file.memory();
    let descriptor = memory.descriptor(channel);
    let there: BTreeSet<u8> = named(file, channel).iter().map(|axis| axis.logical).collect();
    let own = (0..3).map(|plane| descriptor.number(PLANES + plane));
    let further = (0..3).filter_map(|plane| memory.q(Name::P(channel, FURTHER_PLANES + plane)).ok());
    for number in own.chain(further) {
        let bytes = memory.system(number).bits().unwrap_or(0).to_le_bytes();
        let missing = bytes
            .iter()
            .take(3)
            .find(|axis| **axis > 0 && !there.contains(*axis));
        if let Some(axis) = missing {
            let message = format!("channel {channel} has no logical axis {axis} for a plane");
            faults.push(Diagnostic::error(file.span(number), message));
        }
    }
    for word in 0..COUPLINGS_MAX {
        let number = descriptor.number(SPINDLE_WORDS + word);
        let block = memory.system(number);
        let is_block = |block: i64| (0..=i64::from(COUPLINGS_MAX)).contains(&block);
        if block.bits().is_some() && !block.whole().is_some_and(is_block) {
            let message = format!("q{number} is a spindle block from 1 to {COUPLINGS_MAX}");
            faults.push(Diagnostic::error(file.span(number), message));
        }
    }
    faults
}

/// What is wrong with the words of axes.
fn words(file: &DataFile, channel: u8) -> Vec<Diagnostic> {
    let descriptor = file.memory().descriptor(channel);
    let mut faults = Vec::new();
    let mut letters: HashMap<String, Vec<u32>> = HashMap::new();
    for (logical, word) in descriptor.axes() {
        let number = descriptor.number(AXIS_WORDS + u32::from(logical) - 1);
        let place = file.span(number);
        if word.physical > AXES {
            let message = format!("there is no physical axis {}, the last is {AXES}", word.physical);
            faults.push(Diagnostic::error(place, message));
        }
        if word.physical == 0 {
            let message = format!("logical axis {logical} of channel {channel} has no physical axis");
            faults.push(Diagnostic::warning(place, message));
        }
        if word.key > KEY_MAX {
            let message = format!("there is no key {}, the last is {KEY_MAX}", word.key);
            faults.push(Diagnostic::warning(place, message));
        }
        if word.letter > 0 && !word.letter.is_ascii_alphabetic() {
            let message = format!("${:02X} is no letter of an axis", word.letter);
            faults.push(Diagnostic::warning(place, message));
        } else if word.letter > 0 {
            letters.entry(word.name()).or_default().push(number);
        }
    }
    for (name, numbers) in letters.into_iter().filter(|(_, numbers)| numbers.len() > 1) {
        let mut places: Vec<_> = numbers.iter().map(|number| file.span(*number)).collect();
        places.sort();
        for place in places.into_iter().skip(1) {
            let message = format!("channel {channel} has an axis {name} already");
            faults.push(Diagnostic::error(place, message));
        }
    }
    faults
}

/// What is wrong with physical axes, whoever has them.
pub(super) fn of_machine(file: &DataFile) -> Vec<Diagnostic> {
    let memory = file.memory();
    let mut owners: HashMap<u8, Vec<(u8, u32)>> = HashMap::new();
    for channel in 1..=memory.channels() {
        let descriptor = memory.descriptor(channel);
        for (logical, word) in descriptor.axes().filter(|(_, word)| word.is_there()) {
            let number = descriptor.number(AXIS_WORDS + u32::from(logical) - 1);
            owners.entry(word.physical).or_default().push((channel, number));
        }
    }
    let mut faults = Vec::new();
    for (axis, owners) in &owners {
        let mut of: Vec<_> = owners
            .iter()
            .map(|(channel, number)| (file.span(*number), channel))
            .collect();
        of.sort();
        let Some(((_, first), others)) = of.split_first() else {
            continue;
        };
        faults.extend(others.iter().map(|(place, channel)| {
            let message = match channel == first {
                true => format!("channel {channel} has physical axis {axis} already"),
                false => format!("physical axis {axis} is one of channel {first}, too"),
            };
            Diagnostic::warning(*place, message)
        }));
    }
    let of_couplings = (0..COUPLINGS_MAX).flat_map(|coupling| {
        let first = COUPLINGS + COUPLING_BLOCK * coupling;
        [first, first + 1]
    });
    let of_spindles = (0..COUPLINGS_MAX).map(|spindle| SPINDLES + COUPLING_BLOCK * spindle);
    for number in of_couplings.chain(of_spindles) {
        let name = Name::P(1, number);
        let Ok(place) = memory.q(name) else { continue };
        let cell = memory.system(place);
        let is_there =
            |axis: i64| axis == 0 || u8::try_from(axis).is_ok_and(|axis| owners.contains_key(&axis));
        if cell.bits().is_some() && !cell.whole().is_some_and(is_there) {
            let message = format!("{name}: no channel has a physical axis {}", cell.written());
            faults.push(Diagnostic::error(file.span(place), message));
        }
    }
    faults
}
