//! What is wrong at a place of a file, whatever its language.
//!
//! Decision: What is wrong with a file as a whole is shown at its first line
//!
//! Decision: Only what is a fault of a text becomes a `Diagnostic`: a page of a picture that is too small, and the
//! error of a run in a report, have no place in a file that somebody reads

use std::fmt;
use std::path::PathBuf;

use crate::span::Span;

/// How bad a fault is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// It is accepted, but looks wrong.
    Warning,
    /// It keeps the file from being used, or stops a run.
    Error,
}

impl Severity {
    /// As reports for programs call it.
    pub fn name(self) -> &'static str {
        match self {
            Severity::Warning => "warning",
            Severity::Error => "error",
        }
    }
}

/// Something that is wrong at a place of a file. They are in the order of their places.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Diagnostic {
    /// The file; empty where the text alone is known.
    pub file: PathBuf,
    /// The place in it.
    pub span: Span,
    /// How bad it is.
    pub severity: Severity,
    /// Name or number by which it is explained; empty without one.
    pub code: String,
    /// The block of a part program, as `12` or `N40`; empty elsewhere.
    pub block: String,
    /// What is wrong.
    pub message: String,
    /// What exactly, where the message is that of a control; may be empty.
    pub detail: String,
    /// What to do about it.
    pub help: Option<String>,
    /// Other places that belong to it.
    pub related: Vec<Related>,
    /// The text of its line, where somebody has it.
    pub source: String,
}

/// A place that belongs to a fault.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Related {
    /// The file; empty for that of the fault.
    pub file: PathBuf,
    /// The place in it.
    pub span: Span,
    /// What it has to do with the fault.
    pub message: String,
    /// The text of its line, where somebody has it.
    pub source: String,
}

impl Diagnostic {
    /// An error of a text whose file the caller knows.
    pub fn error(span: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            file: PathBuf::new(),
            span,
            severity: Severity::Error,
            code: String::new(),
            block: String::new(),
            message: message.into(),
            detail: String::new(),
            help: None,
            related: Vec::new(),
            source: String::new(),
        }
    }

    /// A warning about such a text.
    pub fn warning(span: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            severity: Severity::Warning,
            ..Diagnostic::error(span, message)
        }
    }

    /// In a file, with the text of the line.
    pub fn at(self, file: impl Into<PathBuf>, source: impl Into<String>) -> Diagnostic {
        Diagnostic {
            file: file.into(),
            source: source.into(),
            ..self
        }
    }

    /// In a file of this text; what is wrong with the file as a whole is shown at its first line.
    pub fn in_text(self, file: impl Into<PathBuf>, text: &str) -> Diagnostic {
        let index = (self.span.line as usize).saturating_sub(1);
        let source = text.lines().nth(index).unwrap_or_default().to_owned();
        let line = self.span.line.max(1);
        Diagnostic {
            span: Span { line, ..self.span },
            ..self.at(file, source)
        }
    }

    /// Under a headline; what was the message is the detail.
    pub fn under(self, headline: impl Into<String>) -> Diagnostic {
        Diagnostic {
            detail: self.message,
            message: headline.into(),
            ..self
        }
    }

    /// With what exactly is wrong.
    pub fn with_detail(self, detail: impl Into<String>) -> Diagnostic {
        let detail = detail.into();
        Diagnostic { detail, ..self }
    }

    /// With what to do about it.
    pub fn with_help(self, help: Option<impl Into<String>>) -> Diagnostic {
        let help = help.map(Into::into);
        Diagnostic { help, ..self }
    }

    /// With the name or number by which it is explained.
    pub fn with_code(self, code: impl Into<String>) -> Diagnostic {
        let code = code.into();
        Diagnostic { code, ..self }
    }

    /// In a block of a part program.
    pub fn in_block(self, block: impl Into<String>) -> Diagnostic {
        let block = block.into();
        Diagnostic { block, ..self }
    }

    /// What stands at the mark: the block, and what exactly is wrong.
    pub fn label(&self) -> String {
        match (self.block.as_str(), self.detail.as_str()) {
            ("", detail) => detail.to_owned(),
            (block, "") => format!("block {block}"),
            (block, detail) => format!("block {block}: {detail}"),
        }
    }

    /// Message and detail.
    pub fn words(&self) -> String {
        match self.detail.as_str() {
            "" => self.message.clone(),
            detail => format!("{}: {detail}", self.message),
        }
    }

    /// What exactly is wrong: the detail, or the message that has none.
    pub fn exactly(&self) -> &str {
        match self.detail.as_str() {
            "" => &self.message,
            detail => detail,
        }
    }

    /// Line and what exactly is wrong; without a line what is wrong with the file as a whole.
    pub fn at_line(&self) -> String {
        let exactly = self.exactly();
        match self.span.line {
            0 => exactly.to_owned(),
            line => format!("line {line}: {exactly}"),
        }
    }
}

/// `FILE:LINE:COLUMN: MESSAGE`, with as much of the place as is known.
impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.file.as_os_str().is_empty() {
            write!(f, "{}:", self.file.display())?;
        }
        match (self.span.line, self.span.column) {
            (0, _) => {}
            (line, 0) => write!(f, "{line}:")?,
            (line, column) => write!(f, "{line}:{column}:")?,
        }
        if !self.file.as_os_str().is_empty() || self.span.line > 0 {
            f.write_str(" ")?;
        }
        f.write_str(&self.words())
    }
}

impl std::error::Error for Diagnostic {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_said_as_far_as_it_is_known() {
        let fault = Diagnostic::error(Span::new(3, 5, 2), "no number");
        assert_eq!(fault.to_string(), "3:5: no number");
        assert_eq!(fault.at_line(), "line 3: no number");
        let whole = Diagnostic::error(Span::FILE, "the table is empty");
        assert_eq!(
            (whole.to_string(), whole.at_line()),
            ("the table is empty".into(), "the table is empty".into())
        );
        let line = Diagnostic::error(Span::line(3), "no number").at("TOOL.T", "1 x");
        assert_eq!(line.to_string(), "TOOL.T:3: no number");
        let under = line.under("the tool table is wrong");
        assert_eq!(under.to_string(), "TOOL.T:3: the tool table is wrong: no number");
        assert_eq!(under.at_line(), "line 3: no number");
        let shown = whole.in_text("TOOL.T", "");
        assert_eq!((shown.span.line, shown.source.as_str()), (1, ""));
    }

    #[test]
    fn they_are_sorted_by_place() {
        let at = |line, column| Diagnostic::error(Span::new(line, column, 1), "wrong");
        let mut all = [at(2, 1), at(1, 9), at(1, 2), at(2, 1).at("A", "")];
        all.sort();
        let places: Vec<_> = all
            .iter()
            .map(|fault| (fault.span.line, fault.span.column))
            .collect();
        assert_eq!(places, [(1, 2), (1, 9), (2, 1), (2, 1)]);
    }
}
