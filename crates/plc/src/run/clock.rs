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
        for (timer, count) in (0_u8..).zip(&mut self.timers) {
            let n = u16::from(timer);
            if set(image, BitArea::T, n) {
                *count = parameters.timer_preset(timer);
            } else {
                *count = count.saturating_sub(1);
            }
            put(image, BitArea::T, 48 + n, *count > 0);
        }
    }

    /// A counter that is set counts down by one in every cycle in which its release C96+n is 1; C48+n is 1
    /// until it has counted out (inferred, the figure is lost) [000:11824-11833].
    fn run_counters(&mut self, image: &mut Image, parameters: &ParameterList) {
        for (counter, count) in (0_u8..).zip(&mut self.counters) {
            let n = u16::from(counter);
            if set(image, BitArea::C, n) {
                *count = parameters.counter_preset(counter);
            } else if set(image, BitArea::C, 96 + n) {
                *count = count.saturating_sub(1);
            }
            put(image, BitArea::C, 48 + n, *count > 0);
        }
    }

    /// With M2497 a change of an input sets its marker for one run; the second extension board has none
    /// [000:11869-11892].
    fn evaluate_edges(&mut self, image: &mut Image) {
        let enabled = image.bit(signal::ENABLE_INPUT_EDGES);
        for (n, before) in (0_u16..).zip(&mut self.inputs) {
            let now = set(image, BitArea::I, n);
            let has_marker = matches!(n, 0..=31 | 64..=126 | 128..=152);
            if has_marker && (enabled || self.edges) {
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

fn put(image: &mut Image, area: BitArea, number: u16, value: bool) {
    if let Some(bit) = Bit::new(area, number) {
        image.set_bit(bit, value);
    }
}
