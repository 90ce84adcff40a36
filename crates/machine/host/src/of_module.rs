//! What scripts and recordings say of the positioning module beside a machine: `module:X.actual`, `module: ce`.

/// What speaks of a module where there is none.
pub(crate) const NO_MODULE: &str =
    "the machine has no positioning module beside it: `bahn run --with DIR` says which";

/// What stands after `module:`.
pub(crate) fn of_module(text: &str) -> Option<&str> {
    text.trim().strip_prefix("module:").map(str::trim)
}
