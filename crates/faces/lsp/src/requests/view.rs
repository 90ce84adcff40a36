//! What requests are answered from, and what they come to.

use std::collections::HashMap;
use std::sync::Arc;

use lsp_server::Response;
use lsp_types::{TextDocumentPositionParams, Uri};

use crate::document::Document;
use crate::language::Analysis;
use crate::text::Text;
use crate::world::World;

/// What requests are answered from.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    pub(crate) documents: &'a HashMap<Uri, Document>,
    pub(crate) world: &'a World,
}

/// An answer, or that there will be one.
pub(crate) enum Answer {
    Ready(Response),
    /// When the run of this document has ended.
    Later(Uri),
}

/// What a request comes to.
pub(super) enum Reply<R> {
    Done(R),
    /// It cannot be done, for this reason.
    Refused(String),
    Later(Uri),
}

/// A document with its language.
pub(super) struct Opened<'a> {
    pub(super) document: &'a Document,
    pub(super) text: &'a Text,
    pub(super) analysis: Arc<dyn Analysis>,
}

impl View<'_> {
    /// A document that can be read.
    pub(super) fn opened(&self, uri: &Uri) -> Option<Opened<'_>> {
        let document = self.documents.get(uri)?;
        Some(Opened {
            document,
            text: &document.version.text,
            analysis: document.version.analysis(self.world)?,
        })
    }

    /// A document, and the byte that a place in it means.
    pub(super) fn place(&self, params: &TextDocumentPositionParams) -> Option<(Opened<'_>, usize)> {
        let opened = self.opened(&params.text_document.uri)?;
        let at = opened.text.offset(params.position);
        Some((opened, at))
    }
}
