//! The machine parameters that are found by trial when a machine is commissioned [000:9549-9817].

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
}

/// U_limit of the speed controller, V, and what a counting step gives for 1 in MP1920, V [000:18387-18391].
const MONITOR_VOLTS: f64 = 15.0;
const STEP_VOLTS: f64 = 9.7e-6;

impl Adjustment {
    /// Every adjustment, in the order of the variants.
    pub const ALL: [Adjustment; 22] = [
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
    ];

    fn number(self) -> u16 {
        match self {
            Adjustment::ServoLag => 1390,
            Adjustment::Transient => 1520,
            Adjustment::KvPrecontrol => 1510,
            Adjustment::KvLag => 1810,
            Adjustment::KinkFactor => 1820,
            Adjustment::KinkPoint => 1830,
            Adjustment::IntegralFactor => 1080,
            Adjustment::LagMonitor => 1710,
            Adjustment::LagEmergency => 1720,
            Adjustment::Proportional => 1940,
            Adjustment::Integral => 1920,
            Adjustment::SpeedMonitor => 1910,
            Adjustment::AccelerationPrecontrol => 1945,
            Adjustment::DigitalReversal => 1960,
            Adjustment::ReversalHeight => 711,
            Adjustment::ReversalStep => 712,
            Adjustment::StictionFactor => 1511,
            Adjustment::StictionLimit => 1512,
            Adjustment::StictionFeed => 1513,
            Adjustment::Backlash => 710,
            Adjustment::Linear => 720,
            Adjustment::Nonlinear => 730,
        }
    }

    /// MP1910 for an entry of MP1920: `15 V / (MP1920 · 9.7 µV)` [000:18552-18558].
    pub fn speed_monitor(integral: f64) -> f64 {
        (MONITOR_VOLTS / (integral.max(1.0) * STEP_VOLTS)).round()
    }
}

impl ParameterList {
    fn adjusted(&self, what: Adjustment, index: u8) -> Option<&'static Definition> {
        // The numbers of the TNC 151/155 mean something else.
        let number = Some(what.number()).filter(|_| !self.has_old_numbers())?;
        let id = |index| ParameterId { number, index };
        let found = Definition::named(self.model(), id(Some(index)));
        found.or_else(|_| Definition::named(self.model(), id(None))).ok()
    }

    /// The value of an axis by its index; `None` where the model has no such parameter.
    pub fn adjustment(&self, what: Adjustment, index: u8) -> Option<f64> {
        let definition = self.adjusted(what, index)?;
        let value = self.get(what.number(), definition.id.index.unwrap_or(0))?;
        Some(match what {
            Adjustment::Nonlinear => f64::from(u8::from(crate::settings::bit_of(value, index.into()))),
            _ => value,
        })
    }

    /// Adjusts a parameter of an axis to a value within its range and decimals: which one, and the entry as it is now.
    /// `None` where the model has no such parameter.
    pub fn adjust(&mut self, what: Adjustment, index: u8, value: f64) -> Option<(ParameterId, f64)> {
        let definition = self.adjusted(what, index)?;
        let place = definition.id.index.unwrap_or(0);
        let entry = match what {
            Adjustment::Nonlinear => {
                let bit = 1u32 << index;
                let before = self.get(what.number(), place)? as u32;
                f64::from(if value == 0.0 { before & !bit } else { before | bit })
            }
            _ => {
                let scale = 10f64.powi(definition.decimals.into());
                (value.clamp(definition.min, definition.max) * scale).round() / scale
            }
        };
        let text = format!("{}={}", definition.id, definition.format_value(entry));
        self.assign(text.trim_start_matches("MP")).ok()?;
        Some((definition.id, self.get(what.number(), place)?))
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
        let mut old = ParameterList::reference(ControlModel::Tnc155);
        assert_eq!(old.adjust(Adjustment::KvLag, 0, 2.0), None);
    }
}
