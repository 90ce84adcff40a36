//! The two images and when they are swapped.

use crate::image::{CELLS, EXCHANGED, Image, input_cells};
use crate::{Bit, Number};

/// The images of NC and PLC.
///
/// Each side owns one and sees only its own. A change travels as a change: what the NC writes between scans
/// is queued and reaches the PLC at the start of the next scan; what the PLC changes during a scan reaches
/// the NC at its end. So either side may set and reset any marker, whatever the manual's columns say; an
/// NC write to a marker that the PLC changes in the same scan is the later one and wins (inferred).
/// Inputs go in one direction only: a program that writes one sees its value until the next scan [000:12235].
///
/// ```
/// use bahn_exchange::{Exchange, signal};
/// let mut exchange = Exchange::default();
/// exchange.nc_set(signal::M_FUNCTION_STROBE, true);
/// assert!(!exchange.plc().bit(signal::M_FUNCTION_STROBE), "not before the scan starts");
/// exchange.begin_scan();
/// assert!(exchange.plc().bit(signal::M_FUNCTION_STROBE));
/// exchange.plc_mut().set_bit(signal::M_FUNCTION_ACK, true);
/// assert!(!exchange.nc().bit(signal::M_FUNCTION_ACK), "not before the scan ends");
/// exchange.end_scan();
/// assert!(exchange.nc().bit(signal::M_FUNCTION_ACK));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Exchange {
    nc: Image,
    plc: Image,
    /// The PLC's image as the scan found it.
    start: Image,
    /// 0xFF where the NC wrote since the last scan start.
    queued: Queue,
}

impl Exchange {
    /// What the NC sees.
    pub fn nc(&self) -> &Image {
        &self.nc
    }

    /// Sets a bit for the NC; inputs too. The PLC sees it from the start of the next scan.
    pub fn nc_set(&mut self, bit: Bit, value: bool) {
        self.nc.set_bit(bit, value);
        self.queued.note(bit.cell(), 1);
    }

    /// Sets a byte, word or doubleword for the NC. The PLC sees it from the start of the next scan.
    pub fn nc_set_number(&mut self, number: Number, value: i32) {
        self.nc.set_number(number, value);
        self.queued.note(number.cell(), number.size().bytes().into());
    }

    /// Sets a bit for the NC when it changes.
    pub fn nc_put(&mut self, bit: Bit, value: bool) {
        if self.nc.bit(bit) != value {
            self.nc_set(bit, value);
        }
    }

    /// Sets a byte, word or doubleword for the NC when it changes.
    pub fn nc_put_number(&mut self, number: Number, value: i32) {
        if self.nc.number(number) != value {
            self.nc_set_number(number, value);
        }
    }

    /// What the PLC sees.
    pub fn plc(&self) -> &Image {
        &self.plc
    }

    /// What the PLC sees, to be changed by the PLC program.
    pub fn plc_mut(&mut self) -> &mut Image {
        &mut self.plc
    }

    /// A PLC scan starts: inputs are read, and what the NC wrote reaches the PLC.
    pub fn begin_scan(&mut self) {
        let inputs = input_cells();
        let (plc, nc) = (self.plc.cells_mut(), self.nc.cells());
        if let (Some(to), Some(from)) = (plc.get_mut(inputs.clone()), nc.get(inputs)) {
            to.copy_from_slice(from);
        }
        if self.queued.any {
            for ((plc, nc), queued) in plc
                .iter_mut()
                .zip(nc)
                .zip(self.queued.cells.iter())
                .take(EXCHANGED)
            {
                *plc = (*plc & !queued) | (nc & queued);
            }
            self.queued.clear();
        }
        self.start.cells_mut().copy_from_slice(plc);
    }

    /// A PLC scan ends: what the PLC changed reaches the NC.
    pub fn end_scan(&mut self) {
        let inputs = input_cells();
        let nc = self.nc.cells_mut();
        let parts = [0..inputs.start, inputs.end..EXCHANGED];
        for part in parts {
            let slices = (
                nc.get_mut(part.clone()),
                self.plc.cells().get(part.clone()),
                self.start.cells().get(part.clone()),
                self.queued.cells.get(part),
            );
            let (Some(nc), Some(plc), Some(start), Some(queued)) = slices else {
                continue;
            };
            let chunks = nc
                .chunks_mut(CHUNK)
                .zip(plc.chunks(CHUNK))
                .zip(start.chunks(CHUNK))
                .zip(queued.chunks(CHUNK));
            // Most of the memory does not change in a scan.
            for (((nc, plc), start), queued) in chunks.filter(|(((_, plc), start), _)| plc != start) {
                for (((nc, plc), start), queued) in nc.iter_mut().zip(plc).zip(start).zip(queued) {
                    let changed = if plc == start { 0 } else { !queued };
                    *nc = (*nc & !changed) | (plc & changed);
                }
            }
        }
    }

    /// Code number 531 210: erases what power-off keeps, on both sides [000:11581].
    pub fn erase_retained(&mut self) {
        self.nc.erase_retained();
        self.plc.erase_retained();
    }

    /// What power-off keeps, as the PLC has it: M1000-M1999, then B0-B127 [000:11579].
    pub fn retained(&self) -> impl Iterator<Item = u8> {
        let cells = self.plc.cells();
        crate::image::retained_cells().filter_map(|cell| cells.get(cell).copied())
    }

    /// RESET: everything but M1000-M1999 and B0-B127 is cleared on both sides [000:11579-11584]. That
    /// markers outside M1000-M1999 are cleared is inferred.
    pub fn reset(&mut self) {
        let mut kept = Image::default();
        for cell in crate::image::retained_cells() {
            kept.cells_mut()[cell & (CELLS - 1)] = self.plc.cells()[cell & (CELLS - 1)];
        }
        *self = Exchange::with(kept);
    }

    /// Both sides start with the same memory.
    pub(crate) fn with(image: Image) -> Exchange {
        Exchange {
            nc: image.clone(),
            plc: image.clone(),
            start: image,
            queued: Queue::default(),
        }
    }
}

/// Cells that are compared at once: to ask is dear, to compare is not, and what changes lies close together.
const CHUNK: usize = 256;

#[derive(Clone)]
struct Queue {
    any: bool,
    cells: Box<[u8; CELLS]>,
}

impl Default for Queue {
    fn default() -> Queue {
        Queue {
            any: false,
            cells: Box::new([0; CELLS]),
        }
    }
}

impl Queue {
    fn note(&mut self, cell: usize, count: usize) {
        self.any = true;
        for queued in self.cells.iter_mut().skip(cell).take(count) {
            *queued = 0xff;
        }
    }

    fn clear(&mut self) {
        self.any = false;
        self.cells.fill(0);
    }
}

impl std::fmt::Debug for Queue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let count = self.cells.iter().filter(|queued| **queued != 0).count();
        write!(f, "{count} cells")
    }
}
