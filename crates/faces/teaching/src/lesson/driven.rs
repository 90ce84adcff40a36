//! What a lesson needs from the station that it runs on.

use bahn_host::{AnyPlant, Host, LoadedMachine};

/// What a lesson drives until its task begins.
pub trait Driven {
    /// What the machine's folder says, as it was loaded.
    fn machine(&self) -> &LoadedMachine;

    /// The machine that is on.
    fn host(&mut self) -> &mut Host<AnyPlant>;

    /// A contour cycle of the whole station.
    ///
    /// # Errors
    /// In words.
    fn cycle(&mut self) -> Result<(), String>;
}
