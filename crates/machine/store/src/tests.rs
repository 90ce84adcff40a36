//! What the file service does, and what nobody brings it to do.

use std::io::{Read, Write};
use std::path::PathBuf;

use super::*;
use proptest::prelude::*;

/// A folder of its own for a test, gone after it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("bahn-store-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        for folder in ["programs", "plc"] {
            fs::create_dir_all(path.join(folder)).unwrap();
        }
        Folder(path)
    }

    fn store(&self) -> Store {
        Store::of_machine(&self.0.join("programs"), &self.0.join("plc")).unwrap()
    }

    fn put(&self, path: &str, text: &str) {
        fs::write(self.0.join("programs").join(path), text).unwrap();
    }

    fn on_medium(&self) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(self.0.join("programs"))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn at(store: &Store, path: &str) -> Place {
    store.root().join(path).unwrap()
}

fn write(store: &Store, path: &str, text: &str) -> Result<(), StoreError> {
    let mut file = store.create(&at(store, path), Existing::Replace)?;
    file.write_all(text.as_bytes()).unwrap();
    file.commit()
}

fn read(store: &Store, path: &str) -> Result<String, StoreError> {
    let mut text = String::new();
    store.open(&at(store, path))?.read_to_string(&mut text).unwrap();
    Ok(text)
}

fn names(store: &Store, path: &str) -> Vec<String> {
    let entries = store.list(&at(store, path)).unwrap();
    entries.into_iter().map(|entry| entry.name).collect()
}

#[test]
fn names_are_compared_without_regard_to_case() {
    let folder = Folder::new("case");
    let store = folder.store();
    folder.put("Part.h", "one");
    assert_eq!(read(&store, "PART.H").unwrap(), "one");
    write(&store, "PART.H", "two").unwrap();
    assert_eq!(
        (read(&store, "part.H").unwrap(), folder.on_medium()),
        ("two".into(), vec!["Part.h".into()])
    );
    // Of two that differ in case only the one that is meant, else the first.
    folder.put("PART.H", "three");
    assert_eq!(read(&store, "PART.H").unwrap(), "three");
    assert_eq!(read(&store, "Part.h").unwrap(), "two");
    assert_eq!(read(&store, "pART.h").unwrap(), "three");
    assert_eq!(names(&store, "TNC:"), ["PART.H"]);
    // A file may be spelled anew.
    store.delete(&at(&store, "PART.H")).unwrap();
    store
        .rename(&at(&store, "part.h"), &at(&store, "PART.H"))
        .unwrap();
    assert_eq!(folder.on_medium(), ["PART.H"]);
}

#[test]
fn what_the_personal_computer_kept_is_read_and_replaced() {
    let folder = Folder::new("nc");
    let store = folder.store();
    folder.put("15.HNC", "old");
    folder.put("3.LNC", "pallets");
    folder.put("X.XNC", "no code");
    assert_eq!(names(&store, "TNC:"), ["15.H", "3.P", "X.XNC"]);
    assert_eq!(read(&store, "15.h").unwrap(), "old");
    assert_eq!(read(&store, "15.HNC").unwrap(), "old");
    assert_eq!(read(&store, "3.P").unwrap(), "pallets");
    // All types of code A are read as .A [000:16935-16937].
    folder.put("E.ANC", "text");
    assert_eq!(read(&store, "E.A").unwrap(), "text");
    assert_eq!(
        read(&store, "E.ER1"),
        Err(StoreError::NoFile("TNC:\\E.ER1".into()))
    );
    write(&store, "15.H", "new").unwrap();
    assert_eq!(folder.on_medium(), ["15.H", "3.LNC", "E.ANC", "X.XNC"]);
    assert_eq!(read(&store, "15.H").unwrap(), "new");
}

