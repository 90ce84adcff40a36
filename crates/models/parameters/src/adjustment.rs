//! The machine parameters that are found by trial when a machine is commissioned [000:9549-9817], on the TNC 151/155 under
//! their old numbers [001:2573-2760].

use crate::{Definition, ParameterId, ParameterList};

/// What is adjusted, by trial or by measuring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Adjustment {
    /// MP1390: 1 runs programs with servo lag, 0 with feed pre-control; one for all axes.
    ServoLag,
    /// MP1520, m/min: transient response; one for all axes.
    Transient,
    /// MP1510, (m/min)/mm: kv with pre-control.
    KvPrecontrol,
    /// MP1810, (m/min)/mm: kv with servo lag.
    KvLag,
    /// MP1820: factor of kv above the kink point.
    KinkFactor,
    /// MP1830, % of rapid traverse: the kink point.
    KinkPoint,
    /// MP1080: integral factor at standstill.
    IntegralFactor,
    /// MP1710, mm: lag at which POSITIONING ERROR comes, recommended 1.2 times that at rapid traverse.
    LagMonitor,
    /// MP1720, mm: lag at which the gross error comes, recommended 1.4 times it.
    LagEmergency,
    /// MP1940 of a digital speed controller.
    Proportional,
    /// MP1920 of a digital speed controller.
    Integral,
    /// MP1910, counting steps: monitoring of a digital speed controller.
    SpeedMonitor,
    /// MP1945, V/(m/s²).
    AccelerationPrecontrol,
    /// MP1960, mm: reversal peaks of digital axes.
    DigitalReversal,
    /// MP711, mm: height of reversal peaks.
    ReversalHeight,
    /// MP712, mm: their compensation in a cycle.
    ReversalStep,
    /// MP1511, µs: stiction.
    StictionFactor,
    /// MP1512, counting steps: its limit.
    StictionLimit,
    /// MP1513, mm/min: the feed up to which it is compensated.
    StictionFeed,
    /// MP710, mm: backlash.
    Backlash,
    /// MP720, mm/m: linear error.
    Linear,
    /// MP730: 1 lets tables act in place of the linear error.
    Nonlinear,
    /// MP1060, m/s²: acceleration on the path.
    Acceleration,
    /// MP1070, m/s²: radial acceleration, half of the other on the TNC 151/155.
    RadialAcceleration,
    /// MP1530: damping of the transient response when an axis accelerates.
    Damping,
    /// MP1410, mm: distance at which POSITIONING ERROR comes with pre-control, recommended 0.5.
    PrecontrolMonitor,
    /// MP1420, mm: distance at which the gross error comes with pre-control, recommended 10.
    PrecontrolEmergency,
}

/// U_limit of the speed controller, V, and what a counting step gives for 1 in MP1920, V [000:18387-18391].
const MONITOR_VOLTS: f64 = 15.0;
const STEP_VOLTS: f64 = 9.7e-6;

impl Adjustment {
    /// Every adjustment, in the order of the variants.
    pub const ALL: [Adjustment; 27] = [
        Adjustment::ServoLag,
        Adjustment::Transient,
        Adjustment::KvPrecontrol,
        Adjustment::KvLag,
        Adjustment::KinkFactor,
        Adjustment::KinkPoint,
        Adjustment::IntegralFactor,
        Adjustment::LagMonitor,
        Adjustment::LagEmergency,
        Adjustment::Proportional,
        Adjustment::Integral,
        Adjustment::SpeedMonitor,
        Adjustment::AccelerationPrecontrol,
        Adjustment::DigitalReversal,
        Adjustment::ReversalHeight,
        Adjustment::ReversalStep,
        Adjustment::StictionFactor,
        Adjustment::StictionLimit,
        Adjustment::StictionFeed,
        Adjustment::Backlash,
        Adjustment::Linear,
        Adjustment::Nonlinear,
        Adjustment::Acceleration,
        Adjustment::RadialAcceleration,
        Adjustment::Damping,
        Adjustment::PrecontrolMonitor,
        Adjustment::PrecontrolEmergency,
    ];

