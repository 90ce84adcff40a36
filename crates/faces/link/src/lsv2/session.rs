//! What one connection may do and does: a telegram in, at most one out.
//!
//! Decision: The key lock of LSV/2 is among hosts, and ends with the connection; the operator's keys are not locked

use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::transfer::{Receiving, Sending};
use super::{Command, Device, ErrorNumber, Level, Passwords, Telegram};
use bahn_store::Place;

/// A telegram at most, before the client asks for more: length, command and data (public).
pub(super) const BLOCK: usize = 256;
/// Bytes of the status that a client may set and read back (public).
const STATUS: usize = 12;
/// Wrong passwords of one connection, after which it is closed.
const WRONG_PASSWORDS: u32 = 5;

/// What all connections to a machine share.
pub struct Site {
    /// The machine that answers.
    pub device: Arc<dyn Device>,
    /// Passwords of the levels.
    pub passwords: Passwords,
    /// The connection that has locked the keys.
    locked: Mutex<Option<u64>>,
    /// Connections that take messages of the PLC.
    hosts: AtomicUsize,
    connections: AtomicU64,
}

impl Site {
    /// A machine and who may come in.
    pub fn new(device: Arc<dyn Device>, passwords: Passwords) -> Site {
        Site {
            device,
            passwords,
            locked: Mutex::default(),
            hosts: AtomicUsize::new(0),
            connections: AtomicU64::new(0),
        }
    }

    fn locked(&self) -> MutexGuard<'_, Option<u64>> {
        self.locked.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// One more or one less takes messages of the PLC.
    fn count_host(&self, comes: bool) {
        let before = match comes {
            true => self.hosts.fetch_add(1, Ordering::AcqRel),
            false => self.hosts.fetch_sub(1, Ordering::AcqRel),
        };
        if before == usize::from(!comes) {
            self.device.host_is_there(comes);
        }
    }
}

/// What a connection is in the middle of.
#[derive(Default)]
pub(super) enum Task {
    /// No answer is sent.
    #[default]
    None,
    /// Telegrams that go out one by one, each when the one before is confirmed.
    Listing(VecDeque<Telegram>),
    /// A file goes out.
    Sending(Sending),
    /// A file comes in.
    Receiving(Receiving),
}

/// What a command leads to: a telegram, or the number of the error.
pub(super) type Answer = Result<Telegram, ErrorNumber>;

/// A connection: logins, folder, what it is in the middle of.
pub struct Session {
    pub(super) site: Arc<Site>,
    number: u64,
    pub(super) levels: Vec<Level>,
    /// Where paths without a drive begin.
    pub(super) folder: Place,
    /// A telegram at most.
    pub(super) block: usize,
    /// The end of a file that comes in is answered.
    pub(super) secure: bool,
    pub(super) task: Task,
    /// The message that is sent next.
    pub(super) next_message: usize,
    pub(super) status: [u8; STATUS],
    wrong_passwords: u32,
}

impl Session {
    /// A connection to a machine, without any login.
    pub fn new(site: &Arc<Site>) -> Session {
        Session {
            number: site.connections.fetch_add(1, Ordering::Relaxed),
            levels: Vec::new(),
            folder: site.device.store().root(),
            block: BLOCK,
            secure: false,
            task: Task::None,
            next_message: 0,
            status: [0; STATUS],
            wrong_passwords: 0,
            site: Arc::clone(site),
        }
    }

    /// Logs in: name of the level, and its password.
    pub(super) fn log_in(&mut self, telegram: &Telegram) -> Answer {
        let mut fields = telegram.fields();
        let name = fields.string().ok_or(ErrorNumber::BAD_FORMAT)?;
        let level: Level = name.parse().map_err(|_| ErrorNumber::WRONG_PARAMETER)?;
        let password = fields.string().unwrap_or_default();
        if !self.site.passwords.admit(level, &password) {
            self.wrong_passwords += 1;
            return Err(ErrorNumber::WRONG_PASSWORD);
        }
        if !self.has(level) {
            self.levels.push(level);
            if level == Level::Dnc {
                self.site.count_host(true);
            }
        }
        Ok(Telegram::new(Command::T_OK))
    }

    /// Logs out of a level, or of all.
    pub(super) fn log_out(&mut self, telegram: &Telegram) -> Answer {
        match telegram.fields().string() {
            Some(name) if !name.is_empty() => {
                let level: Level = name.parse().map_err(|_| ErrorNumber::WRONG_PARAMETER)?;
                self.leave(Some(level));
            }
            _ => self.leave(None),
        }
        Ok(Telegram::new(Command::T_OK))
    }

    fn leave(&mut self, level: Option<Level>) {
        let was_host = self.has(Level::Dnc);
        self.levels
            .retain(|known| level.is_some_and(|level| level != *known));
        if was_host && !self.has(Level::Dnc) {
            self.site.count_host(false);
        }
        if !self.has(Level::Monitor) && !self.has(Level::Diagnostics) {
            self.unlock_keys();
        }
    }

    /// Whether a login holds.
    pub(super) fn has(&self, level: Level) -> bool {
        self.levels.contains(&level)
    }

    /// Whether it takes messages of the PLC, and is in the middle of nothing.
    pub(crate) fn takes_messages(&self) -> bool {
        self.has(Level::Dnc) && matches!(self.task, Task::None)
    }

    /// Somebody is logged in.
    pub(crate) fn is_logged_in(&self) -> bool {
        !self.levels.is_empty()
    }

    /// Wrong passwords so far: each costs time.
    pub(crate) fn wrong_passwords(&self) -> u32 {
        self.wrong_passwords
    }

    /// Too many wrong passwords: the connection ends.
    pub fn is_over(&self) -> bool {
        self.wrong_passwords >= WRONG_PASSWORDS
    }

    /// Locks the keys for everybody else, or unlocks them.
    pub(super) fn lock_keys(&mut self, on: bool) -> Result<(), ErrorNumber> {
        let mut locked = self.site.locked();
        if locked.is_some_and(|owner| owner != self.number) {
            return Err(ErrorNumber::KEY_REFUSED);
        }
        *locked = on.then_some(self.number);
        Ok(())
    }

    /// Whether this connection may press keys.
    pub(super) fn has_keys(&self) -> bool {
        self.site.locked().is_none_or(|owner| owner == self.number)
    }

    fn unlock_keys(&mut self) {
        let mut locked = self.site.locked();
        if *locked == Some(self.number) {
            *locked = None;
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.leave(None);
    }
}
