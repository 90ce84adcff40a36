//! A positioning module beside the control that it belongs to: RS-422 between the PLC programs of both, and their EMERGENCY
//! STOP chains [000:17986-18115].
//!
//! Decision: The module begins with its control and follows it in the same time, a contour cycle after the other. The cable
//! joins the RS-422 ports, each as MP5020.2, MP5030.2 and MP5040 of its own control say; where rate or characters differ,
//! what comes is faulty. A control that is off is no ready device

use std::time::Duration;

use bahn_host::{Action, Host, HostError, ModuleFolder, Next, Notice, Reader, Source, Stamped};
use bahn_tnc::{Command, DataLineEvent, DataLineOrder, LineEvent, LineSetup, Switch};

use crate::characters::Characters;
use crate::plc_line::PlcLine;
use crate::settings::Settings;

/// Number of the interface RS-422/V.11 for modules 9100 to 9107 [000:15629].
const RS_422: usize = 1;

/// A positioning module that is on.
pub struct PositioningModule {
    /// The module: a control with its machine.
    pub host: Host,
    wiring: ModuleFolder,
    /// Of the control, and of the module.
    ends: [End; 2],
    /// Characters that have gone to the module, and to the control.
    characters: [u64; 2],
}

/// One end of the cable.
struct End {
    notices: Reader<Stamped>,
    line: PlcLine,
    /// How its PLC has the line.
    used: Option<Used>,
    /// Time of the cable that no character has used, µs.
    free_us: u64,
    /// The control was told that the other side is there.
    reported: bool,
}

/// How a PLC has a line.
#[derive(Clone, Copy, PartialEq)]
struct Used {
    baud: u32,
    characters: Characters,
}

impl End {
    fn new(host: &Host) -> End {
        End {
            notices: host.notices(),
            line: PlcLine::default(),
            used: None,
            free_us: 0,
            reported: false,
        }
    }

    /// What the PLC of this side wants.
    fn obey(&mut self, host: &Host) {
        while let Some(next) = self.notices.next() {
            let Next::Item(Stamped {
                notice: Notice::Line(order),
                ..
            }) = next
            else {
                continue;
            };
            match order {
                DataLineOrder::Assigned { line: RS_422, setup } => self.assign(setup, host),
                DataLineOrder::Send { line: RS_422, text } => self.line.transmit(&text),
                DataLineOrder::Taken { line: RS_422 } => self.line.taken(),
                _ => {}
            }
        }
    }

    fn assign(&mut self, setup: Option<LineSetup>, host: &Host) {
        let settings = setup.map(|_| Settings::of_plc(host.control().first().edited_list()));
        self.used = setup.zip(settings).map(|(setup, settings)| Used {
            baud: setup.baud,
            characters: settings.characters,
        });
        self.line.assign(settings);
    }

    /// The characters that go over the cable in a time.
    fn send(&mut self, passed_us: u64, now: Duration, into: &mut Vec<u8>) {
        self.line.clock(now);
        let Some(used) = self.used.filter(|_| self.line.has_output()) else {
            self.free_us = 0;
            return;
        };
        let character_us = (used.characters.time(used.baud).as_micros() as u64).max(1);
        self.free_us += passed_us;
        let room = self.free_us / character_us;
        self.free_us -= room * character_us;
        self.line
            .send(usize::try_from(room).unwrap_or(usize::MAX), now, into);
    }

    /// Characters of the other side, which has the line so.
    fn receive(&mut self, bytes: &[u8], other: Option<Used>, host: &mut Host) -> Result<(), HostError> {
        if self.used == other {
            bytes.iter().for_each(|byte| self.line.receive(*byte));
        } else if !bytes.is_empty() && self.used.is_some() {
            tell(host, LineEvent::Faulty)?;
        }
        while let Some(event) = self.line.event() {
            tell(host, event)?;
        }
        Ok(())
    }

    /// The other side has gone on or off.
    fn is_there(&mut self, there: bool, host: &mut Host) -> Result<(), HostError> {
        if self.reported == there {
            return Ok(());
        }
        self.reported = there;
        if !there {
            self.line.unplugged();
        }
        tell(host, LineEvent::Ready(Switch::from(there)))
    }
}

/// What happens at the line is told to a control; one that is off, or receives nothing, does not want it.
fn tell(host: &mut Host, event: LineEvent) -> Result<(), HostError> {
    let event = Command::DataLine(DataLineEvent::Line(RS_422, event));
    let cable = Source::Client("cable".to_owned());
    host.act(cable, Action::Command(0, event)).map(drop)
}

impl PositioningModule {
    /// A module that was switched on with its control.
    pub fn new(host: Host, control: &Host, wiring: ModuleFolder) -> PositioningModule {
        PositioningModule {
            ends: [End::new(control), End::new(&host)],
            host,
            wiring,
            characters: [0; 2],
        }
    }

    /// Follows its control to the end of the contour cycle that it has spent.
    ///
    /// # Errors
    /// When the log or what survives power-off of the module cannot be written.
    pub fn follow(&mut self, control: &mut Host) -> Result<(), HostError> {
        self.interlock(control);
        while self.host.control().time_us() < control.control().time_us() {
            self.host.step()?;
        }
        let [first, second] = &mut self.ends;
        let (is_on, module_is_on) = (!control.control().is_off(), !self.host.control().is_off());
        first.is_there(module_is_on, control)?;
        second.is_there(is_on, &mut self.host)?;
        first.obey(control);
        second.obey(&self.host);
        let now = Duration::from_micros(control.control().time_us());
        let passed_us = u64::from(control.control().cycle_us());
        let mut bytes = [Vec::new(), Vec::new()];
        let [to_module, to_control] = &mut bytes;
        first.send(passed_us, now, to_module);
        second.send(passed_us, now, to_control);
        for (count, bytes) in self.characters.iter_mut().zip([&*to_module, &*to_control]) {
            *count += bytes.len() as u64;
        }
        let (used, used_by_module) = (first.used, second.used);
        second.receive(to_module, used, &mut self.host)?;
        first.receive(to_control, used_by_module, control)
    }

    /// The EMERGENCY STOP chains of both open each other.
    fn interlock(&mut self, control: &mut Host) {
        let (of_control, of_module) = (control.plant().interlock(), self.host.plant().interlock());
        let delay_ms = self.wiring.ready_delay_ms;
        self.host.plant_mut().couple(of_control, delay_ms, None);
        control
            .plant_mut()
            .couple(of_module, delay_ms, self.wiring.voltage);
    }

    /// Characters that have gone to the module, and from it.
    pub fn characters(&self) -> [u64; 2] {
        self.characters
    }
}
