//! What can be folded.

use lsp_types::{FoldingRange, FoldingRangeKind, FoldingRangeParams};

use super::{Reply, View};

pub(super) fn folds(view: &View<'_>, params: FoldingRangeParams) -> Reply<Option<Vec<FoldingRange>>> {
    let opened = view.opened(&params.text_document.uri);
    let number = |line: usize| u32::try_from(line).unwrap_or(u32::MAX);
    Reply::Done(opened.map(|opened| {
        let folds = opened.analysis.folds();
        folds
            .into_iter()
            .filter(|fold| fold.last > fold.first)
            .map(|fold| FoldingRange {
                start_line: number(fold.first),
                end_line: number(fold.last),
                kind: fold.is_comment.then_some(FoldingRangeKind::Comment),
                ..FoldingRange::default()
            })
            .collect()
    }))
}
