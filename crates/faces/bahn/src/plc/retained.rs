//! The retained memory of a bench.

use std::path::Path;

use bahn_host::Retained;

use crate::{UsageError, diagnostics};

/// Opens the journal of the retained memory; says what is damaged in it.
pub(super) fn retained(path: Option<&Path>) -> Result<Option<Retained>, UsageError> {
    let retained = path.map(Retained::open).transpose()?;
    if let Some(damage) = retained.as_ref().and_then(Retained::damage) {
        diagnostics::print_line(&format!("warning: {damage}"));
    }
    Ok(retained)
}
