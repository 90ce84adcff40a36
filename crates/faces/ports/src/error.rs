//! What goes wrong at the interfaces, and who hears of it.

use std::sync::Arc;

use bahn_host::HostError;
use bahn_service::ServiceError;

/// Hears what is to be told while a machine is on, a line each.
pub type Tell = Arc<dyn Fn(&str) + Send + Sync>;

/// Why an interface does not work.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PortError {
    /// The machine or a file.
    #[error(transparent)]
    Host(#[from] HostError),
    /// The interface of this name, `rs232` or `rs422`, prints, and has no port.
    #[error("{0} prints, and has no port")]
    NoPrinter(&'static str),
    /// The machine, by its service.
    #[error(transparent)]
    Service(#[from] ServiceError),
    /// Anything else, in words.
    #[error("{0}")]
    Failed(String),
}
