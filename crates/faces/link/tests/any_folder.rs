//! The serial interfaces know no folders: a name alone is found wherever the file lies.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs;

use bahn_link::Files;
use bahn_store::Store;

#[test]
fn a_name_alone_is_found_in_any_folder() {
    let folder = std::env::temp_dir().join(format!("bahn-link-folders-{}", std::process::id()));
    for (path, text) in [
        ("plc/MAIN.PLC", ""),
        ("programs/1.H", "root"),
        ("programs/B/1.H", "in b"),
        ("programs/B/2.H", "in b"),
        ("programs/A/DEEP/2.H", "deep"),
        ("programs/A/DEEP/3.H", "deep"),
    ] {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    let programs = folder.join("programs");
    let mut store = Store::of_machine(&programs, &folder.join("plc")).unwrap();
    let listed = Files::list(&mut store);
    let names: Vec<&str> = listed.iter().map(|file| file.name.as_str()).collect();
    // Folder by folder, those on top first: B is before A\DEEP.
    assert_eq!(names, ["1.H", "2.H", "3.H"]);
    let texts = ["1.h", "2.H", "3.H"].map(|name| {
        let mut text = String::new();
        let mut file = Files::open(&mut store, name).unwrap();
        file.read_to_string(&mut text).unwrap();
        text
    });
    assert_eq!(texts, ["root", "in b", "deep"]);
    // A file that is there is replaced where it lies; a new one lies in the folder of the drive.
    for name in ["3.H", "4.H"] {
        let mut file = Files::create(&mut store, name).unwrap();
        file.write_all(b"new").unwrap();
        file.commit().unwrap();
    }
    let text = |path: &str| fs::read_to_string(programs.join(path)).unwrap();
    assert_eq!((text("A/DEEP/3.H"), text("4.H")), ("new".into(), "new".into()));
    assert!(!programs.join("3.H").exists());
    assert_eq!(Files::find(&mut store, "5.H"), None);
    fs::remove_dir_all(&folder).unwrap();
}