    /// Its numbers: that of the TNC 360 and later, and that of the TNC 151/155, if they have it.
    fn numbers(self) -> (u16, Option<OldNumber>) {
        use OldNumber::{Common, EachAxis};
        match self {
            Adjustment::ServoLag => (1390, Some(Common(60))),
            Adjustment::Transient => (1520, Some(Common(53))),
            Adjustment::KvPrecontrol => (1510, Some(EachAxis(32))),
            Adjustment::KvLag => (1810, Some(EachAxis(177))),
            Adjustment::KinkFactor => (1820, Some(Common(176))),
            Adjustment::KinkPoint => (1830, Some(Common(181))),
            Adjustment::IntegralFactor => (1080, Some(EachAxis(28))),
            Adjustment::LagMonitor => (1710, Some(Common(175))),
            Adjustment::LagEmergency => (1720, Some(Common(174))),
            Adjustment::Proportional => (1940, None),
            Adjustment::Integral => (1920, None),
            Adjustment::SpeedMonitor => (1910, None),
            Adjustment::AccelerationPrecontrol => (1945, None),
            Adjustment::DigitalReversal => (1960, None),
            Adjustment::ReversalHeight => (711, None),
            Adjustment::ReversalStep => (712, None),
            Adjustment::StictionFactor => (1511, None),
            Adjustment::StictionLimit => (1512, None),
            Adjustment::StictionFeed => (1513, None),
            Adjustment::Backlash => (710, Some(EachAxis(36))),
            Adjustment::Linear => (720, Some(EachAxis(40))),
            Adjustment::Nonlinear => (730, None),
            Adjustment::Acceleration => (1060, Some(Common(54))),
            Adjustment::RadialAcceleration => (1070, Some(Common(55))),
            Adjustment::Damping => (1530, Some(Common(64))),
            Adjustment::PrecontrolMonitor => (1410, Some(Common(56))),
            Adjustment::PrecontrolEmergency => (1420, Some(Common(57))),
        }
    }

    /// MP1910 for an entry of MP1920: `15 V / (MP1920 · 9.7 µV)` [000:18552-18558].
    pub fn speed_monitor(integral: f64) -> f64 {
        (MONITOR_VOLTS / (integral.max(1.0) * STEP_VOLTS)).round()
    }
}

/// Where an adjustment stands in the list of the TNC 151/155.
#[derive(Clone, Copy)]
enum OldNumber {
    /// One number for all axes.
    Common(u16),
    /// The number of X, of four in sequence.
    EachAxis(u16),
}

/// Axes with numbers of their own in the list of the TNC 151/155.
const OLD_AXES: u8 = 4;

