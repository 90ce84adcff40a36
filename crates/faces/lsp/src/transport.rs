//! Messages over a pair of streams: each has a head with its length.
//!
//! What comes is not trusted: a buffer grows with what has come, never to a length that somebody states. What is no message
//! is answered or logged, and the next one is read; where no one can say any more where that begins, reading ends.

use std::io::{BufRead, Read, Write};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};

use crossbeam_channel::{Sender, bounded};
use lsp_server::{Connection, ErrorCode, Message, Notification, RequestId, Response};
use lsp_types::notification::{LogMessage, Notification as _};
use lsp_types::{LogMessageParams, MessageType};
use serde_json::Value;

use crate::ServeError;

/// Longest message, 64 MiB: four times the largest text that is looked at.
const MESSAGE_MAX: u64 = 64 << 20;
/// Longest line of a head, and most lines of one.
const LINE_MAX: u64 = 4096;
const LINES_MAX: usize = 64;

/// What was read from the client.
#[derive(Debug)]
pub enum Frame {
    /// A message that could be read as a whole.
    Message(Box<Message>),
    /// No message, with the request that it was meant to be.
    Wrong(String, Option<RequestId>),
    /// Nothing more, and why, where that is not the end of the stream between two messages.
    End(Option<String>),
}

/// Reads what comes next.
pub fn read(input: &mut impl BufRead) -> Frame {
    let length = match head(input) {
        Ok(Some(length)) => length,
        Ok(None) => return Frame::End(None),
        Err(frame) => return frame,
    };
    let mut bytes = Vec::new();
    match input.by_ref().take(length).read_to_end(&mut bytes) {
        Ok(count) if count as u64 == length => message(&bytes),
        Ok(count) => Frame::End(Some(format!("a message of {length} bytes ends after {count}"))),
        Err(error) => Frame::End(Some(error.to_string())),
    }
}

/// The length that a head states. `None` at the end of the stream.
fn head(input: &mut impl BufRead) -> Result<Option<u64>, Frame> {
    let mut length = None;
    let mut wrong = None;
    for lines in 0..LINES_MAX {
        let mut line = Vec::new();
        match input.by_ref().take(LINE_MAX).read_until(b'\n', &mut line) {
            Ok(0) if lines == 0 => return Ok(None),
            Ok(_) if line.last() == Some(&b'\n') => {}
            Ok(count) if count as u64 == LINE_MAX => {
                return Err(Frame::End(Some("a line of a head does not end".to_owned())));
            }
            Ok(_) => return Err(Frame::End(Some("the stream ends within a head".to_owned()))),
            Err(error) => return Err(Frame::End(Some(error.to_string()))),
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim_end();
        if line.is_empty() {
            return match (length, wrong) {
                (Some(length), _) => Ok(Some(length)),
                (None, wrong) => {
                    let wrong = wrong.unwrap_or_else(|| "a head without Content-Length".to_owned());
                    Err(Frame::Wrong(wrong, None))
                }
            };
        }
        match line.split_once(':') {
            Some((name, value)) if name.trim().eq_ignore_ascii_case("Content-Length") => {
                // Without a valid length nobody knows where the next message begins.
                let number = value.trim().parse().ok().filter(|length| *length <= MESSAGE_MAX);
                length = Some(number.ok_or_else(|| {
                    let value = value.trim();
                    Frame::End(Some(format!(
                        "Content-Length {value} is not within 0 to {MESSAGE_MAX}"
                    )))
                })?);
            }
            Some(_) => {}
            None => wrong = Some(format!("`{line}` is no line of a head")),
        }
    }
    Err(Frame::End(Some(format!(
        "a head has more than {LINES_MAX} lines"
    ))))
}

/// The message of these bytes.
fn message(bytes: &[u8]) -> Frame {
    let error = match serde_json::from_slice(bytes) {
        Ok(message) => return Frame::Message(Box::new(message)),
        Err(error) => error,
    };
    let value: Option<Value> = serde_json::from_slice(bytes).ok();
    let id = value.as_ref().and_then(|value| value.get("id"));
    let id = id.and_then(|id| serde_json::from_value(id.clone()).ok());
    Frame::Wrong(format!("what came is no message: {error}"), id)
}

/// The threads that read and write.
pub struct Streams {
    writer: JoinHandle<std::io::Result<()>>,
    reader: JoinHandle<()>,
    ended: Arc<Mutex<Option<String>>>,
}

impl Streams {
    /// A connection over a stream that is read and one that is written.
    pub fn connect(
        mut input: impl BufRead + Send + 'static,
        mut output: impl Write + Send + 'static,
    ) -> (Connection, Streams) {
        let (sender, to_write) = bounded::<Message>(0);
        let writer = thread::spawn(move || {
            to_write
                .into_iter()
                .try_for_each(|message| message.write(&mut std::io::BufWriter::new(&mut output)))
        });
        let (to_serve, receiver) = bounded::<Message>(0);
        let ended = Arc::new(Mutex::new(None));
        let (why, answers) = (Arc::clone(&ended), sender.clone());
        let reader = thread::spawn(move || {
            loop {
                match read(&mut input) {
                    Frame::Message(message) => {
                        let is_exit = matches!(&*message, Message::Notification(one) if one.method == "exit");
                        if to_serve.send(*message).is_err() || is_exit {
                            return;
                        }
                    }
                    Frame::Wrong(what, id) => answer(&answers, what, id),
                    Frame::End(what) => {
                        if let Ok(mut why) = why.lock() {
                            *why = what;
                        }
                        return;
                    }
                }
            }
        });
        let connection = Connection { sender, receiver };
        let streams = Streams {
            writer,
            reader,
            ended,
        };
        (connection, streams)
    }

    /// Ends with a connection that is dropped, served so.
    ///
    /// # Errors
    /// Why the editor was served no longer, or what could not be written.
    pub fn end(self, served: Result<(), ServeError>) -> Result<(), ServeError> {
        if let Err(error) = served {
            let why = self.ended.lock().ok().and_then(|mut why| why.take());
            // Where the editor still writes, the reader waits for ever.
            return Err(why.map_or(error, ServeError::Stream));
        }
        let failed = |what: &str| ServeError::Stream(what.to_owned());
        self.reader.join().map_err(|_| failed("the reader has failed"))?;
        let written = self.writer.join().map_err(|_| failed("the writer has failed"))?;
        written.map_err(|error| ServeError::Stream(error.to_string()))
    }
}

/// Says that something was no message: to whom has asked, else in the log.
fn answer(sender: &Sender<Message>, what: String, id: Option<RequestId>) {
    let message = match id {
        Some(id) => Response::new_err(id, ErrorCode::InvalidRequest as i32, what).into(),
        None => {
            let params = LogMessageParams {
                typ: MessageType::WARNING,
                message: what,
            };
            Notification::new(LogMessage::METHOD.to_owned(), params).into()
        }
    };
    // An editor that has gone is noticed by the loop.
    let _ = sender.send(message);
}
