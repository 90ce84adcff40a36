//! Power off and on, and what is set from outside while the control runs: operands of the PLC, machine parameters with
//! what their change needs [000:10088].

use bahn_exchange::{Assignment, BitArea, Operand};
use bahn_parameters::{Change, Definition, MessageId, ParameterList, Reaction};

use crate::control::Control;
use crate::message::Message;

impl Control {
    /// Whether the supply is off: time passes on the machine alone.
    pub fn is_off(&self) -> bool {
        self.supply.off
    }

    /// How often the control has begun: at power-on, and by a reset.
    pub fn starts(&self) -> u32 {
        self.supply.starts
    }

    /// Switches the supply off or on. What survives is what [`Control::remember`] and the retained memory of the PLC
    /// hold; the list of machine parameters is that of the editor. Time goes on counting.
    pub(crate) fn switch(&mut self, on: bool) -> bool {
        if on != self.supply.off {
            return false;
        }
        if on {
            self.supply.off = false;
            self.supply.starts += 1;
            let operation = self.machine.link.list().operation_parameters();
            if operation.power_interrupted {
                self.show_power_interrupted();
            }
        } else {
            *self = self.anew(self.machine.link.edited_list().clone());
            self.machine.messages.forget();
            self.supply.off = true;
        }
        true
    }

    fn show_power_interrupted(&mut self) {
        let interrupted = Message::Plain(MessageId::PowerInterrupted);
        self.machine.messages.of_machine().show(interrupted, false, None);
    }

    /// The control as it begins with what it has kept, at the time that it is.
    fn anew(&self, parameters: ParameterList) -> Control {
        let (mut setup, mut others) = (*self.supply.made_of).clone();
        setup.parameters = parameters;
        setup.remembered = self.remember();
        setup.exchange = self.machine.memory.first().clone();
        setup.exchange.reset();
        for (number, other) in (1..).zip(&mut others) {
            if let Some(channel) = self.channel(number) {
                other.remembered = channel.remember();
            }
        }
        // They were put together once.
        let mut control = Control::with_channels(setup, others).unwrap_or_else(|_| self.clone());
        control.now_us = self.now_us;
        control.machine.messages.restart(self.machine.messages.time_us());
        control.keeps = self.keeps;
        control.log.clone_from(&self.log);
        control.ordered.clone_from(&self.ordered);
        control.supply.starts = self.supply.starts;
        for (new, old) in control.channels.iter_mut().zip(self.channels.iter()) {
            new.run.source.tap = old.run.source.tap;
            new.run.source.defers = old.run.source.defers;
            new.run.block_time.clone_from(&old.run.block_time);
        }
        control
    }

    /// Sets an operand, or a machine parameter of a channel. `false` when it is not possible now.
    pub(crate) fn set(&mut self, channel: usize, assignment: &Assignment) -> bool {
        match assignment {
            // There is one memory; the lists of the channels beside the first one are the machine builder's.
            _ if channel > 0 => false,
            Assignment::Operand(Operand::Bit(bit), _) if bit.area() == BitArea::I => false,
            Assignment::Operand(operand, content) => {
                operand.write(self.machine.memory.first_mut(), content);
                true
            }
            Assignment::Parameter(text) => self.alter(text),
        }
    }

    /// Changes a machine parameter as the editor of the list does when it is left.
    fn alter(&mut self, text: &str) -> bool {
        let mut list = self.machine.link.edited_list().clone();
        let Ok(id) = list.assign(text) else {
            return false;
        };
        let Ok(definition) = Definition::named(list.model(), id) else {
            return false;
        };
        let runs = self.channels.iter().any(|channel| channel.run.is_active());
        if runs && (definition.change != Change::PlcRun || definition.reaction != Reaction::None) {
            return false;
        }
        if definition.reaction == Reaction::Reset {
            *self = self.anew(list);
            self.supply.starts += 1;
            return true;
        }
        self.machine.link.edit(&list, id);
        self.machine.take_parameters();
        self.channels.first_mut().take_parameters(&mut self.machine);
        if definition.reaction == Reaction::ReferenceMarks {
            let units = self.machine.axes.iter_mut();
            let of_axis = |index: usize| id.index.is_none_or(|own| usize::from(own) == index);
            for unit in units.filter(|unit| unit.channel == 0 && of_axis(unit.index)) {
                unit.referenced = false;
            }
        }
        true
    }
}
