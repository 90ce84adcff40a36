//! What the user of an editor chooses.

use bahn_parameters::ControlModel;
use serde::Deserialize;
use serde_json::Value;

/// How documents are read, as options of `bahn check` and `bahn fmt` say it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The control; without it that of the machine to whose folder a file belongs.
    pub model: Option<ControlModel>,
    /// Refuse what is otherwise accepted with a warning.
    pub strict: bool,
    /// Pass over what nothing here knows, with a warning.
    pub skip_unknown: bool,
    /// Formatting writes decimal commas.
    pub comma: bool,
    /// Step of the block numbers of DIN/ISO programs.
    pub iso_step: u8,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            model: None,
            strict: false,
            skip_unknown: false,
            comma: false,
            iso_step: 10,
        }
    }
}

/// As they stand in the settings of an editor; what is missing stays as it is.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Written {
    model: Option<String>,
    strict: Option<bool>,
    skip_unknown: Option<bool>,
    comma: Option<bool>,
    iso_step: Option<u8>,
}

impl Settings {
    /// These settings with what an editor sends, by itself or below `bahn`. The second value says what is wrong with it.
    pub(crate) fn with(&self, sent: &Value) -> (Settings, Option<String>) {
        let sent = sent.get("bahn").unwrap_or(sent);
        if sent.is_null() {
            return (self.clone(), None);
        }
        let written = match Written::deserialize(sent) {
            Ok(written) => written,
            Err(error) => return (self.clone(), Some(format!("settings of bahn: {error}"))),
        };
        let mut settings = self.clone();
        let mut wrong = None;
        match written.model.as_deref().map(str::parse) {
            Some(Ok(model)) => settings.model = Some(model),
            Some(Err(error)) if written.model.as_deref() != Some("") => {
                wrong = Some(format!("settings of bahn: {error}"))
            }
            Some(Err(_)) => settings.model = None,
            None => {}
        }
        settings.strict = written.strict.unwrap_or(settings.strict);
        settings.skip_unknown = written.skip_unknown.unwrap_or(settings.skip_unknown);
        settings.comma = written.comma.unwrap_or(settings.comma);
        settings.iso_step = written.iso_step.unwrap_or(settings.iso_step);
        (settings, wrong)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn editors_send_a_part_of_the_settings() {
        let first = Settings::default();
        let (second, wrong) = first.with(&json!({"bahn": {"model": "tnc360", "isoStep": 5}}));
        assert_eq!(
            (second.model, second.iso_step, wrong),
            (Some(ControlModel::Tnc360), 5, None)
        );
        let (third, wrong) = second.with(&json!({"model": "tnc430", "strict": true}));
        assert!(third.strict && wrong.unwrap().contains("tnc430"));
        assert_eq!(third.model, Some(ControlModel::Tnc360));
        assert_eq!(third.with(&json!({"model": ""})).0.model, None);
        assert_eq!(first.with(&Value::Null), (first.clone(), None));
        assert!(first.with(&json!({"strict": 7})).1.is_some());
    }
}
