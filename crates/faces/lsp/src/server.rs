//! The main loop: takes what the editor sends and what the background has found, and answers.

use std::collections::HashMap;
use std::sync::Arc;

use crossbeam_channel::{Sender, after, select};
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::notification::{
    Cancel, DidChangeConfiguration, DidChangeTextDocument, DidCloseTextDocument, DidOpenTextDocument,
    LogMessage, Notification as _, PublishDiagnostics,
};
use lsp_types::{
    CancelParams, DidChangeConfigurationParams, DidChangeTextDocumentParams, DidCloseTextDocumentParams,
    DidOpenTextDocumentParams, InitializeParams, LogMessageParams, MessageType, NumberOrString,
    PublishDiagnosticsParams, Uri,
};
use serde::de::DeserializeOwned;

use crate::ServeError;
use crate::background::{Background, Done};
use crate::capabilities;
use crate::document::{Document, Version};
use crate::language::Kind;
use crate::requests::{self, Answer};
use crate::settings::Settings;
use crate::text::Text;
use crate::uri::path_of;
use crate::world::{Disk, World};

/// Serves one editor until it says that it has done.
///
/// # Errors
/// When the editor breaks the protocol or goes away.
pub fn serve(connection: &Connection, files: Arc<dyn Disk>, settings: &Settings) -> Result<(), ServeError> {
    let (id, params) = connection.initialize_start()?;
    let params: InitializeParams = serde_json::from_value(params)?;
    connection.initialize_finish(id, serde_json::to_value(capabilities::offered())?)?;
    let mut server = Server {
        sender: connection.sender.clone(),
        background: Background::start(),
        documents: HashMap::new(),
        world: World {
            files,
            settings: Arc::new(settings.clone()),
            open: Arc::default(),
        },
        parked: Vec::new(),
    };
    server.settings(&params.initialization_options.unwrap_or_default());
    loop {
        while let Some(uri) = server.background.next() {
            server.examine(uri);
        }
        select! {
            recv(connection.receiver) -> message => match message {
                Ok(Message::Request(request)) => {
                    if connection.handle_shutdown(&request)? {
                        return Ok(());
                    }
                    server.request(request);
                }
                Ok(Message::Notification(notification)) => server.notification(notification),
                // Nothing is asked of the editor.
                Ok(Message::Response(_)) => {}
                Err(_) => return Err(ServeError::EditorGone),
            },
            recv(server.background.done) -> done => match done {
                Ok(done) => server.examined(done),
                Err(_) => return Err(ServeError::BackgroundGone),
            },
            recv(after(server.background.patience())) -> _ => {}
        }
    }
}

struct Server {
    sender: Sender<Message>,
    background: Background,
    documents: HashMap<Uri, Document>,
    world: World,
    /// Requests that wait for a run of their document.
    parked: Vec<(Uri, Request)>,
}

impl Server {
    fn notification(&mut self, notification: Notification) {
        let params = notification.params;
        match notification.method.as_str() {
            DidOpenTextDocument::METHOD => self.take(params, Server::open),
            DidChangeTextDocument::METHOD => self.take(params, Server::change),
            DidCloseTextDocument::METHOD => self.take(params, Server::close),
            DidChangeConfiguration::METHOD => {
                self.take(params, |server, params: DidChangeConfigurationParams| {
                    server.settings(&params.settings)
                });
            }
            Cancel::METHOD => self.take(params, Server::cancel),
            // Those that begin with $/ may be passed over, and of others nothing can be said.
            _ => {}
        }
    }

    /// Does what a notification says; what cannot be read is logged.
    fn take<P: DeserializeOwned>(&mut self, params: serde_json::Value, what: impl FnOnce(&mut Server, P)) {
        match serde_json::from_value(params) {
            Ok(params) => what(self, params),
            Err(error) => self.log(format!("a notification cannot be read: {error}")),
        }
    }

    fn open(&mut self, params: DidOpenTextDocumentParams) {
        let document = params.text_document;
        let path = path_of(&document.uri);
        let kind = Kind::of(&document.language_id, &path);
        let version = Version::new(path, kind, document.version, Text::new(&document.text));
        self.put(document.uri, version);
    }

