//! What of a plant an operator, a script, a teacher and a panel have in their hands and before their eyes.
//!
//! Decision: What a plant does not say of itself it does not have; one without copy stays where it is, and what a
//! script does to it is tried when it is done, not when it is read

use bahn_machine::{DeviceState, Event, MagazineState, Mechanics};
use bahn_servo::Plant;

/// A plant that can be operated: it has a panel, and things can happen to it.
///
/// Whoever writes one says with [`Operable::operate`] what can be done to it. All else is what is known of it: what a
/// plant does not say it does not have, and what is built on it stays empty. So without keys the panel shows none, without
/// wires a reason ends at the input, without a copy there is no time line. [`AnyPlant`](crate::AnyPlant) is one whatever
/// it is.
///
/// ```
/// use bahn_host::{Event, KeyAction, Operable};
/// use bahn_servo::{Commands, IdealAxes, Measured, Plant, Step};
///
/// /// Ideal axes with a key START at I10.
/// struct Bench(IdealAxes);
/// impl Plant for Bench {
///     fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured) {
///         self.0.exchange(step, commands, measured);
///     }
/// }
/// impl Operable for Bench {
///     fn operate(&mut self, event: &Event) -> Result<(), String> {
///         match event {
///             Event::Key(name, action) if name == "START" => {
///                 self.0.inputs[10] = *action != KeyAction::Release;
///                 Ok(())
///             }
///             other => Err(format!("the bench has nothing for {other:?}")),
///         }
///     }
///     fn keys(&self) -> Vec<&str> {
///         vec!["START"]
///     }
/// }
/// let mut bench = Bench(IdealAxes::default());
/// assert_eq!(bench.operate(&Event::Key("START".to_owned(), KeyAction::Press)), Ok(()));
/// assert!(bench.0.inputs[10] && bench.operate(&Event::EmergencyStop(bahn_machine::Button::Pressed)).is_err());
/// ```
pub trait Operable: Plant {
    /// Lets something happen to it.
    ///
    /// # Errors
    /// In words, when it has not what the event names. Nothing is done then.
    fn operate(&mut self, event: &Event) -> Result<(), String>;

    /// The tool that the control has in the spindle; who changes tools by hand puts it there.
    fn tool_is_called(&mut self, _tool: u32) {}

    /// The files of the machine were read anew, and this is the simulated machine that they describe. A plant that is not
    /// described there stays what it is.
    fn renew(&mut self, _described: bahn_machine::Machine) {}

    /// Where everything stands, for a plant that ends with the program; a real one stays where it is.
    fn mechanics(&self) -> Option<Mechanics> {
        None
    }

    /// The same once more, which goes its own way: for the time line, and to try what can be done to it. A real machine has
    /// none.
    fn copied(&self) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }

    /// The names of the keys of its operating panel.
    fn keys(&self) -> Vec<&str> {
        Vec::new()
    }

    /// Those that are held; a tapped key is let go by itself.
    fn held_keys(&self) -> Vec<&str> {
        Vec::new()
    }

    /// The lamps of its operating panel, and whether each is lit.
    fn lamps(&self) -> Vec<(&str, bool)> {
        Vec::new()
    }

    /// The potentiometers of feed and spindle, %.
    fn knobs(&self) -> [f64; 2] {
        [100.0; 2]
    }

    /// What is known of the EMERGENCY STOP chain.
    fn stop_chain(&self) -> StopChain {
        StopChain::default()
    }

    /// What is wired to inputs and outputs of the PLC.
    fn wires(&self) -> Vec<Wired> {
        Vec::new()
    }

    /// The letters of its axes.
    fn axis_letters(&self) -> Vec<char> {
        Vec::new()
    }

    /// What only the plant knows of an axis.
    fn true_axis(&self, _letter: char) -> Option<TrueAxis> {
        None
    }

    /// The things with two states: doors, pumps, clamps.
    fn devices(&self) -> Vec<DeviceState<'_>> {
        Vec::new()
    }

    /// Where the tools of its magazine are.
    fn magazine(&self) -> Option<MagazineState<'_>> {
        None
    }
}

/// What a plant knows of its EMERGENCY STOP chain. By default nothing is wrong with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StopChain {
    /// The EMERGENCY STOP button is in.
    pub pressed: bool,
    /// The supply of the control voltage is there.
    pub supply: bool,
    /// No limit switch of the chain is actuated.
    pub limits_clear: bool,
}

impl Default for StopChain {
    fn default() -> StopChain {
        StopChain {
            pressed: false,
            supply: true,
            limits_clear: true,
        }
    }
}

/// What only a plant knows of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueAxis {
    /// Where its table stands, mm or degrees from the zero point of the plant.
    pub position: f64,
    /// Force of its motor, N or Nm.
    pub force: f64,
}

/// Something that is wired to an input or output of the PLC, named as in the description of a simulated machine: the key
/// NC_START is the function `NC_START` of the part `keys`, a limit switch of X `limit_plus` of `axis.X`. What is named
/// otherwise is said so.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wired {
    /// The input or output, as `I24`.
    pub operand: String,
    /// What it belongs to.
    pub part: String,
    /// What it is there.
    pub function: String,
    /// A contact that opens.
    pub opens: bool,
}

impl Wired {
    /// It is a contact of this key of the panel.
    pub fn is_key(&self, name: &str) -> bool {
        self.part == "keys" && self.function == name
    }
}
