//! The knee mill with changes of its files.

use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

use bahn_host::LoadedMachine;

use crate::trainee::copy::copy;

/// What is seen of the mill, some of whose files have another text in place of one, or behind what they have.
pub fn mill<T>(changes: &[(&str, &str, &str)], seen: impl FnOnce(&LoadedMachine) -> Option<T>) -> Option<T> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let folder = std::env::temp_dir().join(format!("bahn-rows-{}-{number}", std::process::id()));
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines/mill-tnc155");
    copy(&shipped, &folder);
    for (name, from, to) in changes {
        let path = folder.join(name);
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(text.contains(from), "{name}: {from}");
        let changed = match from.is_empty() {
            true => text + to,
            false => text.replacen(from, to, 1),
        };
        std::fs::write(path, changed).unwrap();
    }
    let machine = LoadedMachine::load(&folder).unwrap();
    let result = machine.ok().as_ref().and_then(seen);
    let _ = std::fs::remove_dir_all(&folder);
    result
}
