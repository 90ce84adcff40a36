//! What the operator chooses for himself and the control keeps: display, dimensions, language, axes of L blocks, data
//! interfaces.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;

use bahn_host::files::{self, NewFile};
use bahn_parameters::ControlModel;
use bahn_parameters::interfaces::Mode;
use bahn_screen::texts::{self, Language};
use serde::{Deserialize, Serialize};

/// What the position display shows [003:7081-7089].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum PositionType {
    /// ACTL: actual position from the workpiece datum.
    #[default]
    Actl,
    /// NOML: nominal position from the workpiece datum.
    Noml,
    /// LAG: nominal minus actual position.
    Lag,
    /// DIST: distance to the end of the block.
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

/// Which device is connected to a data interface [000:17216-17228] [003:7048-7060].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(crate) enum InterfaceMode {
    /// Floppy disk unit, whose directory is asked for.
    #[default]
    Fe1,
    /// Floppy disk unit, whose directory is not asked for.
    Fe2,
    /// Magnetic tape unit.
    Me,
    /// Any device, as MP5020.0 ff. say.
    Ext1,
    /// Any device, as MP5020.1 ff. say.
    Ext2,
    /// A PC that leads.
    Lsv2,
    /// No device: of a control with one interface.
    None,
}

impl InterfaceMode {
    /// Those of a control: with two interfaces, with one, and of a TNC 151/155, where there is always a device
    /// [001:1137-1148].
    pub fn all(model: ControlModel) -> &'static [InterfaceMode] {
        use InterfaceMode::{Ext1, Ext2, Fe1, Fe2, Lsv2, Me, None};
        match (model.has_rs_422(), model.has_soft_keys()) {
            (true, _) => &[Fe1, Fe2, Me, Ext1, Ext2, Lsv2],
            (false, true) => &[Fe1, Me, Ext1, None],
            (false, false) => &[Me, Fe1, Ext1],
        }
    }

    /// What transfers files there; `None` where nothing does as the control leads.
    pub fn device(self) -> Option<Mode> {
        match self {
            InterfaceMode::Fe1 => Some(Mode::Fe1),
            InterfaceMode::Fe2 => Some(Mode::Fe2),
            InterfaceMode::Me => Some(Mode::Me),
            InterfaceMode::Ext1 => Some(Mode::Ext1),
            InterfaceMode::Ext2 => Some(Mode::Ext2),
            InterfaceMode::Lsv2 | InterfaceMode::None => None,
        }
    }

    /// As it stands on the screen; a control with a single interface has one FE and one EXT.
    pub fn name(self, single: bool) -> &'static str {
        match self {
            InterfaceMode::Fe1 if single => "FE",
            InterfaceMode::Ext1 if single => "EXT",
            InterfaceMode::Fe1 => "FE1",
            InterfaceMode::Fe2 => "FE2",
            InterfaceMode::Me => "ME",
            InterfaceMode::Ext1 => "EXT1",
            InterfaceMode::Ext2 => "EXT2",
            InterfaceMode::Lsv2 => "LSV/2",
            InterfaceMode::None => "",
        }
    }
}

/// How a data interface is set up; at first FE1 [000:10011] with 9600 baud (inferred).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Interface {
    pub mode: InterfaceMode,
    pub baud: u32,
}

impl Default for Interface {
    fn default() -> Interface {
        Interface {
            mode: InterfaceMode::default(),
            baud: 9600,
        }
    }
}

/// A kind of transfer, which takes one of both interfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TransferOf {
    /// Of whole files, to read in or out.
    Files,
    /// Of a program that is executed meanwhile.
    ProgramRun,
}

/// What the operator has chosen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Settings {
    /// POSITION DISPLAY: what the axes are shown with.
    pub position_type: PositionType,
    /// CHANGE MM/INCH: positions are shown and entered in inches.
    pub inch: bool,
    /// Dialogue language; `None` as MP7230 says.
    pub language: Option<String>,
    /// PROGRAM INPUT: ISO, otherwise HEIDENHAIN.
    pub iso: bool,
    /// How RS-232-C/V.24 and RS-422/V.11 are set.
    pub interfaces: [Interface; 2],
    /// Transfers of files, and of programs that run meanwhile, take the second interface.
    pub second_interface: [bool; 2],
    /// AXIS SELECTION: letters of the axes that go into an L block with actual position capture, at most three.
    pub captured_axes: String,
    /// Minutes that the control was on, a program ran, the spindle turned [003:7030].
    pub timers_min: [u64; 3],
    /// The program that was selected for programming last.
    pub edited: Option<String>,
    /// What was typed of a block when the station ended.
    pub draft: Option<serde_json::Value>,
    /// Files whose protection by their type was taken away, until the control is switched off.
    #[serde(skip)]
    pub unprotected: BTreeSet<String>,
}

impl Settings {
    /// Name of the file in the folder of the state.
    const FILE: &str = "panel.json";

    /// Name of a file that could not be read, which is kept beside the new one.
    const UNREAD: &str = "panel.unread.json";

    /// What was kept in a folder, and what is wrong with it, in words of the system. What cannot be read is what it
    /// was at first; its file is kept for whoever can mend it.
    pub fn read(folder: &Path) -> (Settings, Option<String>) {
        let path = folder.join(Settings::FILE);
        if !path.exists() {
            return (Settings::default(), None);
        }
        let read = files::read_table(&path).map_err(|error| error.to_string());
        let wrong =
            match read.and_then(|bytes| serde_json::from_slice(&bytes).map_err(|error| error.to_string())) {
                Ok(settings) => return (settings, None),
                Err(wrong) => wrong,
            };
        let said = match std::fs::rename(&path, folder.join(Settings::UNREAD)) {
            Ok(()) => format!("{} -> {}: {wrong}", Settings::FILE, Settings::UNREAD),
            Err(error) => format!("{}: {wrong}; {error}", Settings::FILE),
        };
        (Settings::default(), Some(said))
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

    /// The interface of a kind of transfer, from 0.
    pub fn assigned_port(&self, transfer: TransferOf) -> usize {
        let [files, program_run] = self.second_interface;
        usize::from(match transfer {
            TransferOf::Files => files,
            TransferOf::ProgramRun => program_run,
        })
    }

    /// A kind of transfer takes the other interface.
    pub fn swap_port(&mut self, transfer: TransferOf) {
        let [files, program_run] = &mut self.second_interface;
        let own = match transfer {
            TransferOf::Files => files,
            TransferOf::ProgramRun => program_run,
        };
        *own = !*own;
    }

    /// The language of the dialogue.
    pub fn language(&self, english: bool) -> Language {
        let chosen = self.language.as_deref().and_then(texts::language_of_code);
        chosen.unwrap_or(if english {
            Language::English
        } else {
            Language::German
        })
    }
}
