//! The words of a text by kind, for colours.

use lsp_types::{SemanticToken, SemanticTokens, SemanticTokensParams, SemanticTokensResult};

use super::{Reply, View};

pub(super) fn tokens(view: &View<'_>, params: SemanticTokensParams) -> Reply<Option<SemanticTokensResult>> {
    let opened = view.opened(&params.text_document.uri);
    Reply::Done(opened.map(|opened| {
        let mut data = Vec::new();
        let (mut line, mut character) = (0, 0);
        let mut end = 0;
        for (range, token) in opened.analysis.tokens() {
            let shown = opened.text.get(range.clone());
            // Tokens of several lines are not for every editor, and none may lie in another.
            if shown.is_empty() || shown.contains(['\n', '\r']) || range.start < end {
                continue;
            }
            end = range.end;
            let start = opened.text.position(range.start);
            if start.line != line {
                character = 0;
            }
            data.push(SemanticToken {
                delta_line: start.line - line,
                delta_start: start.character - character,
                length: u32::try_from(shown.encode_utf16().count()).unwrap_or(u32::MAX),
                token_type: token as u32,
                token_modifiers_bitset: 0,
            });
            (line, character) = (start.line, start.character);
        }
        SemanticTokensResult::Tokens(SemanticTokens {
            result_id: None,
            data,
        })
    }))
}
