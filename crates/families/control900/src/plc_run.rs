//! The PLC program of a machine, with its memory, its inputs and its outputs.
//!
//! Decision: The memory of the PLC begins with 0 at power-on: what is to survive stands in parameters, which a battery keeps

use std::sync::Arc;

use bahn_exchange::{Bit, BitArea, Exchange};
use bahn_plc::{PlcProgram, Start};
use bahn_servo::{Commands, INPUTS, Measured, OUTPUTS};

use crate::plc_modules::NoModules;
use crate::plc_window::Window900;

/// A PLC program with its window.
#[derive(Clone, Debug)]
pub struct Plc900 {
    /// The program.
    pub program: Arc<PlcProgram>,
    /// Which of its operands are which parameters.
    pub window: Window900,
}

/// The PLC of a machine that is on.
#[derive(Clone)]
pub(crate) struct PlcRun {
    pub plc: bahn_plc::Machine,
    pub exchange: Exchange,
    pub window: Window900,
    pub modules: NoModules,
    inputs: Vec<(usize, Bit)>,
    outputs: Vec<(usize, Bit)>,
}

impl PlcRun {
    /// At power-on.
    pub fn new(plc: Plc900) -> PlcRun {
        let bits = |area: BitArea, count: usize| -> Vec<(usize, Bit)> {
            let numbers = (0..count).filter_map(|number| u16::try_from(number).ok());
            numbers
                .filter_map(|number| Some((usize::from(number), Bit::new(area, number)?)))
                .collect()
        };
        PlcRun {
            plc: bahn_plc::Machine::new(plc.program, Start::PowerOn),
            exchange: Exchange::default(),
            window: plc.window,
            modules: NoModules::default(),
            inputs: bits(BitArea::I, INPUTS),
            outputs: bits(BitArea::O, OUTPUTS),
        }
    }

    /// The memory of the PLC.
    pub fn exchange(&self) -> &Exchange {
        &self.exchange
    }

    /// Inputs go into the image of the PLC.
    pub fn read_inputs(&mut self, measured: &Measured) {
        for (number, bit) in &self.inputs {
            let read = measured.inputs.get(*number).copied().unwrap_or(false);
            self.exchange.nc_put(*bit, read);
        }
    }

    /// Outputs as the last scan left them.
    pub fn write_outputs(&self, commands: &mut Commands) {
        for (number, bit) in &self.outputs {
            if let Some(output) = commands.outputs.get_mut(*number) {
                *output = self.exchange.nc().bit(*bit);
            }
        }
    }
}
