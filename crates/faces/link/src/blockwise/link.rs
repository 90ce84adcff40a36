//! One end of a line with check characters: what comes in pieces, what goes out, and how long it has been quiet.
//!
//! Decision: Blocks have no numbers, so one is repeated for NAK only: a lost answer ends the transfer (E, M, N as
//! printed), a damaged frame, or one that stops halfway, is NAK after half the patience; answers that come before a
//! block is sent are those of a line that doubles

use std::collections::VecDeque;
use std::time::Duration;

use crate::DC1;
use crate::frame::{Decoder, Kind, Piece, encode};
use crate::settings::Settings;

/// So often the same block may be wrong: the third time is the last [000:17404-17405] [000:17584-17589].
pub(super) const TRIES: u8 = 3;

/// One end of the line.
#[derive(Debug)]
pub(super) struct Link {
    pub settings: Settings,
    decoder: Decoder,
    outgoing: VecDeque<u8>,
    /// The block that waits for its answer.
    block: Vec<u8>,
    /// How often it was sent, less one; or how often the block that is awaited was wrong.
    pub wrong: u8,
    /// Since when nothing has come or gone.
    quiet: Duration,
}

impl Link {
    pub fn new(settings: Settings) -> Link {
        Link {
            settings,
            decoder: Decoder::default(),
            outgoing: VecDeque::new(),
            block: Vec::new(),
            wrong: 0,
            quiet: Duration::ZERO,
        }
    }

    /// A byte has come; what it is a piece of, when that is whole.
    ///
    /// Answers that come before a block is sent are answers to nothing: the line has doubled one. Its check character ends a
    /// block; the DC1 after it may still be in transit.
    pub fn receive(&mut self, byte: u8, now: Duration) -> Option<Piece> {
        self.quiet = now;
        let piece = self.decoder.take(&self.settings, byte)?;
        let is_answer = matches!(piece, Piece::Ack | Piece::Nak);
        let is_sent = match self.outgoing.front() {
            None => true,
            Some(next) => *next == DC1 && self.outgoing.len() == 1,
        };
        (is_sent || !is_answer).then_some(piece)
    }

    /// Sends a block, which waits for its answer.
    pub fn send_block(&mut self, kind: Kind, text: &[u8]) {
        self.block = encode(&self.settings, kind, text);
        self.wrong = 0;
        self.outgoing.extend(&self.block);
    }

    /// Sends characters that wait for an answer.
    pub fn send_awaiting(&mut self, characters: &[u8]) {
        self.block = characters.to_vec();
        self.wrong = 0;
        self.outgoing.extend(characters);
    }

    /// The answer was NAK: sends the block again; `false` when that was the third one.
    pub fn repeat(&mut self) -> bool {
        self.wrong += 1;
        let again = self.wrong < TRIES;
        if again {
            self.outgoing.extend(&self.block);
        }
        again
    }

    /// Puts characters after those that wait for the line.
    pub fn send(&mut self, characters: &[u8]) {
        self.outgoing.extend(characters);
    }

    /// What came was right.
    pub fn acknowledge(&mut self) {
        self.wrong = 0;
        self.outgoing.push_back(self.settings.control.ack);
    }

    /// What came was wrong: NAK; `false` when that is the third time in sequence.
    pub fn refuse(&mut self) -> bool {
        self.wrong += 1;
        let again = self.wrong < TRIES;
        if again {
            self.outgoing.push_back(self.settings.control.nak);
        }
        again
    }

    /// Nothing more goes out of what is there.
    pub fn clear(&mut self) {
        self.outgoing.clear();
        self.decoder.reset();
        self.wrong = 0;
    }

    pub fn has_output(&self) -> bool {
        !self.outgoing.is_empty()
    }

    pub fn take(&mut self, room: usize, now: Duration, into: &mut Vec<u8>) {
        if self.outgoing.is_empty() {
            return;
        }
        let count = room.min(self.outgoing.len());
        into.extend(self.outgoing.drain(..count));
        self.quiet = now;
    }

    /// When it will have been quiet for so long.
    pub fn quiet_for(&self, limit: Duration) -> Option<Duration> {
        // While it sends it is not quiet.
        self.outgoing.is_empty().then(|| self.quiet + limit)
    }

    /// Whether a block has begun that is not yet whole.
    pub fn is_inside(&self) -> bool {
        self.decoder.is_inside()
    }

    /// A block that has begun does not come to its end: it counts as wrong.
    pub fn give_block_up(&mut self, now: Duration) {
        self.decoder.reset();
        self.quiet = now;
    }

    /// Within a block no character takes longer *(inferred)*; half of the patience of the other side, which waits for its
    /// answer.
    pub fn gap(&self) -> Duration {
        self.settings.patience / 2
    }
}
