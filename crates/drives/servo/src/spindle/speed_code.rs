//! Coded spindle speeds of DIN 66025 [000:5718-5849].

use super::settings::SpeedCodes;

/// Hundredths of the standard speeds of a decade.
const DECADE: [u32; 20] = [
    100, 112, 125, 140, 160, 180, 200, 224, 250, 280, 315, 355, 400, 450, 500, 560, 630, 710, 800, 900,
];
/// Highest S code: two digits.
const CODE_MAX: u8 = 99;

/// An S code, 0 to 99: what the control puts out for a speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SpeedCode(u8);

impl SpeedCode {
    /// The code of a number, 0 to 99.
    pub fn new(code: u8) -> Option<SpeedCode> {
        (code <= CODE_MAX).then_some(SpeedCode(code))
    }

    /// The code of the standard speed nearest to a speed in rpm, of two as near the lower (inferred). `None`
    /// above 9000 rpm and for what is no speed.
    pub fn nearest(rpm: f64) -> Option<SpeedCode> {
        let highest = SpeedCode(CODE_MAX).rpm();
        if !(0.0..=highest).contains(&rpm) {
            return None;
        }
        let nearer = |a: &SpeedCode, b: &SpeedCode| (a.rpm() - rpm).abs().total_cmp(&(b.rpm() - rpm).abs());
        (0..=CODE_MAX).map(SpeedCode).min_by(nearer)
    }

    /// The two digits as a number, 0 to 99.
    pub fn number(self) -> u8 {
        self.0
    }

    /// The speed, rpm: 0 for code 0, then 20 steps to a decade from 0.112 to 9000.
    pub fn rpm(self) -> f64 {
        if self.0 == 0 {
            return 0.0;
        }
        let decade = 10u32.pow(u32::from(self.0 / 20));
        f64::from(DECADE[usize::from(self.0 % 20)] * decade) / 1000.0
    }

    /// Whether MP3020 permits the code: between its limits, and in its steps from the lower one (inferred).
    pub fn permitted(self, codes: &SpeedCodes) -> bool {
        let steps = self.0.checked_sub(codes.min);
        self.0 <= codes.max && steps.is_some_and(|steps| steps % codes.step.max(1) == 0)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that unwraps nothing fails")]
    use super::*;

    /// The manual's table [000:5747-5849].
    #[rustfmt::skip]
    const TABLE: [f64; 100] = [
        0.0, 0.112, 0.125, 0.14, 0.16, 0.18, 0.2, 0.224, 0.25, 0.28,
        0.315, 0.355, 0.4, 0.45, 0.5, 0.56, 0.63, 0.71, 0.8, 0.9,
        1.0, 1.12, 1.25, 1.4, 1.6, 1.8, 2.0, 2.24, 2.5, 2.8,
        3.15, 3.55, 4.0, 4.5, 5.0, 5.6, 6.3, 7.1, 8.0, 9.0,
        10.0, 11.2, 12.5, 14.0, 16.0, 18.0, 20.0, 22.4, 25.0, 28.0,
        31.5, 35.5, 40.0, 45.0, 50.0, 56.0, 63.0, 71.0, 80.0, 90.0,
        100.0, 112.0, 125.0, 140.0, 160.0, 180.0, 200.0, 224.0, 250.0, 280.0,
        315.0, 355.0, 400.0, 450.0, 500.0, 560.0, 630.0, 710.0, 800.0, 900.0,
        1000.0, 1120.0, 1250.0, 1400.0, 1600.0, 1800.0, 2000.0, 2240.0, 2500.0, 2800.0,
        3150.0, 3550.0, 4000.0, 4500.0, 5000.0, 5600.0, 6300.0, 7100.0, 8000.0, 9000.0,
    ];

    #[test]
    fn all_100_codes_are_those_of_the_table() {
        for (code, rpm) in (0..).zip(TABLE) {
            let code = SpeedCode::new(code).unwrap();
            assert_eq!(code.rpm(), rpm, "{code:?}");
            assert_eq!(SpeedCode::nearest(rpm), Some(code), "{rpm}");
        }
        assert_eq!(SpeedCode::new(100), None);
    }

    #[test]
    fn other_speeds_are_rounded_to_the_nearest() {
        let code = |rpm| SpeedCode::nearest(rpm).map(SpeedCode::number);
        assert_eq!(code(105.0), Some(60), "100 is nearer than 112");
        assert_eq!(code(107.0), Some(61));
        assert_eq!(code(106.0), Some(60), "as near: the lower");
        assert_eq!(code(8501.0), Some(99));
        assert_eq!(code(9000.5), None);
        assert_eq!(code(-1.0), None);
        assert_eq!(code(f64::NAN), None);
    }

    #[test]
    fn mp3020_permits_limits_and_steps() {
        // 20802: from 1 to 1000 rpm, every second: 1, 1.25, 1.6 ... [000:5734].
        let every_second = SpeedCodes {
            min: 20,
            max: 80,
            step: 2,
        };
        let permitted: Vec<u8> = (0..100)
            .filter(|code| SpeedCode::new(*code).unwrap().permitted(&every_second))
            .collect();
        assert_eq!(permitted.len(), 31);
        assert_eq!(permitted[..3], [20, 22, 24]);
        assert_eq!(permitted[30], 80);
        let all = SpeedCodes {
            min: 0,
            max: 99,
            step: 1,
        };
        assert!((0..100).all(|code| SpeedCode::new(code).unwrap().permitted(&all)));
    }
}
