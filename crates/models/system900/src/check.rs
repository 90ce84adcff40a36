//! What of a data file does not go together.
//!
//! Decision: What lies wrong is said at its start, a count at its own line, of two that lie over one another the one
//! whose line is later
//!
//! Decision: Coupled axes and axes of spindles are there when a channel has them
//!
//! Decision: A channel of q2 without descriptor is a warning, and a file without q2 may hold changes alone

mod axes;
mod blocks;

pub use axes::{Channel, ChannelAxis};

use bahn_text::{Diagnostic, Severity};

use crate::array::{PARAMETERS_MAX, PARAMETERS_MIN};
use crate::file::DataFile;
use crate::m_functions::MFunction;
use crate::numbers::{CHANNELS, CHANNELS_MAX, PARAMETERS};

/// What is found out about a data file.
#[derive(Clone, Debug)]
pub struct Checked {
    /// Errors and warnings in the order of their places.
    pub faults: Vec<Diagnostic>,
    /// The channels of the file.
    pub channels: Vec<Channel>,
}

impl Checked {
    /// What keeps the file from being used.
    pub fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        let faults = self.faults.iter();
        faults.filter(|fault| fault.severity == Severity::Error)
    }
}

/// Looks for everything that is wrong with a data file.
pub fn check(file: &DataFile) -> Checked {
    let mut faults = file.faults().to_vec();
    faults.extend(numbers(file));
    for channel in 1..=file.memory().channels() {
        faults.extend(axes::of_channel(file, channel));
    }
    faults.extend(axes::of_machine(file));
    faults.extend(blocks::of_array(file));
    faults.extend(doubtful_functions(file));
    faults.sort();
    faults.dedup();
    let channels = (1..=file.memory().channels()).map(|channel| Channel {
        channel,
        axes: axes::named(file, channel),
    });
    Checked {
        channels: channels.collect(),
        faults,
    }
}

/// How many channels and parameters there are.
fn numbers(file: &DataFile) -> impl Iterator<Item = Diagnostic> {
    let (least, most) = (PARAMETERS_MIN as i64, PARAMETERS_MAX as i64);
    let of = |number: u32, least: i64, most: i64| {
        let cell = file.memory().system(number);
        let is_within = |value: Option<i64>| value.is_some_and(|value| (least..=most).contains(&value));
        let is_wrong = file.span(number).line > 0 && !is_within(cell.whole());
        let message = format!("q{number} is a whole number from {least} to {most}");
        is_wrong.then(|| Diagnostic::error(file.span(number), message))
    };
    let channels = of(CHANNELS, 1, CHANNELS_MAX.into());
    channels.into_iter().chain(of(PARAMETERS, least, most))
}

/// M functions whose bits do not go together, at the parameter that defines them.
fn doubtful_functions(file: &DataFile) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for channel in 1..=file.memory().channels() {
        for function in MFunction::defined(file.memory(), channel) {
            let place = function.parameter.parse().ok();
            let place = place.and_then(|name| file.memory().q(name).ok());
            let doubt = function.doubt();
            found.extend(
                place
                    .zip(doubt)
                    .map(|(number, doubt)| Diagnostic::warning(file.span(number), doubt)),
            );
        }
    }
    found
}
