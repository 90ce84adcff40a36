//! Miscellaneous functions: when they act and what they do in the control.

use bahn_parameters::technology::{ControlAction, Output, Technology};
use bahn_path::{Axis, ControlFunction, Function, SpindleOrder, Switch};
use bahn_program::{Compensation, MFunctions};

use crate::availability::Feature;
use crate::block_functions::{BlockFunctions, Reference};
use crate::context::Context;
use crate::contour::{Corner, CornerArcs, FeedLaw};
use crate::error::{Fault, WarningKind};
use crate::modal::Modal;
use crate::numbers::Numbers;
use crate::q_parameters::preassigned;
use crate::settings::Settings;
use crate::status::Spindle;
use crate::superimposing;
use crate::tilting;
use crate::voltage;

/// Takes the M functions of a block.
pub(crate) fn take_m_functions(c: &mut Context<'_>, m: &MFunctions) -> Result<BlockFunctions, Fault> {
    let mut block = BlockFunctions {
        cycle_call: c.modal.cycle_after_each_block,
        ..Default::default()
    };
    for &code in m.codes() {
        take_m_function(c, code, m, &mut block)?;
    }
    Ok(block)
}

fn take_m_function(
    c: &mut Context<'_>,
    code: u16,
    m: &MFunctions,
    block: &mut BlockFunctions,
) -> Result<(), Fault> {
    if is_idle_approach(c, code) || !c.executes(Feature::M(code))? {
        return Ok(());
    }
    let Some(technology) = Technology::of_m(c.settings.model, code) else {
        return Ok(());
    };
    let rules = &c.settings.rules;
    if technology.does(ControlAction::ModalCycleCall) && rules.m_functions.m89_calls_cycle {
        c.modal.cycle_after_each_block = true;
        block.cycle_call = true;
        return Ok(());
    }
    for action in technology.actions() {
        if let Some(why) = idle(c, action) {
            c.without_effect(format!("M{code} has no effect {why}"))?;
        }
        act(c, action, block);
        tilting::act(c, action)?;
        act_on_block(c.modal, action, block);
        act_on_feed(c.modal, c.numbers, c.settings, action, m)?;
        let function = match action {
            ControlAction::Control(control) => Function::Control(control),
            ControlAction::Voltage => Function::Voltage(voltage::of(code, m, c.numbers, c.settings)?),
            ControlAction::Superimpose => Function::Superimpose(superimposing::ranges(m, c.numbers)?),
            ControlAction::SpindleOrientation => Function::SpindleOrientation(
                c.modal
                    .orientation_deg
                    .unwrap_or(c.settings.rules.spindle_orientation_deg),
            ),
            _ => continue,
        };
        block.output.push(rules.machine.output(function, technology));
    }
    if technology.output == Output::Plc {
        let own = c.settings.functions.get(code);
        block.output.push(rules.machine.m_output(code, own, technology));
    }
    Ok(())
}

/// M95 and M96 of a TNC 151/155 change how a compensated contour is approached and left, and put nothing out: without
/// compensation they have nothing to do [001:707-708].
fn is_idle_approach(c: &Context<'_>, code: u16) -> bool {
    let approaches = c.settings.model.has_approach_functions() && matches!(code, 95 | 96);
    approaches && c.modal.compensation == Compensation::Off
}

