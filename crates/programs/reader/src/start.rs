//! What a program begins with.

use bahn_parameters::own_functions::{OwnFunction, OwnFunctions};
use bahn_parameters::technology::{AxisHalts, Technology};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_path::{At, AxisSet, Function, Position, Synchronisation, TechnologyFunction};

/// What machine parameters rule in programs of any language.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachineRules {
    /// At which functions the axes halt.
    pub halts: AxisHalts,
    /// M6 stops the run: MP7440 bit 0 = 0 [000:7258-7262].
    pub m6_stops: bool,
    /// Highest spindle speed that can be programmed, rpm [003:2180-2182].
    pub speed_max_rpm: f64,
}

impl MachineRules {
    /// By a list of machine parameters.
    pub fn of(list: &ParameterList) -> MachineRules {
        let m = list.m_functions();
        MachineRules {
            halts: AxisHalts {
                at_m_functions: m.axes_wait,
                at_speeds: m.axes_wait_for_speed,
            },
            m6_stops: m.m6_stops,
            speed_max_rpm: list.spindle_speed_max_rpm(),
        }
    }

    /// A function where the table of the model has it.
    pub fn output(&self, function: Function, technology: &Technology) -> TechnologyFunction {
        TechnologyFunction::new(function, technology.at, technology.synchronisation(self.halts))
    }

    /// An M function that goes to the PLC: where the machine builder has it, else where the table of the model has it.
    pub fn m_output(
        &self,
        code: u16,
        own: Option<OwnFunction>,
        technology: &Technology,
    ) -> TechnologyFunction {
        match own {
            Some(OwnFunction::Out { at, synchronisation }) => {
                TechnologyFunction::new(Function::M(code), at, synchronisation)
            }
            Some(OwnFunction::Point) => synchronisation_point(),
            None => TechnologyFunction {
                spindle: technology.spindle(),
                ..self.output(Function::M(code), technology)
            },
        }
    }
}

/// `#EXPL SYN`: what waits for it is to be acknowledged here [004:75].
pub fn synchronisation_point() -> TechnologyFunction {
    TechnologyFunction::new(Function::Synchronise, At::Start, Synchronisation::Mos)
}

/// What a program finds on a machine when it begins, whatever language it is in.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// The control model that executes it.
    pub model: ControlModel,
    /// The M functions that are synchronised otherwise than the control model does.
    pub functions: OwnFunctions,
    /// What its machine parameters say.
    pub rules: MachineRules,
    /// Axes that no program moves, where whoever feeds from it does not find that out.
    pub absent: AxisSet,
    /// Where the axes stand, workpiece coordinates, mm and degrees.
    pub position: Position,
}

impl Start {
    /// On a machine with a list of machine parameters.
    pub fn of(list: &ParameterList, functions: OwnFunctions, absent: AxisSet, position: Position) -> Start {
        Start {
            model: list.model(),
            functions,
            rules: MachineRules::of(list),
            absent,
            position,
        }
    }
}
