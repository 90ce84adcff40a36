//! The machine as a page and a terminal reach it.

use std::sync::Arc;
use std::time::Duration;

use bahn_live::{Input, Link, Live, Stepped};
use bahn_screen::Screen;
use bahn_service::{Operated, Presses, Role, ServiceError, Surface, SurfaceKey, SurfaceShortcut};

use crate::keys::{CHANNELS, KEYBOARD};
use crate::station::Station900;

/// What the control is called.
const MODEL: &str = "System 900";

/// A machine with a System 900 that runs, for any thread. Clones are handles on the same one.
#[derive(Clone)]
pub struct Service900 {
    link: Link<Station900>,
    surface: Surface,
    role: Role,
}

impl Service900 {
    /// A machine that runs, for who may operate it.
    ///
    /// # Errors
    /// When the machine has ended.
    pub fn of(live: &Live<Station900>) -> Result<Service900, ServiceError> {
        let link = live.link();
        let surface = link.look(surface)?;
        Ok(Service900 {
            link,
            surface,
            role: Role::Operate,
        })
    }

    fn operates(&self) -> Result<(), ServiceError> {
        match self.role {
            Role::Operate => Ok(()),
            Role::Look => Err(ServiceError::OnlyLooks),
        }
    }
}

/// What does not change while it is on.
fn surface(station: &Station900) -> Surface {
    let channels = &station.machine().checked.channels;
    let chosen = CHANNELS.iter().take(channels.len()).map(|name| SurfaceKey {
        name,
        group: "mode",
        label: "Channel",
    });
    let mut axes = String::new();
    for letter in channels
        .iter()
        .flat_map(|channel| &channel.axes)
        .filter_map(|axis| axis.name.chars().next())
    {
        if !axes.contains(letter) {
            axes.push(letter);
        }
    }
    Surface {
        name: station.machine().folder.name.clone(),
        model: MODEL.to_owned(),
        keys: chosen.chain(KEYBOARD.iter().copied()).collect(),
        machine_keys: station.machine_keys(),
        axes,
        has_past: false,
        has_teacher: false,
        has_part: false,
        shortcuts: shortcuts().collect(),
    }
}

/// What real keys do.
fn shortcuts() -> impl Iterator<Item = SurfaceShortcut> {
    let of = |real, alt, does| SurfaceShortcut { real, alt, does };
    let keys = [
        ("Enter", "ENT"),
        ("Escape", "CE"),
        ("Delete", "CE"),
        ("Backspace", "BACK"),
        ("ArrowUp", "UP"),
        ("ArrowDown", "DOWN"),
        ("ArrowLeft", "LEFT"),
        ("ArrowRight", "RIGHT"),
        (".", "POINT"),
        (",", "POINT"),
        ("-", "SIGN"),
        (":", "COLON"),
        ("$", "DOLLAR"),
        ("F1", "SK1"),
        ("F2", "SK2"),
        ("F3", "SK3"),
        ("F4", "SK4"),
        ("F5", "SK5"),
        ("F6", "SK6"),
        ("F7", "SK7"),
        ("F8", "SK8"),
    ];
    let machine = [
        ("s", "START"),
        ("o", "STOP"),
        ("h", "HAND"),
        ("q", "SEQUENCE"),
        ("w", "SINGLE"),
        ("r", "RESET"),
        ("f", "REFERENCE"),
        ("e", "EMERGENCY_STOP"),
    ];
    let knobs = [("+", 5.0), ("-", -5.0)];
    let keys = keys
        .into_iter()
        .map(move |(real, name)| of(real, false, Presses::Key(name)));
    let machine = machine
        .into_iter()
        .map(move |(real, name)| of(real, true, Presses::Machine(name)));
    keys.chain(machine).chain(
        knobs
            .into_iter()
            .map(move |(real, step)| of(real, true, Presses::Feed(step))),
    )
}

impl Operated for Service900 {
    fn surface(&self) -> Surface {
        self.surface.clone()
    }

    fn for_role(&self, role: Role) -> Arc<dyn Operated> {
        Arc::new(Service900 {
            role: role.min(self.role),
            ..self.clone()
        })
    }

    fn screen(&self) -> Arc<Screen> {
        self.link.screen()
    }

    fn next_screen(&self, serial: u64, at_most: Duration) -> Arc<Screen> {
        self.link.next_screen(serial, at_most)
    }

    fn input(&self, input: Input) -> Result<(), ServiceError> {
        self.operates()?;
        Ok(self.link.input(input)?)
    }

    fn steps(&self, cycles: u32) -> Result<Stepped, ServiceError> {
        self.operates()?;
        Ok(self.link.steps(cycles)?)
    }

    fn state_json(&self) -> Result<String, ServiceError> {
        Ok(self.link.look(Station900::state_json)?)
    }
}