impl ParameterList {
    fn adjusted(&self, what: Adjustment, index: u8) -> Option<&'static Definition> {
        let (number, old) = what.numbers();
        let id = |number, index| ParameterId { number, index };
        if self.has_old_numbers() {
            let number = match old? {
                OldNumber::Common(number) => number,
                OldNumber::EachAxis(first) => {
                    first + u16::from(Some(index).filter(|index| *index < OLD_AXES)?)
                }
            };
            return Definition::named(self.model(), id(number, None)).ok();
        }
        let found = Definition::named(self.model(), id(number, Some(index)));
        found
            .or_else(|_| Definition::named(self.model(), id(number, None)))
            .ok()
    }

    /// What an entry is for the value 1: MP32 to MP35 are output steps for each µm of lag, not kv.
    fn entry_per_value(&self, what: Adjustment, index: u8) -> f64 {
        match what {
            Adjustment::KvPrecontrol if self.has_old_numbers() => self.old_steps_per_kv(index),
            _ => 1.0,
        }
    }

    /// The parameter that an adjustment of an axis is, if the model has it.
    pub fn adjustment_id(&self, what: Adjustment, index: u8) -> Option<ParameterId> {
        self.adjusted(what, index).map(|definition| definition.id)
    }

    /// Whether an adjustment is one for all axes in this list.
    pub fn is_common(&self, what: Adjustment) -> bool {
        self.adjustment_id(what, 0) == self.adjustment_id(what, 1)
    }

    /// The least difference between two entries, in the unit of the value.
    pub fn adjustment_step(&self, what: Adjustment, index: u8) -> Option<f64> {
        let definition = self.adjusted(what, index)?;
        let step = 10f64.powi(-i32::from(definition.decimals));
        Some(step / self.entry_per_value(what, index))
    }

    /// The value of an axis by its index; `None` where the model has no such parameter.
    pub fn adjustment(&self, what: Adjustment, index: u8) -> Option<f64> {
        let definition = self.adjusted(what, index)?;
        let value = self.get(definition.id.number, definition.id.index.unwrap_or(0))?;
        Some(match what {
            Adjustment::Nonlinear => f64::from(u8::from(crate::settings::bit_of(value, index.into()))),
            _ => value / self.entry_per_value(what, index),
        })
    }

    /// Adjusts a parameter of an axis to a value within its range and decimals: which one, and the value as it is now.
    /// `None` where the model has no such parameter.
    pub fn adjust(&mut self, what: Adjustment, index: u8, value: f64) -> Option<(ParameterId, f64)> {
        let definition = self.adjusted(what, index)?;
        let place = definition.id.index.unwrap_or(0);
        let scale = self.entry_per_value(what, index);
        let entry = match what {
            Adjustment::Nonlinear => {
                let bit = 1u32 << index;
                let before = self.get(definition.id.number, place)? as u32;
                f64::from(if value == 0.0 { before & !bit } else { before | bit })
            }
            _ => {
                let decimals = 10f64.powi(definition.decimals.into());
                ((value * scale).clamp(definition.min, definition.max) * decimals).round() / decimals
            }
        };
        let text = format!("{}={}", definition.id, definition.format_value(entry));
        self.assign(text.trim_start_matches("MP")).ok()?;
        Some((definition.id, self.get(definition.id.number, place)? / scale))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use crate::ControlModel;

    /// Entries stay within range and decimals; bits of other axes stay; the manual's MP1910 [000:18558] [000:18607].
    #[test]
    fn adjustments_are_entries_of_the_list() {
        let mut list = ParameterList::reference(ControlModel::Tnc425);
        let (id, value) = list.adjust(Adjustment::KvPrecontrol, 1, 7.123_456).unwrap();
        assert_eq!((id.to_string().as_str(), value), ("MP1510.1", 7.123));
        assert_eq!(list.adjust(Adjustment::KvPrecontrol, 1, 99.0).unwrap().1, 20.0);
        list.adjust(Adjustment::Nonlinear, 0, 1.0).unwrap();
        list.adjust(Adjustment::Nonlinear, 2, 1.0).unwrap();
        list.adjust(Adjustment::Nonlinear, 0, 0.0).unwrap();
        assert_eq!(list.adjustment(Adjustment::Nonlinear, 2), Some(1.0));
        assert_eq!(list.adjustment(Adjustment::Nonlinear, 0), Some(0.0));
        assert_eq!(Adjustment::speed_monitor(5.0), 309_278.0);
        assert_eq!(Adjustment::speed_monitor(180.0), 8591.0);
        // Every one is a parameter of its own of the TNC 425.
        let mut ids: Vec<String> = Adjustment::ALL
            .iter()
            .map(|what| list.adjust(*what, 0, 1.0).unwrap().0.to_string())
            .collect();
        ids.sort();
        ids.dedup();
        assert_eq!(ids.len(), Adjustment::ALL.len());
    }

    /// The list of the TNC 151/155 has other numbers, of which some are common to all axes, and no tables. kv 1.2 at rapid
    /// traverse 10 m/min and 9 V is 0.44 in MP32 [001:1746-1762]: 3.6864 * 1.2 / 10 = 0.4424.
    #[test]
    fn the_tnc_155_has_its_own_numbers() {
        use Adjustment::{Backlash, KinkPoint, KvLag, KvPrecontrol, LagMonitor, Linear, Nonlinear, ServoLag};
        let mut list = ParameterList::reference(ControlModel::Tnc155);
        for (what, axis, value, name) in [
            (KvLag, 0, 2.0, "MP177"),
            (KvLag, 3, 1.5, "MP180"),
            (Backlash, 1, 0.02, "MP37"),
            (Linear, 2, -0.05, "MP42"),
            (KinkPoint, 2, 40.0, "MP181"),
            (LagMonitor, 0, 8.0, "MP175"),
            (ServoLag, 1, 1.0, "MP60"),
            (Adjustment::Acceleration, 2, 1.25, "MP54"),
            (Adjustment::RadialAcceleration, 0, 0.625, "MP55"),
            (Adjustment::Damping, 1, 0.5, "MP64"),
            (Adjustment::PrecontrolMonitor, 0, 0.5, "MP56"),
            (Adjustment::PrecontrolEmergency, 3, 10.0, "MP57"),
        ] {
            let (id, entry) = list.adjust(what, axis, value).unwrap();
            assert_eq!((id.to_string().as_str(), entry), (name, value));
            assert_eq!(list.adjustment(what, axis), Some(value), "{name}");
        }
        assert_eq!(list.axis_parameters(0).lag.kv, 2.0);
        assert_eq!(list.axis_parameters(2).compensation.linear_mm_m, -0.05);
        assert!(list.is_common(KinkPoint) && !list.is_common(KvLag));
        assert_eq!(list.adjust(Nonlinear, 0, 1.0), None);
        assert_eq!(list.adjust(KvLag, 4, 1.0), None);
        list.assign("0=10000").unwrap();
        list.assign("52=9").unwrap();
        let (id, kv) = list.adjust(KvPrecontrol, 0, 1.2).unwrap();
        assert_eq!(id.to_string(), "MP32");
        assert_eq!(list.get(32, 0), Some(0.442));
        assert!((kv - 1.2).abs() < 0.002);
        assert!((list.axis_parameters(0).precontrol.kv - kv).abs() < 1e-9);
    }
}
