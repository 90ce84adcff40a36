//! Miscellaneous functions: when they act and what they do in the control.

use bahn_parameters::technology::{Deed, Output, Technology};
use bahn_path::{Axis, ControlFunction, Function, SpindleOrder, TechnologyFunction};
use bahn_program::MFunctions;

use crate::availability::Feature;
use crate::block_functions::{BlockFunctions, Reference};
use crate::contour::{Corner, CornerArcs, FeedLaw};
use crate::error::{Fault, WarningKind};
use crate::q_parameters::preassigned;
use crate::run::Run;
use crate::settings::Settings;
use crate::status::Spindle;

impl Run {
    /// Takes the M functions of a block.
    pub(crate) fn take_m_functions(
        &mut self,
        m: &MFunctions,
        settings: &Settings,
    ) -> Result<BlockFunctions, Fault> {
        let mut block = BlockFunctions {
            cycle_call: self.modal.cycle_after_each_block,
            ..Default::default()
        };
        for &code in m.codes() {
            self.take_m_function(code, m, settings, &mut block)?;
        }
        Ok(block)
    }

    fn take_m_function(
        &mut self,
        code: u16,
        m: &MFunctions,
        settings: &Settings,
        block: &mut BlockFunctions,
    ) -> Result<(), Fault> {
        if !self.executes(Feature::M(code), settings)? {
            return Ok(());
        }
        let Some(technology) = Technology::of_m(settings.model, code) else {
            return Ok(());
        };
        let rules = &settings.rules.m_functions;
        if technology.does(Deed::ModalCycleCall) && rules.m89_calls_cycle {
            self.modal.cycle_after_each_block = true;
            block.cycle_call = true;
            return Ok(());
        }
        for deed in technology.deeds() {
            self.act(deed, block, settings);
            self.act_on_block(deed, block);
            self.act_on_feed(deed, m, settings)?;
            let function = match deed {
                Deed::Control(ControlFunction::SecondServoSet(_)) if !rules.m105_enabled => continue,
                Deed::Control(control) => Function::Control(control),
                Deed::SpindleOrientation => Function::SpindleOrientation(
                    self.modal
                        .orientation_deg
                        .unwrap_or(settings.rules.spindle_orientation_deg),
                ),
                _ => continue,
            };
            block.output.push(rules.output(function, technology));
        }
        if technology.output == Output::Plc {
            let function = rules.output(Function::M(code), technology);
            block.output.push(TechnologyFunction {
                spindle: technology.spindle(),
                ..function
            });
        }
        Ok(())
    }

    /// Program, spindle and coolant.
    fn act(&mut self, deed: Deed, block: &mut BlockFunctions, settings: &Settings) {
        match deed {
            Deed::ProgramStop => block.stop = true,
            Deed::ToolChange => block.stop = settings.rules.m_functions.m6_stops,
            Deed::ProgramEnd => {
                block.end = true;
                if self.at.in_called_program() {
                    self.warn(WarningKind::EndInCalledProgram);
                }
            }
            Deed::Spindle(SpindleOrder::Clockwise) => {
                self.modal.set_spindle(Spindle::Clockwise, &mut self.numbers.q)
            }
            Deed::Spindle(SpindleOrder::CounterClockwise) => self
                .modal
                .set_spindle(Spindle::CounterClockwise, &mut self.numbers.q),
            Deed::Spindle(SpindleOrder::Stop | SpindleOrder::StopWithRun) => {
                self.modal.stop_spindle(&mut self.numbers.q)
            }
            Deed::Coolant(on) => self.set_coolant(on),
            _ => {}
        }
    }

    /// What acts on the block itself.
    fn act_on_block(&mut self, deed: Deed, block: &mut BlockFunctions) {
        match deed {
            Deed::ConstantSpeed => block.constant_speed = true,
            Deed::MachineZero => block.reference = Reference::MachineZero,
            Deed::MachineDatum => block.reference = Reference::MachineDatum,
            Deed::ToolPosition => block.reference = Reference::Position,
            Deed::ReduceRotaryAxes => self.reduce_rotary_axes(),
            Deed::Intersection => block.corner = Corner::Intersection,
            Deed::OpenContour => block.corner = Corner::Open,
            Deed::CycleCall => {
                self.modal.cycle_after_each_block = false;
                block.cycle_call = true;
            }
            _ => {}
        }
    }

    /// What acts on feed and corners of the blocks that follow.
    fn act_on_feed(&mut self, deed: Deed, m: &MFunctions, settings: &Settings) -> Result<(), Fault> {
        match deed {
            Deed::PlungingFeed if settings.rules.m_functions.m103_enabled => {
                let percent = m
                    .argument(103, 'F')
                    .map(|value| self.numbers.q.value(value))
                    .transpose()?;
                self.modal.plunge_factor = percent.map(|percent| percent / 100.0);
            }
            Deed::FeedAtEdge => self.modal.feed_law = FeedLaw::Edge,
            Deed::FeedAtEdgeReduced => self.modal.feed_law = FeedLaw::EdgeReduced,
            Deed::FeedAtCentre => self.modal.feed_law = FeedLaw::Centre,
            Deed::CornerArcs => self.begin_corner_arcs(m, settings)?,
            Deed::SharpCorners => self.modal.corner_arcs = None,
            _ => {}
        }
        Ok(())
    }

    /// M112 T A: tolerance and greatest angle of the arcs at corners.
    fn begin_corner_arcs(&mut self, m: &MFunctions, settings: &Settings) -> Result<(), Fault> {
        let value = |letter| -> Result<Option<f64>, Fault> {
            m.argument(112, letter)
                .map(|value| self.numbers.q.value(value))
                .transpose()
        };
        let (tolerance, angle) = (value('T')?, value('A')?);
        let rules = &settings.rules;
        let plane = self.modal.plane;
        self.modal.corner_arcs = Some(CornerArcs {
            tolerance_mm: tolerance.map_or(f64::INFINITY, |value| value * self.numbers.unit_mm),
            angle_deg: angle.unwrap_or(0.0),
            acceleration_m_s2: [plane.first, plane.second]
                .into_iter()
                .filter_map(|axis| rules.acceleration_m_s2.get(axis.index()))
                .fold(rules.radial_acceleration_m_s2, |least, value| least.min(*value)),
        });
        Ok(())
    }

    fn set_coolant(&mut self, on: bool) {
        self.numbers
            .q
            .preassign(preassigned::COOLANT, if on { 1.0 } else { 0.0 });
    }

    /// M94: the position of rotary axes is reduced below 360 degrees without a movement [003:7482].
    fn reduce_rotary_axes(&mut self) {
        for axis in Axis::ALL.into_iter().filter(|axis| axis.is_rotary()) {
            for position in [&mut self.modal.nominal, &mut self.modal.actual] {
                position[axis] = position[axis].rem_euclid(360.0);
            }
        }
    }
}
