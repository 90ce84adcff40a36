//! The normalised listing.

use lsp_types::{DocumentFormattingParams, TextEdit};

use super::{Reply, View};
use crate::text::Text;

pub(super) fn formatted(view: &View<'_>, params: DocumentFormattingParams) -> Reply<Option<Vec<TextEdit>>> {
    let Some(opened) = view.opened(&params.text_document.uri) else {
        return Reply::Done(None);
    };
    match opened.analysis.formatted(view.world) {
        Ok(listing) => Reply::Done(Some(edits(opened.text, &listing))),
        Err(reason) => Reply::Refused(reason),
    }
}

/// What makes one text of another: the lines that differ between the first and the last, so that the cursor stays.
fn edits(text: &Text, new: &str) -> Vec<TextEdit> {
    let old_lines: Vec<&str> = text.text.split_inclusive('\n').collect();
    let new_lines: Vec<&str> = new.split_inclusive('\n').collect();
    let same_front = old_lines
        .iter()
        .zip(&new_lines)
        .take_while(|(old, new)| old == new)
        .count();
    let rest = old_lines.len().min(new_lines.len()) - same_front;
    let same_back = old_lines
        .iter()
        .rev()
        .zip(new_lines.iter().rev())
        .take(rest)
        .take_while(|(old, new)| old == new)
        .count();
    let bytes = |lines: &[&str]| lines.iter().map(|line| line.len()).sum::<usize>();
    let start = bytes(old_lines.get(..same_front).unwrap_or_default());
    let end = text.text.len() - bytes(old_lines.get(old_lines.len() - same_back..).unwrap_or_default());
    let between = new_lines.get(same_front..new_lines.len() - same_back);
    let replacement = between.unwrap_or_default().concat();
    if start == end && replacement.is_empty() {
        return Vec::new();
    }
    vec![TextEdit::new(text.range(&(start..end)), replacement)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::Change;
    use proptest::prelude::*;

    proptest! {
        /// The edits make the new text of the old one.
        #[test]
        fn edits_lead_to_the_new_text(old in "[aä\n]{0,20}", new in "[aä\n]{0,20}") {
            let text = Text::new(&old);
            let changes: Vec<Change> = edits(&text, &new)
                .into_iter()
                .map(|edit| Change { range: Some(edit.range), range_length: None, text: edit.new_text })
                .collect();
            prop_assert_eq!(&*text.changed(&changes).text, new.as_str());
        }
    }
}
