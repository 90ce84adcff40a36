//! A protocol on a channel: what comes is handed to it, what it answers is sent, and it is given the time.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crate::channel::{Channel, Happened};
use crate::protocol::{Event, Protocol};

/// How often one looks whether the process is to end.
const LOOK: Duration = Duration::from_millis(100);

/// What observes the bytes that pass: `true` when they were sent.
pub type Tap<'a> = &'a mut dyn FnMut(bool, u8, Duration);

/// Who gets the events, and answers questions.
pub trait Attendant {
    /// Something has happened; the answer to a question, which may come later by [`Attendant::answer`].
    fn event(&mut self, event: Event) -> Option<bool>;
    /// An answer that has come meanwhile.
    fn answer(&mut self) -> Option<bool> {
        None
    }
    /// Whether it is over, now that the protocol has nothing to do.
    fn is_over(&mut self, connected: bool, now: Duration) -> bool;
}

/// Drives a protocol until who attends says that it is over, or somebody stops it.
///
/// # Errors
/// When the channel does not work any more.
pub fn drive(
    channel: &mut Channel,
    protocol: &mut dyn Protocol,
    attendant: &mut dyn Attendant,
    stop: &AtomicBool,
    tap: Tap<'_>,
) -> io::Result<()> {
    let mut buffer = Vec::new();
    let mut by_rts = false;
    if channel.is_connected() {
        protocol.plugged(channel.now());
    }
    while !stop.load(Ordering::Relaxed) {
        let now = channel.now();
        while let Some(byte) = channel.receive() {
            tap(false, byte, now);
            protocol.receive(byte, now);
        }
        protocol.clock(now);
        while let Some(event) = protocol.event() {
            if let Some(yes) = attendant.event(event) {
                protocol.answer(yes, now);
            }
        }
        if let Some(yes) = attendant.answer() {
            protocol.answer(yes, now);
        }
        if protocol.has_stopped_by_rts() != by_rts {
            by_rts = !by_rts;
            channel.request_to_send(!by_rts);
        }
        channel.set_transparent(protocol.is_transparent());
        let mut wait = LOOK;
        if channel.is_connected() && protocol.has_output() {
            let room = channel.room();
            if room > 0 {
                buffer.clear();
                protocol.send(room, now, &mut buffer);
                buffer.iter().for_each(|byte| tap(true, *byte, now));
                channel.send(&buffer);
            }
            wait = if protocol.has_output() {
                channel.until_room().min(LOOK)
            } else {
                Duration::ZERO
            };
        } else if protocol.is_idle() && channel.is_written() && attendant.is_over(channel.is_connected(), now)
        {
            return Ok(());
        }
        if let Some(deadline) = protocol.deadline() {
            wait = wait.min(deadline.saturating_sub(channel.now()));
        }
        wait = protocol.patience().map_or(wait, |patience| wait.min(patience));
        match channel.wait(wait)? {
            Happened::Nothing => {}
            Happened::Opened => protocol.plugged(channel.now()),
            Happened::Closed => {
                let now = channel.now();
                while let Some(byte) = channel.receive() {
                    tap(false, byte, now);
                    protocol.receive(byte, now);
                }
                protocol.unplugged(now);
            }
        }
    }
    let now = channel.now();
    protocol.end(now);
    buffer.clear();
    protocol.send(usize::MAX, now, &mut buffer);
    buffer.iter().for_each(|byte| tap(true, *byte, now));
    channel.send(&buffer);
    channel.wait(Duration::ZERO).map(drop)
}
