//! What a fault does to an axis, and what CE does to the fault.

use super::Axis;
use crate::fault::Fault;

impl Axis {
    #[inline]
    pub(super) fn is_sound(&self) -> bool {
        self.fault.is_none_or(|fault| !fault.opens_loop())
    }

    /// Whether the residual voltage after POSITIONING ERROR is switched off.
    pub(super) fn is_released(&self) -> bool {
        self.fault == Some(Fault::Positioning) && self.residual_steps == 0
    }

    /// Enters a fault: what monitoring found, or a slave too far from its master.
    pub(crate) fn raise(&mut self, fault: Fault) {
        match self.fault {
            None => {
                self.fault = Some(fault);
                self.residual_steps = self.timing.steps_of(self.settings.monitoring.residual_voltage_s);
            }
            Some(known) if !known.opens_loop() && fault.opens_loop() => self.fault = Some(fault),
            Some(_) => {}
        }
    }

    /// The key CE: clears a fault that can be cleared, switches the residual voltage off and makes the
    /// actual position the nominal one [000:5240-5242].
    pub fn acknowledge(&mut self) {
        if self.fault.is_some_and(|fault| !fault.opens_loop()) {
            self.fault = None;
            self.transfer();
        }
    }

    /// The fault that monitoring has found and that was not cleared.
    pub fn fault(&self) -> Option<Fault> {
        self.fault
    }
}
