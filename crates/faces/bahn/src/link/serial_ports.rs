//! The serial ports of a machine, RS-232-C and RS-422; why one does not open is told here.

use bahn_link::Spec;
use bahn_parameters::ParameterList;
pub(super) use bahn_ports::serial_ports::{Port, of_plc};

use super::port::{Refused, tell};

/// The ports that are named.
pub(super) fn specs(named: [Option<&String>; 2]) -> Result<Vec<(usize, Spec)>, Refused> {
    bahn_ports::serial_ports::specs(named).map_err(Refused::from)
}

/// Opens them all, or none.
pub(super) fn open(specs: &[(usize, Spec)], list: &ParameterList) -> Result<Vec<Port>, Refused> {
    bahn_ports::serial_ports::open(specs, list, &tell()).map_err(Refused::from)
}
