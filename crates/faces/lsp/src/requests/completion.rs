//! What may be written next.

use lsp_types::{
    CompletionItem, CompletionItemKind, CompletionParams, CompletionResponse, CompletionTextEdit,
    Documentation, InsertTextFormat, MarkupContent, MarkupKind, TextEdit,
};

use super::{Reply, View};
use crate::language::{Completion, CompletionKind};
use crate::text::Text;

pub(super) fn completions(view: &View<'_>, params: CompletionParams) -> Reply<Option<CompletionResponse>> {
    let place = view.place(&params.text_document_position);
    Reply::Done(place.map(|(opened, at)| {
        let found = opened.analysis.completions(at, view.world);
        let items = found.into_iter().enumerate();
        let items = items.map(|(order, found)| item(opened.text, order, found));
        CompletionResponse::Array(items.collect())
    }))
}

fn item(text: &Text, order: usize, found: Completion) -> CompletionItem {
    CompletionItem {
        kind: Some(match found.kind {
            CompletionKind::Word => CompletionItemKind::KEYWORD,
            CompletionKind::Cycle => CompletionItemKind::SNIPPET,
            CompletionKind::Label => CompletionItemKind::REFERENCE,
            CompletionKind::Function => CompletionItemKind::FUNCTION,
            CompletionKind::Parameter => CompletionItemKind::VARIABLE,
            CompletionKind::File => CompletionItemKind::FILE,
            CompletionKind::Value => CompletionItemKind::VALUE,
        }),
        detail: (!found.detail.is_empty()).then_some(found.detail),
        documentation: (!found.documentation.is_empty()).then_some(Documentation::MarkupContent(
            MarkupContent {
                kind: MarkupKind::Markdown,
                value: found.documentation,
            },
        )),
        // Their own order, not that of the alphabet: CYCL DEF 2 stands before CYCL DEF 10.
        sort_text: Some(format!("{order:05}")),
        filter_text: Some(found.label.clone()),
        label: found.label,
        insert_text_format: Some(InsertTextFormat::SNIPPET),
        text_edit: Some(CompletionTextEdit::Edit(TextEdit::new(
            text.range(&found.range),
            found.snippet,
        ))),
        ..CompletionItem::default()
    }
}
