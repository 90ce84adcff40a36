//! Parameters that all channels share, and those of the system by which a control runs [002:6147-6627] [002:1272-1350].
//!
//! Decision: With G96 a spindle of a System 900 turns P11648 / (pi * d); d is P11642, or twice P12151 of the axis P11641. P11644
//! limits the cutting speed, P12004 of the spindle the speed in rpm; P11649 shows what turns in the unit of P11648

use crate::array::Cell;
use crate::axis_block::AxisParameter;
use crate::memory::{Memory, Place};
use crate::name::Name;
use crate::numbered::parameters;
use crate::numbers::{COUPLING_BLOCK, COUPLINGS_MAX, SHARED, SPINDLE_WORDS};

parameters! {
/// A parameter that all channels share.
SharedParameter {
    /// P11130: the language of the texts [002:5663-5665].
    Language = 11130,
    /// P11301: the interpolation cycle, ms.
    CycleTime = 11301,
    /// P11310: override 1, %: five parameters each.
    Override = 11310,
    /// P11370: how many values the override table has; they follow.
    OverrideTable = 11370,
    /// P11400: handwheel 1, ten parameters each.
    Handwheel = 11400,
    /// P11480: coupling 1, twenty parameters each.
    Coupling = 11480,
    /// P11640: spindle 1, twenty parameters each.
    Spindle = 11640,
}
}

/// Decimals of positions, in the descriptor [002:954-965].
const POSITION_DECIMALS: u32 = 59;
/// Overrides, of which the first four follow a potentiometer [002:6200-6290].
const OVERRIDE_BLOCK: u32 = 5;
const OVERRIDES: u8 = 8;
const FREE_OVERRIDES: u8 = 4;
/// What the other four give, %.
const FIXED_OVERRIDES: [f64; 4] = [0.0, 10.0, 50.0, 100.0];
/// The preset table, %.
const PRESET: [f64; 27] = [
    0.0, 1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 70.0, 75.0,
    80.0, 85.0, 90.0, 95.0, 100.0, 105.0, 110.0, 115.0, 120.0,
];
/// Steps of a potentiometer.
const RAW_MAX: f64 = 255.0;
/// Ratio, and what couples or is coupled, in the block of a coupling.
const HANDWHEEL_BLOCK: u32 = 10;
/// P11647: a cutting speed is programmed.
const CUTTING: f64 = 96.0;
/// P11643: it counts in m/min.
const METRES: f64 = 1000.0;
/// P11646 = 1: degrees.
const TURN_DEG: f64 = 360.0;
/// Handwheels [002:6297-6360].
const HANDWHEELS: u32 = 8;

/// A coupling of two physical axes as it is written [002:6520-6573].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CouplingBlock {
    /// Which, from 1 on.
    pub number: u8,
    /// The physical axis that leads.
    pub master: u8,
    /// The physical axis that follows.
    pub slave: u8,
    /// The error that is allowed, mm or degrees; `None` without monitoring.
    pub error_mm: Option<f64>,
    /// So long it may last, s.
    pub time_s: f64,
    /// Where both stand when they are synchronous, mm or degrees.
    pub synchronous_mm: [f64; 2],
    /// The slave goes so much farther than the master.
    pub ratio: f64,
    /// What is ordered: off 0, on 1, synchronous 2.
    pub order: i64,
}

/// A handwheel as it is written [002:6297-6360].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandwheelBlock {
    /// The physical axis whose encoder it is.
    pub encoder: u8,
    /// The physical axis that it moves.
    pub axis: u8,
    /// It acts.
    pub active: bool,
    /// Way of an increment with its multiplier, mm or degrees.
    pub step_mm: f64,
}

/// A spindle as it is written [002:6575-6627].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpindleBlock {
    /// Which, from 1 on.
    pub number: u8,
    /// The physical axis that turns.
    pub axis: u8,
    /// Its speed at most, rpm: P11645, with G96 that of the cutting speed P11644.
    pub max_rpm: f64,
    /// The programmed speed, rpm.
    pub rpm: f64,
    /// What one unit of the programmed speed is, rpm; infinite with G96 in the middle of the reference.
    pub unit_rpm: f64,
    /// What is ordered: off 0, positive 1, negative -1, to its position ±2.
    pub order: i64,
    /// Where it is positioned, degrees.
    pub position_deg: f64,
    /// The speed counts as reached when it is so near, %; `None` without monitoring.
    pub tolerance_percent: Option<f64>,
}

