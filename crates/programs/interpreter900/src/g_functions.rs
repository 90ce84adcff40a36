//! G functions: what stays in force, and what a block alone has.
//!
//! Decision: G14, G15, G47, G147 and G171 are the state in which programs begin, and are taken; what they end is
//! refused at its block until it is executed here, and so is what the manual names without a word about it

use bahn_path::PerAxis;
use bahn_path::parallel::Side;
use bahn_system900::Memory;

use crate::axes::ChannelAxes;
use crate::modal::{FeedKind, Modal};
use crate::refusal::Refusal;
use crate::turning::Way;
use crate::words::Words;

/// What G functions order of their block alone.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Once {
    /// G4
    pub dwells: bool,
    /// G8, G9
    pub exact_stop: Option<bool>,
    /// G92
    pub shifts: bool,
    /// G12
    pub corner: bool,
    /// G69, G71 to G75
    pub cycle: Option<u16>,
    /// G81 to G85
    pub drills: Option<u16>,
    /// G86 to G89
    pub pattern: Option<u16>,
    /// G96, G97
    pub speed_kind: Option<u16>,
}

/// Takes the G functions of a block.
pub(crate) fn take(
    words: &Words,
    modal: &mut Modal,
    memory: &Memory,
    channel: u8,
    axes: &ChannelAxes,
) -> Result<Once, Refusal> {
    let mut once = Once::default();
    let mut is_stale = false;
    let mut turns = false;
    for number in &words.g {
        match *number {
            motion @ 0..=3 => modal.motion = motion as u8,
            4 => once.dwells = true,
            5 => modal.way = Way::Positive,
            6 => modal.way = Way::Negative,
            7 => modal.way = Way::Shortest,
            8 => once.exact_stop = Some(true),
            9 => once.exact_stop = Some(false),
            10 | 11 => (modal.is_polar, modal.polar) = (*number == 10, [0.0; 2]),
            12 => once.corner = true,
            40..=42 => {
                modal.side = match number {
                    41 => Side::Left,
                    42 => Side::Right,
                    _ => Side::Off,
                }
            }
            14 | 15 | 171 => {}
            96 | 97 => {
                modal.cuts = *number == 96;
                once.speed_kind = Some(*number);
            }
            17..=19 | 117..=119 => {
                modal.plane_word = *number;
                is_stale = true;
            }
            28 | 29 => modal.exact_stop = *number == 28,
            43 | 44 => {
                modal.axis_correction = *number == 44;
                is_stale = true;
            }
            45 => turns = true,
            46 => modal.rotation = None,
            60 => modal.mirrored = [false; 2],
            61 => modal.mirrored[0] = true,
            62 => modal.mirrored[1] = true,
            63 | 64 => (modal.override_off, modal.full_feed) = (*number == 63, *number),
            47 | 147 => modal.coordinates = *number,
            69 | 71..=75 => once.cycle = Some(*number),
            80 => modal.drilling = None,
            81 | 83..=85 => {
                once.drills = Some(*number);
                modal.drilling = memory.path_data(channel).drilling_is_modal().then_some(*number);
            }
            86..=89 => once.pattern = Some(*number),
            90 | 91 => modal.is_absolute = *number == 90,
            92 => once.shifts = true,
            93 => modal.feed_kind = FeedKind::Time,
            94 => modal.feed_kind = FeedKind::PerMinute,
            95 => modal.feed_kind = FeedKind::PerTurn,
            zero_point if is_zero_point(zero_point) => {
                modal.zero_point = zero_point;
                is_stale = true;
            }
            other => return Err(Refusal::NotYet(format!("G{other}"))),
        }
    }
    if is_stale {
        modal.refresh(memory, channel, axes)?;
    }
    if turns {
        modal.turn(memory, channel);
    }
    if once.shifts {
        shift(words, modal);
    }
    Ok(once)
}

/// G53 to G59, G153 to G159, G254 to G259 and so on.
fn is_zero_point(number: u16) -> bool {
    matches!(number, 53..=59 | 153) || (154..=959).contains(&number) && (54..=59).contains(&(number % 100))
}

/// G92: the axes of the block are shifted so far from here on, alone it takes all shifts back (inferred).
fn shift(words: &Words, modal: &mut Modal) {
    if !words.has_axes {
        (modal.g92, modal.has_g92) = (PerAxis::default(), false);
        return;
    }
    modal.has_g92 = true;
    for axis in bahn_path::Axis::ALL {
        if let Some(shift) = words.axes[axis] {
            modal.g92[axis] = shift;
        }
    }
}
