//! From source files to a program.

mod chain;
mod compilation;
mod cost;
mod emit;
mod file;
mod labels;
mod link;
mod options;
mod report;
mod structure;
mod time;

use report::{Place, Reports};

use crate::source::Memories;

pub use options::Options;

pub use compilation::Compilation;

impl Compilation {
    /// Compiles a main file and all that it links. Never fails: errors are in the result.
    pub fn compile<'a>(files: impl Into<Memories<'a>>, main: &str, options: Options) -> Compilation {
        link::compile(files.into(), main, options)
    }
}
