//! What is wrong with a document, published without a request.

use std::ops::Range as Bytes;

use lsp_types::{
    Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, Location, NumberOrString, Position,
    PublishDiagnosticsParams, Range, Uri,
};

use crate::document::Document;
use crate::language::{BYTES_MAX, Examined, Fault, Place, Related, Severity};
use crate::uri::uri_of;

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
    let related: Vec<_> = fault
        .related
        .iter()
        .filter_map(|related| information(document, related))
        .collect();
    Diagnostic {
        range: document.version.text.range(&fault.range),
        severity: Some(match fault.severity {
            Severity::Error => DiagnosticSeverity::ERROR,
            Severity::Warning => DiagnosticSeverity::WARNING,
        }),
        code: (!fault.code.is_empty()).then(|| NumberOrString::String(fault.code.clone())),
        source: Some("bahn".to_owned()),
        message: fault.message.clone(),
        related_information: (!related.is_empty()).then_some(related),
        ..Diagnostic::default()
    }
}

fn information(document: &Document, related: &Related) -> Option<DiagnosticRelatedInformation> {
    let uri: Uri = match &related.path {
        Some(path) => uri_of(path)?,
        None => document.uri.clone(),
    };
    let range = match &related.place {
        Place::Here(bytes) => document.version.text.range(bytes),
        Place::There { line, characters } => characters_of(*line, characters),
    };
    Some(DiagnosticRelatedInformation {
        location: Location::new(uri, range),
        message: related.message.clone(),
    })
}

fn characters_of(line: u32, characters: &Bytes<u32>) -> Range {
    Range::new(
        Position::new(line, characters.start),
        Position::new(line, characters.end),
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