/// The name of one that comes so many after a parameter.
fn shared_name(of: SharedParameter, after: u32) -> Name {
    Name::P(1, of.number() + after)
}

/// The override whose potentiometer a system parameter is.
pub(crate) fn override_at(number: u32) -> Option<u8> {
    let first = SharedParameter::Override.number() - SHARED.0 + SHARED.1 + 1;
    let at = number.checked_sub(first)?;
    let index = at / OVERRIDE_BLOCK;
    let number = u8::try_from(index + 1).ok()?;
    (at % OVERRIDE_BLOCK == 0 && number <= FREE_OVERRIDES).then_some(number)
}

impl Memory {
    /// What a system parameter holds.
    pub fn system_cell(&self, number: u32) -> Cell {
        self.at(Place::Q(number))
    }

    fn shared_cell(&self, of: SharedParameter, offset: u32) -> Cell {
        self.system_cell(of.number() - SHARED.0 + SHARED.1 + offset)
    }

    fn shared_number(&self, of: SharedParameter, offset: u32) -> f64 {
        self.shared_cell(of, offset).number().unwrap_or(0.0)
    }

    fn shared_axis(&self, of: SharedParameter, offset: u32) -> Option<u8> {
        let number = self.shared_cell(of, offset).whole()?;
        u8::try_from(number).ok().filter(|axis| *axis > 0)
    }

    /// The interpolation cycle that is wanted, ms; `None` when nobody says.
    pub fn cycle_ms(&self) -> Option<f64> {
        self.shared_cell(SharedParameter::CycleTime, 0)
            .number()
            .filter(|ms| *ms > 0.0)
    }

    /// Decimals of positions that the control writes [002:954-965].
    pub fn position_decimals(&self, channel: u8) -> u8 {
        let said = self.descriptor(channel).entry(POSITION_DECIMALS).whole();
        said.and_then(|decimals| u8::try_from(decimals).ok())
            .filter(|decimals| (1..=9).contains(decimals))
            .unwrap_or(3)
    }

    /// The second language is selected, P11130 [002:5663-5665].
    pub fn has_second_language(&self) -> bool {
        self.shared_cell(SharedParameter::Language, 0).whole() == Some(1)
    }

    /// How the potentiometer of an override stands, 1 to 4: the parameter that the panel writes [002:6376].
    pub fn override_name(&self, number: u8) -> Name {
        let at = u32::from(number.clamp(1, FREE_OVERRIDES) - 1) * OVERRIDE_BLOCK + 1;
        shared_name(SharedParameter::Override, at)
    }

    /// Where its potentiometer has to stand so that an override, 1 to 4, comes nearest to so many %.
    pub fn override_raw(&self, number: u8, percent: f64) -> u8 {
        let at = u32::from(number.clamp(1, FREE_OVERRIDES) - 1) * OVERRIDE_BLOCK;
        let far = |raw: u8| (self.percent_at(at, raw.into()) - percent).abs();
        (0..=u8::MAX)
            .min_by(|a, b| far(*a).total_cmp(&far(*b)))
            .unwrap_or(u8::MAX)
    }

    /// What a handwheel, 1 to 8, has written: the axis that it moves, whether it acts, its multiplier [002:6297-6360].
    pub fn handwheel_names(&self, number: u8) -> [Name; 3] {
        let at = u32::from(number.saturating_sub(1)).min(HANDWHEELS - 1) * HANDWHEEL_BLOCK;
        [1, 2, 4].map(|offset| shared_name(SharedParameter::Handwheel, at + offset))
    }

    /// An override, %, 1 to 8: as its potentiometer stands, through the table, within its limits [002:6200-6290]. One that was
    /// never written is 100 %, and so is one that is none (inferred).
    pub fn override_percent(&self, number: u8) -> f64 {
        let at = u32::from(number.saturating_sub(1)) * OVERRIDE_BLOCK;
        if !(1..=OVERRIDES).contains(&number) {
            return 100.0;
        }
        if number > FREE_OVERRIDES {
            let fixed = FIXED_OVERRIDES.get(usize::from(number - FREE_OVERRIDES - 1));
            return fixed.copied().unwrap_or(100.0);
        }
        let of = |offset: u32| self.shared_cell(SharedParameter::Override, at + offset).number();
        let Some(raw) = of(1) else { return 100.0 };
        self.percent_at(at, raw)
    }

