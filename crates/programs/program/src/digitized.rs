//! The program that digitizing writes: straight lines from point to point [003:6832-6857].
//!
//! Decision: Digitized points are those of the tip: a ball cutter like the stylus makes the surface again. In a test
//! run the probe is the tool that was called (also `interpreter/src/digitize.rs`)

use std::fmt::Write as _;

use bahn_path::{ScanJob, ScanPattern, ScanPoint};

/// Block numbers end here and begin again with 0 [003:6853].
const NUMBERS: u32 = 65_536;

/// The text of a digitized program, block by block.
///
/// Its points are those of the tip of the stylus: a ball cutter of the same radius, whose length is that to its tip, makes
/// the surface again *(inferred)*.
#[derive(Clone, Debug)]
pub struct DigitizedText {
    job: ScanJob,
    number: u32,
    /// Coordinates in output steps as they were written last.
    last: [Option<i64>; 3],
    decimals: usize,
}

impl DigitizedText {
    /// The program of a scan.
    pub fn new(job: ScanJob) -> DigitizedText {
        let step = job.rules.step_mm;
        let decimals = if job.inch || step < 0.001 { 4 } else { 3 };
        DigitizedText {
            job,
            number: 0,
            last: [None; 3],
            decimals: if !job.inch && step > 0.001 { 2 } else { decimals },
        }
    }

    /// The first blocks: to clearance height, and to where the scan began.
    pub fn begin(&mut self) -> String {
        let mut text = String::new();
        let unit = self.unit();
        self.block(
            &mut text,
            &format!("BEGIN PGM {} {unit}", self.job.program.as_str()),
        );
        self.blank(&mut text);
        let begin = self.job.begin();
        let up = self.job.tool_place();
        self.line(&mut text, &begin, |axis| axis == up, " FMAX");
        self.line(&mut text, &begin, |axis| axis != up, " FMAX");
        text
    }

    /// With a TM 110 the range as a blank, in the working plane greater by twice the depth of deflection, half of that on
    /// each side (inferred) [000:821].
    fn blank(&mut self, text: &mut String) {
        let Some(measuring) = self.job.rules.measuring else {
            return;
        };
        let (job, up) = (self.job, self.job.tool_place());
        let unit_mm = if job.inch { 25.4 } else { 1.0 };
        let scale = 10f64.powi(i32::try_from(self.decimals).unwrap_or(3));
        let corner = |point: &ScanPoint, side: f64| {
            let mut words = String::new();
            for (k, letter) in ['X', 'Y', 'Z'].into_iter().enumerate() {
                let more = if k == up { 0.0 } else { side * measuring.depth_mm };
                let at = (point[k] - job.shift[k] + more) / unit_mm;
                let _ = write!(words, " {letter}{:+}", (at * scale).round() / scale + 0.0);
            }
            words
        };
        let (least, greatest) = (corner(&job.min, -1.0), corner(&job.max, 1.0));
        self.block(text, &format!("BLK FORM 0.1 {}{least}", job.tool_axis));
        self.block(text, &format!("BLK FORM 0.2{greatest}"));
    }

    /// A point; nothing when it is the last one.
    pub fn point(&mut self, text: &mut String, point: &ScanPoint) {
        let m90 = if self.job.rules.m90 { " M90" } else { "" };
        self.line(text, point, |_| true, m90);
    }

    /// The last blocks: back to clearance height.
    pub fn end(&mut self) -> String {
        let mut text = String::new();
        let begin = self.job.begin();
        let up = self.job.tool_place();
        if matches!(self.job.pattern, ScanPattern::ContourLines { .. }) {
            self.line(&mut text, &begin, |axis| axis != up, " FMAX");
        }
        self.line(&mut text, &begin, |axis| axis == up, " FMAX");
        let unit = self.unit();
        self.block(
            &mut text,
            &format!("END PGM {} {unit}", self.job.program.as_str()),
        );
        text
    }

