//! What the compiler finds, at its place.

use bahn_text::{Diagnostic, Related, Severity, Span};

use crate::error::PlcError;
use crate::program::SourceText;

/// An error or a warning of the compiler, with its place. A warning carries the number of the error that
/// it would be if the rule were not narrowed for the manual's own listings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Which error.
    pub error: PlcError,
    /// The file, as the program names it.
    pub file: String,
    /// The word that is wrong.
    pub span: Span,
    /// What exactly is wrong; may be empty.
    pub detail: String,
    /// The bracket, structure or table that is still open, where that is what is wrong.
    pub opened: Option<Span>,
}

impl Fault {
    /// What is wrong here; begins with the text of the error.
    pub fn message(&self) -> String {
        match self.detail.as_str() {
            "" => self.error.text().to_owned(),
            detail => format!("{}: {detail}", self.error.text()),
        }
    }

    /// As people and programs get it, in one of these files; their names are those of the program.
    pub fn diagnostic(&self, severity: Severity, files: &[SourceText]) -> Diagnostic {
        let file = files.iter().find(|own| own.name == self.file);
        let source = |span: Span| {
            let index = (span.line as usize).saturating_sub(1);
            let line = file.and_then(|file| file.lines.get(index));
            line.cloned().unwrap_or_default()
        };
        let opened = self.opened.map(|span| Related {
            file: self.file.as_str().into(),
            span,
            message: "opened here".to_owned(),
            source: source(span),
        });
        Diagnostic {
            severity,
            related: opened.into_iter().collect(),
            ..Diagnostic::error(self.span, self.error.to_string())
                .with_code(format!("PLC {}", self.error.number()))
                .with_detail(self.detail.as_str())
                .with_help(Some(format!("{} {}", self.error.cause(), self.error.cure())))
                .at(self.file.as_str(), source(self.span))
        }
    }
}
