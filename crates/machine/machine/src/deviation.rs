//! How far an encoder is from the truth: errors of its scale or screw, and growth as the machine warms up.

use crate::reader::Section;

/// `errors_um` and `drift_um` of an encoder: the table stands so much farther than the encoder says.
#[derive(Clone, Debug)]
pub(crate) struct Deviation {
    /// Position, mm or degrees, and error, mm or degrees, ascending; straight between two, as at the ends beyond.
    errors: Vec<[f64; 2]>,
    /// Growth in the end, units; what is left of it after a step, and what was reached.
    drift: f64,
    kept: f64,
    left: f64,
}

impl Deviation {
    /// Of the `encoder` table of an axis; `None` where it is exact.
    pub fn read(section: &Section, step_s: f64) -> Option<Box<Deviation>> {
        let errors = section.pairs("errors_um");
        let drift = section.number("drift_um", -1e6..=1e6).unwrap_or(0.0);
        let minutes = section.number("drift_min", 0.01..=10_000.0);
        if minutes.is_some() && drift == 0.0 {
            section.fault_at("drift_min", "drift_min goes with drift_um".to_owned());
        }
        if errors.windows(2).any(|pair| pair[0][0] >= pair[1][0]) {
            section.fault_at("errors_um", "the positions of errors_um ascend".to_owned());
        }
        let time_s = minutes.unwrap_or(30.0) * 60.0;
        (!errors.is_empty() || drift != 0.0).then(|| {
            Box::new(Deviation {
                errors: errors.into_iter().map(|[at, um]| [at, um * 1e-3]).collect(),
                drift: drift * 1e-3,
                kept: (-step_s / time_s).exp(),
                left: 1.0,
            })
        })
    }

    /// Lets a step pass.
    pub fn advance(&mut self) {
        if self.drift != 0.0 {
            self.left *= self.kept;
        }
    }

    /// Where the encoder says that the table is.
    pub fn seen(&self, position: f64) -> f64 {
        position - self.error(position) - self.drift * (1.0 - self.left)
    }

    fn error(&self, position: f64) -> f64 {
        let next = self.errors.partition_point(|[at, _]| *at <= position);
        match (
            next.checked_sub(1).and_then(|last| self.errors.get(last)),
            self.errors.get(next),
        ) {
            (Some([from, low]), Some([to, high])) => low + (high - low) * (position - from) / (to - from),
            (Some([_, error]), None) | (None, Some([_, error])) => *error,
            (None, None) => 0.0,
        }
    }
}
