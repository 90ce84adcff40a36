//! The machines that are shipped, as data: each a folder with parameters, PLC program, simulated machine, part programs
//! and lessons.
//!
//! ```
//! let plant = bahn_machines::MILL.file("plant.toml");
//! assert!(plant.is_some_and(|text| text.contains("[axis.X]")));
//! ```

/// The folder of a machine.
#[derive(Clone, Copy, Debug)]
pub struct ShippedMachine {
    /// Name of the folder.
    pub name: &'static str,
    /// Identifiers of the control models that it is a start for; the first is its own.
    pub models: &'static [&'static str],
    /// Files by their path in the folder, with `/`, and their text.
    pub files: &'static [(&'static str, &'static str)],
}

macro_rules! machine {
    ($folder:literal for $($model:literal),+: $($file:literal),* $(,)?) => {
        ShippedMachine {
            name: $folder,
            models: &[$($model),+],
            files: &[$(($file, include_str!(concat!($folder, "/", $file)))),*],
        }
    };
}

/// What every folder of a machine can hold, explained.
pub const FOLDER: &str = include_str!("FOLDER.md");

/// A mill with rotary table and two gear ranges; its control is a TNC 415 B.
pub const MILL: ShippedMachine = machine!("mill" for "tnc415b", "tnc407":
    "README.md", "machine.toml", "parameters.mp", "plant.toml", "tools.tsv", "pockets.tsv", "plc/MAIN.PLC",
    "plc/MAIN.ER1", "plc/functions.txt", "plc/gear.txt", "plc/start.txt", "plc/tool.txt", "plc355/MAIN.PLC",
    "plc/DIALOG.TXT", "programs/BRACKET.H", "programs/CIRCLE.H", "programs/DATUM.H", "programs/FLANGE.H",
    "programs/INDEX.H", "programs/KNOB.H", "programs/MEASURE.H", "programs/PALLET.H", "programs/SADDLE.H", "programs/eprom/99999968.H",
    "lessons/01-power-on.lesson", "lessons/02-datum.lesson", "lessons/03-limit.lesson",
    "lessons/04-door.lesson", "lessons/05-lag.lesson", "lessons/06-drive.lesson",
    "lessons/07-tool-change.lesson", "lessons/08-lubricant.lesson",
    "lessons/09-emergency-stop.lesson", "lessons/10-broken-wire.lesson",
);

/// A small mill of three axes; its control is a TNC 360.
pub const MILL_TNC360: ShippedMachine = machine!("mill-tnc360" for "tnc360":
    "README.md", "machine.toml", "parameters.mp", "plant.toml", "tools.tsv", "plc/MAIN.PLC", "plc/MAIN.ER1",
    "plc/run.txt", "programs/COVER.H", "programs/PLATE.H",
);

/// A knee mill with relay cabinet and the standard PLC program; its control is a TNC 155.
pub const MILL_TNC155: ShippedMachine = machine!("mill-tnc155" for "tnc155", "tnc151":
    "README.md", "machine.toml", "parameters.mp", "plant.toml", "tools.tsv", "programs/ACCEL.H", "programs/BLOCK.H",
    "programs/LAG.H", "lessons/01-contactor.lesson", "lessons/02-e17.lesson", "lessons/03-lag.lesson",
    "lessons/04-kink.lesson", "lessons/05-acceleration.lesson", "lessons/06-square-root.lesson",
);

/// A mill with digital drives, whose speed loops the control closes; it is a TNC 425.
pub const DIG425: ShippedMachine = machine!("dig425" for "tnc425":
    "README.md", "machine.toml", "parameters.mp", "plant.toml", "tools.tsv", "plc/MAIN.PLC", "plc/MAIN.ER1",
    "plc/run.txt", "programs/CIRCLE.H", "programs/COVER.H", "programs/MODEL.H", "programs/PALLETS.H", "pallets.txt",
);

/// A portal mill with two channels; its control is a TNC 415 B. It is a start where it is asked for by its name.
pub const TWIN: ShippedMachine = machine!("twin" for "tnc415b":
    "README.md", "machine.toml", "left.mp", "right.mp", "plant.toml", "tools.tsv", "plc/MAIN.PLC", "plc/MAIN.ER1",
    "plc/together.txt", "programs/LEFT.H", "programs/RIGHT.H", "programs/TAPS.H", "scripts/emergency.txt", "scripts/stop.txt",
);

/// A portal mill with synchronized axes and a spindle that swivels; its control is a TNC 415 B. It is a start where it is
/// asked for by its name.
pub const GANTRY: ShippedMachine = machine!("gantry" for "tnc415b":
    "README.md", "machine.toml", "parameters.mp", "plant.toml", "tools.tsv", "plc/MAIN.PLC", "plc/MAIN.ER1",
    "plc/start.txt", "programs/ROOF.H", "programs/THREADS.H", "programs/NOSE.H",
);

/// A loader as positioning module beside another machine; its control is a TNC 360. It runs no programs of its own.
pub const MODULE_TNC360: ShippedMachine = machine!("module-tnc360" for "tnc360":
    "README.md", "machine.toml", "parameters.mp", "plant.toml", "plc/MAIN.PLC", "plc/MAIN.ER1", "scripts/stop.txt",
    "scripts/refused.txt",
);

/// A portal with two heads on one beam; its control is a System 900. It is a start where it is asked for by its name.
pub const PORTAL900: ShippedMachine = machine!("portal900" for "system900":
    "README.md", "machine.toml", "parameters.q", "plant.toml", "plc/MAIN.PLC",
    "programs/P1000.900", "programs/P2000.900", "programs/P9001.900", "programs/P9002.900", "programs/Z6.900", "programs/Z100.900",
    "programs/Z234.900", "scripts/stop.txt", "scripts/again.txt", "scripts/emergency.txt", "scripts/lock.txt",
);

/// Those with a System 900; each is a start where it is asked for by its name.
pub const SYSTEM900: [ShippedMachine; 1] = [PORTAL900];

/// Those that run by themselves; the first one that has a model is the start for it.
pub const ALL: [ShippedMachine; 6] = [MILL, MILL_TNC360, MILL_TNC155, DIG425, TWIN, GANTRY];

/// Those that go beside another one; each is a start where it is asked for by its name.
pub const MODULES: [ShippedMachine; 1] = [MODULE_TNC360];

impl ShippedMachine {
    /// The text of a file.
    pub fn file(&self, path: &str) -> Option<&'static str> {
        let file = self.files.iter().find(|(name, _)| *name == path);
        file.map(|(_, text)| *text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nothing that lies in the folders is forgotten.
    #[test]
    fn every_file_is_shipped() {
        fn files(folder: &std::path::Path, prefix: &str, found: &mut Vec<String>) {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                let name = format!("{prefix}{}", path.file_name().unwrap().to_string_lossy());
                match path.is_dir() {
                    true if name != "state" => files(&path, &format!("{name}/"), found),
                    true => {}
                    false => found.push(name),
                }
            }
        }
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        for machine in ALL.into_iter().chain(MODULES).chain(SYSTEM900) {
            let mut found = Vec::new();
            files(&root.join(machine.name), "", &mut found);
            found.sort();
            let mut shipped: Vec<&str> = machine.files.iter().map(|(name, _)| *name).collect();
            shipped.sort_unstable();
            assert_eq!(found, shipped, "{}", machine.name);
        }
    }
}
