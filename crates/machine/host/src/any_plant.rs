//! A plant whose type nobody needs to know.

use bahn_machine::{DeviceState, Event, Machine, MagazineState, Mechanics};
use bahn_servo::{Commands, Measured, Plant, Step};

use crate::operable::{Operable, StopChain, TrueAxis, Wired};

/// Any plant that can be operated: what is built on it, such as the operator's panel, is the same for all of them.
///
/// ```
/// use bahn_host::{AnyPlant, Event, Operable};
/// use bahn_machine::{Button, Machine};
/// let text = "[emergency_stop]\nacknowledgement = \"I3\"\n[axis.X]\noutput = \"1\"\nspeed = 15000\nvolts = 9\n\
///             encoder = { input = \"X1\", period_um = 20 }";
/// let machine = Machine::from_toml(text).map_err(|faults| faults[0].clone())?;
/// let mut plant = AnyPlant::new(machine);
/// assert_eq!((plant.axis_letters(), plant.keys().len()), (vec!['X'], 0));
/// let before = plant.copied();
/// assert_eq!(plant.operate(&Event::EmergencyStop(Button::Pressed)), Ok(()));
/// assert!(plant.stop_chain().pressed && before.is_some_and(|before| !before.stop_chain().pressed));
/// # Ok::<(), bahn_text::Diagnostic>(())
/// ```
pub struct AnyPlant(Box<dyn Copying + Send + Sync>);

impl AnyPlant {
    /// Takes a plant of any kind.
    pub fn new(plant: impl Operable + Send + Sync + 'static) -> AnyPlant {
        AnyPlant(Box::new(plant))
    }
}

/// What a plant can do behind a pointer, and how it is copied there.
trait Copying: Operable {
    fn boxed_copy(&self) -> Option<AnyPlant>;
}

impl<P: Operable + Send + Sync + 'static> Copying for P {
    fn boxed_copy(&self) -> Option<AnyPlant> {
        self.copied().map(AnyPlant::new)
    }
}

impl Plant for AnyPlant {
    fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured) {
        self.0.exchange(step, commands, measured);
    }
}

impl Operable for AnyPlant {
    fn operate(&mut self, event: &Event) -> Result<(), String> {
        self.0.operate(event)
    }

    fn tool_is_called(&mut self, tool: u32) {
        self.0.tool_is_called(tool);
    }

    fn renew(&mut self, described: Machine) {
        self.0.renew(described);
    }

    fn mechanics(&self) -> Option<Mechanics> {
        self.0.mechanics()
    }

    fn copied(&self) -> Option<AnyPlant> {
        self.0.boxed_copy()
    }

    fn keys(&self) -> Vec<&str> {
        self.0.keys()
    }

    fn held_keys(&self) -> Vec<&str> {
        self.0.held_keys()
    }

    fn lamps(&self) -> Vec<(&str, bool)> {
        self.0.lamps()
    }

    fn knobs(&self) -> [f64; 2] {
        self.0.knobs()
    }

    fn stop_chain(&self) -> StopChain {
        self.0.stop_chain()
    }

    fn wires(&self) -> Vec<Wired> {
        self.0.wires()
    }

    fn axis_letters(&self) -> Vec<char> {
        self.0.axis_letters()
    }

    fn true_axis(&self, letter: char) -> Option<TrueAxis> {
        self.0.true_axis(letter)
    }

    fn devices(&self) -> Vec<DeviceState<'_>> {
        self.0.devices()
    }

    fn magazine(&self) -> Option<MagazineState<'_>> {
        self.0.magazine()
    }
}
