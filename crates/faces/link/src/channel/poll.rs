//! Waiting for a file of the operating system, and what comes of it.

use std::io;
use std::os::fd::AsFd;
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};

/// The result of a read that does not wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Got {
    /// So many bytes were read.
    Bytes(usize),
    /// No bytes are there yet.
    Nothing,
    /// A peer has connected.
    Opened,
    /// The peer is gone.
    Closed,
}

/// Waits until something can be read, at most so long.
pub(super) fn readable(file: &impl AsFd, wait: Duration) -> io::Result<()> {
    wait_for(file, PollFlags::IN, wait).map(drop)
}

/// Waits until something can be written, at most so long.
pub(super) fn writable(file: &impl AsFd, wait: Duration) -> io::Result<()> {
    wait_for(file, PollFlags::OUT, wait).map(drop)
}

/// Waits for one of these; what came may be a hang-up, too.
pub(super) fn wait_for(file: &impl AsFd, what: PollFlags, wait: Duration) -> io::Result<PollFlags> {
    let mut files = [PollFd::new(file, what)];
    let time = Timespec {
        tv_sec: i64::try_from(wait.as_secs()).unwrap_or(i64::MAX),
        tv_nsec: wait.subsec_nanos().into(),
    };
    match poll(&mut files, Some(&time)) {
        Ok(_) | Err(rustix::io::Errno::INTR) => {
            let [file] = &files;
            Ok(file.revents())
        }
        Err(error) => Err(error.into()),
    }
}

/// Nothing is there yet.
pub(super) fn nothing(error: &io::Error) -> Option<Got> {
    use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    matches!(error.kind(), WouldBlock | TimedOut | Interrupted).then_some(Got::Nothing)
}
