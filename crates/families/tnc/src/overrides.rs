//! Feed and spindle override: potentiometer, steps, and the factor that the PLC writes.

use bahn_exchange::{Exchange, Number, signal};
use bahn_parameters::operation::OverrideSteps;

/// One override: the potentiometer in W494 or W492, the value that is used in W766 or W764. When the PLC
/// writes another value there, that one is used; otherwise the potentiometer works [000:5577-5594]
/// [000:6527-6543].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Override {
    potentiometer: Number,
    used: Number,
    steps: OverrideSteps,
    /// What the NC wrote last to the word that is used.
    written: Option<i32>,
    /// The PLC has taken over.
    by_plc: bool,
    percent: f64,
}

impl Override {
    pub fn feed(steps: OverrideSteps) -> Override {
        Override::new(signal::FEED_OVERRIDE, signal::FEED_OVERRIDE_FROM_PLC, steps)
    }

    pub fn spindle(steps: OverrideSteps) -> Override {
        Override::new(signal::SPINDLE_OVERRIDE, signal::SPINDLE_OVERRIDE_FROM_PLC, steps)
    }

    fn new(potentiometer: Number, used: Number, steps: OverrideSteps) -> Override {
        Override {
            potentiometer,
            used,
            steps,
            written: None,
            by_plc: false,
            percent: 0.0,
        }
    }

    /// Before a PLC scan: the potentiometer in %.
    pub fn publish(&mut self, exchange: &mut Exchange, percent: f64) {
        let value = self.value(percent);
        if exchange.nc().number(self.potentiometer) != value || self.written.is_none() {
            exchange.nc_set_number(self.potentiometer, value);
        }
        if !self.by_plc && self.written != Some(value) {
            exchange.nc_set_number(self.used, value);
            self.written = Some(value);
        }
    }

    /// After a PLC scan.
    pub fn take(&mut self, exchange: &Exchange) {
        let used = exchange.nc().number(self.used);
        self.by_plc |= self.written.is_some_and(|written| written != used);
        self.percent = f64::from(used.max(0)) / self.scale();
        self.percent = self.percent.min(150.0);
    }

    /// What is effective, 0 to 150 %.
    pub fn percent(&self) -> f64 {
        self.percent
    }

    /// Counts of 1 %.
    fn scale(&self) -> f64 {
        if self.steps == OverrideSteps::NonLinear {
            100.0
        } else {
            1.0
        }
    }

    /// The word of a position of the potentiometer.
    fn value(&self, percent: f64) -> i32 {
        let percent = percent.clamp(0.0, 150.0);
        let value = match self.steps {
            OverrideSteps::TwoPercent => (percent / 2.0).round() * 2.0,
            OverrideSteps::OnePercent => percent.round(),
            // Steps of 0.01 % up to 2.5 %, of 0.75 % above [000:5583].
            OverrideSteps::NonLinear if percent <= 2.5 => (percent * 100.0).round(),
            OverrideSteps::NonLinear => (250.0 + ((percent - 2.5) / 0.75).round() * 75.0).min(15_000.0),
        };
        value as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scan(exchange: &mut Exchange, plc: impl Fn(&mut bahn_exchange::Image)) {
        exchange.begin_scan();
        plc(exchange.plc_mut());
        exchange.end_scan();
    }

    #[test]
    fn the_potentiometer_works_until_the_plc_writes() {
        let mut exchange = Exchange::default();
        let mut feed = Override::feed(OverrideSteps::OnePercent);
        feed.publish(&mut exchange, 80.4);
        scan(&mut exchange, |_| {});
        feed.take(&exchange);
        assert_eq!(feed.percent(), 80.0);
        assert_eq!(exchange.plc().number(signal::FEED_OVERRIDE), 80);
        feed.publish(&mut exchange, 80.0);
        scan(&mut exchange, |plc| {
            plc.set_number(signal::FEED_OVERRIDE_FROM_PLC, 30)
        });
        feed.take(&exchange);
        assert_eq!(feed.percent(), 30.0);
        feed.publish(&mut exchange, 120.0);
        scan(&mut exchange, |_| {});
        feed.take(&exchange);
        assert_eq!(feed.percent(), 30.0, "the potentiometer is ignored");
        assert_eq!(exchange.plc().number(signal::FEED_OVERRIDE), 120, "but shown");
    }

    /// Values 0 to 15 000 in 1/100 %: 0.01 % steps up to 2.5 %, then 0.75 % [000:5583].
    #[test]
    fn steps() {
        let value = |steps, percent| Override::feed(steps).value(percent);
        assert_eq!(value(OverrideSteps::NonLinear, 1.234), 123);
        assert_eq!(
            value(OverrideSteps::NonLinear, 100.0),
            10_000,
            "130 steps of 0.75 % above 2.5 %"
        );
        assert_eq!(value(OverrideSteps::NonLinear, 3.0), 325);
        assert_eq!(
            value(OverrideSteps::NonLinear, 200.0),
            15_000,
            "the end of its way"
        );
        assert_eq!(value(OverrideSteps::TwoPercent, 33.0), 34);
        assert_eq!(value(OverrideSteps::OnePercent, 149.6), 150);
    }
}