    fn change(&mut self, params: DidChangeTextDocumentParams) {
        let Some(document) = self.documents.get(&params.text_document.uri) else {
            return;
        };
        let old = &document.version;
        let text = old.text.changed(&params.content_changes);
        let version = Version::new(old.path.clone(), old.kind, params.text_document.version, text);
        self.put(params.text_document.uri, version);
    }

    fn put(&mut self, uri: Uri, version: Version) {
        Arc::make_mut(&mut self.world.open).insert(version.path.clone(), version.text.clone());
        self.background.wants(&uri);
        let examined = self.documents.remove(&uri).and_then(|document| document.examined);
        let document = Document {
            uri: uri.clone(),
            version: Arc::new(version),
            examined,
            is_examined: false,
        };
        self.documents.insert(uri, document);
    }

    fn close(&mut self, params: DidCloseTextDocumentParams) {
        let uri = params.text_document.uri;
        self.background.forget(&uri);
        if let Some(document) = self.documents.remove(&uri) {
            Arc::make_mut(&mut self.world.open).remove(&document.version.path);
            self.publish(PublishDiagnosticsParams::new(uri.clone(), Vec::new(), None));
        }
        self.release(&uri);
    }

    fn cancel(&mut self, params: CancelParams) {
        let id: RequestId = match params.id {
            NumberOrString::Number(number) => number.into(),
            NumberOrString::String(text) => text.into(),
        };
        let (cancelled, parked) = std::mem::take(&mut self.parked)
            .into_iter()
            .partition(|(_, request)| request.id == id);
        self.parked = parked;
        for (_, request) in cancelled {
            let code = ErrorCode::RequestCanceled as i32;
            self.send(Response::new_err(request.id, code, "cancelled by the editor".to_owned()).into());
        }
    }

    /// Takes settings over; everything is read again with them.
    fn settings(&mut self, sent: &serde_json::Value) {
        let (settings, wrong) = self.world.settings.with(sent);
        if let Some(wrong) = wrong {
            self.log(wrong);
        }
        if settings == *self.world.settings {
            return;
        }
        self.world.settings = Arc::new(settings);
        for document in self.documents.values_mut() {
            document.version = Arc::new(document.version.unread());
            document.is_examined = false;
            self.background.wants(&document.uri);
        }
    }

    fn examine(&mut self, uri: Uri) {
        if let Some(document) = self.documents.get(&uri) {
            let version = document.version.clone();
            self.background.examine(uri, version, self.world.clone());
        }
    }

    fn examined(&mut self, done: Done) {
        self.background.has_done();
        let Some(document) = self.documents.get_mut(&done.uri) else {
            return;
        };
        if !Arc::ptr_eq(&document.version, &done.version) {
            return;
        }
        let params = requests::diagnostics(document, &done.examined);
        document.examined = Some(Arc::new(done.examined));
        document.is_examined = true;
        self.publish(params);
        self.release(&done.uri);
    }

    /// Answers what has waited for a document.
    fn release(&mut self, uri: &Uri) {
        let (ready, parked) = std::mem::take(&mut self.parked)
            .into_iter()
            .partition::<Vec<_>, _>(|(waited, _)| waited == uri);
        self.parked = parked;
        ready.into_iter().for_each(|(_, request)| self.request(request));
    }

    fn request(&mut self, request: Request) {
        let view = requests::View {
            documents: &self.documents,
            world: &self.world,
        };
        match requests::answer(&view, &request) {
            Answer::Ready(response) => self.send(response.into()),
            Answer::Later(uri) => self.parked.push((uri, request)),
        }
    }

    fn publish(&self, params: PublishDiagnosticsParams) {
        self.send(Notification::new(PublishDiagnostics::METHOD.to_owned(), params).into());
    }

    fn log(&self, message: String) {
        let params = LogMessageParams {
            typ: MessageType::WARNING,
            message,
        };
        self.send(Notification::new(LogMessage::METHOD.to_owned(), params).into());
    }

    /// An editor that has gone is noticed by the loop.
    fn send(&self, message: Message) {
        let _ = self.sender.send(message);
    }
}
