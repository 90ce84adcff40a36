//! Part programs of a System 900: `P1000.900`, and its cycles, `Z6.900`.
//!
//! A [`Program`] is the text of one file. [`Program::block`] reads a block into plain [`Word`]s, which whoever runs the
//! program follows: parameters that it writes, conditions with their targets, G and M functions, axes by the names of the
//! channel. [`examine`] tells all that is wrong with a file and with the cycles that it calls. [`meanings`] is the table
//! of the words, each with where the manual shows it; what is not there is a fault at its block with its name.
//!
//! ```
//! use bahn_din::system900::{Program, Relation, WordKind};
//!
//! let program = Program::from_bytes("P1.900", b"N100 P7950:1 { start }\nN110 M1\nN120 P7960<10.110\n");
//! let faults = program.findings().faults;
//! assert!(faults.is_empty());
//! let waiting = program.words_read(3);
//! if let Some(WordKind::Jump(condition)) = waiting.first().map(|word| &word.kind) {
//!     assert_eq!((condition.relation, condition.target), (Relation::Less, 110));
//!     assert_eq!(program.line_of(condition.target), Some(2));
//! }
//! ```

mod block;
mod examine;
mod line;
mod listing;
mod plain;
mod program;
mod rules;
mod table;
mod value;
mod words;

pub use block::{AxisName, Block, Condition, MFunction, Relation, Word, WordKind};
pub use examine::{Found, examine};
pub use program::{Findings, Program};
pub use table::{Meaning, Part, g_function, m_function, meanings};
pub use value::{Number, Parameter, Value};
pub use words::words;
