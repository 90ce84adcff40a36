//! The control's messages: one id each, with its text per control model.

mod codes;
mod table;
mod texts;

pub use codes::MessageCode;
pub use table::MessageId;

use crate::ControlModel;

use texts::Message;

impl MessageId {
    /// The text that the model shows.
    pub fn text(self, model: ControlModel) -> &'static str {
        let message = self.message();
        message
            .variants
            .iter()
            .find(|(models, _)| models.contains(&model.family()))
            .map_or(message.text, |(_, text)| *text)
    }

    /// Why the control shows it.
    pub fn cause(self) -> &'static str {
        self.message().cause
    }

    /// What the programmer can do about it.
    pub fn remedy(self) -> &'static str {
        self.message().remedy
    }

    /// Where the manuals print it, as `[003:7868-7871]`, or that it is Bahn's own.
    pub fn source(self) -> &'static str {
        self.message().source
    }

    /// Whether the message is Bahn's own: no manual prints it.
    pub fn is_own(self) -> bool {
        !self.source().starts_with('[')
    }

    /// The name of the id, `EntryValueIncorrect`, for lists and machine-readable reports.
    pub fn name(self) -> &'static str {
        self.message().name
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_message_is_complete_and_its_text_unique() {
        for model in ControlModel::ALL {
            let mut texts = HashSet::new();
            for id in MessageId::ALL {
                let text = id.text(model);
                assert!(texts.insert(text), "{text} is printed for two ids on {model}");
                // One is printed otherwise [000:16959].
                if *id != MessageId::ProgramMemoryOverflow {
                    assert_eq!(text, text.to_uppercase(), "messages are shown in capitals");
                }
                assert!(!id.cause().is_empty() && !id.remedy().is_empty(), "{id:?}");
                for shown in [text, id.cause(), id.remedy()] {
                    assert!(
                        !shown.contains("[0"),
                        "{id:?}: a citation is not for the screen: {shown}"
                    );
                }
                assert!(
                    id.is_own() || id.source().starts_with('['),
                    "{id:?}: {}",
                    id.source()
                );
                assert_eq!(format!("{id:?}"), id.name());
            }
        }
    }

    #[test]
    fn texts_differ_between_models_where_the_manuals_do() {
        use ControlModel::{Tnc360, Tnc415b};
        assert_eq!(MessageId::WrongRpm.text(Tnc360), "WRONG RPM");
        assert_eq!(MessageId::WrongRpm.text(Tnc415b), "WRONG SPINDLE SPEED");
        assert_eq!(
            MessageId::CircleEndPosIncorrect.text(Tnc360),
            "CIRCLE END POS. INCORRECT"
        );
        assert_eq!(
            MessageId::CircleEndPosIncorrect.text(Tnc415b),
            "ARC END-POINT INCORRECT"
        );
        // The switch-on test of a TNC 151/155 [001:927-933].
        for model in [ControlModel::Tnc151, ControlModel::Tnc155] {
            assert_eq!(
                MessageId::RelayExtDcVoltageMissing.text(model),
                "RELAY EXT-DC VOLTAGE MISSING"
            );
            assert_eq!(MessageId::ExternalEmergencyStop.text(model), "EMERGENCY STOP");
        }
    }
}