#[test]
fn a_file_appears_when_it_is_committed_or_not_at_all() {
    let folder = Folder::new("commit");
    let store = folder.store();
    write(&store, "1.H", "before").unwrap();
    let changes = store.changes();
    let mut half = store.create(&at(&store, "1.H"), Existing::Replace).unwrap();
    half.write_all(b"af").unwrap();
    half.flush().unwrap();
    assert_eq!(
        (read(&store, "1.H").unwrap(), names(&store, "TNC:")),
        ("before".into(), vec!["1.H".into()])
    );
    // Meanwhile nobody else touches it, also through another connection and another spelling.
    let busy = Err(StoreError::Busy("TNC:\\1.h".into()));
    assert_eq!(write(&store.clone(), "1.h", "other"), busy);
    assert_eq!(store.delete(&at(&store, "1.h")), busy);
    assert_eq!(store.rename(&at(&store, "1.h"), &at(&store, "2.H")), busy);
    drop(half);
    assert_eq!(
        (read(&store, "1.H").unwrap(), folder.on_medium()),
        ("before".into(), vec!["1.H".into()])
    );
    assert_eq!(store.changes(), changes);
    // What is opened stays what it was.
    let mut old = store.open(&at(&store, "1.H")).unwrap();
    write(&store, "1.H", "after").unwrap();
    assert_eq!(store.changes(), changes + 1);
    let mut text = String::new();
    old.read_to_string(&mut text).unwrap();
    assert_eq!(
        (text, old.length(), read(&store, "1.H").unwrap()),
        ("before".into(), 6, "after".into())
    );
    let kept = store.create(&at(&store, "1.H"), Existing::Keep).map(drop);
    assert_eq!(kept, Err(StoreError::Exists("TNC:\\1.H".into())));
    // A new name is taken as soon as it is begun.
    let new = store.create(&at(&store, "NEW.H"), Existing::Keep).unwrap();
    assert_eq!(
        write(&store, "NEW.H", ""),
        Err(StoreError::Busy("TNC:\\NEW.H".into()))
    );
    assert_eq!(
        store.make_folder(&at(&store, "NEW.H")),
        Err(StoreError::Busy("TNC:\\NEW.H".into()))
    );
    drop(new);
    write(&store, "NEW.H", "").unwrap();
}

#[test]
fn protected_files_stay_as_they_are() {
    let folder = Folder::new("protected");
    let store = folder.store();
    write(&store, "1.H", "BEGIN PGM 1 MM\nEND PGM 1 MM\n").unwrap();
    write(&store, "2.H", "0 BEGIN PGM 2 MM P\n1 END PGM 2 MM P\n").unwrap();
    write(&store, "2.A", "0 BEGIN PGM 2 MM P\n").unwrap();
    let mut begun = store.create(&at(&store, "1.H"), Existing::Replace).unwrap();
    begun.write_all(b"x").unwrap();
    store.protect(&at(&store, "1.h"), true).unwrap();
    assert_eq!(begun.commit(), Err(StoreError::Protected("TNC:\\1.H".into())));
    for name in ["1.H", "2.H"] {
        let denied = Err(StoreError::Protected(format!("TNC:\\{name}")));
        assert_eq!(write(&store, name, ""), denied);
        assert_eq!(store.delete(&at(&store, name)), denied);
        assert_eq!(store.rename(&at(&store, name), &at(&store, "3.H")), denied);
        assert!(store.attributes(&at(&store, name)).unwrap().protected);
    }
    assert!(!store.attributes(&at(&store, "2.A")).unwrap().protected);
    // A copy by itself is not protected by permission.
    store.copy(&at(&store, "1.H"), &at(&store, "COPY.H")).unwrap();
    assert!(!store.attributes(&at(&store, "COPY.H")).unwrap().protected);
    store.protect(&at(&store, "1.H"), false).unwrap();
    write(&store, "1.H", "changed").unwrap();
    assert_eq!(folder.on_medium(), ["1.H", "2.A", "2.H", "COPY.H"]);
}

#[test]
fn folders_are_made_listed_and_removed() {
    let folder = Folder::new("folders");
    let store = folder.store();
    let parts = at(&store, "Parts");
    store.make_folder(&parts).unwrap();
    assert_eq!(
        store.make_folder(&at(&store, "PARTS")),
        Err(StoreError::Exists("TNC:\\PARTS".into()))
    );
    store.make_folder(&parts.join("B").unwrap()).unwrap();
    write(&store, "parts\\1.H", "x").unwrap();
    write(&store, "PLC:\\MAIN.PLC", "EM").unwrap();
    assert_eq!(names(&store, "PARTS"), ["1.H", "B"]);
    assert_eq!(names(&store, "plc:"), ["MAIN.PLC"]);
    let entries = store.list(&parts).unwrap();
    let kinds: Vec<_> = entries
        .iter()
        .map(|entry| (entry.attributes.is_folder, entry.attributes.size))
        .collect();
    assert_eq!(kinds, [(false, 1), (true, 0)]);
    assert_eq!(
        store.remove_folder(&parts),
        Err(StoreError::NotEmpty("TNC:\\Parts".into()))
    );
    store
        .rename(&at(&store, "PARTS\\1.H"), &at(&store, "2.H"))
        .unwrap();
    store.remove_folder(&at(&store, "PARTS\\b")).unwrap();
    store.remove_folder(&parts).unwrap();
    assert_eq!(
        store.enter(&parts),
        Err(StoreError::NoFolder("TNC:\\Parts".into()))
    );
    assert!(store.enter(&Place::root("PLC")).is_ok());
    assert_eq!(
        store.enter(&Place::root("X")),
        Err(StoreError::NoFolder("X:\\".into()))
    );
    assert_eq!(
        store.remove_folder(&store.root()),
        Err(StoreError::Protected("TNC:\\".into()))
    );
    assert!(store.delete(&at(&store, "PLC:")).is_err() && folder.0.join("plc").is_dir());
    assert_eq!(read(&store, "2.H").unwrap(), "x");
    // A file is no folder and a folder no file.
    assert_eq!(
        store.list(&at(&store, "2.H")),
        Err(StoreError::NoFolder("TNC:\\2.H".into()))
    );
    assert!(store.make_folder(&at(&store, "2.H\\A")).is_err());
}

