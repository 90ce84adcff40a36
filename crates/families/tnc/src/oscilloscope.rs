//! Who operates the oscilloscope of the control: a code number opens it, soft keys START and STOP record
//! [000:18660-18701] [000:18776-18778].

use bahn_parameters::ControlModel;
use bahn_parameters::code_numbers::OSCILLOSCOPE;

/// What was pressed of the oscilloscope since power-on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OscilloscopeKeys {
    /// The code number was entered; it counts until power-off.
    pub open: bool,
    /// START was pressed last, not STOP.
    pub records: bool,
    /// How often START was pressed.
    pub starts: u32,
}

impl OscilloscopeKeys {
    /// A code number that is entered.
    pub(crate) fn enter_code(&mut self, code: u32, model: ControlModel) -> bool {
        self.open |= code == OSCILLOSCOPE && model.has_oscilloscope();
        true
    }

    /// START or STOP; refused while the oscilloscope is not open, and where START would change nothing.
    pub(crate) fn press(&mut self, start: bool) -> bool {
        let possible = self.open && self.records != start;
        if possible {
            self.records = start;
            self.starts += u32::from(start);
        }
        possible
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// START and STOP work after the code number only; a TNC 360 has no oscilloscope.
    #[test]
    fn the_code_number_opens_it() {
        let mut keys = OscilloscopeKeys::default();
        assert!(!keys.press(true));
        keys.enter_code(688_378, ControlModel::Tnc425);
        keys.enter_code(OSCILLOSCOPE, ControlModel::Tnc360);
        assert!(!keys.press(true) && !keys.open);
        keys.enter_code(OSCILLOSCOPE, ControlModel::Tnc425);
        assert!(!keys.press(false), "nothing is recorded that could be stopped");
        assert!(keys.press(true) && !keys.press(true) && keys.press(false) && keys.press(true));
        assert_eq!((keys.records, keys.starts), (true, 2));
    }
}
