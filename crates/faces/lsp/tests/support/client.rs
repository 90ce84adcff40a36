//! A scripted client of the language server: it sends what an editor sends, holds the texts as an editor does, and checks
//! each answer against what it knows itself.

#![allow(dead_code, reason = "every test file uses its part")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in the support of tests fails the test"
)]

use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// How messages go to the server and come back.
pub trait Wire {
    fn send(&mut self, message: Value);
    /// The next message; none within the time.
    fn receive(&mut self, patience: Duration) -> Option<Value>;
}

/// What a server may take before the test has failed.
const PATIENCE: Duration = Duration::from_secs(60);

pub struct Client<W: Wire> {
    wire: W,
    next: i64,
    version: i64,
    /// Diagnostics that came, newest last.
    pub published: Vec<Value>,
    pub capabilities: Value,
}

impl<W: Wire> Client<W> {
    /// Begins as an editor does.
    pub fn start(wire: W, options: Value) -> Client<W> {
        let mut client = Client {
            wire,
            next: 0,
            version: 0,
            published: Vec::new(),
            capabilities: Value::Null,
        };
        let params = json!({
            "processId": null, "rootUri": null, "initializationOptions": options,
            "capabilities": {"textDocument": {"completion": {"completionItem": {"snippetSupport": true}}}},
        });
        let answer = client.request("initialize", params);
        client.capabilities = answer["capabilities"].clone();
        assert_eq!(client.capabilities["positionEncoding"], "utf-16");
        client.notify("initialized", json!({}));
        client
    }

    pub fn notify(&mut self, method: &str, params: Value) {
        self.wire
            .send(json!({"jsonrpc": "2.0", "method": method, "params": params}));
    }

    /// Sends a request without waiting for its answer.
    pub fn ask(&mut self, method: &str, params: Value) -> i64 {
        self.next += 1;
        let id = self.next;
        self.wire
            .send(json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params}));
        id
    }

    /// The answer to a request: result or error.
    pub fn answer(&mut self, id: i64) -> Result<Value, Value> {
        let until = Instant::now() + PATIENCE;
        loop {
            let message = self.receive(until);
            if message["id"] == id && message.get("method").is_none() {
                return match message.get("error") {
                    Some(error) => Err(error.clone()),
                    None => Ok(message["result"].clone()),
                };
            }
        }
    }

    pub fn request(&mut self, method: &str, params: Value) -> Value {
        let id = self.ask(method, params);
        self.answer(id)
            .unwrap_or_else(|error| panic!("{method}: {error}"))
    }

    /// The error of a request that is refused.
    pub fn refused(&mut self, method: &str, params: Value) -> String {
        let id = self.ask(method, params);
        let error = self.answer(id).expect_err("the request is refused");
        error["message"].as_str().unwrap().to_owned()
    }

    fn receive(&mut self, until: Instant) -> Value {
        let left = until.saturating_duration_since(Instant::now());
        let message = self.wire.receive(left).expect("the server answers in time");
        if message["method"] == "textDocument/publishDiagnostics" {
            self.published.push(message["params"].clone());
        }
        message
    }

    /// Opens a document as it lies on the disk.
    pub fn open(&mut self, path: &Path, language: &str) -> Document {
        let text = std::fs::read_to_string(path).unwrap();
        self.open_text(path, language, &text)
    }

    pub fn open_text(&mut self, path: &Path, language: &str, text: &str) -> Document {
        self.version += 1;
        let uri = format!("file://{}", path.display());
        let item = json!({"uri": uri, "languageId": language, "version": self.version, "text": text});
        self.notify("textDocument/didOpen", json!({"textDocument": item}));
        Document {
            uri,
            text: text.to_owned(),
            version: self.version,
        }
    }

    /// Replaces the first place of a text by another, as an incremental change.
    pub fn edit(&mut self, document: &mut Document, old: &str, new: &str) {
        let at = document.text.find(old).expect("the text is there");
        self.replace(document, at..at + old.len(), new);
    }

    /// Replaces bytes by a text, as an incremental change.
    pub fn replace(&mut self, document: &mut Document, bytes: std::ops::Range<usize>, new: &str) {
        let range = document.range(bytes.start, bytes.end);
        document.text.replace_range(bytes, new);
        self.version += 1;
        document.version = self.version;
        self.notify(
            "textDocument/didChange",
            json!({
                "textDocument": {"uri": document.uri, "version": self.version},
                "contentChanges": [{"range": range, "text": new}],
            }),
        );
    }

    /// The diagnostics of the newest version of a document.
    pub fn diagnostics(&mut self, document: &Document) -> Vec<Value> {
        let until = Instant::now() + PATIENCE;
        loop {
            let known = self
                .published
                .iter()
                .rev()
                .find(|params| params["uri"] == *document.uri && params["version"] == document.version);
            if let Some(params) = known {
                return params["diagnostics"].as_array().unwrap().clone();
            }
            self.receive(until);
        }
    }

    /// A request about the first place of a text, `offset` bytes into it.
    pub fn at(&mut self, document: &Document, method: &str, text: &str, offset: usize) -> Value {
        let params = document.place(text, offset);
        self.request(method, params)
    }

    /// The Markdown of a hover.
    pub fn hover(&mut self, document: &Document, text: &str, offset: usize) -> String {
        let hover = self.at(document, "textDocument/hover", text, offset);
        hover["contents"]["value"].as_str().unwrap_or_default().to_owned()
    }

    /// The texts at the places that a request names, of this document.
    pub fn places(&mut self, document: &Document, method: &str, text: &str, offset: usize) -> Vec<String> {
        let mut params = document.place(text, offset);
        params["context"] = json!({"includeDeclaration": true});
        let answer = self.request(method, params);
        let places = answer.as_array().cloned().unwrap_or_default();
        places
            .iter()
            .map(|place| document.line_of(&place["range"]))
            .collect()
    }

    /// Labels of what may be written at a place, with what is written.
    pub fn completions(&mut self, document: &Document, text: &str, offset: usize) -> Vec<(String, String)> {
        let answer = self.at(document, "textDocument/completion", text, offset);
        let items = answer.as_array().cloned().unwrap_or_default();
        items
            .iter()
            .map(|item| {
                let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
                (text(&item["label"]), text(&item["textEdit"]["newText"]))
            })
            .collect()
    }

    /// The document after edits that a request answers.
    pub fn edited(&mut self, document: &Document, edits: &Value) -> String {
        let mut text = document.text.clone();
        let mut edits: Vec<(std::ops::Range<usize>, String)> = edits
            .as_array()
            .unwrap()
            .iter()
            .map(|edit| {
                (
                    document.bytes(&edit["range"]),
                    edit["newText"].as_str().unwrap().to_owned(),
                )
            })
            .collect();
        edits.sort_by_key(|(range, _)| std::cmp::Reverse(range.start));
        for (range, new) in edits {
            text.replace_range(range, &new);
        }
        text
    }

    pub fn close(&mut self, document: &Document) {
        self.notify(
            "textDocument/didClose",
            json!({"textDocument": {"uri": document.uri}}),
        );
    }

    /// Goes without a word.
    pub fn into_wire(self) -> W {
        self.wire
    }

    /// Ends as an editor does.
    pub fn end(mut self) -> W {
        assert_eq!(self.request("shutdown", Value::Null), Value::Null);
        self.notify("exit", Value::Null);
        self.wire
    }
}

