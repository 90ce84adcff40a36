//! Block search: what stands before the block with which a run begins is decoded and neither output nor moved.
//!
//! Its last state is listed (inferred): of each range the last of each function, of functions
//! that replace one another the last of all.
//!
//! Decision: A block search looks in the program itself, then in its subroutines, then in the next programs of the
//! file; what it passes over is neither output nor commanded nor waited for, only listed

use bahn_din::{Command, Unit};
use bahn_path::Position;

use super::in_force::InForce;
use super::plan::Plan;
use super::ranges::Ranges;
use super::resolve::Resolve;
use crate::report::{Fault, Skipped};
use crate::run::{Blocks, Run};

/// Functions of a spindle that replace one another, and the gear stages.
const GROUPS: [&[&str]; 2] = [
    &["M3", "M4", "M5", "M19"],
    &["M40", "M41", "M42", "M43", "M44", "M45"],
];

/// Where a run begins.
pub(super) struct Begun<'a> {
    /// What was passed over before.
    pub(super) skipped: Vec<Skipped>,
    /// Number of the program.
    pub(super) index: usize,
    pub(super) blocks: Box<dyn Blocks + 'a>,
    pub(super) position: Position,
    /// Commands that are in force there: the last of each kind.
    pub(super) commands: Vec<Command>,
}

impl Plan<'_> {
    /// Looks for a block in the programs of the first file, one after the other.
    pub(super) fn search<'r>(
        &mut self,
        run: &'r Run<'_>,
        block: &str,
        start: Position,
        ranges: &mut Ranges,
        cycle_s: f64,
    ) -> Result<Begun<'r>, Fault> {
        let mut position = start;
        let mut list = Vec::new();
        let mut missing = None;
        let first = run.programs.name(0);
        let same_file = |index: &usize| run.programs.name(*index) == first;
        for index in (0..run.programs.count()).take_while(same_file) {
            self.in_force = InForce::new(self.settings);
            let mut blocks = run.programs.open(index, &position)?;
            let mut commands = Vec::new();
            let found = self.skip_to(
                blocks.as_mut(),
                (block, cycle_s),
                ranges,
                &mut list,
                &mut commands,
            );
            if found.map_err(|fault| self.coded(fault))? {
                return Ok(Begun {
                    skipped: list,
                    index,
                    position: blocks.position(),
                    blocks,
                    commands,
                });
            }
            position = blocks.position();
            missing.get_or_insert_with(|| blocks.not_found(block));
        }
        Err(missing.unwrap_or(Fault {
            code: "syntax".to_owned(),
            message: "there is no program".to_owned(),
            program: first,
            block: block.to_owned(),
            line: 0,
        }))
    }

    /// Passes over what stands before a block of a program. Whether there is such a block.
    fn skip_to(
        &mut self,
        blocks: &mut dyn Blocks,
        (block, cycle_s): (&str, f64),
        ranges: &mut Ranges,
        list: &mut Vec<Skipped>,
        commands: &mut Vec<Command>,
    ) -> Result<bool, Fault> {
        while !blocks.next_is(block) {
            let Some(unit) = blocks.next(&mut self.in_force)? else {
                return Ok(false);
            };
            self.skip(&unit, cycle_s, ranges, list);
            if unit.ends {
                return Ok(false);
            }
            remember(commands, unit);
        }
        Ok(true)
    }

    /// Notes the functions of a block that is passed over. What the channel does not know is nobody's state.
    fn skip(&mut self, unit: &Unit, cycle_s: f64, ranges: &mut Ranges, list: &mut Vec<Skipped>) {
        let mut resolve = Resolve {
            settings: &self.in_force.settings,
            ranges,
            orders: &mut Default::default(),
            cycle_s,
        };
        for (function, value, target) in resolve.skipped(unit) {
            let free = self.in_force.settings.spindle_m_free;
            let group = GROUPS
                .iter()
                .filter(|_| !free)
                .find(|group| group.contains(&function.as_str()));
            list.retain(|other| {
                let replaced = other.function == function
                    || group.is_some_and(|group| group.contains(&other.function.as_str()));
                other.target != target || !replaced
            });
            list.push(Skipped {
                function,
                value,
                target,
                program: unit.place.program.to_string(),
                block: unit.place.block.to_string(),
            });
        }
    }
}

/// Keeps the last command of each kind that stays in force. The Micro Joint that a command shapes is that of the next
/// function, so it is over after one.
fn remember(commands: &mut Vec<Command>, unit: Unit) {
    if !unit.functions.is_empty() {
        commands.retain(|command| !matches!(command, Command::MicroJoint { .. }));
    }
    for command in unit.commands {
        let stays = matches!(
            command,
            Command::MicroJoint { .. }
                | Command::VectorLimit { .. }
                | Command::EdgeBanding(_)
                | Command::RadiusCompensation(_)
        );
        if stays {
            let kind = std::mem::discriminant(&command);
            commands.retain(|other| std::mem::discriminant(other) != kind);
            commands.push(command);
        }
    }
}
