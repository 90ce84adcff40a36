//! The EMERGENCY STOP chain and the relay for the control voltage [000:6149-6228].
//!
//! The relay holds as long as the supply is there, the button is not pressed, no limit switch of the chain
//! is actuated and the control has switched "control is ready" on. Its contact is the acknowledgement I3
//! and feeds the drives and the outputs that an EMERGENCY STOP switches off.
//!
//! Decision: The chains of a control and its positioning module, whose circuit is lost [000:18093-18099], open each other:
//! button, limit switches and supply of one at once, its "control is ready" after a delay, so that the test at power-on,
//! which drops it for some 60 ms, does not reach the other

use bahn_servo::{INPUTS, OUTPUTS};

use crate::reader::{Contact, OUTPUT_LETTERS, Reader, Section};

/// How the relay can fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelayFault {
    /// It drops out only after so many milliseconds.
    Slow(u32),
    /// Its contacts are welded: it never drops out.
    Welded,
    /// It never pulls in.
    Open,
}

/// How a contact at an input can fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactFault {
    /// It always reads so.
    Stuck(bool),
    /// It chatters: every [`ContactFault::CHATTER_US`] it reads the other way.
    Bouncing,
}

impl ContactFault {
    /// So long a chattering contact stays as it is, µs.
    pub const CHATTER_US: u64 = 17_000;

    /// What is read of a contact at a time that would read `level`.
    pub(crate) fn level(self, time_us: u64, level: bool) -> bool {
        match self {
            ContactFault::Stuck(level) => level,
            ContactFault::Bouncing => level ^ (time_us / ContactFault::CHATTER_US % 2 == 1),
        }
    }
}

/// What one machine puts into the EMERGENCY STOP chain of another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interlock {
    /// Supply, button and limit switches let its chain close.
    pub path: bool,
    /// Its control has switched "control is ready" on.
    pub ready: bool,
    /// Its relay has closed: it has control voltage.
    pub voltage: bool,
}

/// How the other machine is wired to this one.
#[derive(Clone, Copy, Debug)]
struct Coupled {
    other: Interlock,
    /// How long its control may be not ready until this chain opens.
    delay_ms: u32,
    /// How long it has been.
    missing_ms: u32,
    /// The input that tells of its control voltage.
    input: Option<usize>,
}

/// The chains of contacts; the module describes them.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    pub acknowledgement: Option<Contact>,
    /// The key that switches the control voltage on; without one it comes on by itself.
    key: Option<String>,
    limit_switches: bool,
    pull_in_ms: u32,
    drop_out_ms: u32,
    /// Outputs without voltage while the relay is off [000:2134-2174].
    switched: Vec<bool>,
    /// The description says which these are.
    switched_is_said: bool,

    pub supply: bool,
    pub button: bool,
    pub control_ready: bool,
    pub fault: Option<RelayFault>,
    relay: bool,
    changing_ms: u32,
    coupled: Option<Coupled>,
}

impl Chain {
    /// Reads `[emergency_stop]`; without it the usual values hold.
    pub fn read(root: &Section) -> Chain {
        let mut chain = Chain {
            acknowledgement: None,
            key: None,
            limit_switches: false,
            pull_in_ms: 15,
            drop_out_ms: 15,
            switched: vec![false; OUTPUTS],
            switched_is_said: false,
            supply: true,
            button: false,
            control_ready: false,
            fault: None,
            relay: false,
            changing_ms: 0,
            coupled: None,
        };
        let Some(section) = root.section("emergency_stop") else {
            root.fault("the machine needs [emergency_stop] with its acknowledgement, usually I3".to_owned());
            return chain;
        };
        if !section.has("acknowledgement") {
            section.fault("[emergency_stop] needs acknowledgement, usually \"I3\"".to_owned());
        }
        chain.acknowledgement = section.contact("acknowledgement");
        chain.key = section.text("control_voltage_key").map(str::to_owned);
        chain.limit_switches = section.flag("limit_switches").unwrap_or(false);
        let delay = |key| {
            section
                .number(key, 0.0..=10_000.0)
                .map_or(15, |delay| delay as u32)
        };
        chain.pull_in_ms = delay("pull_in_ms");
        chain.drop_out_ms = delay("drop_out_ms");
        chain.switched_is_said = section.has("switched_outputs");
        for (at, text) in section.texts("switched_outputs") {
            chain.read_switched(section.reader, at, text);
        }
        section.finish();
        chain
    }

