//! What can be made of a document: the same program in another language. The work is done when an action is chosen.

use std::path::Path;
use std::str::FromStr;

use lsp_types::{
    CodeAction, CodeActionKind, CodeActionOrCommand, CodeActionParams, CreateFile, CreateFileOptions,
    DocumentChangeOperation, DocumentChanges, OneOf, OptionalVersionedTextDocumentIdentifier, Position,
    Range, ResourceOp, TextDocumentEdit, TextEdit, Uri, WorkspaceEdit,
};
use serde_json::{Value, json};

use super::{Reply, View};
use crate::language::Conversion;
use crate::uri::uri_of;

pub(super) fn actions(view: &View<'_>, params: CodeActionParams) -> Reply<Option<Vec<CodeActionOrCommand>>> {
    let wanted = params.context.only.as_deref();
    let is_wanted = wanted.is_none_or(|kinds| {
        let own = CodeActionKind::REFACTOR_REWRITE;
        kinds.iter().any(|kind| own.as_str().starts_with(kind.as_str()))
    });
    let uri = params.text_document.uri;
    let opened = view.opened(&uri).filter(|_| is_wanted);
    Reply::Done(opened.map(|opened| {
        let targets = opened.analysis.targets().into_iter();
        let actions = targets.map(|target| CodeAction {
            title: target.title.to_owned(),
            kind: Some(CodeActionKind::REFACTOR_REWRITE),
            data: Some(json!({"uri": uri.as_str(), "target": target.id})),
            ..CodeAction::default()
        });
        actions.map(CodeActionOrCommand::CodeAction).collect()
    }))
}

/// Does the work of an action that was chosen.
pub(super) fn resolved(view: &View<'_>, mut action: CodeAction) -> Reply<CodeAction> {
    let data = action.data.clone().unwrap_or_default();
    let text = |name: &str| data.get(name).and_then(Value::as_str).unwrap_or_default();
    let opened = Uri::from_str(text("uri")).ok();
    let opened = opened.as_ref().and_then(|uri| view.opened(uri));
    let Some(opened) = opened else {
        return Reply::Refused("the document is not open any more".to_owned());
    };
    match opened.analysis.converted(text("target"), view.world) {
        Err(reason) => Reply::Refused(reason),
        Ok(conversion) => {
            action.edit = new_file(&opened.document.version.path, conversion);
            Reply::Done(action)
        }
    }
}

/// A new file beside the old one; one that is there stays.
fn new_file(path: &Path, conversion: Conversion) -> Option<WorkspaceEdit> {
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
    Some(WorkspaceEdit {
        document_changes: Some(DocumentChanges::Operations(changes)),
        ..WorkspaceEdit::default()
    })
}
