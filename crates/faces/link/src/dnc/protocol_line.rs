//! A line of blocks that a protocol makes of a channel.

use std::collections::VecDeque;
use std::io::{self, Write};
use std::mem::take;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::{Arrival, BlockLine};
use crate::blockwise::{self, Want};
use crate::channel::{Channel, Happened};
use crate::files::{Files, Listed, NewFile};
use crate::protocol::{Event, Protocol, Shown};
use crate::settings::Settings;
use crate::{FileType, standard};
use bahn_parameters::MessageId;
use bahn_store::StoreError;

/// Lines of the standard protocol that wait before the device is stopped *(inferred)*.
const LINES: usize = 32;
/// What a device must still read when the transfer is over has this time to go out.
const LAST: Duration = Duration::from_millis(500);
/// One look at a line that has something to send.
const LOOK: Duration = Duration::from_millis(20);

/// Blocks that have come, and that no more comes.
#[derive(Debug, Default)]
struct Came {
    blocks: VecDeque<Vec<u8>>,
    complete: bool,
}

type Shared = Arc<Mutex<Came>>;

fn lock(shared: &Shared) -> std::sync::MutexGuard<'_, Came> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Where a protocol puts the only file that is read: its lines are blocks that wait.
struct Blocks(Shared);

impl Files for Blocks {
    fn list(&mut self) -> Vec<Listed> {
        Vec::new()
    }

    fn open(&mut self, name: &str) -> Result<Box<dyn io::Read + Send>, StoreError> {
        Err(StoreError::NoFile(name.to_owned()))
    }

    fn create(&mut self, _name: &str) -> Result<Box<dyn NewFile>, StoreError> {
        Ok(Box::new(Incoming {
            came: Arc::clone(&self.0),
            line: Vec::new(),
        }))
    }
}

/// The program that is read.
struct Incoming {
    came: Shared,
    line: Vec<u8>,
}

