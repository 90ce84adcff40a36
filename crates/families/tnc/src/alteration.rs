//! What is set from outside while the control runs: operands of the PLC, machine parameters with what their change needs
//! [000:10088].
//!
//! Decision: Power-off, and a machine parameter that needs a reset, make the control anew of what it was made of and
//! of what survives; time goes on counting, so that scripts, logs and recordings go on

use bahn_exchange::{Assignment, BitArea, Operand};
use bahn_parameters::{Change, Definition, ParameterList, Reaction};

use crate::tnc::Tnc;

/// What came of it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Altered {
    Done,
    /// It is not possible now.
    Refused,
    /// The control begins anew with this list.
    Reset(Box<ParameterList>),
}

/// Sets an operand, or a machine parameter of a channel.
pub(crate) fn set(tnc: &mut Tnc, channel: usize, assignment: &Assignment) -> Altered {
    match assignment {
        // There is one memory; the lists of the channels beside the first one are the machine builder's.
        _ if channel > 0 => Altered::Refused,
        Assignment::Operand(Operand::Bit(bit), _) if bit.area() == BitArea::I => Altered::Refused,
        Assignment::Operand(operand, content) => {
            operand.write(tnc.machine.memory.first_mut(), content);
            Altered::Done
        }
        Assignment::Parameter(text) => alter(tnc, text),
    }
}

/// Changes a machine parameter as the editor of the list does when it is left.
fn alter(tnc: &mut Tnc, text: &str) -> Altered {
    let mut list = tnc.machine.link.edited_list().clone();
    let Ok(id) = list.assign(text) else {
        return Altered::Refused;
    };
    let Ok(definition) = Definition::named(list.model(), id) else {
        return Altered::Refused;
    };
    let runs = tnc.channels.iter().any(|channel| channel.run.is_active());
    if runs && (definition.change != Change::PlcRun || definition.reaction != Reaction::None) {
        return Altered::Refused;
    }
    if definition.reaction == Reaction::Reset {
        return Altered::Reset(Box::new(list));
    }
    tnc.machine.link.edit(&list, id);
    tnc.machine.take_parameters();
    tnc.channels.first_mut().take_parameters(&mut tnc.machine);
    if definition.reaction == Reaction::ReferenceMarks {
        let units = tnc.machine.core.axes.iter_mut();
        let of_axis = |index: usize| id.index.is_none_or(|own| usize::from(own) == index);
        for unit in units.filter(|unit| unit.channel == 0 && of_axis(unit.index)) {
            unit.referenced = false;
        }
    }
    Altered::Done
}
