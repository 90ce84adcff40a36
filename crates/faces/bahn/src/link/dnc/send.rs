//! `bahn link dnc send`: a folder of programs for controls that execute them while they come.

use std::time::Duration;

use bahn_link::blockwise::{self, Rights};
use bahn_link::dnc::{Spool, Spooled};
use bahn_link::{Attendant, Ended, Event, Files, Protocol, drive, standard};
use bahn_parameters::ControlModel;
use serde::Serialize;

use super::options::DncSendOptions;
use super::port;
use crate::files::{self, Loaded};
use crate::interrupt::Interrupt;
use crate::link::port as link_port;
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};

/// How often progress is told.
const PERIOD: Duration = Duration::from_secs(1);
/// How long a connection that is made again must hold to count as one.
const HOLDS: Duration = Duration::from_secs(1);

/// Sends programs block by block to a control that executes them.
pub(super) fn command(options: &DncSendOptions) -> Result<Outcome, UsageError> {
    let store = link_port::disk(&options.dir)?;
    let mut spool = Spool::new(Box::new(store), options.resume);
    if let Some(missing) = options.names.iter().find(|name| spool.find(name).is_none()) {
        let folder = options.dir.display();
        return Err(UsageError::new(format!(
            "there is no program {missing} in {folder}"
        )));
    }
    if let Some(name) = options.names.iter().find(|name| is_din(options, name)) {
        return Err(UsageError::new(format!(
            "{name} is a program of DIN 66025, which no control executes while it comes: `bahn link send --as host` \
             brings it into the memory"
        )));
    }
    let Ok(list) = link_port::list(options.parameters.as_deref()) else {
        return Ok(Outcome::ProgramError);
    };
    let Some((mut channel, settings)) = port::open(&options.port, &list) else {
        return Ok(Outcome::ProgramError);
    };
    let teller = Teller {
        format: options.format,
        spooled: spool.spooled(),
    };
    let rights = Rights {
        gives: true,
        takes: false,
        only: options.names.clone(),
        asks: false,
    };
    let files = Box::new(spool);
    let mut protocol: Box<dyn Protocol> = match settings.blockwise {
        true => Box::new(blockwise::Peripheral::new(settings, files, rights)),
        false => Box::new(standard::Peripheral::new(settings, files, rights)),
    };
    let mut sender = Sender {
        teller: teller.clone(),
        missing: options.names.clone(),
        endless: options.names.is_empty(),
        again: Again {
            within: options
                .port
                .starts_with("connect:")
                .then(|| Duration::from_secs(options.again)),
            lost: None,
            held: None,
        },
        blocks: 0,
    };
    let interrupt = Interrupt::on_ctrl_c();
    let mut reported = Duration::ZERO;
    let mut before = 0;
    let mut tap = |_: bool, _: u8, now: Duration| {
        if now.saturating_sub(reported) >= PERIOD {
            reported = now;
            let blocks = teller.spooled.progress().blocks;
            if std::mem::replace(&mut before, blocks) != blocks {
                teller.tell("progress");
            }
        }
    };
    let driven = drive(
        &mut channel,
        &mut *protocol,
        &mut sender,
        &interrupt.flag(),
        &mut tap,
    );
    if let Err(error) = &driven {
        diagnostics::print_line(&format!("error: {}: {error}", options.port));
    }
    sender.done(options.format)?;
    Ok(match driven {
        _ if sender.has_sent_all() => Outcome::Fine,
        Err(_) => Outcome::ProgramError,
        Ok(()) if interrupt.is_requested() => Outcome::Interrupted,
        Ok(()) => Outcome::ProgramError,
    })
}

/// Whether a program of the folder is in none of the control's languages.
fn is_din(options: &DncSendOptions, name: &str) -> bool {
    let program = files::named(&options.dir, name).and_then(|path| files::load_program(&path).ok());
    matches!(program, Some(Loaded::Program(program)) if program.dialect().is_some())
}

/// Tells how far a program is.
#[derive(Clone)]
struct Teller {
    format: Format,
    spooled: Spooled,
}

/// A line of progress.
#[derive(Serialize)]
struct Reported<'a> {
    event: &'a str,
    program: &'a str,
    blocks: u64,
    percent: f64,
}

impl Teller {
    fn tell(&self, event: &str) {
        let progress = self.spooled.progress();
        let percent = (progress.percent() * 10.0).round() / 10.0;
        // Whoever has closed the output knows.
        let _ = match self.format {
            Format::Text => {
                let what = match event {
                    "end" => "has arrived",
                    "broken" => "is broken off",
                    _ => "goes on",
                };
                console::print(&format!(
                    "{}: {what}, {} blocks are in the machine ({percent} %)\n",
                    progress.name, progress.blocks
                ))
            }
            Format::Json => console::print_json_line(&Reported {
                event,
                program: &progress.name,
                blocks: progress.blocks,
                percent,
            }),
        };
    }
}

/// Who attends the transfers.
struct Sender {
    teller: Teller,
    /// What was named and has not arrived.
    missing: Vec<String>,
    endless: bool,
    again: Again,
    /// Of all programs that have arrived.
    blocks: u64,
}

impl Sender {
    fn has_sent_all(&self) -> bool {
        !self.endless && self.missing.is_empty()
    }

    /// What is told at the end as JSON; people have seen it on the way.
    fn done(&self, format: Format) -> Result<(), UsageError> {
        match format {
            Format::Text => Ok(()),
            Format::Json => console::print_json_line(
                &serde_json::json!({ "event": "done", "blocks": self.blocks, "complete": self.has_sent_all() }),
            ),
        }
    }
}

/// How long one tries to connect again.
struct Again {
    /// For so long; who listens waits for ever.
    within: Option<Duration>,
    /// When the connection was lost.
    lost: Option<Duration>,
    /// Since when there is one again.
    held: Option<Duration>,
}

impl Again {
    /// Whether it was tried for long enough.
    fn is_in_vain(&mut self, connected: bool, now: Duration) -> bool {
        let Some(within) = self.within else { return false };
        if connected {
            if now - *self.held.get_or_insert(now) >= HOLDS {
                self.lost = None;
            }
            return false;
        }
        self.held = None;
        now - *self.lost.get_or_insert(now) >= within
    }
}

impl Attendant for Sender {
    fn event(&mut self, event: Event) -> Option<bool> {
        // Somebody is there.
        self.again.lost = None;
        match event {
            Event::Sent(name) => {
                self.teller.spooled.arrived(&name);
                self.blocks += self.teller.spooled.progress().blocks;
                self.teller.tell("end");
                self.missing
                    .retain(|missing| !missing.eq_ignore_ascii_case(&name));
            }
            Event::Ended(Ended::Incomplete) => {
                self.teller.spooled.broken_off();
                self.teller.tell("broken");
            }
            Event::Message(shown) => {
                diagnostics::print_line(&shown.text(ControlModel::default()));
            }
            _ => {}
        }
        None
    }

    fn is_over(&mut self, connected: bool, now: Duration) -> bool {
        self.has_sent_all() || self.again.is_in_vain(connected, now)
    }
}
