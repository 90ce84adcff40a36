//! What all fuzz targets share: bounded memory.

use std::alloc::System;

use cap::Cap;

/// A target that wants more than 256 MiB is a finding: an input of N bytes is read in memory near linear in N.
#[global_allocator]
static MEMORY: Cap<System> = Cap::new(System, 256 << 20);