    fn unit(&self) -> &'static str {
        if self.job.inch { "INCH" } else { "MM" }
    }

    fn block(&mut self, text: &mut String, block: &str) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{} {block}", self.number);
        self.number = (self.number + 1) % NUMBERS;
    }

    /// A line with those coordinates that are others than before.
    fn line(&mut self, text: &mut String, point: &ScanPoint, of: impl Fn(usize) -> bool, after: &str) {
        let unit_mm = if self.job.inch { 25.4 } else { 1.0 };
        let scale = 10f64.powi(i32::try_from(self.decimals).unwrap_or(3));
        let mut words = String::from("L");
        for (axis, letter) in ['X', 'Y', 'Z']
            .into_iter()
            .enumerate()
            .filter(|(axis, _)| of(*axis))
        {
            let (Some(at), Some(shift)) = (point.get(axis), self.job.shift.get(axis)) else {
                continue;
            };
            let steps = ((at - shift) / unit_mm * scale).round();
            let Some(last) = self.last.get_mut(axis) else {
                continue;
            };
            if last.replace(steps as i64) != Some(steps as i64) {
                let value = steps / scale + 0.0;
                let _ = write!(words, " {letter}{value:+}");
            }
        }
        if words.len() > 1 {
            words.push_str(after);
            self.block(text, &words);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use bahn_path::{Axis, MeasuringRules, ScanName, ScanRules};

    fn contour_lines() -> ScanJob {
        ScanJob {
            tool_axis: Axis::Z,
            min: [-50.0, -50.0, 0.0],
            max: [50.0, 50.0, 1.0],
            shift: [0.0; 3],
            clearance_mm: 40.0,
            pattern: ScanPattern::ContourLines {
                start: [0.0, -25.0, 0.0],
                approach: (Axis::Y, 1.0),
                direction: (Axis::X, 1.0),
                time_limit_s: 0.0,
            },
            travel_mm: 0.5,
            spacing_mm: 0.5,
            interval_mm: 0.2,
            stylus_radius_mm: 2.0,
            beside: [0.0; 3],
            inch: false,
            program: ScanName::new("DATA").unwrap(),
            rules: ScanRules::default(),
        }
    }

    /// With a TM 110 the blank is the range and the depth of deflection more on each side of the plane.
    #[test]
    fn the_blank_of_a_measuring_probe() {
        let measuring = MeasuringRules {
            depth_mm: 0.5,
            reversed: [false; 3],
            axes: [0, 1, 2],
            limit_mm: 2.0,
            feed_mm_min: 600.0,
            slows: false,
            window_mm: 0.4,
        };
        let mut job = contour_lines();
        job.rules.measuring = Some(measuring);
        assert_eq!(
            DigitizedText::new(job).begin(),
            "0 BEGIN PGM DATA MM\n1 BLK FORM 0.1 Z X-50.5 Y-50.5 Z+0\n2 BLK FORM 0.2 X+50.5 Y+50.5 Z+1\n\
             3 L Z+40 FMAX\n4 L X+0 Y-25 FMAX\n"
        );
    }

    /// The shape of the manual's example [003:6844-6851].
    #[test]
    fn the_program_of_the_manual() {
        let job = contour_lines();
        let mut program = DigitizedText::new(job);
        let mut text = program.begin();
        for point in [
            [2.005, -12.561, 0.0],
            [2.025, -12.375, 0.0],
            [2.025, -12.375, 0.0001],
            [0.0, -10.4229, 0.5],
        ] {
            program.point(&mut text, &point);
        }
        text.push_str(&program.end());
        assert_eq!(
            text,
            "0 BEGIN PGM DATA MM\n1 L Z+40 FMAX\n2 L X+0 Y-25 FMAX\n3 L X+2.005 Y-12.561 Z+0\n4 L X+2.025 Y-12.375\n\
             5 L X+0 Y-10.423 Z+0.5\n6 L Y-25 FMAX\n7 L Z+40 FMAX\n8 END PGM DATA MM\n"
        );
        program = DigitizedText::new(ScanJob {
            inch: true,
            rules: ScanRules {
                m90: true,
                ..job.rules
            },
            ..job
        });
        text.clear();
        program.begin();
        program.point(&mut text, &[25.4, 0.0, 0.0]);
        assert_eq!(text, "3 L X+1 Y+0 Z+0 M90\n");
    }
}
