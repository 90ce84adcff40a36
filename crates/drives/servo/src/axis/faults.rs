//! What a fault does to an axis, and what CE does to the fault.

use crate::fault::Fault;

/// The fault that monitoring has found, if any.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Faults {
    found: Option<Fault>,
    /// Steps until the residual voltage is switched off after POSITIONING ERROR.
    residual_steps: u32,
}

impl Faults {
    /// The fault that was found and not cleared.
    pub fn found(&self) -> Option<Fault> {
        self.found
    }

    /// The loop may be closed.
    #[inline]
    pub fn is_sound(&self) -> bool {
        self.found.is_none_or(|fault| !fault.opens_loop())
    }

    /// Whether the residual voltage after POSITIONING ERROR is switched off.
    pub fn is_released(&self) -> bool {
        self.found == Some(Fault::Positioning) && self.residual_steps == 0
    }

    /// Enters a fault, after whose first one a residual voltage stays so many steps.
    pub fn raise(&mut self, fault: Fault, residual_steps: u32) {
        match self.found {
            None => {
                self.found = Some(fault);
                self.residual_steps = residual_steps;
            }
            Some(known) if !known.opens_loop() && fault.opens_loop() => self.found = Some(fault),
            Some(_) => {}
        }
    }

    /// A step passes.
    pub fn pass(&mut self) {
        self.residual_steps = self.residual_steps.saturating_sub(1);
    }

    /// Clears a fault that can be cleared; whether there was one.
    pub fn clear(&mut self) -> bool {
        let clears = self.found.is_some_and(|fault| !fault.opens_loop());
        if clears {
            self.found = None;
        }
        clears
    }
}
