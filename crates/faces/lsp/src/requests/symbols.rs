//! The outline.

use lsp_types::{DocumentSymbol, DocumentSymbolParams, DocumentSymbolResponse, SymbolKind as Shown};

use super::{Reply, View};
use crate::language::{Symbol, SymbolKind};
use crate::text::Text;

pub(super) fn symbols(
    view: &View<'_>,
    params: DocumentSymbolParams,
) -> Reply<Option<DocumentSymbolResponse>> {
    let opened = view.opened(&params.text_document.uri);
    Reply::Done(opened.map(|opened| {
        let symbols = opened.analysis.symbols();
        let shown = symbols.into_iter().map(|symbol| shown(opened.text, symbol));
        DocumentSymbolResponse::Nested(shown.collect())
    }))
}

#[allow(deprecated, reason = "the field `deprecated` must be given, too")]
fn shown(text: &Text, symbol: Symbol) -> DocumentSymbol {
    let children: Vec<_> = symbol
        .children
        .into_iter()
        .map(|child| shown(text, child))
        .collect();
    DocumentSymbol {
        // Editors refuse a name without letters.
        name: if symbol.name.trim().is_empty() {
            "?".to_owned()
        } else {
            symbol.name
        },
        detail: (!symbol.detail.is_empty()).then_some(symbol.detail),
        kind: match symbol.kind {
            SymbolKind::Program => Shown::MODULE,
            SymbolKind::Label => Shown::FUNCTION,
            SymbolKind::Tool => Shown::OBJECT,
            SymbolKind::Cycle => Shown::EVENT,
            SymbolKind::Section => Shown::NAMESPACE,
            SymbolKind::Parameter => Shown::PROPERTY,
            SymbolKind::Field => Shown::ARRAY,
        },
        tags: None,
        deprecated: None,
        range: text.range(&symbol.range),
        selection_range: text.range(&symbol.selection),
        children: (!children.is_empty()).then_some(children),
    }
}