    /// What the override at a place gives where its potentiometer stands, %.
    fn percent_at(&self, at: u32, raw: f64) -> f64 {
        let of = |offset: u32| self.shared_cell(SharedParameter::Override, at + offset).number();
        let raw = raw.clamp(0.0, RAW_MAX);
        let percent = match of(4).filter(|pointer| *pointer != 0.0) {
            Some(_) => self.tabled(raw),
            None => raw * of(3).unwrap_or(100.0) / RAW_MAX,
        };
        percent
            .max(of(2).unwrap_or(0.0))
            .min(of(3).unwrap_or(f64::INFINITY))
    }

    fn tabled(&self, raw: f64) -> f64 {
        let length = self.shared_cell(SharedParameter::OverrideTable, 0).whole();
        let preset = PRESET.len();
        let count = length
            .and_then(|length| usize::try_from(length).ok())
            .filter(|count| *count > 0);
        let index = (raw * count.unwrap_or(preset) as f64 / (RAW_MAX + 1.0)).floor() as u32;
        let own = self
            .shared_cell(SharedParameter::OverrideTable, 1 + index)
            .number();
        match count.and(own) {
            Some(percent) => percent,
            None => PRESET.get(index as usize).copied().unwrap_or(100.0),
        }
    }

    /// Where the potentiometer of an override, 1 to 4, is: 0 to 255.
    pub fn override_place(&self, number: u8) -> Option<Place> {
        let at = u32::from(number.checked_sub(1)?) * OVERRIDE_BLOCK + 1;
        let place = SharedParameter::Override.number() - SHARED.0 + SHARED.1 + at;
        (number <= FREE_OVERRIDES).then_some(Place::Q(place))
    }

    /// Stores what an override is now.
    pub fn show_override(&mut self, number: u8) {
        if (1..=OVERRIDES).contains(&number) {
            let percent = self.override_percent(number);
            let at = u32::from(number - 1) * OVERRIDE_BLOCK;
            let number = SharedParameter::Override.number() - SHARED.0 + SHARED.1 + at;
            self.store(Place::Q(number), Some(percent), 0);
        }
    }

    /// A coupling, 1 to 8, that names two axes.
    pub fn coupling(&self, number: u8) -> Option<CouplingBlock> {
        let number = number.min(COUPLINGS_MAX as u8);
        let at = u32::from(number.checked_sub(1)?) * COUPLING_BLOCK;
        let of = |offset: u32| self.shared_number(SharedParameter::Coupling, at + offset);
        let teeth = |offset: u32| Some(of(offset)).filter(|teeth| *teeth != 0.0).unwrap_or(1.0);
        Some(CouplingBlock {
            number,
            master: self.shared_axis(SharedParameter::Coupling, at)?,
            slave: self.shared_axis(SharedParameter::Coupling, at + 1)?,
            error_mm: Some(of(4)).filter(|error| *error > 0.0),
            time_s: of(5) * 1e-3,
            synchronous_mm: [of(10), of(11)],
            ratio: teeth(12) / teeth(13),
            order: self
                .shared_cell(SharedParameter::Coupling, at + 15)
                .whole()
                .unwrap_or(0),
        })
    }

    /// Stores how far a coupling is: off 0, on 1, synchronous 2.
    pub fn show_coupling(&mut self, number: u8, state: u8) {
        let at = u32::from(number.saturating_sub(1)) * COUPLING_BLOCK + 16;
        let place = SharedParameter::Coupling.number() - SHARED.0 + SHARED.1 + at;
        self.store(Place::Q(place), Some(state.into()), 0);
    }

    /// A handwheel, 1 to 8, that names an encoder and an axis.
    pub fn handwheel(&self, number: u8) -> Option<HandwheelBlock> {
        let number = u32::from(number)
            .checked_sub(1)
            .filter(|number| *number < HANDWHEELS)?;
        let at = number * HANDWHEEL_BLOCK;
        let of = |offset: u32| self.shared_number(SharedParameter::Handwheel, at + offset);
        let resolution = Some(of(3)).filter(|resolution| *resolution != 0.0)?;
        let multiplier = Some(of(4)).filter(|multiplier| *multiplier != 0.0).unwrap_or(1.0);
        Some(HandwheelBlock {
            encoder: self.shared_axis(SharedParameter::Handwheel, at)?,
            axis: self.shared_axis(SharedParameter::Handwheel, at + 1)?,
            active: of(2) == 1.0,
            step_mm: multiplier / resolution,
        })
    }