/// Why a function does nothing where it stands: M97 and M98 act on the corners of compensated paths
/// [003:3467-3512], M101 on the lives of a tool table [000:9103] [000:9175].
fn idle(c: &Context<'_>, action: ControlAction) -> Option<&'static str> {
    match action {
        ControlAction::Intersection | ControlAction::OpenContour
            if c.modal.compensation == Compensation::Off =>
        {
            Some("without radius compensation")
        }
        ControlAction::Control(ControlFunction::ReplaceWornTools(Switch::On))
            if c.settings.tools.is_none() =>
        {
            Some("without a tool table: tool lives and replacement tools stand there")
        }
        _ => None,
    }
}

/// Program, spindle and coolant.
fn act(c: &mut Context<'_>, action: ControlAction, block: &mut BlockFunctions) {
    let q = &mut c.numbers.q;
    match action {
        ControlAction::ProgramStop => block.stop = true,
        ControlAction::ToolChange => block.stop |= c.settings.rules.machine.m6_stops,
        ControlAction::ProgramEnd => {
            block.end = true;
            if c.at.in_called_program() {
                c.warn(WarningKind::EndInCalledProgram);
            }
        }
        ControlAction::Spindle(SpindleOrder::Clockwise) => c.modal.set_spindle(Spindle::Clockwise, q),
        ControlAction::Spindle(SpindleOrder::CounterClockwise) => {
            c.modal.set_spindle(Spindle::CounterClockwise, q)
        }
        ControlAction::Spindle(SpindleOrder::Stop | SpindleOrder::StopWithRun) => c.modal.stop_spindle(q),
        ControlAction::Coolant(switch) => {
            q.preassign(preassigned::COOLANT, f64::from(u8::from(switch.is_on())))
        }
        _ => {}
    }
}

/// What acts on the block itself.
fn act_on_block(modal: &mut Modal, action: ControlAction, block: &mut BlockFunctions) {
    match action {
        ControlAction::ConstantSpeed => block.constant_speed = true,
        ControlAction::MachineZero => block.reference = Reference::MachineZero,
        ControlAction::MachineDatum => block.reference = Reference::MachineDatum,
        ControlAction::ToolPosition => block.reference = Reference::Position,
        ControlAction::ReduceRotaryAxes => reduce_rotary_axes(modal),
        ControlAction::Intersection => block.corner = Corner::Intersection,
        ControlAction::OpenContour => block.corner = Corner::Open,
        ControlAction::Control(ControlFunction::TakeLargerTools(takes)) => {
            modal.takes_larger_tools = takes.is_on()
        }
        ControlAction::CycleCall => {
            modal.cycle_after_each_block = false;
            block.cycle_call = true;
        }
        _ => {}
    }
}

/// What acts on feed and corners of the blocks that follow.
fn act_on_feed(
    modal: &mut Modal,
    numbers: &Numbers,
    settings: &Settings,
    action: ControlAction,
    m: &MFunctions,
) -> Result<(), Fault> {
    match action {
        ControlAction::PlungingFeed => {
            let percent = m
                .argument(103, 'F')
                .map(|value| numbers.q.value(value))
                .transpose()?;
            modal.plunge_factor = percent.map(|percent| percent / 100.0);
        }
        ControlAction::FeedAtEdge => modal.feed_law = FeedLaw::Edge,
        ControlAction::FeedAtEdgeReduced => modal.feed_law = FeedLaw::EdgeReduced,
        ControlAction::FeedAtCentre => modal.feed_law = FeedLaw::Centre,
        ControlAction::CornerArcs => modal.corner_arcs = Some(corner_arcs(numbers, settings, m)?),
        ControlAction::SharpCorners => (modal.corner_arcs, modal.point_spacing_mm) = (None, 0.0),
        ControlAction::LeaveOutPoints => {
            let spacing = m.argument(124, 'T').map(|value| numbers.length(value));
            modal.point_spacing_mm = spacing.transpose()?.unwrap_or(0.0);
        }
        _ => {}
    }
    Ok(())
}

/// M112 T A: tolerance and greatest angle of the arcs at corners.
fn corner_arcs(numbers: &Numbers, settings: &Settings, m: &MFunctions) -> Result<CornerArcs, Fault> {
    let value = |letter| -> Result<Option<f64>, Fault> {
        m.argument(112, letter)
            .map(|value| numbers.q.value(value))
            .transpose()
    };
    let (tolerance, angle) = (value('T')?, value('A')?);
    let rules = &settings.rules;
    Ok(CornerArcs {
        tolerance_mm: tolerance.map_or(f64::INFINITY, |value| value * numbers.unit_mm),
        angle_deg: angle.unwrap_or(0.0),
        acceleration_m_s2: rules
            .acceleration_m_s2
            .map(|value| value.min(rules.radial_acceleration_m_s2)),
        spacing_mm: 0.0,
    })
}

/// M94: the position of rotary axes is reduced below 360 degrees without a movement [003:7482].
fn reduce_rotary_axes(modal: &mut Modal) {
    for axis in Axis::ALL.into_iter().filter(|axis| axis.is_rotary()) {
        for position in [&mut modal.nominal, &mut modal.actual] {
            position[axis] = position[axis].rem_euclid(360.0);
        }
    }
}