/// Cycles of the machine builder in the EPROM of the PLC are not in the program memory: an interface without folders neither
/// sends them with all files nor replaces one.
#[test]
fn the_eprom_is_no_folder_of_programs() {
    let folder = Folder::new("eprom");
    fs::create_dir_all(folder.0.join("programs/eprom")).unwrap();
    folder.put("1.H", "one");
    folder.put("eprom/99999968.H", "cycle");
    let store = folder.store();
    let names: Vec<String> = store
        .everywhere()
        .into_iter()
        .map(|(_, entry)| entry.name)
        .collect();
    assert_eq!(names, ["1.H"]);
    assert_eq!(store.whereabouts("99999968.H").unwrap(), at(&store, "99999968.H"));
}

#[cfg(unix)]
#[test]
fn links_lead_nowhere() {
    use std::os::unix::fs::symlink;
    let folder = Folder::new("links");
    let store = folder.store();
    let programs = folder.0.join("programs");
    fs::write(folder.0.join("secret.toml"), "secret").unwrap();
    symlink(folder.0.join("secret.toml"), programs.join("S.H")).unwrap();
    symlink(&folder.0, programs.join("UP")).unwrap();
    symlink("gone", programs.join("GONE.H")).unwrap();
    assert!(names(&store, "TNC:").is_empty());
    for path in ["S.H", "UP\\secret.toml", "GONE.H"] {
        assert!(
            read(&store, path).is_err() && store.attributes(&at(&store, path)).is_err(),
            "{path}"
        );
        assert!(write(&store, path, "overwritten").is_err(), "{path}");
        assert!(store.delete(&at(&store, path)).is_err(), "{path}");
        assert!(store.protect(&at(&store, path), true).is_err(), "{path}");
    }
    assert!(store.enter(&at(&store, "UP")).is_err());
    write(&store, "1.H", "x").unwrap();
    for path in ["S.H", "GONE.H", "UP\\NEW.H"] {
        assert!(
            store.rename(&at(&store, "1.H"), &at(&store, path)).is_err(),
            "{path}"
        );
        assert!(
            store.copy(&at(&store, "1.H"), &at(&store, path)).is_err(),
            "{path}"
        );
    }
    assert_eq!(
        fs::read_to_string(folder.0.join("secret.toml")).unwrap(),
        "secret"
    );
    assert!(!folder.0.join("programs/gone").exists() && !folder.0.join("NEW.H").exists());
}

#[test]
fn a_disk_has_256_files_and_no_folders() {
    let folder = Folder::new("disk");
    let store = Store::of_disk(&folder.0.join("programs")).unwrap();
    for number in 0..DISK_FILES - 1 {
        folder.put(&format!("{number}.H"), "");
    }
    let last = store.create(&at(&store, "LAST.H"), Existing::Keep).unwrap();
    // The last place is taken by the one that is begun.
    assert_eq!(write(&store, "MORE.H", ""), Err(StoreError::DirectoryFull));
    last.commit().unwrap();
    assert_eq!(write(&store, "MORE.H", ""), Err(StoreError::DirectoryFull));
    write(&store, "last.h", "overwritten").unwrap();
    store.rename(&at(&store, "0.H"), &at(&store, "ZERO.H")).unwrap();
    assert_eq!(
        store.copy(&at(&store, "1.H"), &at(&store, "ONE.H")),
        Err(StoreError::DirectoryFull)
    );
    store.delete(&at(&store, "1.H")).unwrap();
    write(&store, "MORE.H", "").unwrap();
    store.delete(&at(&store, "MORE.H")).unwrap();
    assert!(store.make_folder(&at(&store, "A")).is_err());
    fs::create_dir(folder.0.join("programs/SUB")).unwrap();
    assert!(store.enter(&at(&store, "SUB")).is_err());
    assert_eq!(store.list(&store.root()).unwrap().len(), DISK_FILES - 1);
}

