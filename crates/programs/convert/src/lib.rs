//! Part programs from one language into another, and the proof that both do the same.
//!
//! The face of this room:
//! - [`convert`]: a program block by block into the other language of the control; what that cannot say is listed;
//! - [`prove`]: two runs side by side, element by element, function by function, message by message;
//! - [`unroll`]: a run as a program whose blocks are its movements, for what a language has no blocks for;
//! - [`gcode`]: a run as a program for LinuxCNC, and the reader that proves it.
//!
//! ```
//! use bahn_convert::{Language, Options, convert};
//! use bahn_program::Program;
//!
//! let text = "BEGIN PGM 1 MM\nTOOL CALL 1 Z S500\nL X+10 Y+5 R0 FMAX M3\nEND PGM 1 MM\n";
//! let program = Program::from_bytes("1.H", text.into());
//! let made = convert(&program, Language::Iso, &Options::default());
//! assert_eq!(made.text, "%1 G71 *\nN1 T1 G17 S500 *\nN2 G00 G40 G90 X+10 Y+5 M3 *\nN99999 %1 G71 *\n");
//! assert!(made.refused.is_empty());
//! ```
//!
//! Both languages are read to the same operations, so a conversion is: read, put in what G functions in force leave open
//! (`lower`, with `flow` for what is in force where), write, and read again: what does not come back is refused.

mod blocks;
mod canonical;
mod floating_tap;
mod flow;
pub mod gcode;
mod listed;
mod lower;
mod proof;
mod reason;
mod to_iso;
mod unroll;

pub use blocks::{Converted, Options, convert};
pub use listed::{Language, Listed};
pub use proof::{At, Difference, FEED_TOLERANCE, Proof, TOLERANCE_MM, prove};
pub use unroll::{prove_unrolled, unroll};
