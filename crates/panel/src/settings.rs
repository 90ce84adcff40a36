//! What the operator chooses for himself and the control keeps: display, dimensions, language, axes of L blocks.

use std::io::Write;
use std::path::Path;

use bahn_host::files::{self, NewFile};
use serde::{Deserialize, Serialize};

use crate::texts::{self, Language};

/// What the position display shows [003:7081-7089].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum PositionType {
    /// Actual position.
    #[default]
    Actl,
    /// Nominal position.
    Noml,
    /// Servo lag.
    Lag,
    /// Distance to go.
    Dist,
    /// Actual position from the machine datum.
    Ref,
}

impl PositionType {
    /// All of them in the order of the MOD function.
    pub const ALL: [PositionType; 5] = [
        PositionType::Actl,
        PositionType::Noml,
        PositionType::Lag,
        PositionType::Dist,
        PositionType::Ref,
    ];

    /// As it stands beside the positions.
    pub fn name(self) -> &'static str {
        match self {
            PositionType::Actl => "ACTL",
            PositionType::Noml => "NOML",
            PositionType::Lag => "LAG",
            PositionType::Dist => "DIST",
            PositionType::Ref => "REF",
        }
    }
}

/// What the operator has chosen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Settings {
    /// POSITION DISPLAY.
    pub position_type: PositionType,
    /// CHANGE MM/INCH: inches.
    pub inch: bool,
    /// Dialogue language; `None` as MP7230 says.
    pub language: Option<String>,
    /// PROGRAM INPUT: ISO.
    pub iso: bool,
    /// AXIS SELECTION: letters of the axes that go into an L block with actual position capture, at most three.
    pub captured_axes: String,
    /// Minutes that the control was on, a program ran, the spindle turned [003:7030].
    pub timers_min: [u64; 3],
    /// The program that was selected for programming last.
    pub edited: Option<String>,
    /// What was typed of a block when the station ended.
    pub draft: Option<serde_json::Value>,
}

impl Settings {
    /// Name of the file in the folder of the state.
    const FILE: &str = "panel.json";

    /// What was kept in a folder; what cannot be read is what it was at first.
    pub fn read(folder: &Path) -> Settings {
        let bytes = files::read_table(&folder.join(Settings::FILE)).ok();
        bytes
            .and_then(|bytes| serde_json::from_slice(&bytes).ok())
            .unwrap_or_default()
    }

    /// Keeps it, whole or not at all.
    ///
    /// # Errors
    /// In words.
    pub fn write(&self, folder: &Path) -> Result<(), String> {
        let text = serde_json::to_vec_pretty(self).map_err(|error| error.to_string())?;
        let path = folder.join(Settings::FILE);
        let write = || {
            let mut file = NewFile::create(&path)?;
            file.write_all(&text)
                .map_err(|error| files::cannot("write", &path, &error))?;
            file.finish()
        };
        write().map_err(|error: bahn_host::HostError| error.to_string())
    }

    /// The language of the dialogue.
    pub fn language(&self, english: bool) -> Language {
        let chosen = self.language.as_deref().and_then(texts::from_code);
        chosen.unwrap_or(if english {
            Language::English
        } else {
            Language::German
        })
    }
}