#[test]
fn what_lies_elsewhere_is_shown_and_left_alone() {
    let folder = Folder::new("views");
    let view = View {
        place: Place::root(TNC).join("TOOL.T").unwrap(),
        source: folder.0.join("tools.tsv"),
        bytes: Box::new(|| Some(b"BEGIN TOOL .T MM".to_vec())),
    };
    let store = Store::of_machine_with(
        &folder.0.join("programs"),
        &folder.0.join("plc"),
        vec![view],
        InUse::never(),
    )
    .unwrap();
    write(&store, "A.H", "").unwrap();
    write(&store, "Z.H", "").unwrap();
    assert_eq!(names(&store, "TNC:"), ["A.H", "TOOL.T", "Z.H"]);
    assert_eq!(read(&store, "tool.t").unwrap(), "BEGIN TOOL .T MM");
    let attributes = store.attributes(&at(&store, "TOOL.T")).unwrap();
    assert_eq!(
        (
            attributes.size,
            attributes.protected,
            store.has(&at(&store, "TOOL.T"))
        ),
        (16, true, true)
    );
    let protected = Err(StoreError::Protected("TNC:\\TOOL.T".into()));
    assert_eq!(write(&store, "TOOL.T", ""), protected);
    assert_eq!(store.delete(&at(&store, "TOOL.T")), protected);
    assert_eq!(store.rename(&at(&store, "TOOL.T"), &at(&store, "B.T")), protected);
    let exists = Err(StoreError::Exists("TNC:\\TOOL.T".into()));
    assert_eq!(store.rename(&at(&store, "A.H"), &at(&store, "TOOL.T")), exists);
    store.copy(&at(&store, "TOOL.T"), &at(&store, "COPY.T")).unwrap();
    assert_eq!(read(&store, "COPY.T").unwrap(), "BEGIN TOOL .T MM");
    // A file of the drive itself comes first.
    folder.put("TOOL.T", "own");
    assert_eq!(
        (read(&store, "TOOL.T").unwrap(), names(&store, "TNC:").len()),
        ("own".into(), 4)
    );
    store.delete(&at(&store, "TOOL.T")).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever paths are sent for whatever actions: nothing outside the two folders is touched.
    #[test]
    fn no_path_leads_out(paths in proptest::collection::vec("(TNC:|PLC:|)[A-C./\\\\]{0,8}(up|1.H)?", 1..20)) {
        let folder = Folder::new("out");
        let store = folder.store();
        fs::write(folder.0.join("1.H"), "outside").unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink(&folder.0, folder.0.join("programs/up")).unwrap();
        for pair in paths.windows(2) {
            let [one, two] = [&pair[0], &pair[1]].map(|path| store.root().join(path));
            let Ok(one) = one else { continue };
            let _ = store.make_folder(&one);
            let _ = store.create(&one, Existing::Replace).and_then(Writing::commit);
            if let Ok(two) = two {
                let _ = store.copy(&one, &two);
                let _ = store.rename(&one, &two);
            }
            let _ = (store.delete(&one), store.remove_folder(&one));
        }
        let mut outside: Vec<_> = fs::read_dir(&folder.0).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        outside.sort();
        prop_assert_eq!(outside, ["1.H", "plc", "programs"]);
        prop_assert_eq!(fs::read_to_string(folder.0.join("1.H")).unwrap(), "outside");
    }
}

#[test]
fn what_is_in_use_is_left_as_it_is() {
    let folder = Folder::new("in-use");
    for name in ["1.H", "DATUM.D", "2.H"] {
        folder.put(name, "old");
    }
    // 1.H runs; the machine is not switched on again without DATUM.D, which may change meanwhile.
    let in_use = InUse(Box::new(|place, change| match place.name() {
        Some("1.H") => true,
        Some("DATUM.D") => change == Change::Name,
        _ => false,
    }));
    let [programs, plc] = ["programs", "plc"].map(|name| folder.0.join(name));
    let store = Store::of_machine_with(&programs, &plc, Vec::new(), in_use).unwrap();
    let refused = |name: &str| Err(StoreError::InUse(format!("TNC:\\{name}")));
    let new = at(&store, "NEW.X");
    for name in ["1.H", "DATUM.D"] {
        assert_eq!(store.delete(&at(&store, name)), refused(name));
        assert_eq!(store.rename(&at(&store, name), &new), refused(name));
    }
    assert_eq!(write(&store, "1.H", "new"), refused("1.H"));
    assert_eq!(write(&store, "DATUM.D", "new"), Ok(()));
    assert_eq!(write(&store, "2.H", "new"), Ok(()));
    let texts = ["1.H", "DATUM.D", "2.H"].map(|name| read(&store, name).unwrap());
    assert_eq!(texts, ["old", "new", "new"]);
    assert_eq!(
        folder.on_medium(),
        ["1.H", "2.H", "DATUM.D"],
        "nothing half written"
    );
}

