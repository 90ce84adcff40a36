//! Open documents.

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use bahn_program::Program;
use lsp_types::Uri;

use crate::channel::ChannelText;
use crate::din::DinProgram;
use crate::language::{Analysis, Examined, Kind};
use crate::list::ParameterText;
use crate::part::PartProgram;
use crate::plc::PlcSource;
use crate::system900::System900Program;
use crate::text::Text;
use crate::world::{BYTES_MAX, World};

/// A document that is open in the editor.
pub(crate) struct Document {
    pub(crate) uri: Uri,
    pub(crate) version: Arc<Version>,
    /// What was found in this version; in the one before while this one is examined.
    pub(crate) examined: Option<Arc<Examined>>,
    /// Whether [`Document::examined`] is of this version.
    pub(crate) is_examined: bool,
}

/// One version of a document. It is read when somebody asks, once.
pub(crate) struct Version {
    pub(crate) path: PathBuf,
    /// None of a language that nobody here reads, and of a text that is too large.
    pub(crate) kind: Option<Kind>,
    pub(crate) number: i32,
    pub(crate) text: Arc<Text>,
    read: OnceLock<Arc<dyn Analysis>>,
}

impl Version {
    pub(crate) fn new(path: PathBuf, kind: Option<Kind>, number: i32, text: Text) -> Version {
        Version {
            path,
            kind,
            number,
            text: Arc::new(text),
            read: OnceLock::new(),
        }
    }

    pub(crate) fn is_too_large(&self) -> bool {
        self.text.text.len() > BYTES_MAX
    }

    /// The text, read in its language.
    pub(crate) fn analysis(&self, world: &World) -> Option<Arc<dyn Analysis>> {
        let kind = self.kind.filter(|_| !self.is_too_large())?;
        let read = || analyse(kind, &self.path, self.text.clone(), world);
        Some(self.read.get_or_init(read).clone())
    }

    /// The same text, to be read again since the settings are others.
    pub(crate) fn unread(&self) -> Version {
        Version {
            path: self.path.clone(),
            kind: self.kind,
            number: self.number,
            text: self.text.clone(),
            read: OnceLock::new(),
        }
    }
}

/// Reads a text in the language of its kind.
fn analyse(kind: Kind, path: &Path, text: Arc<Text>, world: &World) -> Arc<dyn Analysis> {
    let kind = match kind {
        Kind::Din if begins_in_plain_language(&text) => Kind::Plain,
        kind => kind,
    };
    match kind {
        Kind::Plain | Kind::Iso => Arc::new(PartProgram::new(path, text, world)),
        Kind::Din => Arc::new(DinProgram::new(path, text)),
        Kind::System900 => Arc::new(System900Program::new(path, text)),
        Kind::Plc => Arc::new(PlcSource::new(path, text, world)),
        Kind::Parameters => Arc::new(ParameterText::new(path, text, world)),
        Kind::Channel => Arc::new(ChannelText::new(text)),
    }
}

/// Shops name programs in plain language `.nc`, too: those begin with BEGIN PGM.
fn begins_in_plain_language(text: &Text) -> bool {
    Program::from_bytes("1.H", text.text.as_bytes().to_vec()).begins_with_header()
}
