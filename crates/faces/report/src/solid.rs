//! What a stylus feels: the part, or a solid from a mesh.

use std::path::Path;
use std::sync::Arc;

use bahn_machine::Solid;
use bahn_path::{Axis, Position};
use bahn_workpiece::{Feeler, Part, Resolution};

use crate::ReportError;
use bahn_host::files;

/// Reads a solid (STL) in workpiece coordinates.
///
/// # Errors
/// When it cannot be read, or is no mesh.
pub fn read(path: &Path, resolution_mm: Option<f64>) -> Result<Arc<Part>, ReportError> {
    let bytes = files::read_program(path)?
        .ok_or_else(|| ReportError::new(format!("{}: {}", path.display(), files::TOO_LARGE)))?;
    let resolution = resolution_mm.map_or(Resolution::BySize, Resolution::Millimetres);
    Part::from_stl(&bytes, resolution)
        .map(Arc::new)
        .map_err(|error| ReportError::new(format!("{}: {error}", path.display())))
}

/// A part on the table of a machine.
#[derive(Debug)]
struct OnTable {
    feeler: Feeler,
    /// Where its workpiece datum is in positions of the axes X, Y and Z, mm.
    datum: [f64; 3],
}

/// A part as the stylus of a machine touches it, with its workpiece datum at a position of the axes.
pub fn on_table(part: Arc<Part>, radius_mm: f64, datum: &Position) -> Arc<dyn Solid> {
    Arc::new(OnTable {
        feeler: Feeler::new(part, radius_mm),
        datum: [Axis::X, Axis::Y, Axis::Z].map(|axis| datum.get(axis).unwrap_or(0.0)),
    })
}

impl OnTable {
    fn local(&self, end: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = self.datum;
        [end[0] - x, end[1] - y, end[2] - z]
    }
}

impl Solid for OnTable {
    fn touches(&self, end: [f64; 3]) -> bool {
        self.feeler.touches(&self.local(end))
    }

    fn deflection(&self, end: [f64; 3]) -> [f64; 3] {
        self.feeler.deflection(&self.local(end))
    }
}
