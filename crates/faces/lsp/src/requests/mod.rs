//! Requests of the editor: a file for each kind. They turn what a language says into what the protocol says.

mod actions;
mod completion;
mod diagnostics;
mod folding;
mod formatting;
mod hover;
mod navigation;
mod rename;
mod symbols;
mod tokens;
mod view;

use lsp_server::{ErrorCode, Request as Message, Response};
use lsp_types::request::{
    CodeActionRequest, CodeActionResolveRequest, Completion, DocumentHighlightRequest, DocumentSymbolRequest,
    FoldingRangeRequest, Formatting, GotoDefinition, HoverRequest, PrepareRenameRequest, References, Rename,
    Request, SemanticTokensFullRequest,
};

pub(crate) use diagnostics::diagnostics;

use view::Reply;
pub(crate) use view::{Answer, View};

/// Answers a request of the client.
pub(crate) fn answer(view: &View<'_>, request: &Message) -> Answer {
    match request.method.as_str() {
        HoverRequest::METHOD => of::<HoverRequest>(view, request, hover::hover),
        GotoDefinition::METHOD => of::<GotoDefinition>(view, request, navigation::definition),
        References::METHOD => of::<References>(view, request, navigation::references),
        DocumentHighlightRequest::METHOD => {
            of::<DocumentHighlightRequest>(view, request, navigation::highlights)
        }
        DocumentSymbolRequest::METHOD => of::<DocumentSymbolRequest>(view, request, symbols::symbols),
        FoldingRangeRequest::METHOD => of::<FoldingRangeRequest>(view, request, folding::folds),
        Completion::METHOD => of::<Completion>(view, request, completion::completions),
        Formatting::METHOD => of::<Formatting>(view, request, formatting::formatted),
        PrepareRenameRequest::METHOD => of::<PrepareRenameRequest>(view, request, rename::prepared),
        Rename::METHOD => of::<Rename>(view, request, rename::renamed),
        CodeActionRequest::METHOD => of::<CodeActionRequest>(view, request, actions::actions),
        CodeActionResolveRequest::METHOD => of::<CodeActionResolveRequest>(view, request, actions::resolved),
        SemanticTokensFullRequest::METHOD => of::<SemanticTokensFullRequest>(view, request, tokens::tokens),
        other => {
            let text = format!("{other} is not offered");
            Answer::Ready(failed(request, ErrorCode::MethodNotFound, text))
        }
    }
}

fn of<R: Request>(
    view: &View<'_>,
    request: &Message,
    handler: impl FnOnce(&View<'_>, R::Params) -> Reply<R::Result>,
) -> Answer {
    let params = match serde_json::from_value::<R::Params>(request.params.clone()) {
        Ok(params) => params,
        Err(error) => return Answer::Ready(failed(request, ErrorCode::InvalidParams, error.to_string())),
    };
    Answer::Ready(match handler(view, params) {
        Reply::Done(result) => Response::new_ok(request.id.clone(), result),
        Reply::Refused(text) => failed(request, ErrorCode::RequestFailed, text),
        Reply::Later(uri) => return Answer::Later(uri),
    })
}

fn failed(request: &Message, code: ErrorCode, text: String) -> Response {
    Response::new_err(request.id.clone(), code as i32, text)
}
