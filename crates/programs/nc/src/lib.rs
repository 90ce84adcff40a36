//! DIN 66025 programs of a TF5200 (`.nc`) as what a contouring control feeds from.
//!
//! [`NcReader`] makes path elements of the blocks that [`bahn_din`] executes. M functions and the speed of the spindle go
//! out where the control model, or the machine builder, says; the path waits for them as for those of its own programs.
//! What the control cannot do (H functions, ranges of axes, synchronisation types that the program changes) is refused
//! at its block and named: `bahn technology` runs it.
//!
//! ```
//! use std::sync::Arc;
//!
//! use bahn_nc::NcReader;
//! use bahn_parameters::own_functions::OwnFunctions;
//! use bahn_parameters::{ControlModel, ParameterList};
//! use bahn_path::{Axis, AxisSet, ElementSource, Position, Step};
//! use bahn_reader::Start;
//! use bahn_text::MemoryFiles;
//!
//! let list = ParameterList::reference(ControlModel::Tnc415b);
//! let start = Start::of(&list, OwnFunctions::default(), AxisSet::EMPTY, Position::ZERO);
//! let beside = Arc::new(MemoryFiles::default()); // No subroutines.
//! let mut run = NcReader::new("part.nc", b"N10 G01 X25 F2000 M8\nN20 M30\n", start, beside);
//! if let Step::Element(element) = run.next() {
//!     assert_eq!(element.end[Axis::X], 25.0);
//!     assert_eq!(element.functions().len(), 1);
//! }
//! ```

mod functions;
mod onward;
mod reader;
mod texts;
mod variables;

pub use reader::NcReader;
