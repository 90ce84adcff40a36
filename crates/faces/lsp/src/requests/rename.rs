//! Another name for a label, everywhere.

use std::collections::HashMap;

use lsp_types::{PrepareRenameResponse, RenameParams, TextDocumentPositionParams, TextEdit, WorkspaceEdit};

use super::{Reply, View};
use crate::language::mention_at;

pub(super) fn prepared(
    view: &View<'_>,
    params: TextDocumentPositionParams,
) -> Reply<Option<PrepareRenameResponse>> {
    let Some((opened, at)) = view.place(&params) else {
        return Reply::Done(None);
    };
    let mention = mention_at(opened.analysis.mentions(), at);
    let mention = mention.filter(|mention| opened.analysis.can_rename(&mention.thing));
    Reply::Done(
        mention.map(|mention| PrepareRenameResponse::RangeWithPlaceholder {
            range: opened.text.range(&mention.range),
            placeholder: opened.text.get(mention.range.clone()).to_owned(),
        }),
    )
}

#[allow(
    clippy::mutable_key_type,
    reason = "the protocol's own type; no URI is changed"
)]
pub(super) fn renamed(view: &View<'_>, params: RenameParams) -> Reply<Option<WorkspaceEdit>> {
    let Some((opened, at)) = view.place(&params.text_document_position) else {
        return Reply::Done(None);
    };
    let Some(mention) = mention_at(opened.analysis.mentions(), at) else {
        return Reply::Refused("here stands no name".to_owned());
    };
    if !opened.analysis.can_rename(&mention.thing) {
        return Reply::Refused("only labels get other names".to_owned());
    }
    let edits = opened
        .analysis
        .renamed(&mention.thing, params.new_name.trim(), view.world);
    match edits {
        Err(reason) => Reply::Refused(reason),
        Ok(edits) => {
            let edits = edits
                .into_iter()
                .map(|(range, text)| TextEdit::new(opened.text.range(&range), text))
                .collect();
            let uri = opened.document.uri.clone();
            Reply::Done(Some(WorkspaceEdit::new(HashMap::from([(uri, edits)]))))
        }
    }
}
