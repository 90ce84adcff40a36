//! Which telegram needs which login, and what it does.

use std::sync::Arc;

use super::session::{Answer, Session, Task};
use super::{Command, ErrorNumber, Level, Telegram, file_commands, machine_commands, memory};

/// Who may send a telegram.
enum Who {
    /// Allowed without a login.
    All,
    /// Who is logged in anywhere.
    Any,
    /// Who is logged in there.
    In(&'static [Level]),
}

/// A telegram that is known.
struct Known {
    command: &'static [u8; 4],
    who: Who,
    act: fn(&mut Session, &Telegram) -> Answer,
}

/// The logins that have what INSPECT has (public).
const INSPECT: Who = Who::In(&[
    Level::Inspect,
    Level::Diagnostics,
    Level::File,
    Level::FilePlc,
    Level::Monitor,
    Level::PlcDebug,
]);
const FILE: Who = Who::In(&[Level::File, Level::FilePlc]);
const DNC: Who = Who::In(&[Level::Dnc]);
const KEYS: Who = Who::In(&[Level::Monitor, Level::Diagnostics]);
const DIAGNOSTICS: Who = Who::In(&[Level::Diagnostics]);
const PLC: Who = Who::In(&[Level::PlcDebug, Level::Inspect, Level::Diagnostics]);
const CHANGES: Who = Who::In(&[Level::PlcDebug]);
const DATA: Who = Who::In(&[Level::Data]);

macro_rules! known {
    ($($command:literal $who:expr, $act:path;)+) => {
        &[$(Known { command: $command, who: $who, act: $act }),+]
    };
}

/// All telegrams (public, [000:17514-17540]).
const KNOWN: &[Known] = known! {
    b"A_LG" Who::All, Session::log_in;
    b"A_LO" Who::Any, Session::log_out;
    b"R_ST" Who::Any, machine_commands::status;
    b"C_ST" Who::Any, machine_commands::set_status;
    b"R_VR" INSPECT, machine_commands::version;
    b"R_PR" INSPECT, memory::parameters;
    b"R_CI" INSPECT, machine_commands::configuration;
    b"R_MC" INSPECT, machine_commands::parameter;
    b"R_MP" INSPECT, machine_commands::parameter;
    b"C_MC" CHANGES, machine_commands::set_parameter;
    b"R_MB" PLC, memory::block;
    b"R_DP" DATA, memory::data_path;
    b"R_RI" DNC, machine_commands::run;
    b"R_DT" DIAGNOSTICS, machine_commands::date;
    b"R_LB" DIAGNOSTICS, machine_commands::log_book;
    b"C_LK" KEYS, machine_commands::lock_keys;
    b"C_EK" KEYS, machine_commands::press;
    b"M_PC" DNC, machine_commands::message;
    b"X_PC" DNC, machine_commands::message_to_confirm;
    b"C_CC" Who::Any, machine_commands::system;
    b"R_DI" FILE, file_commands::folder;
    b"C_DC" FILE, file_commands::change_folder;
    b"C_DM" FILE, file_commands::make_folder;
    b"C_DD" FILE, file_commands::remove_folder;
    b"R_DR" FILE, file_commands::list;
    b"R_FI" FILE, file_commands::file;
    b"R_FL" FILE, file_commands::send;
    b"C_FL" FILE, file_commands::receive;
    b"C_FD" FILE, file_commands::delete;
    b"C_FR" FILE, file_commands::rename;
    b"C_FC" FILE, file_commands::copy;
    b"C_FA" FILE, file_commands::change_attributes;
};

/// What belongs to a transfer, and comes without one.
const OF_A_TRANSFER: [&[u8; 4]; 5] = [b"S_FL", b"T_OK", b"T_FD", b"T_ER", b"T_BD"];

/// The telegram of a command; those of a transfer are not expected outside.
fn find(command: Command) -> Option<&'static Known> {
    const UNEXPECTED: &Known = &Known {
        command: b"T_OK",
        who: Who::All,
        act: |_, _| Err(ErrorNumber::UNEXPECTED),
    };
    let known = KNOWN.iter().find(|known| *known.command == command.0);
    known.or_else(|| OF_A_TRANSFER.contains(&&command.0).then_some(UNEXPECTED))
}

impl Known {
    /// Whether one of these logins allows it.
    fn admits(&self, levels: &[Level]) -> Result<(), ErrorNumber> {
        match &self.who {
            Who::All => Ok(()),
            _ if levels.is_empty() => Err(ErrorNumber::NO_LOGIN),
            Who::In(wanted) if !levels.iter().any(|level| wanted.contains(level)) => {
                Err(ErrorNumber::NO_PRIVILEGE)
            }
            Who::Any | Who::In(_) => Ok(()),
        }
    }
}

impl Session {
    /// Takes a telegram; what is to be answered, if anything is.
    pub fn take(&mut self, telegram: &Telegram) -> Option<Telegram> {
        let device = Arc::clone(&self.site.device);
        let changes = device.store().changes();
        let answer = self.answer(telegram);
        if device.store().changes() != changes {
            device.files_changed();
        }
        answer
    }

    fn answer(&mut self, telegram: &Telegram) -> Option<Telegram> {
        // A transfer takes its own telegrams; any other ends it.
        match (std::mem::take(&mut self.task), &telegram.command.0) {
            (Task::Listing(mut telegrams), b"T_OK") => {
                let next = telegrams.pop_front();
                self.task = Task::Listing(telegrams);
                Some(next.unwrap_or_else(|| self.end()))
            }
            (Task::Sending(mut sending), b"T_OK") => {
                let next = sending.next(self.block);
                self.task = Task::Sending(sending);
                Some(match next {
                    Ok(Some(block)) => block,
                    Ok(None) => self.end(),
                    Err(error) => {
                        self.task = Task::None;
                        error.of_block()
                    }
                })
            }
            (Task::Listing(_) | Task::Sending(_), b"T_ER" | b"T_BD" | b"T_FD") => None,
            (Task::Receiving(mut receiving), b"S_FL") => match receiving.take(&telegram.data) {
                Ok(()) => {
                    self.task = Task::Receiving(receiving);
                    Some(Telegram::new(Command::T_OK))
                }
                Err(error) => Some(error.of_block()),
            },
            (Task::Receiving(receiving), b"T_FD") => {
                let answer = match receiving.end() {
                    Ok(()) => Telegram::new(Command::T_OK),
                    Err(error) => error.telegram(),
                };
                self.secure.then_some(answer)
            }
            // The client has broken off: nothing of the file is left.
            (Task::Receiving(_), b"T_ER" | b"T_BD") => Some(Telegram::new(Command::T_OK)),
            _ => Some(self.command(telegram).unwrap_or_else(ErrorNumber::telegram)),
        }
    }

    fn end(&mut self) -> Telegram {
        self.task = Task::None;
        Telegram::new(Command::T_FD)
    }

    fn command(&mut self, telegram: &Telegram) -> Answer {
        let known = find(telegram.command).ok_or(ErrorNumber::UNKNOWN)?;
        known.admits(&self.levels)?;
        (known.act)(self, telegram)
    }
}
