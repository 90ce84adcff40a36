//! What lies on the table of the machine while the touch probe probes or digitizes.
//!
//! Decision: While the touch probe probes, by program or by hand, or digitizes, the part as it is then lies on the
//! table, at the datum of the program that machined it: a datum that is set later moves no part; a solid from a mesh
//! lies at the datum of machine.toml. Boxes and rings of the plant stay beside it: what is touched first counts

use std::sync::Arc;

use bahn_host::Host;
use bahn_path::Position;
use bahn_tnc::{Mode, RunState};
use bahn_workpiece::Part;

use crate::solid;
use bahn_workpiece::Cutting;

/// The table: a solid that was given, or the part as far as it is machined.
#[derive(Default)]
pub struct Table {
    given: bool,
    /// The stylus was on its way to a surface.
    probed: bool,
    /// Where the datum of the program was that machined the part: a datum that is set later moves no part.
    datum: Option<Position>,
}

impl Table {
    /// With a solid that lies there from the start, its datum at a position of the axes.
    pub fn with(solid: Option<Arc<Part>>, datum: &Position, host: &mut Host) -> Table {
        let given = solid.is_some();
        if let (Some(part), Some(radius)) = (solid, host.plant().probe_radius_mm()) {
            let solid = solid::on_table(part, radius, datum);
            host.plant_mut().put_on_table(Some(solid));
        }
        Table {
            given,
            ..Table::default()
        }
    }

    /// When a probing or a scan begins the part lies on the table as it is then, at the datum of the program.
    pub fn cycle(&mut self, host: &mut Host, cutting: Option<&mut Cutting>) {
        let channel = host.control().first();
        if channel.run_state() == RunState::Running && channel.mode() != Mode::Mdi {
            self.datum = Some(channel.datum());
        }
        let probes = channel.probes();
        let begins = !std::mem::replace(&mut self.probed, probes) && probes;
        let (true, false, Some(datum)) = (begins, self.given, &self.datum) else {
            return;
        };
        let Some(radius) = host.plant().probe_radius_mm() else {
            return;
        };
        let part = cutting.and_then(Cutting::part).cloned();
        let solid = part.map(|part| solid::on_table(Arc::new(part), radius, datum));
        host.plant_mut().put_on_table(solid);
    }
}
