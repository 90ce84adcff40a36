//! Miscellaneous functions: when they act and what they do in the control.

use bahn_path::{At, Axis, Function, Synchronisation, TechnologyFunction};
use bahn_program::MFunctions;

use crate::availability::Feature;
use crate::block_functions::{BlockFunctions, Reference};
use crate::contour::{Corner, CornerArcs, FeedLaw};
use crate::error::{Fault, WarningKind};
use crate::q_parameters::preassigned;
use crate::run::Run;
use crate::settings::Settings;
use crate::status::Spindle;

/// Highest M function that goes to the PLC [000:7206].
const M_PLC_MAX: u16 = 99;

/// Whether an M function takes effect at the end of its block [003:7459-7577] [000:7076-7171].
pub(crate) fn acts_at_end(m: u16) -> bool {
    matches!(m, 0..=2 | 5 | 6 | 9 | 10 | 12 | 19 | 30 | 32..=35 | 52..=54 | 60 | 63..=70 | 95..=99)
}

/// M functions that act inside the control and are not output [000:7080-7186]. Those of [`inside`] go with the path
/// all the same.
fn is_internal(m: u16) -> bool {
    matches!(m, 90..=99) || m > M_PLC_MAX
}

/// A function that acts in the control when the path comes to it, without a stop.
fn inside(code: u16) -> TechnologyFunction {
    TechnologyFunction {
        function: Function::M(code),
        at: At::Start,
        synchronisation: Synchronisation::Mos,
    }
}

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
        let rules = &settings.rules.m_functions;
        match code {
            0 => {
                block.stop = true;
                self.stop_spindle();
                self.set_coolant(false);
            }
            2 | 30 => {
                block.end = true;
                self.stop_spindle();
                self.set_coolant(false);
                if self.at.in_called_program() {
                    self.warn(WarningKind::EndInCalledProgram);
                }
            }
            3 | 13 => self.set_spindle(Spindle::Clockwise),
            4 | 14 => self.set_spindle(Spindle::CounterClockwise),
            5 => self.stop_spindle(),
            6 => {
                block.stop = rules.m6_stops;
                self.stop_spindle();
            }
            8 => self.set_coolant(true),
            9 => self.set_coolant(false),
            19 => {
                let angle = self
                    .modal
                    .orientation_deg
                    .unwrap_or(settings.rules.spindle_orientation_deg);
                block
                    .output
                    .push(output(Function::SpindleOrientation(angle), code, rules.axes_wait));
            }
            89 if rules.m89_calls_cycle => {
                self.modal.cycle_after_each_block = true;
                block.cycle_call = true;
                return Ok(());
            }
            90 => block.constant_speed = true,
            91 => block.reference = Reference::MachineZero,
            92 => block.reference = Reference::MachineDatum,
            93 => block.reference = Reference::Position,
            94 => self.reduce_rotary_axes(),
            97 => block.corner = Corner::Intersection,
            98 => block.corner = Corner::Open,
            99 => {
                self.modal.cycle_after_each_block = false;
                block.cycle_call = true;
            }
            103 if rules.m103_enabled => {
                let percent = m
                    .argument(103, 'F')
                    .map(|value| self.q.value(value))
                    .transpose()?;
                self.modal.plunge_factor = percent.map(|percent| percent / 100.0);
            }
            109 => self.modal.feed_law = FeedLaw::Edge,
            110 => self.modal.feed_law = FeedLaw::EdgeReduced,
            111 => self.modal.feed_law = FeedLaw::Centre,
            112 => self.modal.corner_arcs = Some(self.corner_arcs(m, settings)?),
            113 => self.modal.corner_arcs = None,
            // For who counts tool lives, and for the position loops.
            101 | 102 | 107 | 108 => block.output.push(inside(code)),
            105 | 106 if rules.m105_enabled => block.output.push(inside(code)),
            _ => {}
        }
        if matches!(code, 13 | 14) {
            self.set_coolant(true);
        }
        if !is_internal(code) {
            block
                .output
                .push(output(Function::M(code), code, rules.axes_wait));
        }
        Ok(())
    }

    /// M112 with T and A: arcs at the corners of uncompensated lines.
    fn corner_arcs(&self, m: &MFunctions, settings: &Settings) -> Result<CornerArcs, Fault> {
        let value = |letter| -> Result<Option<f64>, Fault> {
            m.argument(112, letter)
                .map(|value| self.q.value(value))
                .transpose()
        };
        let (tolerance, angle) = (value('T')?, value('A')?);
        let rules = &settings.rules;
        let plane = self.modal.plane;
        Ok(CornerArcs {
            tolerance_mm: tolerance.map_or(f64::INFINITY, |value| value * self.unit_mm),
            angle_deg: angle.unwrap_or(0.0),
            acceleration_m_s2: [plane.first, plane.second]
                .into_iter()
                .filter_map(|axis| rules.acceleration_m_s2.get(axis.index()))
                .fold(rules.radial_acceleration_m_s2, |least, value| least.min(*value)),
        })
    }

    fn set_coolant(&mut self, on: bool) {
        self.q.preassign(preassigned::COOLANT, if on { 1.0 } else { 0.0 });
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

/// An output with its place in the block.
fn output(function: Function, code: u16, axes_wait: bool) -> TechnologyFunction {
    let at = if acts_at_end(code) { At::End } else { At::Start };
    // Functions with a programmed stop always stop the axes [001:1651-1652].
    let stops = matches!(code, 0 | 2 | 6 | 30);
    let synchronisation = match (axes_wait || stops, at) {
        (false, _) => Synchronisation::Mos,
        (true, At::End) => Synchronisation::MnsSns,
        (true, _) => Synchronisation::MvsSvs,
    };
    TechnologyFunction {
        function,
        at,
        synchronisation,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The whole table of the manuals: effective at the end of the block [003:7463-7577].
    #[test]
    fn the_table_of_m_functions_is_complete() {
        let predefined_end = [0, 2, 5, 6, 9, 30, 95, 96, 97, 98, 99];
        let free_end = [
            1, 10, 12, 19, 32, 33, 34, 35, 52, 53, 54, 60, 63, 64, 65, 66, 67, 68, 69, 70,
        ];
        let at_end: Vec<u16> = (0..=99).filter(|m| acts_at_end(*m)).collect();
        let mut expected: Vec<u16> = predefined_end.into_iter().chain(free_end).collect();
        expected.sort_unstable();
        assert_eq!(at_end, expected);
    }

    #[test]
    fn functions_of_the_control_do_not_reach_the_plc() {
        // M91 to M99 act in the control; M100 and above are never sent [000:7206].
        let sent: Vec<u16> = (85..=105).filter(|m| !is_internal(*m)).collect();
        assert_eq!(sent, [85, 86, 87, 88, 89]);
    }
}
