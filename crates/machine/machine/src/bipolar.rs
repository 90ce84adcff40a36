//! The bipolar outputs of a PL 110 B, and the signal that they are overloaded [001:327-369].
//!
//! Decision: Between the two outputs of a pair lies one load when both are wired, otherwise each output has its own against
//! 0 V; every load takes the nominal 300 mA, or the `current` of the plant

use bahn_servo::{INPUTS, OUTPUTS};

use crate::reader::{Contact, Section};

/// Current of a load where the plant says no other, A [001:345-347].
const NOMINAL_A: f64 = 0.3;
/// Above this sum of currents J3/11 is 1, A: about 0.8 to 0.9 [001:363].
const OVERLOAD_A: f64 = 0.85;

/// The loads at the bipolar outputs.
#[derive(Clone, Debug)]
pub(crate) struct Bipolar {
    overload: Option<Contact>,
    current_a: f64,
    /// The outputs of each pair that are wired.
    pairs: Vec<[Option<usize>; 2]>,
}

impl Bipolar {
    /// Reads `[bipolar]`.
    pub fn read(section: Section) -> Bipolar {
        if !section.has("overload") {
            section
                .fault("[bipolar] needs overload, the input that J3/11 is wired to, as \"I40\"".to_owned());
        }
        let bipolar = Bipolar {
            overload: section.contact("overload"),
            current_a: section.number("current", 0.0..=1.2).unwrap_or(NOMINAL_A),
            pairs: Vec::new(),
        };
        section.finish();
        bipolar
    }

    /// The outputs that are bipolar, two and two, and whether something is wired to each.
    pub fn fit(&mut self, outputs: &[usize], is_wired: impl Fn(usize) -> bool) {
        let wired = |output: &usize| Some(*output).filter(|output| is_wired(*output));
        let pairs = outputs
            .chunks(2)
            .map(|pair| [pair.first().and_then(wired), pair.get(1).and_then(wired)]);
        self.pairs = pairs.filter(|pair| *pair != [None; 2]).collect();
    }

    /// Sets the input of the signal.
    pub fn set_inputs(&self, outputs: &[bool; OUTPUTS], inputs: &mut [bool; INPUTS]) {
        let is_on = |output: usize| outputs.get(output).copied().unwrap_or(false);
        let loads = self.pairs.iter().filter(|pair| match pair {
            [Some(one), Some(other)] => is_on(*one) != is_on(*other),
            [one, other] => one.or(*other).is_some_and(is_on),
        });
        let sum_a = loads.count() as f64 * self.current_a;
        if let Some(overload) = self.overload {
            overload.set(inputs, sum_a > OVERLOAD_A);
        }
    }
}
