//! What a page and a terminal need of a machine that is on, whatever the family of its control is.

use std::sync::Arc;
use std::time::Duration;

use bahn_access::Role;
use bahn_panel::{BeingCut, Breakable, Input, Picture, Press, SHORTCUTS, Screen, Stepped};

use crate::error::ServiceError;
use crate::service::{Machine, MachineService};

/// What does not change of a panel while its machine is on.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Name of the machine.
    pub name: String,
    /// The control, as people call it.
    pub model: String,
    /// The keys of its keyboard.
    pub keys: Vec<SurfaceKey>,
    /// Names of the keys that are held as long as they are pressed: those of the machine operating panel.
    pub machine_keys: Vec<String>,
    /// Letters of the axes that a handwheel can move.
    pub axes: String,
    /// It leads back to earlier moments.
    pub has_past: bool,
    /// It has lessons, and a drawer of what can be broken.
    pub has_teacher: bool,
    /// It shows the part that is being cut.
    pub has_part: bool,
    /// What the keys of a real keyboard do; where none says something else a letter and a digit are themselves.
    pub shortcuts: Vec<SurfaceShortcut>,
}

/// A key of a keyboard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceKey {
    /// Its name in inputs: `ENT`.
    pub name: &'static str,
    /// The keys beside which it stands: `entry`.
    pub group: &'static str,
    /// What it does, in English.
    pub label: &'static str,
}

/// What a key of a real keyboard does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceShortcut {
    /// The key, as browsers name it.
    pub real: &'static str,
    /// Alt is held.
    pub alt: bool,
    /// What it does.
    pub does: Presses,
}

/// What is pressed, or turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Presses {
    /// A key of the keyboard.
    Key(&'static str),
    /// A key of the machine operating panel.
    Machine(&'static str),
    /// The feed override is turned by so many %.
    Feed(f64),
    /// The spindle override is turned by so many %.
    Spindle(f64),
}

/// A machine that is on, as a page or a terminal shows and operates it. What an input means to it, it says itself; one that
/// means nothing to it is refused in words.
pub trait Operated: Send + Sync {
    /// What does not change while the machine is on.
    fn surface(&self) -> Surface;

    /// The same machine with another role, which never allows more than this one does.
    fn for_role(&self, role: Role) -> Arc<dyn Operated>;

    /// The screen as it was made last; all who show one draw this.
    fn screen(&self) -> Arc<Screen>;

    /// Waits for a screen after this serial, at most so long.
    fn next_screen(&self, serial: u64, at_most: Duration) -> Arc<Screen>;

    /// Gives an input and waits until it was taken.
    ///
    /// # Errors
    /// Why it is refused.
    fn input(&self, input: Input) -> Result<(), ServiceError>;

    /// Asks for so many contour cycles, and waits until they have passed or will not pass any more.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    fn steps(&self, cycles: u32) -> Result<Stepped, ServiceError>;

    /// The numbers behind the screen, as JSON.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    fn state_json(&self) -> Result<String, ServiceError>;

    /// What the graphics show, to be drawn; `None` while they are not looked at, and without a part.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    fn picture(&self) -> Result<Option<Picture>, ServiceError> {
        Ok(None)
    }

    /// The part of the test or the run that the operator looks at.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    fn being_cut(&self) -> Result<Option<BeingCut>, ServiceError> {
        Ok(None)
    }

    /// Everything that a teacher can break, and how.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    fn drawer(&self) -> Result<Vec<Breakable>, ServiceError> {
        Ok(Vec::new())
    }

    /// The lessons of the machine's folder: names and titles.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    fn lessons(&self) -> Result<Vec<(String, String)>, ServiceError> {
        Ok(Vec::new())
    }
}

impl Surface {
    /// That of a TNC: the keyboard of its model, and what real keys do on it.
    pub fn of(machine: &Machine) -> Surface {
        let shortcuts = SHORTCUTS.iter().filter(|shortcut| match shortcut.press {
            Press::Key(key) => machine.keyboard.contains(&key),
            _ => true,
        });
        Surface {
            name: machine.name.clone(),
            model: machine.model.name().to_owned(),
            keys: machine
                .keyboard
                .iter()
                .map(|key| SurfaceKey {
                    name: key.name(),
                    group: key.group().name(),
                    label: key.label(),
                })
                .collect(),
            machine_keys: machine.machine_keys.clone(),
            axes: machine.axes.clone(),
            has_past: true,
            has_teacher: true,
            has_part: true,
            shortcuts: shortcuts
                .map(|shortcut| SurfaceShortcut {
                    real: shortcut.real,
                    alt: shortcut.alt,
                    does: match shortcut.press {
                        Press::Key(key) => Presses::Key(key.name()),
                        Press::Machine(name) => Presses::Machine(name),
                        Press::Feed(step) => Presses::Feed(step),
                        Press::Spindle(step) => Presses::Spindle(step),
                    },
                })
                .collect(),
        }
    }
}

impl Operated for MachineService {
    fn surface(&self) -> Surface {
        Surface::of(self.machine())
    }

    fn for_role(&self, role: Role) -> Arc<dyn Operated> {
        Arc::new(self.with_role(role))
    }

    fn screen(&self) -> Arc<Screen> {
        MachineService::screen(self)
    }

    fn next_screen(&self, serial: u64, at_most: Duration) -> Arc<Screen> {
        MachineService::next_screen(self, serial, at_most)
    }

    fn input(&self, input: Input) -> Result<(), ServiceError> {
        MachineService::input(self, input)
    }

    fn steps(&self, cycles: u32) -> Result<Stepped, ServiceError> {
        MachineService::steps(self, cycles)
    }

    fn state_json(&self) -> Result<String, ServiceError> {
        let state = self.state()?;
        serde_json::to_string(&state).map_err(|error| ServiceError::Refused(error.to_string()))
    }

    fn picture(&self) -> Result<Option<Picture>, ServiceError> {
        MachineService::picture(self)
    }

    fn being_cut(&self) -> Result<Option<BeingCut>, ServiceError> {
        MachineService::being_cut(self)
    }

    fn drawer(&self) -> Result<Vec<Breakable>, ServiceError> {
        MachineService::drawer(self)
    }

    fn lessons(&self) -> Result<Vec<(String, String)>, ServiceError> {
        MachineService::lessons(self)
    }
}
