//! The simulated machine as a plant that can be operated.

use bahn_machine::{DeviceState, Event, Machine, MagazineState, Mechanics};

use crate::operable::{Operable, StopChain, TrueAxis, Wired};

impl Operable for Machine {
    fn operate(&mut self, event: &Event) -> Result<(), String> {
        self.act(event).map_err(|error| error.to_string())
    }

    fn tool_is_called(&mut self, tool: u32) {
        Machine::tool_is_called(self, tool);
    }

    fn renew(&mut self, described: Machine) {
        *self = described;
    }

    fn mechanics(&self) -> Option<Mechanics> {
        Some(Machine::mechanics(self))
    }

    fn copied(&self) -> Option<Machine> {
        Some(self.clone())
    }

    fn keys(&self) -> Vec<&str> {
        Machine::keys(self).collect()
    }

    fn held_keys(&self) -> Vec<&str> {
        Machine::held_keys(self).collect()
    }

    fn lamps(&self) -> Vec<(&str, bool)> {
        let lit = |name| self.lamp(name).unwrap_or(false);
        Machine::lamps(self).map(|name| (name, lit(name))).collect()
    }

    fn knobs(&self) -> [f64; 2] {
        Machine::knobs(self)
    }

    fn stop_chain(&self) -> StopChain {
        StopChain {
            pressed: self.emergency_stop_is_pressed(),
            supply: self.has_supply(),
            limits_clear: self.limit_switches_clear(),
        }
    }

    fn wires(&self) -> Vec<Wired> {
        let wires = Machine::wires(self).iter();
        let wired = wires.map(|wire| Wired {
            operand: wire.operand.clone(),
            part: wire.section.clone(),
            function: wire.key.clone(),
            opens: wire.opens,
        });
        wired.collect()
    }

    fn axis_letters(&self) -> Vec<char> {
        self.axes().map(|axis| axis.letter).collect()
    }

    fn true_axis(&self, letter: char) -> Option<TrueAxis> {
        self.axis(letter).map(|axis| TrueAxis {
            position: axis.position,
            force: axis.force,
        })
    }

    fn devices(&self) -> Vec<DeviceState<'_>> {
        Machine::devices(self).collect()
    }

    fn magazine(&self) -> Option<MagazineState<'_>> {
        Machine::magazine(self)
    }
}
