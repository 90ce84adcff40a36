//! What the control shows of the blocks that are read and executed.
//!
//! The look-ahead shows its last block when it gives the parameters back; what is in force in each block is kept until the
//! block is executed, where states are kept.

use std::collections::VecDeque;

use bahn_din::system900::Block;
use bahn_path::PerAxis;
use bahn_path::parallel::Side;
use bahn_system900::{BlockState, BlockWords, Memory};

use crate::axes::ChannelAxes;
use crate::file::FilesOfRun;
use crate::modal::{FeedKind, Modal};
use crate::run::{Frame, Run};
use crate::turning::Way;
use crate::words::Words;

/// What is in force from a block on, by its place in the order of execution.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shown(VecDeque<(u64, Box<BlockState>)>);

impl Shown {
    /// A block has a state.
    pub fn note(&mut self, sequence: u64, state: BlockState) {
        match self.0.back() {
            Some((_, last)) if **last == state => {}
            _ => self.0.push_back((sequence, Box::new(state))),
        }
    }

    /// What is in force in a block.
    pub fn of(&self, sequence: u64) -> Option<&BlockState> {
        let found = self.0.iter().rfind(|(of, _)| *of <= sequence);
        found.map(|(_, state)| &**state)
    }

    /// Nothing before a block is asked for any more.
    pub fn forget_before(&mut self, sequence: u64) {
        while self.0.get(1).is_some_and(|(next, _)| *next <= sequence) {
            self.0.pop_front();
        }
    }

    /// The run goes back to a block.
    pub fn go_back(&mut self, sequence: u64) {
        while self.0.back().is_some_and(|(last, _)| *last > sequence) {
            self.0.pop_back();
        }
    }
}

/// The words of a block; none of one that cannot be read.
pub(crate) fn words_of(
    block: &Block,
    memory: &Memory,
    channel: u8,
    axes: &ChannelAxes,
    modal: &Modal,
) -> Words {
    let polar = modal.is_polar.then(|| memory.path_data(channel).polar_letters());
    Words::of(block, memory, channel, axes, polar).unwrap_or_default()
}

/// Number of a file, and of a block in it.
fn place(files: &FilesOfRun, frame: &Frame, block: u32) -> [u32; 2] {
    let Some(file) = files.get(frame.file) else {
        return [0, block];
    };
    let name = file.text.name();
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let digits = name.trim_start_matches(|letter: char| !letter.is_ascii_digit());
    let digits = digits.split(|letter: char| !letter.is_ascii_digit()).next();
    let number = digits.and_then(|digits| digits.parse().ok()).unwrap_or(0);
    let own = file.words.number_in(file.text.line_of(block));
    [number, own.unwrap_or(block)]
}

/// What is in force after a block with these words.
pub(crate) fn state_of(run: &Run, files: &FilesOfRun, words: &Words) -> BlockState {
    let modal = &run.modal;
    let either = |is_on: bool, on: u16, off: u16| if is_on { on } else { off };
    let has = |number: u16| words.g.contains(&number);
    let plane = [modal.plane.first, modal.plane.second, modal.plane.normal];
    let [one, two] = modal.mirrored;
    let [i, j, k] = words.centre;
    let main = run.frames.first();
    let level = run.frames.len().saturating_sub(1);
    let inner = run.frames.last().filter(|_| level > 0);
    BlockState {
        motion: modal.motion.into(),
        turn: match modal.way {
            Way::Positive => 5,
            Way::Negative => 6,
            Way::Shortest => 7,
        },
        stop_in_block: [8, 9].into_iter().find(|number| has(*number)),
        polar: either(modal.is_polar, 10, 11),
        corner: has(12).then_some(12),
        tangent: 14,
        polar_transformation: 15,
        plane: modal.plane_word,
        plane_axes: plane.map(|axis| modal.logical[axis]),
        exact_stop: either(modal.exact_stop, 28, 29),
        radius: match modal.side {
            Side::Off => 40,
            Side::Left => 41,
            Side::Right => 42,
        },
        correction: either(modal.axis_correction, 44, 43),
        rotation: either(modal.rotation.is_some(), 45, 46),
        coordinates: modal.coordinates,
        zero_point: modal.zero_point,
        mirrors: [either(one, 61, 60), either(two, 62, 60)],
        full_feed: modal.full_feed,
        measure: either(modal.is_absolute, 90, 91),
        shifted: either(modal.has_g92, 92, 0),
        feed_kind: match modal.feed_kind {
            FeedKind::Time => 93,
            FeedKind::PerMinute => 94,
            FeedKind::PerTurn => 95,
        },
        feed: modal.feed,
        speeds: modal.speeds,
        shifts: PerAxis::from_fn(|axis| (modal.logical[axis], modal.g92[axis])),
        dwell_s: words.time,
        centre: [i, j, k, words.radius],
        loops: modal.loops,
        loop_depth: run.frames.iter().map(|frame| frame.loops.len() as u32).sum(),
        level: level as u32,
        place: main.map_or([0; 2], |main| match inner {
            None => place(files, main, run.at.block),
            Some(_) => place(files, main, main.called_at),
        }),
        cycle: inner.map(|frame| place(files, frame, run.at.block)),
        call: inner.and_then(|_| {
            let caller = run.frames.get(level.checked_sub(1)?)?;
            Some(place(files, caller, caller.called_at))
        }),
    }
}

/// The words as they are shown.
pub(crate) fn block_words(words: &Words, modal: &Modal) -> BlockWords {
    let m = |at: usize| {
        let function = words.m.get(at)?;
        Some((function.number, [function.target, function.count]))
    };
    BlockWords {
        axes: PerAxis::from_fn(|axis| (modal.logical[axis], words.axes[axis])),
        feed: words.feed,
        g: std::array::from_fn(|at| words.g.get(at).copied()),
        m: std::array::from_fn(m),
        speeds: std::array::from_fn(|at| {
            let mut own = words.speeds.iter();
            own.find(|(word, _)| usize::from(*word) == at + 1)
                .map(|(_, speed)| *speed)
        }),
    }
}
