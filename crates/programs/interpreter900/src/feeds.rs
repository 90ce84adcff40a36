//! What parameters say of feeds and of the ends of movements.
//!
//! Decision: G93 F is the time of a block in seconds, as that of G4 is. P8818 counts for G1, G2 and G3, P8815 takes the
//! place of all of it. Without P8816 G0 is as fast as the axes allow

use bahn_path::FeedRate;
use bahn_system900::PathData;

use crate::refusal::Refusal;

/// Taken when the parameters were written, so that no block looks for them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Feeds {
    /// P8815, mm/min.
    test: Option<f64>,
    /// P8816, mm/min.
    rapid: Option<f64>,
    /// P8818 as a factor.
    factor: Option<f64>,
    /// P8858: G0 does not stop.
    pub rapid_goes_on: bool,
    /// P8852, mm.
    circle_deviation: Option<f64>,
    /// The smallest Kv of the axes of the plane, 1/s.
    kv: f64,
    /// P8843, mm.
    pub radius_error_max: f64,
    /// The spindle that G95 counts, from 1 on.
    pub spindle: u8,
}

impl Feeds {
    pub fn of(data: &PathData, kv: f64) -> Feeds {
        let percent = data.feed_percent().filter(|percent| *percent > 0.0);
        Feeds {
            test: data.test_feed(),
            rapid: data.rapid_feed(),
            factor: percent.map(|percent| percent / 100.0),
            rapid_goes_on: data.end_of_rapid() == 2,
            circle_deviation: data.circle_deviation(),
            kv,
            radius_error_max: data.radius_error_max(),
            spindle: data.feed_spindle(),
        }
    }

    /// That of G0.
    pub fn of_rapid(&self) -> FeedRate {
        self.rapid.map_or(FeedRate::Rapid, FeedRate::Programmed)
    }

    /// What takes the place of every feed of G1, G2, G3, mm/min.
    pub fn test(&self) -> Option<f64> {
        self.test
    }

    /// A programmed feed as it acts, mm/min; `None` where nothing is programmed.
    pub fn acting(&self, programmed: f64) -> Option<f64> {
        let acting = programmed * self.factor.unwrap_or(1.0);
        self.test.or_else(|| (programmed > 0.0).then_some(acting))
    }

    /// A feed on a circle of a radius, mm, as P8852 limits it.
    pub fn on_circle(&self, feed: FeedRate, radius: f64) -> Result<FeedRate, Refusal> {
        match self.circle_deviation {
            None => Ok(feed),
            Some(deviation) if radius <= deviation => Err(Refusal::Numbered(
                1237,
                "the radius of the circle is not greater than P8852",
            )),
            Some(deviation) => Ok(feed.up_to(circle_limit(self.kv, radius, deviation))),
        }
    }
}

/// v = Kv * sqrt(2 R dev), mm/min [002:4566-4604].
pub(crate) fn circle_limit(kv: f64, radius: f64, deviation: f64) -> f64 {
    60.0 * kv * (2.0 * radius * deviation).sqrt()
}
