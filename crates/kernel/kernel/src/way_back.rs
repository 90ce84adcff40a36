//! The way back of an axis that ran on without feed enable.
//!
//! Decision: What an axis of a path ran on without feed enable it goes back on the ramp of MP1060 when the enable is
//! back; the path waits for it

use bahn_motion::{Aim, PointToPoint};

/// How far the loop of an axis is commanded beside its nominal position: what the axis ran on when its feed enable was
/// withdrawn, driven back on the ramp of MP1060 when the enable is back (inferred). The path waits for it.
#[derive(Clone, Copy, Debug, Default)]
pub struct WayBack(Option<PointToPoint>);

impl WayBack {
    /// The axis is so far beside its nominal position, mm or degrees; after a short dip of the enable it still runs, mm/s.
    pub fn begin(&mut self, beside: f64, speed_mm_s: f64) {
        let moves = beside != 0.0 && beside.is_finite() && speed_mm_s.is_finite();
        self.0 = moves.then(|| PointToPoint::moving(beside, speed_mm_s));
    }

    /// There is none any more.
    pub fn end(&mut self) {
        self.0 = None;
    }

    /// The axis is where it shall be.
    pub fn is_over(&self) -> bool {
        self.0.is_none()
    }

    /// How far the axis is commanded beside its nominal position, mm or degrees.
    pub fn beside(&self) -> f64 {
        self.0.map_or(0.0, |way| way.position())
    }

    /// Goes on for a cycle with a feed, mm/min, and an acceleration, m/s².
    pub fn goes_on(&mut self, time_s: f64, feed_mm_min: f64, acceleration_m_s2: f64) {
        let Some(way) = &mut self.0 else { return };
        way.cycle(time_s, Aim::Position(0.0), feed_mm_min, acceleration_m_s2);
        if way.is_at(0.0) {
            self.0 = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2 mm with 2 m/s²: v²/(2a) = 1 mm to the fastest place, 63.2 mm/s, and as long down: t = 2 · √(1 mm · 2 / a) = 63.2 ms.
    #[test]
    fn it_ends_on_the_ramp() {
        let mut way = WayBack::default();
        assert!(way.is_over());
        way.begin(2.0, 0.0);
        let (mut before, mut cycles, mut fastest) = (2.0, 0, 0.0_f64);
        while !way.is_over() {
            way.goes_on(0.001, 60_000.0, 2.0);
            fastest = fastest.max((before - way.beside()) / 0.001);
            before = way.beside();
            cycles += 1;
            assert!(cycles < 100);
        }
        assert_eq!((way.beside(), cycles), (0.0, 64));
        assert!((61.0..=63.3).contains(&fastest), "{fastest}");
    }
}
