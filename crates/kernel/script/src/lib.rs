//! The language of scripts: what happens at which time, whoever plays it.
//!
//! A line is `TIME: WHAT`, a rule that holds all the time, or a comment. This room knows lines, comments, times, words and
//! what is wrong with them; what can be done, waited for or ruled are the [`Verbs`] of the player: a machine, the bench of a PLC,
//! a channel alone.
//!
//! ```
//! use std::convert::Infallible;
//! use std::path::Path;
//! use bahn_script::{Base, Fault, Script, Times, Verbs};
//!
//! /// A lamp.
//! struct Lamp;
//!
//! impl Verbs for Lamp {
//!     type Action = bool;
//!     type Condition = Infallible;
//!     fn action<'a>(&mut self, what: &'a str) -> Result<bool, Fault<'a>> {
//!         match what {
//!             "on" => Ok(true),
//!             "off" => Ok(false),
//!             _ => Err(Fault::new(what, format!("`{what}` is neither on nor off")).meant(what, ["on", "off"])),
//!         }
//!     }
//!     fn end<'a>(&mut self, what: &'a str) -> Result<bool, Fault<'a>> {
//!         self.action(what).map(|on| !on)
//!     }
//! }
//!
//! let text = "1: on       ; a second after power-on\n+0.5..+1: off\n";
//! let (script, faults) = Script::read(Path::new("S"), text, Times::of_cycle(3000), &mut Lamp);
//! assert!(faults.is_empty());
//! let lines = script.lines.iter().map(|line| (line.number, line.offset_us, line.action));
//! assert!(lines.eq([(1, 1_000_000, true), (2, 1_500_000, false), (2, 2_500_000, true)]));
//! let (_, faults) = Script::read(Path::new("S"), "1: onn\n", Times::of_cycle(3000), &mut Lamp);
//! assert_eq!((faults[0].span.line, faults[0].span.column), (1, 4));
//! assert_eq!(faults[0].help.as_deref(), Some("did you mean `on`?"));
//! ```

mod fault;
mod line;
mod read;
mod times;
mod words;

pub use fault::Fault;
pub use line::{Line, Script};
pub use read::Verbs;
pub use times::{Base, Times};
pub use words::Words;
