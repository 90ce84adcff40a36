//! What can be made of a document: the same program in another language.

use lsp_types::{
    CodeAction, CodeActionKind, CodeActionOrCommand, CodeActionParams, CreateFile, CreateFileOptions,
    DocumentChangeOperation, DocumentChanges, OneOf, OptionalVersionedTextDocumentIdentifier, Position,
    Range, ResourceOp, TextDocumentEdit, TextEdit, WorkspaceEdit,
};

use super::{Reply, View};
use crate::language::Conversion;
use crate::uri::uri_of;

pub(super) fn actions(view: &View<'_>, params: CodeActionParams) -> Reply<Option<Vec<CodeActionOrCommand>>> {
    let wanted = params.context.only.as_deref();
    let is_wanted = wanted.is_none_or(|kinds| {
        let own = CodeActionKind::REFACTOR_REWRITE;
        kinds.iter().any(|kind| own.as_str().starts_with(kind.as_str()))
    });
    let opened = view.opened(&params.text_document.uri).filter(|_| is_wanted);
    Reply::Done(opened.map(|opened| {
        let conversions = opened.analysis.conversions(view.world);
        let path = &opened.document.version.path;
        conversions
            .into_iter()
            .filter_map(|conversion| action(path, conversion))
            .map(CodeActionOrCommand::CodeAction)
            .collect()
    }))
}

/// A new file beside the old one; one that is there stays.
fn action(path: &std::path::Path, conversion: Conversion) -> Option<CodeAction> {
    let uri = uri_of(&path.with_file_name(&conversion.file_name))?;
    let create = CreateFile {
        uri: uri.clone(),
        options: Some(CreateFileOptions {
            overwrite: Some(false),
            ignore_if_exists: Some(false),
        }),
        annotation_id: None,
    };
    let front = Range::new(Position::default(), Position::default());
    let edit = TextDocumentEdit {
        text_document: OptionalVersionedTextDocumentIdentifier { uri, version: None },
        edits: vec![OneOf::Left(TextEdit::new(front, conversion.text))],
    };
    let changes = vec![
        DocumentChangeOperation::Op(ResourceOp::Create(create)),
        DocumentChangeOperation::Edit(edit),
    ];
    Some(CodeAction {
        title: conversion.title,
        kind: Some(CodeActionKind::REFACTOR_REWRITE),
        edit: Some(WorkspaceEdit {
            document_changes: Some(DocumentChanges::Operations(changes)),
            ..WorkspaceEdit::default()
        }),
        ..CodeAction::default()
    })
}
