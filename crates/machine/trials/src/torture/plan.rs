//! What a seed says: which program, from which moment of it on, and what happens when.

use super::catalogue::{Catalogue, Kind, Mishap};
use super::dice::Dice;

/// Something that happens at a time of the machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Happening {
    /// Simulation time, µs since power-on.
    pub time_us: u64,
    /// What kind of thing it is.
    pub kind: Kind,
    /// The event of the machine, the command of the control or the operands, as a script has it.
    pub what: String,
}

/// The plan of a seed.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The number from which the plan was drawn.
    pub seed: u64,
    /// The program, by its place among those of the machine.
    pub program: usize,
    /// The moment of the undisturbed run that it begins at, by its place among those that were kept.
    pub moment: usize,
    /// What happens, in the order of time.
    pub happenings: Vec<Happening>,
    /// When the window ends, µs since power-on; then everything is put back.
    pub end_us: u64,
}

/// The shortest and the longest window, µs.
const WINDOW_US: [usize; 2] = [600_000, 2_600_000];

/// Part of what the operator does that is a turn of the handwheel, where a program lets him, percent.
const TURNS: usize = 50;

/// What the seeds choose from in a program.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    /// The program, by its place among those of the campaign.
    pub program: usize,
    /// The kept moments, µs since power-on.
    pub moments: Vec<u64>,
    /// What the handwheel may do beside its path.
    pub turns: Vec<Mishap>,
}

/// What the seeds of a campaign choose from.
pub(super) struct Choice<'a> {
    pub catalogue: &'a Catalogue,
    /// What an undisturbed run showed of each program.
    pub scenes: &'a [Scene],
}

impl Choice<'_> {
    /// The plan of a seed: a function of the seed alone.
    pub fn plan(&self, seed: u64) -> Plan {
        let mut dice = Dice::new(seed);
        let scene = self.scenes.get(dice.below(self.scenes.len()));
        let program = scene.map_or(0, |scene| scene.program);
        let moments = scene.map_or(&[][..], |scene| &scene.moments);
        let turns = scene.map_or(&[][..], |scene| &scene.turns);
        let moment = dice.below(moments.len());
        let from_us = moments.get(moment).copied().unwrap_or_default();
        let window = WINDOW_US[0] + dice.below(WINDOW_US[1] - WINDOW_US[0]);
        // Half of all windows see no fault: whatever message comes in them has no cause.
        let faults = dice.percent(55);
        let mut happenings = Vec::new();
        for _ in 0..1 + dice.below(4) {
            let kind = kind(&mut dice, faults);
            let turned = kind == Kind::Use && !turns.is_empty() && dice.percent(TURNS);
            let mishap = match turned {
                true => dice.pick(turns).cloned(),
                false => self.catalogue.pick(kind, &mut dice),
            };
            let Some(mishap) = mishap else {
                continue;
            };
            let at = dice.below(window);
            let mut put = |at: usize, what: String| {
                happenings.push(Happening {
                    time_us: from_us + at as u64,
                    kind,
                    what,
                });
            };
            put(at, mishap.what);
            if let Some(undone_by) = mishap.undone_by
                && dice.percent(60)
            {
                let dip = dice.percent(30);
                let later = if dip {
                    3_000 + dice.below(60_000)
                } else {
                    dice.below(window)
                };
                put(at + later, undone_by);
            }
        }
        happenings.sort_by_key(|happening| happening.time_us);
        let end_us = from_us + window as u64;
        happenings.retain(|happening| happening.time_us < end_us);
        Plan {
            seed,
            program,
            moment,
            happenings,
            end_us,
        }
    }
}

fn kind(dice: &mut Dice, faults: bool) -> Kind {
    match (dice.below(100), faults) {
        (0..=59, true) => Kind::Fault,
        (60..=64, true) => Kind::Plc,
        (65..=79, true) | (0..=54, false) => Kind::Use,
        (80..=84, true) | (55..=69, false) => Kind::AxisKey,
        (85..=91, true) | (70..=81, false) => Kind::Emergency,
        (92..=94, true) | (82..=89, false) => Kind::Power,
        _ => Kind::Thing,
    }
}
