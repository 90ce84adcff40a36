//! Inputs and outputs of the PLC as they are at the machine.

use bahn_servo::{ANALOGUE_INPUTS, INPUTS, OUTPUTS};

use crate::chain::{Chain, ContactFault};

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
}

impl Default for PlcSide {
    fn default() -> PlcSide {
        PlcSide {
            outputs: [false; OUTPUTS],
            live: [false; OUTPUTS],
            volts: [0.0; ANALOGUE_INPUTS],
            temperatures: [20.0; ANALOGUE_INPUTS],
            stuck: Vec::new(),
        }
    }
}

impl PlcSide {
    /// The contact of an input fails from now on.
    pub fn stick(&mut self, input: usize, fault: ContactFault) {
        self.loosen(input);
        self.stuck.push((input, fault));
    }

    /// The contact of an input is whole.
    pub fn loosen(&mut self, input: usize) {
        self.stuck.retain(|(stuck, _)| *stuck != input);
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
