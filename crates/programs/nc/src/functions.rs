//! M functions and speeds of a block, as the control hands them to PLC and spindle.
//!
//! Decision: On a TNC an M function of a `.nc` program goes out where the table of the model or the machine builder
//! has it: the PLC of the machine is written for that, and a channel list says nothing of a TNC
//!
//! Decision: What a TNC cannot do is refused at its block: a function that is passed over would spoil the part (also
//! `nc/src/reader.rs`)

use bahn_din::{Command, Kind, Target, Unit};
use bahn_parameters::MessageId;
use bahn_parameters::technology::{Block, ControlAction, Output, Technology};
use bahn_path::{At, Function, Synchronisation, TechnologyFunction};
use bahn_reader::Start;

/// What a block orders beside its motion.
#[derive(Default)]
pub(crate) struct Ordered {
    /// In the order of output.
    pub functions: Vec<TechnologyFunction>,
    /// The run stops after the block: by M0, or for the tool change of M6, which has no name.
    pub stops: Option<Option<&'static str>>,
}

/// Why a block cannot be executed here.
pub(crate) struct Refusal {
    pub message: MessageId,
    pub detail: String,
}

impl Refusal {
    /// What a text says wrongly.
    pub fn of_data(detail: &str) -> Refusal {
        Refusal {
            message: MessageId::WrongProgramData,
            detail: detail.to_owned(),
        }
    }

    /// What only the channel of a TF5200 has.
    pub fn of_channel(what: impl std::fmt::Display) -> Refusal {
        Refusal {
            message: MessageId::BlockNotSupported,
            detail: format!("{what}: `bahn technology` runs it"),
        }
    }
}

/// The main spindle, as brackets name it: the only one of this control.
const SPINDLE: &str = "S";

/// Where M19 orients the spindle to without `POS`, degrees (inferred).
const ORIENTATION_DEG: f64 = 0.0;

/// The functions of a block in the order of its text.
pub(crate) fn of_block(unit: &Unit, start: &Start) -> Result<Ordered, Refusal> {
    let mut ordered = Ordered::default();
    for function in &unit.functions {
        match &function.target {
            Some(Target::Axis(axis)) => {
                let what = format!("a function goes to the range of axis {axis}");
                return Err(Refusal::of_channel(what));
            }
            Some(Target::Spindle(name)) if **name != *SPINDLE => {
                return Err(Refusal::of_channel(format!("there is no spindle {name} here")));
            }
            _ => {}
        }
        match function.kind {
            Kind::H(code) => {
                return Err(Refusal::of_channel(format!(
                    "H{code}: this control has no H functions"
                )));
            }
            Kind::M(code) if function.value.is_some() => {
                return Err(Refusal::of_channel(format!(
                    "M{code}: its additive value goes to no PLC of this control"
                )));
            }
            Kind::M(code) => m(code, unit, start, &mut ordered)?,
            Kind::S(rpm) => ordered.functions.push(speed(rpm, start)?),
        }
    }
    Ok(ordered)
}

fn speed(rpm: f64, start: &Start) -> Result<TechnologyFunction, Refusal> {
    if rpm > start.rules.speed_max_rpm {
        return Err(Refusal {
            message: MessageId::WrongRpm,
            detail: format!("S{rpm} is more than {} rpm", start.rules.speed_max_rpm),
        });
    }
    let function = Function::SpindleSpeed(rpm);
    let technology = Technology::of_block(start.model, Block::SpindleSpeed);
    Ok(technology.map_or_else(
        || TechnologyFunction::new(function.clone(), At::Start, Synchronisation::MvsSvs),
        |technology| start.rules.output(function.clone(), technology),
    ))
}

fn m(code: u16, unit: &Unit, start: &Start, ordered: &mut Ordered) -> Result<(), Refusal> {
    if matches!(code, 17 | 29) {
        // They end a subroutine, and are no functions of the machine.
        return Ok(());
    }
    let Some(technology) = Technology::of_m(start.model, code) else {
        return Err(Refusal::of_channel(format!(
            "M{code} is no function of a {}",
            start.model.name()
        )));
    };
    for action in technology.actions() {
        match action {
            ControlAction::ProgramStop => ordered.stops = Some(Some("M0")),
            ControlAction::ToolChange if start.rules.m6_stops => {
                ordered.stops.get_or_insert(None);
            }
            ControlAction::SpindleOrientation => {
                let function = Function::SpindleOrientation(orientation(unit));
                ordered.functions.push(start.rules.output(function, technology));
            }
            ControlAction::ToolChange
            | ControlAction::ProgramEnd
            | ControlAction::Spindle(_)
            | ControlAction::Coolant(_)
            | ControlAction::ModalCycleCall => {}
            _ => return Err(of_a_tnc(code)),
        }
    }
    if technology.output != Output::Plc {
        return Err(of_a_tnc(code));
    }
    let own = start.functions.get(code);
    ordered
        .functions
        .push(start.rules.m_output(code, own, technology));
    Ok(())
}

/// The angle that a spindle bracket gives M19.
fn orientation(unit: &Unit) -> f64 {
    let of = |command: &Command| match command {
        Command::Spindle(order) => order.position_deg,
        _ => None,
    };
    unit.commands.iter().find_map(of).unwrap_or(ORIENTATION_DEG)
}

/// A function that the control itself executes, in programs of its own languages.
fn of_a_tnc(code: u16) -> Refusal {
    Refusal {
        message: MessageId::BlockNotSupported,
        detail: format!("M{code} acts on the path of a plain-language or DIN/ISO program alone"),
    }
}
