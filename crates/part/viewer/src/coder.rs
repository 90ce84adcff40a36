//! The part as a stream of differences.

use bahn_workpiece::Part;

use crate::sheet::Sheet;

/// Follows a part and gives what changed, in tiles.
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
    /// How often the part was another one.
    version: u64,
    /// For each tile the version since which it is as it is.
    since: Vec<u64>,
}

impl PartCoder {
    /// For whoever has the untouched blank of this part.
    pub fn new(part: &Part) -> PartCoder {
        let sheet = Sheet::blank_of(part);
        let [across, along] = sheet.tiles();
        PartCoder {
            since: vec![0; across * along],
            sheet,
            version: 0,
        }
    }

    /// The tiles that changed since the last call, as bytes that `PartView.tiles` of the page takes; `None` when none did.
    /// The part must be of the same blank and resolution.
    pub fn changes(&mut self, part: &Part) -> Option<Vec<u8>> {
        let changes = self.sheet.take(part);
        if changes.is_empty() {
            return None;
        }
        self.version += 1;
        for change in &changes {
            if let Some(since) = self.since.get_mut(change.tile) {
                *since = self.version;
            }
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

    /// How often [`PartCoder::changes`] found something new.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// The tiles that changed after a version, as they are now, for whoever has that one.
    pub fn since(&self, version: u64) -> Vec<u8> {
        let changed = |tile: usize| self.since.get(tile).is_some_and(|since| *since > version);
        let mut out = Vec::new();
        self.sheet.write(&self.sheet.as_they_are(changed), &mut out);
        out
    }

    /// Cells along the first and second axis: fewer than the part has columns when those are too many to be sent.
    pub fn cells(&self) -> [usize; 2] {
        self.sheet.columns
    }
}
