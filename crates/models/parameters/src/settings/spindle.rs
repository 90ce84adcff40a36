//! Settings of the spindle and of tapping.

use crate::ParameterList;
use crate::settings::SpindleOutput;

/// Gear ranges of the spindle.
const GEARS: u8 = 8;

/// Settings of the tapping cycles 2 and 17.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tapping {
    /// Band of the feed override during cycle 2, %: MP7110.0 and .1 (old MP182, MP183) [000:6094-6098]
    /// [001:1409-1412].
    pub override_percent: [f64; 2],
    /// Dwell before the spindle reverses in cycle 2, s: MP7120.0 (old MP67) [000:6060-6101] [001:1804-1807].
    pub reversal_dwell_s: f64,
    /// Whether the spindle is oriented before cycle 17: MP7160 = 0 [000:6141]. TNC 151/155 have no
    /// cycle 17.
    pub orientation: bool,
}

impl ParameterList {
    /// Highest spindle speed of all gear ranges, rpm: the highest MP3515 whose range is in use, otherwise
    /// the highest MP3510 (old MP78-85) [000:5522-5555] [001:1502-1536].
    ///
    /// In the old list the speeds after the last ascending one are those of a comparator, not of a gear
    /// [001:1514-1536]; the highest value is a gear's all the same, since a comparator speed lies below
    /// its gear's. A coded speed knows no gears: S codes reach 9000 rpm [000:5722]. Without output of a
    /// speed nothing limits it.
    pub fn spindle_speed_max_rpm(&self) -> f64 {
        const CODED_MAX_RPM: f64 = 9000.0;
        match self.spindle_parameters().output {
            SpindleOutput::Coded { .. } => return CODED_MAX_RPM,
            SpindleOutput::None => return self.model().limits().spindle_speed_max_rpm,
            SpindleOutput::Analogue { .. } => {}
        }
        let gear_speed = |gear| {
            let rated = self.value((3510, gear), (78 + u16::from(gear), 0));
            let limit = self.get(3515, gear).filter(|_| rated > 0.0).unwrap_or_default();
            rated.max(limit)
        };
        (0..GEARS).map(gear_speed).fold(0.0, f64::max)
    }

    /// Whether spindle speed 0 may be programmed: MP3120 = 0 (old MP190 = 0) [000:5566] [001:1573-1575].
    pub fn spindle_zero_permitted(&self) -> bool {
        self.value((3120, 0), (190, 0)) == 0.0
    }

    /// Least and greatest spindle override, %: MP3310.1 and .0 (old MP89, MP88) [000:5585-5589]
    /// [001:1549-1551].
    pub fn spindle_override_percent(&self) -> [f64; 2] {
        [self.value((3310, 1), (89, 0)), self.value((3310, 0), (88, 0))]
    }

    /// Time in which the spindle reaches a speed from standstill, s: the voltage of the speed in the
    /// smallest gear range that has it, by the ramp MP3410.0 (old MP168) [000:5534] [001:1567-1570].
    /// 0 without a ramp, or for a speed that no gear has.
    pub fn spindle_run_up_s(&self, speed_rpm: f64) -> f64 {
        let rated = |gear: u8| self.value((3510, gear), (78 + u16::from(gear), 0));
        // Gear ranges ascend, unused ones are 0 [000:5522-5524].
        let Some(gear) = (0..GEARS).find(|gear| rated(*gear) >= speed_rpm && rated(*gear) > 0.0) else {
            return 0.0;
        };
        let volts = self.value((3210, gear), (86, 0)) * speed_rpm / rated(gear);
        let volts_per_ms = self.value((3410, 0), (168, 0));
        if volts_per_ms > 0.0 {
            volts / volts_per_ms / 1000.0
        } else {
            0.0
        }
    }

    /// Settings of the tapping cycles.
    pub fn tapping(&self) -> Tapping {
        Tapping {
            override_percent: [self.value((7110, 0), (182, 0)), self.value((7110, 1), (183, 0))],
            reversal_dwell_s: self.value((7120, 0), (67, 0)),
            orientation: self.get(7160, 0) == Some(0.0),
        }
    }
}
