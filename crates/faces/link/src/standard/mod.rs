//! The standard protocol: ME, and EXT with MP5030 = 0 [000:17240-17349].
//!
//! Text goes as it is, with CR LF after each line and nothing to check it by. `items`: what comes; `reading` and `writing`:
//! the control; `peripheral`: the device, and a control that obeys.
//!
//! Decision: A standard device that has sent its text answers the next DC1 with ETX alone until EOT; a control that
//! reads all ends when a device stays silent after ETX, where the operator would press END
//!
//! Decision: After DC3 Bahn sends 12 characters at most; what comes to it after its own DC3 is kept, however much it
//! is

mod items;
mod peripheral;
mod reading;
mod writing;

pub use peripheral::Peripheral;
pub use reading::Reading;
pub use writing::Writing;

use std::collections::VecDeque;

use crate::settings::Settings;
use crate::text::Source;

/// NUL characters before a file [000:17250-17253].
const NULS: usize = 50;
/// Bytes that may wait while the operator is asked; a device that does not stop is held up by its channel.
const HELD_MAX: usize = 1 << 20;

/// Queues a file from its NULs to its last line, a line at a time.
struct Outgoing {
    bytes: VecDeque<u8>,
    source: Option<Source>,
    /// Stopped by DC3 or ready to go on.
    stopped: bool,
}

impl Outgoing {
    fn new() -> Outgoing {
        Outgoing {
            bytes: VecDeque::new(),
            source: None,
            stopped: false,
        }
    }

    /// Begins to send a file.
    fn begin(&mut self, source: Source) {
        self.bytes.extend([0; NULS]);
        self.source = Some(source);
    }

    /// Puts the next line there when the last one has gone; `true` when a file has come to its end.
    fn refill(&mut self) -> std::io::Result<bool> {
        while self.bytes.is_empty()
            && let Some(source) = &mut self.source
        {
            match source.next()? {
                Some(line) => self.bytes.extend(line.iter().chain(b"\r\n")),
                None => {
                    self.source = None;
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    fn has_output(&self) -> bool {
        !self.stopped && !self.bytes.is_empty()
    }

    /// Not more than may still come after a DC3, so that one is seen in time.
    fn take(&mut self, room: usize, into: &mut Vec<u8>) {
        if !self.stopped {
            let count = room.min(crate::AFTER_DC3).min(self.bytes.len());
            into.extend(self.bytes.drain(..count));
        }
    }

    fn clear(&mut self) {
        *self = Outgoing::new();
    }
}

/// The characters that end an output: ME cannot process EOT [000:17262-17264].
fn end_of_output(settings: &Settings) -> Vec<u8> {
    let control = &settings.control;
    match settings.never_eot {
        true => vec![control.etx],
        false => vec![control.etx, control.eot],
    }
}
