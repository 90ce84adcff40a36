//! The command `bahn`: see the library of this crate.

use std::process::ExitCode;

fn main() -> ExitCode {
    bahn::run(std::env::args_os())
}