/// A document as an editor holds it.
pub struct Document {
    pub uri: String,
    pub text: String,
    pub version: i64,
}

impl Document {
    pub fn id(&self) -> Value {
        json!({"textDocument": {"uri": self.uri}})
    }

    pub fn place(&self, text: &str, offset: usize) -> Value {
        let at = self
            .text
            .find(text)
            .unwrap_or_else(|| panic!("{text} is not there"))
            + offset;
        json!({"textDocument": {"uri": self.uri}, "position": self.position(at)})
    }

    pub fn position(&self, at: usize) -> Value {
        let before = &self.text[..at];
        // A return alone ends a line, too; before a line feed it is a part of that.
        let paired = self.text[at..].starts_with('\n') && before.ends_with('\r');
        let unpaired = before.strip_suffix('\r').filter(|_| paired).unwrap_or(before);
        let (line, last) = lines_of(unpaired);
        json!({"line": line, "character": last.encode_utf16().count()})
    }

    pub fn range(&self, start: usize, end: usize) -> Value {
        json!({"start": self.position(start), "end": self.position(end)})
    }

    /// The bytes of a range of the protocol, by the client's own count.
    pub fn bytes(&self, range: &Value) -> std::ops::Range<usize> {
        let offset = |place: &Value| {
            let line = place["line"].as_u64().unwrap() as usize;
            let mut units = place["character"].as_u64().unwrap() as usize;
            let start: usize = self.text.split_inclusive('\n').take(line).map(str::len).sum();
            let mut at = start;
            for character in self.text[start..].chars() {
                if units == 0 || character == '\n' {
                    break;
                }
                units -= character.len_utf16();
                at += character.len_utf8();
            }
            at
        };
        offset(&range["start"])..offset(&range["end"])
    }

    pub fn marked(&self, range: &Value) -> &str {
        &self.text[self.bytes(range)]
    }

    /// The line in which a range begins.
    pub fn line_of(&self, range: &Value) -> String {
        let line = range["start"]["line"].as_u64().unwrap() as usize;
        self.text.lines().nth(line).unwrap_or_default().to_owned()
    }
}

/// How many lines have ended in a text, and what is left after them.
fn lines_of(text: &str) -> (usize, &str) {
    let joined = text.replace("\r\n", "\n");
    let ends = joined.matches(['\n', '\r']).count();
    (ends, text.rsplit(['\n', '\r']).next().unwrap())
}
