//! The part as a stream of differences.

use bahn_workpiece::Part;

use crate::sheet::Sheet;

/// Follows a part and tells what changed, in tiles.
///
/// ```
/// use bahn_path::{Blank, Plane};
/// use bahn_viewer::PartCoder;
/// use bahn_workpiece::{Resolution, Workpiece};
///
/// let blank = Blank { plane: Plane::XY, min: [0.0, 0.0, -20.0], max: [100.0, 80.0, 0.0] };
/// let mut workpiece = Workpiece::new(&blank, Resolution::Millimetres(0.5))?;
/// let mut coder = PartCoder::new(workpiece.part());
/// // Nothing is machined: nothing to send.
/// assert!(coder.changes(workpiece.part()).is_none());
/// # Ok::<(), bahn_workpiece::WorkpieceError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PartCoder {
    sheet: Sheet,
}

impl PartCoder {
    /// For whoever has the untouched blank of this part.
    pub fn new(part: &Part) -> PartCoder {
        PartCoder {
            sheet: Sheet::blank_of(part),
        }
    }

    /// The tiles that changed since the last call, as bytes that `PartView.tiles` of the page takes; `None` when none did.
    /// The part must be of the same blank and resolution.
    pub fn changes(&mut self, part: &Part) -> Option<Vec<u8>> {
        let changes = self.sheet.take(part);
        if changes.is_empty() {
            return None;
        }
        let mut out = Vec::new();
        self.sheet.write(&changes, &mut out);
        Some(out)
    }

    /// All tiles as they were at the last call, for whoever has the untouched blank only.
    pub fn whole(&self) -> Vec<u8> {
        let mut out = Vec::new();
        self.sheet.write(&self.sheet.whole(), &mut out);
        out
    }

    /// Cells along the first and second axis: fewer than the part has columns when those are too many to be sent.
    pub fn cells(&self) -> [usize; 2] {
        self.sheet.columns
    }
}
