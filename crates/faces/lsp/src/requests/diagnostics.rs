//! What is wrong with a document, published without a request.

use bahn_text::{Diagnostic as Fault, Related, Severity, Span};
use lsp_types::{
    Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, Location, NumberOrString, Position,
    PublishDiagnosticsParams, Range,
};

use crate::document::Document;
use crate::language::Examined;
use crate::uri::uri_of;
use crate::world::BYTES_MAX;

/// Most faults that are shown: who has more has another kind of file.
const SHOWN_MAX: usize = 1000;

/// What an editor shows of a document's faults, at most [`SHOWN_MAX`].
pub(crate) fn diagnostics(document: &Document, examined: &Examined) -> PublishDiagnosticsParams {
    let version = &document.version;
    let mut shown: Vec<Diagnostic> = examined
        .faults
        .iter()
        .take(SHOWN_MAX)
        .map(|fault| diagnostic(document, fault))
        .collect();
    let more = examined.not_listed + examined.faults.len().saturating_sub(SHOWN_MAX);
    if more > 0 {
        shown.push(of_file(format!("{more} more errors and warnings are not shown")));
    }
    if version.kind.is_some() && version.is_too_large() {
        shown.push(of_file(format!(
            "the file is larger than {} MiB: it is not looked at",
            BYTES_MAX >> 20
        )));
    }
    PublishDiagnosticsParams::new(document.uri.clone(), shown, Some(version.number))
}

fn diagnostic(document: &Document, fault: &Fault) -> Diagnostic {
    let related = fault.related.iter();
    let related: Vec<_> = related
        .filter_map(|related| information(document, related))
        .collect();
    let mut message = fault.words();
    if let Some(help) = &fault.help {
        message = format!("{message}\n{help}");
    }
    Diagnostic {
        range: document.version.text.range_of(fault.span),
        severity: Some(match fault.severity {
            Severity::Error => DiagnosticSeverity::ERROR,
            Severity::Warning => DiagnosticSeverity::WARNING,
        }),
        code: (!fault.code.is_empty()).then(|| NumberOrString::String(fault.code.clone())),
        source: Some("bahn".to_owned()),
        message,
        related_information: (!related.is_empty()).then_some(related),
        ..Diagnostic::default()
    }
}

fn information(document: &Document, related: &Related) -> Option<DiagnosticRelatedInformation> {
    let is_here = related.file.as_os_str().is_empty() || related.file == document.version.path;
    let (uri, range) = match is_here {
        true => (document.uri.clone(), document.version.text.range_of(related.span)),
        false => (uri_of(&related.file)?, characters_of(related.span)),
    };
    Some(DiagnosticRelatedInformation {
        location: Location::new(uri, range),
        message: related.message.clone(),
    })
}

/// A place in a file that nobody has open.
fn characters_of(span: Span) -> Range {
    let (line, column) = (span.line.saturating_sub(1), span.column.saturating_sub(1));
    Range::new(
        Position::new(line, column),
        Position::new(line, column.saturating_add(span.length)),
    )
}

fn of_file(message: String) -> Diagnostic {
    Diagnostic {
        severity: Some(DiagnosticSeverity::WARNING),
        source: Some("bahn".to_owned()),
        message,
        ..Diagnostic::default()
    }
}
