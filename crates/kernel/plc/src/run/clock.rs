//! Timers, counters and edges: what happens between the runs of the program.

use bahn_exchange::{Bit, BitArea, Image, signal};
use bahn_parameters::ParameterList;

/// Timers T0-T47, counters C0-C31.
const TIMERS: usize = 48;
const COUNTERS: usize = 32;

/// The counts that the operands do not show.
#[derive(Clone, Debug)]
pub(super) struct Clock {
    timers: [u16; TIMERS],
    counters: [u16; COUNTERS],
    /// Inputs of the run before.
    inputs: [bool; 256],
    /// Whether edges were evaluated in the run before.
    edges: bool,
}

impl Default for Clock {
    fn default() -> Clock {
        Clock {
            timers: [0; TIMERS],
            counters: [0; COUNTERS],
            inputs: [false; 256],
            edges: false,
        }
    }
}

impl Clock {
    /// Goes on by one cycle, before a run.
    pub(super) fn tick(&mut self, image: &mut Image, parameters: &ParameterList) {
        self.evaluate_edges(image);
        self.run_timers(image, parameters);
        self.run_counters(image, parameters);
    }

    /// A timer that is started counts its preset, in cycles, while T48+n is 1. A start in run k gives
    /// running in runs k+1 to k+N (inferred, the figure is lost) [000:11756-11772].
    fn run_timers(&mut self, image: &mut Image, parameters: &ParameterList) {
        let (starts, running) = cells(image, BitArea::T, 2 * TIMERS).split_at_mut(TIMERS);
        // Most of the time none of them runs.
        if !any(starts) && !any(running) && self.timers == [0; TIMERS] {
            return;
        }
        let timers = (0_u8..).zip(&mut self.timers).zip(starts).zip(running);
        for (((timer, count), start), running) in timers {
            *count = match start {
                0 => count.saturating_sub(1),
                _ => parameters.timer_preset(timer),
            };
            *running = u8::from(*count > 0);
        }
    }

    /// A counter that is set counts down by one in every cycle in which its release C96+n is 1; C48+n is 1
    /// until it has counted out (inferred, the figure is lost) [000:11824-11833].
    fn run_counters(&mut self, image: &mut Image, parameters: &ParameterList) {
        let (sets, rest) = cells(image, BitArea::C, 96 + COUNTERS).split_at_mut(48);
        let (running, releases) = rest.split_at_mut(48);
        if !any(sets) && !any(running) && self.counters == [0; COUNTERS] {
            return;
        }
        let counters = (0_u8..)
            .zip(&mut self.counters)
            .zip(sets)
            .zip(running)
            .zip(releases);
        for ((((counter, count), set), running), release) in counters {
            if *set != 0 {
                *count = parameters.counter_preset(counter);
            } else if *release != 0 {
                *count = count.saturating_sub(1);
            }
            *running = u8::from(*count > 0);
        }
    }

    /// With M2497 a change of an input sets its marker for one run; the second extension board has none
    /// [000:11869-11892].
    fn evaluate_edges(&mut self, image: &mut Image) {
        let enabled = image.bit(signal::ENABLE_INPUT_EDGES);
        if !enabled && !self.edges {
            let now = cells(image, BitArea::I, BitArea::I.count().into());
            for (before, now) in self.inputs.iter_mut().zip(now) {
                *before = *now != 0;
            }
            return;
        }
        for (n, before) in (0_u16..).zip(&mut self.inputs) {
            let now = set(image, BitArea::I, n);
            let has_marker = matches!(n, 0..=31 | 64..=126 | 128..=152);
            if has_marker {
                let edge = |range: bahn_exchange::BitRange| range.get(n);
                if let (Some(rising), Some(falling)) =
                    (edge(signal::RISING_EDGES), edge(signal::FALLING_EDGES))
                {
                    image.set_bit(rising, enabled && now && !*before);
                    image.set_bit(falling, enabled && !now && *before);
                }
            }
            *before = now;
        }
        self.edges = enabled;
    }
}

fn set(image: &Image, area: BitArea, number: u16) -> bool {
    Bit::new(area, number).is_some_and(|bit| image.bit(bit))
}

/// Whether any of some cells is set: looked at all at once.
fn any(cells: &[u8]) -> bool {
    cells.iter().fold(0, |any, cell| any | cell) != 0
}

/// The first cells of an area.
fn cells(image: &mut Image, area: BitArea, count: usize) -> &mut [u8] {
    let start = usize::from(area.first_cell());
    image
        .cells_mut()
        .get_mut(start..start + count)
        .unwrap_or_default()
}
