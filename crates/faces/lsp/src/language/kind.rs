//! Which language a document is written in.

use std::path::Path;

/// A language of the server.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// HEIDENHAIN plain language, `.H`.
    Plain,
    /// DIN/ISO programs of the control, `.I`.
    Iso,
    /// DIN 66025 programs, `.nc`.
    Din,
    /// Programs and cycles of a System 900, `.900`.
    System900,
    /// A program of the PLC, `.PLC`.
    Plc,
    /// A list of machine parameters, `.MP`.
    Parameters,
    /// A list of channel parameters of a TF5200, `.lis`.
    Channel,
}

/// Names that editors give to the languages, and endings of files.
const NAMES: [(&str, &str, Kind); 7] = [
    ("tnc-plain", "h", Kind::Plain),
    ("tnc-iso", "i", Kind::Iso),
    ("din-66025", "nc", Kind::Din),
    ("system-900", "900", Kind::System900),
    ("tnc-plc", "plc", Kind::Plc),
    ("tnc-parameters", "mp", Kind::Parameters),
    ("tf-channel", "lis", Kind::Channel),
];

impl Kind {
    /// By what the editor calls it, else by the ending of its name.
    pub(crate) fn of(language_id: &str, path: &Path) -> Option<Kind> {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let named = NAMES.iter().find(|(name, _, _)| *name == language_id);
        let ended = || NAMES.iter().find(|(_, own, _)| ending.eq_ignore_ascii_case(own));
        named.or_else(ended).map(|(_, _, kind)| *kind)
    }
}
