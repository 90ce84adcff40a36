//! The PLC program of a machine: inputs in, window in, a scan, window out, outputs out, as on every control of the house.
//!
//! Decision: The memory of the PLC begins with 0 at power-on: what is to survive stands in parameters, which a battery keeps
//!
//! Decision: An error of the PLC program stops the PLC: its outputs fall, the control is not ready any more, and a message of the system
//! says where

use std::sync::Arc;

use bahn_exchange::{Bit, BitArea, Exchange};
use bahn_plc::{PlcProgram, RuntimeError, Start};
use bahn_servo::{Commands, INPUTS, Measured, OUTPUTS};

use crate::machine::Machine;
use crate::message::Kind;
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
    plc: bahn_plc::Machine,
    exchange: Exchange,
    window: Window900,
    modules: NoModules,
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

    fn read_inputs(&mut self, measured: &Measured) {
        for (number, bit) in &self.inputs {
            let read = measured.inputs.get(*number).copied().unwrap_or(false);
            self.exchange.nc_put(*bit, read);
        }
    }

    fn write_outputs(&self, commands: &mut Commands) {
        for (number, bit) in &self.outputs {
            if let Some(output) = commands.outputs.get_mut(*number) {
                *output = self.exchange.nc().bit(*bit);
            }
        }
    }

    fn scan(&mut self, machine: &mut Machine, measured: &Measured) -> Result<(), RuntimeError> {
        self.read_inputs(measured);
        self.window.publish(machine, &mut self.exchange);
        self.plc.scan(&mut self.exchange, &mut self.modules)?;
        self.window.take(machine, &self.exchange);
        Ok(())
    }
}

/// A scan of the PLC program, where there is one that has not stopped.
pub(crate) fn scan(machine: &mut Machine, measured: &Measured, commands: &mut Commands) {
    let Some(mut run) = machine.plc.take() else { return };
    if run.plc.stopped().is_none() {
        match run.scan(machine, measured) {
            Ok(()) => run.write_outputs(commands),
            Err(error) => {
                commands.outputs.fill(false);
                machine.core.emergency.fail();
                let text = format!("the PLC has stopped at {error}");
                machine.say(0, 1, None, Kind::System, text.into());
            }
        }
    }
    machine.plc = Some(run);
}
