//! Called programs of a target: those that were converted, and the others where the source has them.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_program::Program;
use bahn_reader::Programs;

use bahn_host::files::FileLibrary;

/// The converted programs by the names of their sources.
#[derive(Clone, Default)]
pub struct Converted {
    by_source: HashMap<String, Arc<Program>>,
    /// The names of the sources by those of the targets.
    sources: HashMap<String, String>,
}

impl Converted {
    /// Notes what a source has become, for programs that call it.
    pub(super) fn add(&mut self, source: &Program, target: Arc<Program>) {
        self.sources
            .insert(target.name().to_owned(), source.name().to_owned());
        self.by_source.insert(source.name().to_owned(), target);
    }
}

/// What a converted program finds.
pub(super) struct TargetLibrary {
    converted: Converted,
    files: FileLibrary,
}

impl TargetLibrary {
    pub fn new(converted: Converted) -> TargetLibrary {
        TargetLibrary {
            converted,
            files: FileLibrary::default(),
        }
    }

    /// The name that the source has for a program that the target calls.
    fn source_of(&self, caller: &str) -> String {
        let source = self.converted.sources.get(caller);
        source.map_or_else(|| caller.to_owned(), Clone::clone)
    }
}

impl Programs for TargetLibrary {
    fn open(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        // By the name of a target's file, where a call names that.
        let file = Path::new(name.trim());
        let named = |target: &&Arc<Program>| {
            let other = PathBuf::from(target.name());
            file.extension().is_some()
                && other
                    .file_name()
                    .zip(file.file_name())
                    .is_some_and(|(one, other)| one.eq_ignore_ascii_case(other))
        };
        if let Some(target) = self.converted.by_source.values().find(named) {
            return Ok(Some(target.clone()));
        }
        let found = self.files.open(name, &self.source_of(caller))?;
        Ok(found.map(|source| {
            let converted = self.converted.by_source.get(source.name());
            converted.cloned().unwrap_or(source)
        }))
    }

    fn open_in_eprom(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        let caller = self.source_of(caller);
        self.files.open_in_eprom(name, &caller)
    }
}
