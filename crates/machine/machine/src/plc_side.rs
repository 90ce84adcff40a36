//! Inputs and outputs of the PLC as they are at the machine.

use bahn_servo::{ANALOGUE_INPUTS, INPUTS, OUTPUTS};

use crate::bipolar::Bipolar;
use crate::chain::{Chain, ContactFault};
use crate::reader::Section;

/// What the PLC has put out, and what its wires say.
#[derive(Clone, Debug)]
pub(crate) struct PlcSide {
    /// As the PLC set them, and as they arrive.
    pub outputs: [bool; OUTPUTS],
    pub live: [bool; OUTPUTS],
    /// Voltages at the analogue inputs, V, and temperatures, degrees Celsius.
    pub volts: [f64; ANALOGUE_INPUTS],
    pub temperatures: [f64; ANALOGUE_INPUTS],
    stuck: Vec<(usize, ContactFault)>,
    /// The loads at bipolar outputs.
    bipolar: Option<Bipolar>,
}

impl Default for PlcSide {
    fn default() -> PlcSide {
        PlcSide {
            outputs: [false; OUTPUTS],
            live: [false; OUTPUTS],
            volts: [0.0; ANALOGUE_INPUTS],
            temperatures: [20.0; ANALOGUE_INPUTS],
            stuck: Vec::new(),
            bipolar: None,
        }
    }
}

impl PlcSide {
    /// What the description says of outputs beside what is wired to them.
    pub fn read(root: &Section) -> PlcSide {
        PlcSide {
            bipolar: root.section("bipolar").map(Bipolar::read),
            ..PlcSide::default()
        }
    }

    /// Whether there are loads at bipolar outputs; which outputs these are, pair by pair, and what is wired.
    pub fn fit(&mut self, bipolar: &[usize], is_wired: impl Fn(usize) -> bool) -> bool {
        if let Some(own) = &mut self.bipolar {
            own.fit(bipolar, is_wired);
        }
        self.bipolar.is_some()
    }

    /// Sets the inputs that the outputs themselves have.
    pub fn set_inputs(&self, inputs: &mut [bool; INPUTS]) {
        if let Some(bipolar) = &self.bipolar {
            bipolar.set_inputs(&self.live, inputs);
        }
    }

    /// The contact of an input fails from now on.
    pub fn stick(&mut self, input: usize, fault: ContactFault) {
        self.loosen(input);
        self.stuck.push((input, fault));
    }

    /// The contact of an input is whole.
    pub fn loosen(&mut self, input: usize) {
        self.stuck.retain(|(stuck, _)| *stuck != input);
    }

    /// A contact fails.
    pub fn has_faults(&self) -> bool {
        !self.stuck.is_empty()
    }

    /// All contacts are whole.
    pub fn loosen_all(&mut self) {
        self.stuck.clear();
    }

    /// What is read of the contacts that fail.
    pub fn set_stuck(&self, inputs: &mut [bool; INPUTS], time_us: u64) {
        for (input, fault) in &self.stuck {
            if let Some(level) = inputs.get_mut(*input) {
                *level = fault.level(time_us, *level);
            }
        }
    }

    /// What the control sees at the acknowledgement of its chain.
    pub fn acknowledged(&self, chain: &Chain, time_us: u64) -> bool {
        chain.acknowledged(&self.stuck, time_us)
    }
}
