//! Keys, knobs and other inputs of the operator.

use bahn_panel::{Button, Input, Key, Stepped};

use crate::error::ServiceError;
use crate::log::EventKind;
use crate::service::MachineService;

impl MachineService {
    /// Gives an input and waits until it was taken; EMERGENCY STOP does not wait after anything. Keys of the keyboard come
    /// into the log book.
    ///
    /// # Errors
    /// Why it is refused: a key that the PLC program has locked says so in the words of the control.
    pub fn input(&self, input: Input) -> Result<(), ServiceError> {
        self.operates()?;
        if let Input::Key(key) | Input::Held(key, Button::Pressed) = &input {
            let log = &self.shared.log;
            log.follow(&self.shared.link);
            log.note(EventKind::Key, key.name().to_owned());
        }
        self.give(input)
    }

    /// Presses a key of the keyboard by its name, or enters a character.
    ///
    /// # Errors
    /// When there is no such key, or it is refused.
    pub fn press(&self, name: &str) -> Result<(), ServiceError> {
        let mut characters = name.chars();
        let of_character = match (characters.next(), characters.next()) {
            (Some(character), None) => Key::of_character(character),
            _ => None,
        };
        let key = Key::from_name(name).or(of_character);
        self.input(Input::Key(
            key.ok_or_else(|| ServiceError::NoKey(name.to_owned()))?,
        ))
    }

    /// Asks for so many contour cycles, and waits until they have passed or will not pass any more.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    pub fn steps(&self, cycles: u32) -> Result<Stepped, ServiceError> {
        self.operates()?;
        Ok(self.shared.link.steps(cycles)?)
    }

    /// Gives what an interface has to give.
    pub(crate) fn give(&self, input: Input) -> Result<(), ServiceError> {
        Ok(self.shared.link.input(input)?)
    }
}
