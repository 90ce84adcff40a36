//! The DevTools protocol: orders and answers by number, events in between.

use std::io::ErrorKind;
use std::net::TcpStream;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::{Message, WebSocket};

use crate::error::BrowserError;

/// Longest wait for an answer: software drawing of a great part takes its time on a busy host.
const ANSWER: Duration = Duration::from_secs(60);
/// How often a wait looks at the clock.
const SLICE: Duration = Duration::from_millis(100);

/// A web socket to the browser or one of its pages.
#[derive(Debug)]
pub(crate) struct Connection {
    socket: WebSocket<TcpStream>,
    next: u64,
    /// Events that nobody has taken.
    events: Vec<Value>,
}

impl Connection {
    pub fn new(address: &str) -> Result<Connection, BrowserError> {
        let lost = |what: &dyn std::fmt::Display| BrowserError::Lost(what.to_string());
        let host = address
            .strip_prefix("ws://")
            .and_then(|rest| rest.split('/').next())
            .unwrap_or_default();
        let stream = TcpStream::connect(host).map_err(|error| lost(&error))?;
        stream.set_nodelay(true).map_err(|error| lost(&error))?;
        let (socket, _) = tungstenite::client(address, stream).map_err(|error| lost(&error))?;
        socket
            .get_ref()
            .set_read_timeout(Some(SLICE))
            .map_err(|error| lost(&error))?;
        Ok(Connection {
            socket,
            next: 0,
            events: Vec::new(),
        })
    }

    /// Gives an order and waits for its answer.
    pub fn call(&mut self, method: &str, parameters: Value) -> Result<Value, BrowserError> {
        self.next += 1;
        let order = json!({ "id": self.next, "method": method, "params": parameters });
        self.socket
            .send(Message::text(order.to_string()))
            .map_err(|error| BrowserError::Lost(error.to_string()))?;
        let until = Instant::now() + ANSWER;
        while Instant::now() < until {
            let Some(mut message) = self.read()? else { continue };
            if message["id"].as_u64() != Some(self.next) {
                self.events.push(message);
                continue;
            }
            if let Some(error) = message.get("error") {
                return Err(BrowserError::Refused {
                    method: method.to_owned(),
                    message: error["message"].as_str().unwrap_or_default().to_owned(),
                });
            }
            return Ok(message["result"].take());
        }
        Err(BrowserError::Lost(format!("{method} for {} s", ANSWER.as_secs())))
    }

    /// The next event that is there within a time.
    pub fn event(&mut self, within: Duration) -> Result<Option<Value>, BrowserError> {
        let until = Instant::now() + within;
        loop {
            if !self.events.is_empty() {
                return Ok(Some(self.events.remove(0)));
            }
            if let Some(message) = self.read()? {
                self.events.push(message);
            } else if Instant::now() >= until {
                return Ok(None);
            }
        }
    }

    /// Events that came with answers.
    pub fn take_events(&mut self) -> Vec<Value> {
        std::mem::take(&mut self.events)
    }

    /// One message; `None` when there is none for a while.
    fn read(&mut self) -> Result<Option<Value>, BrowserError> {
        let lost = |what: String| BrowserError::Lost(what);
        match self.socket.read() {
            Ok(Message::Text(text)) => serde_json::from_str(text.as_str())
                .map(Some)
                .map_err(|error| lost(error.to_string())),
            Ok(Message::Close(_)) => Err(lost("the connection is closed".to_owned())),
            Ok(_) => Ok(None),
            Err(tungstenite::Error::Io(error))
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) =>
            {
                Ok(None)
            }
            Err(error) => Err(lost(error.to_string())),
        }
    }
}