/// A program may be started while its new text comes in: what runs stays.
#[test]
fn what_comes_into_use_while_it_is_written_stays() {
    use std::sync::atomic::{AtomicBool, Ordering};
    let folder = Folder::new("comes-into-use");
    folder.put("1.H", "old");
    let runs = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&runs);
    let in_use = InUse(Box::new(move |_, _| asked.load(Ordering::Relaxed)));
    let [programs, plc] = ["programs", "plc"].map(|name| folder.0.join(name));
    let store = Store::of_machine_with(&programs, &plc, Vec::new(), in_use).unwrap();
    let mut file = store.create(&at(&store, "1.H"), Existing::Replace).unwrap();
    file.write_all(b"new").unwrap();
    runs.store(true, Ordering::Relaxed);
    assert_eq!(file.commit(), Err(StoreError::InUse("TNC:\\1.H".to_owned())));
    assert_eq!(read(&store, "1.H").unwrap(), "old");
}

/// MP7224.0 bit 1 disables ISO programs, MP7224.1 bit 0 protects HEIDENHAIN programs [000:6857-6880]: of a disabled type nothing is
/// seen, read or written, a protected one is read alone. The files of the PLC have no such types.
#[test]
fn types_of_files_are_disabled_and_protected() {
    let folder = Folder::new("types");
    let before = folder.store();
    for name in ["A.H", "B.I", "C.A"] {
        write(&before, name, "0").unwrap();
    }
    fs::write(folder.0.join("plc/D.I"), "0").unwrap();
    let mut list = bahn_parameters::ParameterList::reference(bahn_parameters::ControlModel::Tnc415b);
    list.assign("7224.0=%00000010").unwrap();
    list.assign("7224.1=%00000001").unwrap();
    let store = folder.store().ruled_by(&list);
    assert_eq!(names(&store, "TNC:"), ["A.H", "C.A"]);
    assert_eq!(names(&store, "PLC:"), ["D.I"]);
    let no_file = Err(StoreError::NoFile("TNC:\\B.I".into()));
    assert_eq!(read(&store, "B.I").map(drop), no_file);
    assert_eq!(store.delete(&at(&store, "B.I")), no_file);
    let protected = |name: &str| Err(StoreError::Protected(format!("TNC:\\{name}")));
    assert_eq!(write(&store, "B.I", "1"), protected("B.I"));
    assert_eq!(write(&store, "A.H", "1"), protected("A.H"));
    assert_eq!(store.delete(&at(&store, "A.H")), protected("A.H"));
    assert_eq!(
        store.rename(&at(&store, "A.H"), &at(&store, "E.A")),
        protected("A.H")
    );
    assert!(store.attributes(&at(&store, "A.H")).unwrap().protected);
    assert_eq!(read(&store, "A.H").unwrap(), "0");
    write(&store, "C.A", "1").unwrap();
}

/// MP7222 = 0: names of eight characters, 1: twelve [000:6847-6852]. A file that is there stays.
#[test]
fn names_are_as_long_as_mp7222_says() {
    let folder = Folder::new("names");
    write(&folder.store(), "LONGPROGRAM.H", "0").unwrap();
    let mut list = bahn_parameters::ParameterList::reference(bahn_parameters::ControlModel::Tnc415b);
    for (value, nine, thirteen) in [
        ("7222=0", false, false),
        ("7222=1", true, false),
        ("7222=2", true, true),
    ] {
        list.assign(value).unwrap();
        let store = folder.store().ruled_by(&list);
        for (name, allowed) in [
            ("12345678.H", true),
            ("123456789.H", nine),
            ("1234567890123.I", thirteen),
        ] {
            assert_eq!(write(&store, name, "0").is_ok(), allowed, "{value} {name}");
            let _ = store.delete(&at(&store, name));
        }
        write(&store, "LONGPROGRAM.H", "1").unwrap();
    }
}
