//! Where the time of a program run went.

use bahn_exchange::{Bit, signal};
use bahn_path::FeedRate;
use bahn_tnc::{Control, RunState, Signal, Waiting};

/// What a cycle was spent with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Spent {
    Feed,
    Rapid,
    Dwell,
    /// A handshake with the PLC: its strobe, and the code of the function.
    Handshake(Bit, i32),
    /// A programmed stop until NC start.
    Stop,
    /// Single block until NC start.
    BlockEnd,
    /// An external stop until NC start.
    Interrupted,
    /// Axes come to their windows, clamps, what else holds the path.
    Settling,
}

/// A kind of time with its sum.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub(super) struct Share {
    /// `feed`, `rapid`, `dwell`, `M3`, `tool change`, `stop` ..
    pub what: String,
    /// How often it began.
    pub count: u64,
    /// Sum of the time, s.
    pub time_s: f64,
}

/// Sums up the time of a run by what it was spent on.
#[derive(Default)]
pub(super) struct Times {
    sums: Vec<(Spent, u64, u64)>,
    last: Option<Spent>,
}

impl Times {
    /// Takes a contour cycle of a running program.
    pub fn cycle(&mut self, control: &Control) {
        let spent = spent(control);
        let begins = self.last != Some(spent);
        self.last = Some(spent);
        let place = self.sums.iter().position(|(known, ..)| *known == spent);
        let place = place.unwrap_or_else(|| {
            self.sums.push((spent, 0, 0));
            self.sums.len() - 1
        });
        if let Some((_, count, time_us)) = self.sums.get_mut(place) {
            *count += u64::from(begins);
            *time_us += u64::from(control.cycle_us());
        }
    }

    /// Takes back what the latest kind of time has had last, at most `time_us`; what was taken back, µs.
    pub fn take_back(&mut self, time_us: u64) -> u64 {
        let last = self.last;
        let latest = self.sums.iter_mut().find(|(spent, ..)| Some(*spent) == last);
        latest.map_or(0, |(_, _, sum)| {
            let taken = time_us.min(*sum);
            *sum -= taken;
            taken
        })
    }

    /// The sums, the longest first.
    pub fn shares(&self) -> Vec<Share> {
        let mut sums = self.sums.clone();
        sums.sort_by_key(|(_, _, time_us)| std::cmp::Reverse(*time_us));
        sums.into_iter()
            .map(|(spent, count, time_us)| Share {
                what: spent.name(),
                count,
                time_s: time_us as f64 * 1e-6,
            })
            .collect()
    }
}

fn spent(control: &Control) -> Spent {
    match control.run_state() {
        RunState::Stopped => return Spent::Stop,
        RunState::BlockEnd => return Spent::BlockEnd,
        RunState::Interrupted => return Spent::Interrupted,
        RunState::Running | RunState::Idle => {}
    }
    let element = control.element();
    if control.observe(&Signal::PathSpeed) > 0.0 {
        return match element.map(|element| element.feed) {
            Some(FeedRate::Rapid) => Spent::Rapid,
            _ => Spent::Feed,
        };
    }
    match control.waiting() {
        Some(Waiting::Acknowledge(pair) | Waiting::AcknowledgeReset(pair)) => {
            let code = if pair.strobe == signal::M_FUNCTION_STROBE {
                control.memory().number(signal::M_CODE)
            } else {
                0
            };
            Spent::Handshake(pair.strobe, code)
        }
        None if element.is_some_and(|element| element.dwell_s > 0.0) => Spent::Dwell,
        None => Spent::Settling,
    }
}

impl Spent {
    fn name(self) -> String {
        let name = match self {
            Spent::Feed => "feed",
            Spent::Rapid => "rapid",
            Spent::Dwell => "dwell",
            Spent::Stop => "programmed stop",
            Spent::BlockEnd => "single block",
            Spent::Interrupted => "interrupted",
            Spent::Settling => "settling",
            Spent::Handshake(strobe, code) => return handshake_name(strobe, code),
        };
        name.to_owned()
    }
}

/// The name of what is handed to the PLC with a strobe.
fn handshake_name(strobe: Bit, code: i32) -> String {
    const NAMES: [(Bit, &str); 5] = [
        (signal::TOOL_CALL_STROBE, "tool change"),
        (signal::TOOL_DEF_STROBE, "tool definition"),
        (signal::GEAR_STROBE, "gear"),
        (signal::S_STROBE, "S code"),
        (signal::FN19_STROBE, "FN 19"),
    ];
    if strobe == signal::M_FUNCTION_STROBE {
        return format!("M{code}");
    }
    let named = NAMES.iter().find(|(known, _)| *known == strobe);
    named.map_or_else(|| format!("strobe {strobe}"), |(_, name)| (*name).to_owned())
}