    /// A spindle, 1 to 8, that names an axis.
    pub fn spindle(&self, number: u8) -> Option<SpindleBlock> {
        let number = number.min(COUPLINGS_MAX as u8);
        let at = u32::from(number.checked_sub(1)?) * COUPLING_BLOCK;
        let of = |offset: u32| self.shared_number(SharedParameter::Spindle, at + offset);
        let limit = |offset: u32| Some(of(offset)).filter(|limit| *limit > 0.0);
        let (unit_rpm, max_rpm) = if of(7) == CUTTING {
            let round = std::f64::consts::PI * self.cutting_diameter(at);
            let factor = if of(3) == METRES { METRES } else { 1.0 };
            (factor / round, limit(4).map(|speed| speed / round))
        } else if of(6) == 1.0 {
            (1.0 / TURN_DEG, limit(5))
        } else {
            (1.0, limit(5))
        };
        let programmed = of(8);
        Some(SpindleBlock {
            number,
            axis: self.shared_axis(SharedParameter::Spindle, at)?,
            max_rpm: max_rpm.unwrap_or(f64::INFINITY),
            // Nothing is nothing, also where a unit is infinite.
            rpm: if programmed == 0.0 {
                0.0
            } else {
                programmed * unit_rpm
            },
            unit_rpm,
            order: self
                .shared_cell(SharedParameter::Spindle, at + 10)
                .whole()
                .unwrap_or(0),
            position_deg: of(12),
            tolerance_percent: Some(of(13)).filter(|percent| *percent > 0.0),
        })
    }

    /// The diameter that a cutting speed is about, mm: P11642, or twice where the axis P11641 stands.
    fn cutting_diameter(&self, at: u32) -> f64 {
        let of = |offset: u32| self.shared_number(SharedParameter::Spindle, at + offset);
        let diameter = match self.shared_axis(SharedParameter::Spindle, at + 1) {
            None => of(2),
            Some(axis) => {
                let stands = self.of_axis(axis, AxisParameter::NominalPosition).number();
                2.0 * stands.unwrap_or(0.0)
            }
        };
        diameter.abs()
    }

    /// A programmed speed, rpm, goes to the spindle that the descriptor of the channel gives to the word S [002:858-881]; to none
    /// where it names none.
    pub fn program_speed(&mut self, channel: u8, rpm: f64) {
        if let Some([speed, _]) = self.spindle_of_word(channel, 1) {
            self.store_exact(Place::Q(speed), Some(rpm));
        }
    }

    /// The system parameters of speed and kind of speed, P11648 and P11647, of the spindle that the descriptor of a channel
    /// gives to a spindle word, 1 to 8 [002:858-881]; `None` where it names none.
    pub fn spindle_of_word(&self, channel: u8, word: u8) -> Option<[u32; 2]> {
        let entry = SPINDLE_WORDS + u32::from(word.checked_sub(1).filter(|word| *word < 8)?);
        let number = self.descriptor(channel).entry(entry).whole()?;
        let number = u32::try_from(number)
            .ok()
            .filter(|number| (1..=COUPLINGS_MAX).contains(number))?;
        let first = SharedParameter::Spindle.number() - SHARED.0 + SHARED.1 + (number - 1) * COUPLING_BLOCK;
        Some([first + 8, first + 7])
    }

    /// Stores the speed of a spindle, in the unit of its programmed speed, and whether it is reached: no 0, yes 1, at its position 2.
    pub fn show_spindle(&mut self, number: u8, speed: f64, reached: u8) {
        let at = u32::from(number.saturating_sub(1)) * COUPLING_BLOCK;
        let first = SharedParameter::Spindle.number() - SHARED.0 + SHARED.1 + at;
        self.store(Place::Q(first + 9), Some(speed), 3);
        self.store(Place::Q(first + 11), Some(reached.into()), 0);
    }
}
