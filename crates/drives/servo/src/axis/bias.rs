//! What keeps the velocity steady after a change of method or kv.

/// A velocity that runs down with the lag.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bias {
    mm_min: f64,
    changed: bool,
}

impl Bias {
    /// The next velocity is to go on where the one before was.
    pub fn change(&mut self) {
        self.changed = true;
    }

    /// The axis begins where it is.
    pub fn clear(&mut self) {
        self.mm_min = 0.0;
    }

    /// The velocity with it, mm/min, in a step that leaves so much of it; `before`: that of the last step, if it drove.
    pub fn added(&mut self, velocity: f64, decay: f64, before: Option<f64>) -> f64 {
        if self.mm_min != 0.0 {
            self.mm_min *= decay;
            // It never comes to 0 by itself, and processors are slow with numbers that are nearly 0.
            if self.mm_min.is_subnormal() {
                self.mm_min = 0.0;
            }
        }
        if std::mem::take(&mut self.changed) {
            self.mm_min = before.map_or(0.0, |before| before - velocity);
        }
        velocity + self.mm_min
    }
}