impl Write for Incoming {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for byte in bytes {
            match byte {
                b'\n' => lock(&self.came).blocks.push_back(take(&mut self.line)),
                byte => self.line.push(*byte),
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl NewFile for Incoming {
    fn commit(self: Box<Self>) -> Result<(), StoreError> {
        lock(&self.came).complete = true;
        Ok(())
    }
}

/// The control's side of a transfer over a channel, by the protocol of its settings.
pub struct ProtocolLine {
    channel: Channel,
    settings: Settings,
    protocol: Option<Box<dyn Protocol>>,
    came: Shared,
    /// A block was handed on and is not acknowledged.
    open: bool,
    message: Option<Shown>,
    over: bool,
    by_rts: bool,
}

impl ProtocolLine {
    /// A line on an open channel.
    pub fn new(channel: Channel, settings: Settings) -> ProtocolLine {
        ProtocolLine {
            channel,
            settings,
            protocol: None,
            came: Shared::default(),
            open: false,
            message: None,
            over: true,
            by_rts: false,
        }
    }

    fn waiting(&self) -> usize {
        lock(&self.came).blocks.len()
    }

    /// Hands on what has come and what is to be sent, and waits as long as this at most.
    fn pump(&mut self, at_most: Duration) {
        let now = self.channel.now();
        let mut wait = at_most;
        if let Some(protocol) = &mut self.protocol {
            while let Some(byte) = self.channel.receive() {
                protocol.receive(byte, now);
            }
            protocol.clock(now);
            while let Some(event) = protocol.event() {
                match event {
                    Event::Message(shown) => self.message = Some(shown),
                    Event::Ended(_) => self.over = true,
                    Event::Question(_) => protocol.answer(true, now),
                    _ => {}
                }
            }
        }
        self.hold_back();
        if let Some(protocol) = &mut self.protocol {
            if protocol.has_stopped_by_rts() != self.by_rts {
                self.by_rts = !self.by_rts;
                self.channel.request_to_send(!self.by_rts);
            }
            if self.channel.is_connected() && protocol.has_output() {
                let room = self.channel.room();
                let mut buffer = Vec::new();
                if room > 0 {
                    protocol.send(room, now, &mut buffer);
                    self.channel.send(&buffer);
                }
                if protocol.has_output() {
                    wait = wait.min(self.channel.until_room());
                }
            }
            if let Some(deadline) = protocol.deadline() {
                wait = wait.min(deadline.saturating_sub(self.channel.now()));
            }
        }
        if self.waiting() > 0 {
            wait = Duration::ZERO;
        }
        match self.channel.wait(wait) {
            Ok(Happened::Nothing) => {}
            Ok(Happened::Opened) => {
                let now = self.channel.now();
                if let Some(protocol) = self.protocol.as_mut().filter(|_| !self.over) {
                    protocol.plugged(now);
                }
            }
            Ok(Happened::Closed) => self.unplugged(),
            Err(error) => {
                self.message.get_or_insert(Shown::Device(error.to_string()));
                self.over = true;
            }
        }
    }

    /// What is between a block and its acknowledgement holds the device back.
    fn hold_back(&mut self) {
        let waiting = self.waiting() + usize::from(self.open);
        let Some(protocol) = &mut self.protocol else {
            return;
        };
        if !self.settings.blockwise {
            protocol.hold(waiting > LINES);
        } else if waiting == 0 {
            // What was no block of the program is acknowledged at once.
            protocol.hold(false);
            protocol.hold(true);
        }
    }

    fn unplugged(&mut self) {
        let now = self.channel.now();
        let Some(protocol) = &mut self.protocol else {
            return;
        };
        while let Some(byte) = self.channel.receive() {
            protocol.receive(byte, now);
        }
        protocol.unplugged(now);
        while let Some(event) = protocol.event() {
            if let Event::Message(shown) = event {
                self.message = Some(shown);
            }
        }
        self.over = true;
    }

    /// What has become of the transfer, when it is over.
    fn end(&self) -> Arrival {
        match lock(&self.came).complete {
            true => Arrival::End,
            false => Arrival::Broken(self.shown()),
        }
    }

    /// The message of a transfer that was broken off.
    fn shown(&self) -> String {
        let shown = self.message.clone();
        let shown = shown.unwrap_or(Shown::Control(MessageId::ProgramIncomplete, None));
        shown.text(self.settings.model)
    }
}

impl BlockLine for ProtocolLine {
    fn is_connected(&mut self) -> bool {
        self.channel.is_connected()
    }

    fn ask_for(&mut self, name: &str) {
        let extension = name.rsplit_once('.').map_or("H", |(_, extension)| extension);
        let programs = FileType::of_extension("H");
        let Some(kind) = FileType::of_extension(extension).or(programs) else {
            return;
        };
        self.came = Shared::default();
        let files = Box::new(Blocks(Arc::clone(&self.came)));
        let want = Want::Selected(match name.contains('.') {
            true => name.to_owned(),
            false => format!("{name}.{extension}"),
        });
        let settings = self.settings;
        let mut protocol: Box<dyn Protocol> = match settings.blockwise {
            true => Box::new(blockwise::Reading::new(settings, files, want, kind)),
            false => Box::new(standard::Reading::new(settings, files, want, kind)),
        };
        protocol.hold(settings.blockwise);
        if self.channel.is_connected() {
            protocol.plugged(self.channel.now());
        }
        self.protocol = Some(protocol);
        (self.open, self.over, self.message) = (false, false, None);
    }

    fn look(&mut self, at_most: Duration) -> Arrival {
        let end = self.channel.now() + at_most;
        loop {
            let left = end.saturating_sub(self.channel.now());
            self.pump(left);
            if let Some(block) = lock(&self.came).blocks.pop_front() {
                self.open = true;
                return Arrival::Block(block);
            }
            if self.over && self.protocol.is_some() {
                return self.end();
            }
            if left.is_zero() {
                return Arrival::Nothing;
            }
        }
    }

    fn watch(&mut self, at_most: Duration) -> Option<String> {
        self.pump(at_most);
        let whole = lock(&self.came).complete;
        (self.over && !whole).then(|| self.shown())
    }

    fn acknowledge(&mut self) {
        self.open = false;
        self.hold_back();
    }

    fn give_up(&mut self) {
        let now = self.channel.now();
        if let Some(protocol) = self.protocol.as_mut().filter(|_| !self.over) {
            protocol.end(now);
        }
        self.over = true;
        // EOT goes out.
        let end = now + LAST;
        let unsent = |line: &ProtocolLine| {
            let output = line
                .protocol
                .as_ref()
                .is_some_and(|protocol| protocol.has_output());
            line.channel.is_connected() && (output || !line.channel.is_written())
        };
        while unsent(self) && self.channel.now() < end {
            lock(&self.came).blocks.clear();
            self.pump(LOOK);
        }
    }
}
