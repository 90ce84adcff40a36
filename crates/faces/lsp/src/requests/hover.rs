//! What the word under the cursor means.

use lsp_types::{Hover, HoverContents, HoverParams, MarkupContent, MarkupKind};

use super::{Reply, View};

pub(super) fn hover(view: &View<'_>, params: HoverParams) -> Reply<Option<Hover>> {
    let place = &params.text_document_position_params;
    let Some((opened, at)) = view.place(place) else {
        return Reply::Done(None);
    };
    if !opened.document.is_examined && opened.analysis.hover_waits(at) {
        return Reply::Later(place.text_document.uri.clone());
    }
    let hover = opened.analysis.hover(at, opened.document.examined.as_deref());
    Reply::Done(hover.map(|hover| Hover {
        contents: HoverContents::Markup(MarkupContent {
            kind: MarkupKind::Markdown,
            value: hover.text,
        }),
        range: Some(opened.text.range(&hover.range)),
    }))
}
