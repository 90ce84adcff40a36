//! A viewer that does not read: nothing waits for him, little is kept for him, and he has the newest when he reads again.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

#[path = "../../../part/viewer/tests/support/screen.rs"]
mod codec;
mod support;

use std::io::ErrorKind;
use std::net::TcpStream;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use codec::Screen;
use rmpv::Value;
use serde_json::json;
use support::Panel;
use tungstenite::{Error, Message, WebSocket};

/// What somebody who looks at the part was sent.
#[derive(Default)]
struct Looker {
    screen: Option<Screen>,
    cells: [usize; 2],
    parts: usize,
    bytes: usize,
    /// Bytes of the longest message.
    longest: usize,
    /// Reads in a row that ended without a message.
    silent: usize,
}

/// Reads of 20 s without a message after which nothing will come: on a busy machine the end of the part that is awaited is reported to
/// the test long after the last message.
const SILENT_MAX: usize = 15;

impl Looker {
    fn take(&mut self, message: &[u8]) {
        self.bytes += message.len();
        self.longest = self.longest.max(message.len());
        let regions = rmpv::decode::read_value(&mut &message[..]).unwrap();
        for region in regions.as_array().unwrap() {
            if region[0].as_str() != Some("part") || region[1].is_nil() {
                continue;
            }
            self.parts += 1;
            let field = |value: &Value, name: &str| {
                let entries = value.as_map().unwrap();
                let found = entries.iter().find(|(key, _)| key.as_str() == Some(name));
                found.map(|(_, value)| value.clone())
            };
            if let Some(head) = field(&region[1], "head") {
                let cells = field(&head, "cells").unwrap();
                self.cells = [0, 1].map(|k| cells[k].as_u64().unwrap() as usize);
                self.screen = Some(Screen::new(self.cells));
            }
            if let Some(tiles) = field(&region[1], "tiles") {
                self.screen.as_mut().unwrap().take(tiles.as_slice().unwrap());
            }
        }
    }
}

impl Looker {
    /// Whether he sees this part.
    fn has(&self, part: Option<&Vec<u16>>) -> bool {
        let seen = self.screen.as_ref().map(|screen| &screen.heights);
        part.is_some() && seen == part
    }

    fn read(&mut self, socket: &mut WebSocket<TcpStream>) {
        match socket.read() {
            Ok(message) => {
                self.silent = 0;
                if let Message::Binary(bytes) = message {
                    self.take(&bytes);
                }
            }
            Err(Error::Io(error)) if error.kind() == ErrorKind::WouldBlock && self.silent < SILENT_MAX => {
                self.silent += 1;
            }
            Err(error) => panic!("{} parts, {} bytes: {error}", self.parts, self.bytes),
        }
    }
}

/// A viewer with a small buffer, who looks at the part.
fn looks(panel: &Panel, name: &str) -> WebSocket<TcpStream> {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .unwrap();
    let stream = runtime.block_on(async {
        let socket = tokio::net::TcpSocket::new_v4().unwrap();
        socket.set_recv_buffer_size(8 << 10).unwrap();
        socket.connect(panel.address).await.unwrap().into_std().unwrap()
    });
    stream.set_nonblocking(false).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    let (mut socket, _) =
        tungstenite::client(format!("ws://{}/ws?name={name}", panel.address), stream).unwrap();
    socket
        .send(Message::text(json!({"part": true}).to_string()))
        .unwrap();
    socket
}

/// Passes over the plate at depths that change, so that every pass is sent.
fn program() -> String {
    let mut text = String::from(
        "BEGIN PGM LIVE MM\nBLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+100 Y+80 Z+0\n\
         TOOL CALL 3 Z S2000\nL Z+50 R0 FMAX M3\nL X-20 Y+5 R0 FMAX\n",
    );
    for pass in 0..6_000 {
        let (y, z) = (pass * 7 % 80, 1.0 + 5.0 * f64::from(pass) / 6_000.0);
        let x = if pass % 2 == 0 { 120 } else { -20 };
        text += &format!("L Y+{y} Z-{z:.3} F900\nL X{x:+}\n");
    }
    text + "L Z+50 R0 FMAX M2\nEND PGM LIVE MM\n"
}

#[test]
fn a_viewer_that_does_not_read_gets_the_newest() {
    let panel = Panel::with(|folder| std::fs::write(folder.join("programs/LIVE.H"), program()).unwrap());
    panel.to_manual();
    panel.press("TEST");
    panel.press("GRAPHICS");
    panel.choose("LIVE");
    let mut slow = looks(&panel, "slow");
    let mut quick = looks(&panel, "quick");
    // The part as it is in the end, when there is one.
    let last: Arc<OnceLock<Vec<u16>>> = Arc::default();
    let along: Arc<AtomicUsize> = Arc::default();
    let (own, cells) = (Arc::clone(&last), Arc::clone(&along));
    let reads = std::thread::spawn(move || {
        let mut looker = Looker::default();
        while !looker.has(own.get()) {
            looker.read(&mut quick);
            cells.store(looker.cells[0], Ordering::Relaxed);
        }
        looker
    });
    let memory = panel.memory_kib();
    panel.press("START");
    panel.until(|screen| screen["graphics"]["progress"] == 1.0);
    while along.load(Ordering::Relaxed) == 0 {
        std::thread::sleep(Duration::from_millis(10));
    }
    last.set(panel.heights(along.load(Ordering::Relaxed))).unwrap();
    let quick = reads.join().unwrap();
    let grown = panel.memory_kib().saturating_sub(memory);

    let mut late = Looker::default();
    while !late.has(last.get()) {
        late.read(&mut slow);
    }
    println!(
        "quick: {} parts, {} bytes; slow: {} parts, {} bytes; {grown} KiB more",
        quick.parts, quick.bytes, late.parts, late.bytes
    );
    // What was in transit is kept for him: what the system holds, twice the bytes that the server asks of it, and the part that was
    // being sent; then comes the newest. How many parts another one sees meanwhile depends on the processor.
    let in_transit = 2 * (256 << 10) + 2 * (8 << 10);
    assert!(
        late.bytes <= in_transit + 2 * late.longest && late.parts <= quick.parts,
        "{} parts, {} bytes, the longest {}; of {} parts",
        late.parts,
        late.bytes,
        late.longest,
        quick.parts
    );
}
