//! Where the blocks of the channels lie, and what lies in them: zero points and tools.

use bahn_text::Diagnostic;

use crate::descriptor::{Descriptor, WINDOWS};
use crate::file::DataFile;
use crate::numbers::{BLOCKS_FROM, CHANNELS, DECIMALS, FIXED_COUNT, TOOLS, ZERO_POINTS};
use crate::{tools, zero};

/// The numbers of a descriptor that count something: entry, least, most.
const COUNTS: [(u32, i64, i64); 12] = [
    (3, 1, 7000),
    (5, 1, 10_000),
    (7, 1, 10_000),
    (ZERO_POINTS + 1, 1, COUNT_MAX),
    (ZERO_POINTS + 2, 0, COUNT_MAX),
    (ZERO_POINTS + 3, 1, 32),
    (ZERO_POINTS + 4, 0, 9),
    (TOOLS + 1, 0, COUNT_MAX),
    (TOOLS + 2, 0, COUNT_MAX),
    (TOOLS + 3, 1, COUNT_MAX),
    (TOOLS + 4, 0, COUNT_MAX),
    (DECIMALS, 0, 9),
];

/// No array has more parameters than a user block.
const COUNT_MAX: i64 = 10_000;

/// What lies somewhere in the array.
#[derive(Clone, Debug)]
struct Block {
    title: String,
    /// Of the channel's own: not a user block.
    is_fixed: bool,
    begin: u32,
    end: u32,
    /// Where its start stands.
    number: u32,
}

impl Block {
    fn overlaps(&self, other: &Block) -> bool {
        self.begin < other.end && other.begin < self.end
    }
}

/// What is wrong with the blocks of all channels.
pub(super) fn of_array(file: &DataFile) -> Vec<Diagnostic> {
    let mut faults = Vec::new();
    let mut blocks = Vec::new();
    for channel in 1..=file.memory().channels() {
        let descriptor = file.memory().descriptor(channel);
        faults.extend(counts(file, &descriptor));
        faults.extend(no_block(file, &descriptor, channel));
        blocks.extend(of_channel(&descriptor, channel));
        faults.extend(contents(file, channel));
    }
    let count = u32::try_from(file.memory().count()).unwrap_or(u32::MAX);
    for block in &blocks {
        let place = file.span(block.number);
        let title = &block.title;
        if block.begin < BLOCKS_FROM && !block.is_fixed {
            let message = format!("{title} begins within q0 to q{}", BLOCKS_FROM - 1);
            faults.push(Diagnostic::error(place, message));
        }
        if block.end > count {
            let message = format!("{title} ends at q{}, beyond q{}", block.end - 1, count - 1);
            faults.push(Diagnostic::error(place, message));
        }
    }
    faults.extend(overlaps(file, &blocks));
    faults
}

/// A channel of which nobody says where its parameters lie, at the number of channels; at that which is there where the
/// descriptor says half of it, or has other blocks alone. A file that has none of it holds changes alone.
fn no_block(file: &DataFile, descriptor: &Descriptor<'_>, channel: u8) -> Option<Diagnostic> {
    let [first, ..] = WINDOWS;
    let is_there = |entry: u32| descriptor.entry(entry).bits().is_some();
    if is_there(first.entry) && is_there(first.entry + 1) {
        return None;
    }
    let entries = WINDOWS.iter().flat_map(|window| [window.entry, window.entry + 1]);
    let numbers = entries
        .filter(|entry| is_there(*entry))
        .map(|entry| descriptor.number(entry));
    let mut places = numbers
        .chain([CHANNELS])
        .map(|number| file.span(number))
        .filter(|place| place.line > 0);
    let begin = descriptor.number(first.entry);
    let message = format!(
        "q{begin} and q{} do not say where the parameters of channel {channel} lie",
        begin + 1
    );
    places.next().map(|place| Diagnostic::warning(place, message))
}