    /// Reads which outputs are switched: `O5` or `O0-O23`.
    fn read_switched(&mut self, reader: &Reader, at: usize, text: &str) {
        let (first, last) = text.split_once('-').unwrap_or((text, text));
        let number = |text: &str| {
            let number: usize = text.trim().strip_prefix(OUTPUT_LETTERS)?.parse().ok()?;
            Some(number).filter(|number| *number < OUTPUTS)
        };
        match (number(first), number(last)) {
            (Some(first), Some(last)) if first <= last => {
                for switched in self.switched.iter_mut().take(last + 1).skip(first) {
                    *switched = true;
                }
            }
            _ => reader.fault(at, format!("`{text}` is no range of outputs like O0-O23")),
        }
    }

    /// Which outputs lose their voltage by their terminals, where the description does not say it.
    pub fn fit(&mut self, switched: impl Fn(usize) -> bool) {
        if !self.switched_is_said {
            self.switched = (0..OUTPUTS).map(switched).collect();
        }
    }

    /// The key of the control voltage, if there is one.
    pub fn key(&self) -> Option<&str> {
        self.key.as_deref()
    }

    /// The control voltage is on.
    pub fn voltage(&self) -> bool {
        self.relay
    }

    /// It wants to know whether limit switches are actuated.
    pub fn watches_limits(&self) -> bool {
        self.limit_switches
    }

    /// What the chain of another machine gets to know; `limits_clear`: no limit switch is actuated.
    pub fn interlock(&self, limits_clear: bool) -> Interlock {
        Interlock {
            path: self.supply && !self.button && (limits_clear || !self.limit_switches),
            ready: self.control_ready,
            voltage: self.relay,
        }
    }

    /// The contacts of another machine stand so from now on.
    pub fn couple(&mut self, other: Interlock, delay_ms: u32, input: Option<usize>) {
        let missing_ms = self.coupled.map_or(0, |coupled| coupled.missing_ms);
        self.coupled = Some(Coupled {
            other,
            delay_ms,
            missing_ms,
            input,
        });
    }

    /// Lets a millisecond pass at the contacts of another machine; whether they are closed.
    fn is_let(&mut self) -> bool {
        let Some(coupled) = &mut self.coupled else {
            return true;
        };
        coupled.missing_ms = match coupled.other.ready {
            true => 0,
            false => coupled.missing_ms.saturating_add(1),
        };
        coupled.other.path && coupled.missing_ms <= coupled.delay_ms
    }

    /// Lets a millisecond pass; whether the relay has switched.
    pub fn advance(&mut self, limits_clear: bool, key_pressed: bool) -> bool {
        let held = self.key.is_none() || self.relay || key_pressed;
        let let_by_other = self.is_let();
        let closed = self.interlock(limits_clear).path && self.control_ready && held && let_by_other;
        let wanted = match self.fault {
            Some(RelayFault::Welded) => self.supply && (closed || self.relay),
            Some(RelayFault::Open) => false,
            _ => closed,
        };
        if wanted == self.relay {
            self.changing_ms = 0;
            return false;
        }
        self.changing_ms += 1;
        let switches = self.changing_ms >= self.delay_ms();
        if switches {
            self.relay = wanted;
            self.changing_ms = 0;
        }
        switches
    }

    /// How long the relay takes to change.
    fn delay_ms(&self) -> u32 {
        match (self.relay, self.fault) {
            (false, _) => self.pull_in_ms,
            (true, Some(RelayFault::Slow(delay))) => delay,
            (true, _) => self.drop_out_ms,
        }
    }

    /// So many milliseconds the relay stays as it is, whatever the axes do. Nobody knows that of a chain with another
    /// machine in it.
    pub fn steady_ms(&self) -> u32 {
        match self.coupled {
            Some(_) => 0,
            None => self.delay_ms().saturating_sub(self.changing_ms + 1),
        }
    }

    /// What arrives of the PLC's outputs at the machine.
    pub fn live(&self, outputs: &[bool; OUTPUTS]) -> [bool; OUTPUTS] {
        let mut live = *outputs;
        if !self.relay {
            for (output, switched) in live.iter_mut().zip(&self.switched) {
                *output &= !switched;
            }
        }
        live
    }

    /// What the control sees at its acknowledgement: a wire that sticks at a level says the same to the NC as
    /// to the PLC.
    pub fn acknowledged(&self, stuck: &[(usize, ContactFault)], time_us: u64) -> bool {
        let level = self.acknowledgement.and_then(|contact| {
            let (_, fault) = stuck.iter().rev().find(|(input, _)| *input == contact.input())?;
            Some(contact.says(fault.level(time_us, contact.says(self.voltage()))))
        });
        level.unwrap_or_else(|| self.voltage())
    }

    pub fn set_inputs(&self, inputs: &mut [bool; INPUTS]) {
        if let Some(contact) = self.acknowledgement {
            contact.set(inputs, self.relay);
        }
        if let Some(coupled) = self.coupled
            && let Some(input) = coupled.input.and_then(|input| inputs.get_mut(input))
        {
            *input = coupled.other.voltage;
        }
    }
}