/// Counts outside their range.
fn counts(file: &DataFile, descriptor: &Descriptor<'_>) -> Vec<Diagnostic> {
    let is_wrong = |(entry, least, most): &&(u32, i64, i64)| {
        let cell = descriptor.entry(*entry);
        let is_within = |count: i64| (*least..=*most).contains(&count);
        cell.bits().is_some() && !cell.whole().is_some_and(is_within)
    };
    let counts = COUNTS.iter().filter(is_wrong).map(|(entry, least, most)| {
        let number = descriptor.number(*entry);
        let message = format!("q{number} is a whole number from {least} to {most}");
        Diagnostic::error(file.span(number), message)
    });
    // Where a block or an array begins is a whole number, too, and none below zero.
    let starts = WINDOWS.iter().map(|window| window.entry);
    let starts = starts
        .chain([ZERO_POINTS, TOOLS])
        .filter(|entry| descriptor.entry(*entry).bits().is_some() && descriptor.count(*entry).is_none());
    let starts = starts.map(|entry| {
        let number = descriptor.number(entry);
        Diagnostic::error(
            file.span(number),
            format!("q{number} is no number of a parameter"),
        )
    });
    counts.chain(starts).collect()
}

/// The blocks of a channel whose counts are in order.
fn of_channel(descriptor: &Descriptor<'_>, channel: u8) -> Vec<Block> {
    let mut blocks = Vec::new();
    for (user, window) in (1..).zip(WINDOWS) {
        let Some((begin, count)) = descriptor.window(window) else {
            continue;
        };
        if !(1..=window.most).contains(&count) {
            continue;
        }
        let end = begin.saturating_add(count);
        let number = descriptor.number(window.entry);
        blocks.push(Block {
            title: format!("user block {user} of channel {channel}"),
            is_fixed: false,
            begin,
            end,
            number,
        });
        if user == 1 {
            blocks.push(Block {
                title: format!("the fixed parameters of channel {channel}"),
                is_fixed: true,
                begin: end,
                end: end.saturating_add(FIXED_COUNT),
                number,
            });
        }
    }
    blocks
}

/// Blocks that lie over one another.
fn overlaps(file: &DataFile, blocks: &[Block]) -> Vec<Diagnostic> {
    let mut faults = Vec::new();
    for (at, one) in blocks.iter().enumerate() {
        for other in blocks.iter().skip(at + 1).filter(|other| one.overlaps(other)) {
            let (first, later) = match file.span(one.number) <= file.span(other.number) {
                true => (one, other),
                false => (other, one),
            };
            let message = format!("{} lies over {}", later.title, first.title);
            let place = file.span(later.number);
            faults.push(match one.is_fixed || other.is_fixed {
                true => Diagnostic::error(place, message),
                false => Diagnostic::warning(place, message),
            });
        }
    }
    faults
}

/// Zero points and tools outside of the user blocks, or over one another.
fn contents(file: &DataFile, channel: u8) -> Vec<Diagnostic> {
    let memory = file.memory();
    let descriptor = memory.descriptor(channel);
    let mut faults = Vec::new();
    let zero = zero::Layout::of(memory, channel).map(|layout| (layout.first, layout.count()));
    let tools = tools::Layout::of(memory, channel).map(|layout| (layout.first, layout.count()));
    for (array, entry, title) in [
        (zero, ZERO_POINTS, "the zero points"),
        (tools, TOOLS, "the tools"),
    ] {
        let Some((first, count)) = array else { continue };
        let end = u64::from(first).saturating_add(count);
        let is_within = WINDOWS.iter().any(|window| {
            let own = descriptor
                .window(*window)
                .map_or(0, |(_, own)| own.min(window.most));
            window.first <= first && end <= u64::from(window.first + own)
        });
        if !is_within {
            let message = format!(
                "{title} of channel {channel}, P{first} to P{}, do not lie in one of its user blocks",
                end - 1
            );
            faults.push(Diagnostic::error(file.span(descriptor.number(entry)), message));
        }
    }
    if let (Some((zero, points)), Some((tool, parameters))) = (zero, tools)
        && u64::from(zero) < u64::from(tool).saturating_add(parameters)
        && u64::from(tool) < u64::from(zero).saturating_add(points)
    {
        let places = [ZERO_POINTS, TOOLS].map(|entry| file.span(descriptor.number(entry)));
        let later = places.into_iter().max().unwrap_or_default();
        let message = format!("zero points and tools of channel {channel} lie over one another");
        faults.push(Diagnostic::error(later, message));
    }
    faults
}
