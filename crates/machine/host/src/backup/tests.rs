//! What is backed up comes back, and nothing else happens.
#![allow(clippy::unwrap_used, reason = "a test may fail")]
use std::sync::atomic::{AtomicU32, Ordering};

use proptest::prelude::*;

use super::*;

struct Folder(PathBuf);

impl Folder {
    fn new() -> Folder {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("bahn-backup-{}-{number}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        Folder(folder)
    }

    fn write(&self, path: &str, bytes: &[u8]) {
        let path = self.0.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }

    fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        back_up(&self.0, "mill", |line| {
            lines.push(line.to_owned());
            Ok(())
        })
        .unwrap();
        lines
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn restore(lines: &[String], folder: &Folder) -> Result<u64, BackupError> {
    Restore::read(&folder.0, (lines.join("\r\n") + "\r\n").as_bytes())?.commit()
}

fn machine() -> Folder {
    let folder = Folder::new();
    folder.write("programs/15.H", b"BEGIN PGM 15 MM\nEND PGM 15 MM\n");
    folder.write("parameters.mp", b"");
    folder.write("state/plc.mem", &(0..=255).collect::<Vec<u8>>());
    folder.write(".hidden", b"x");
    folder
}

#[test]
fn a_backup_reads_as_it_is_reported() {
    let lines = machine().lines();
    let sum = crc32fast::hash(b"BEGIN PGM 15 MM\nEND PGM 15 MM\n");
    let expected = [
        "BEGIN BACKUP 1 mill".to_owned(),
        "FILE 0 00000000 parameters.mp".to_owned(),
        format!("FILE 30 {sum:08X} programs/15.H"),
        "BEGIN PGM 15 MM\\n".to_owned(),
        "END PGM 15 MM\\n".to_owned(),
    ];
    assert_eq!(lines[..5], expected);
    assert_eq!(lines.last().unwrap(), "END BACKUP 3");
    let fits = |line: &String| line.len() <= LINE && line.bytes().all(|byte| (b' '..=b'~').contains(&byte));
    assert!(lines.iter().all(fits));
}

#[test]
fn what_is_restored_is_what_was() {
    let (from, to) = (machine(), Folder::new());
    to.write("programs/15.H", b"old");
    to.write("programs/16.H", b"stays");
    assert_eq!(restore(&from.lines(), &to), Ok(3));
    for path in ["programs/15.H", "parameters.mp", "state/plc.mem"] {
        assert_eq!(
            fs::read(from.0.join(path)).unwrap(),
            fs::read(to.0.join(path)).unwrap()
        );
    }
    assert_eq!(fs::read(to.0.join("programs/16.H")).unwrap(), b"stays");
}

/// What has no ends of lines is no backup, and is not taken into memory as a whole to find that out.
#[test]
fn what_has_no_lines_is_refused() {
    struct Endless(u64);
    impl io::Read for Endless {
        fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
            bytes.fill(b'x');
            self.0 += bytes.len() as u64;
            Ok(bytes.len())
        }
    }
    let mut endless = Endless(0);
    let to = Folder::new();
    let refused = Restore::read(&to.0, io::BufReader::new(&mut endless));
    assert!(
        matches!(refused, Err(BackupError::Damaged { line: 1, .. })),
        "{refused:?}"
    );
    assert!(endless.0 <= 1 << 16, "{}", endless.0);
}

/// Whatever happens to a line, either all is as before, or all is restored.
#[test]
fn a_damaged_backup_changes_nothing() {
    let lines = machine().lines();
    for at in 0..lines.len() {
        let mut lost = lines.clone();
        lost.remove(at);
        let mut changed = lines.clone();
        changed[at].push('!');
        let cut = lines[..at].to_vec();
        for damaged in [lost, changed, cut] {
            let to = Folder::new();
            to.write("programs/15.H", b"old");
            if restore(&damaged, &to).is_err() {
                assert_eq!(to.lines().len(), 4, "line {at}");
                assert_eq!(fs::read(to.0.join("programs/15.H")).unwrap(), b"old");
                assert!(!to.0.join("state").exists());
            } else {
                // The name of the machine is only a name.
                assert_eq!((at, damaged[0].as_str()), (0, "BEGIN BACKUP 1 mill!"));
            }
        }
    }
}

#[test]
fn no_way_leads_out() {
    for path in [
        "../x",
        "/etc/x",
        "a/../../x",
        ".ssh",
        "a/.b",
        "a\\..\\b",
        "",
        "a/b/c/d/e/f/g/h/i",
        "state/lock",
    ] {
        let to = Folder::new();
        let lines = ["BEGIN BACKUP 1 x".to_owned(), format!("FILE 0 00000000 {path}")];
        assert!(restore(&lines, &to).is_err(), "{path}");
    }
    let (outside, to) = (Folder::new(), Folder::new());
    std::os::unix::fs::symlink(&outside.0, to.0.join("programs")).unwrap();
    assert!(restore(&machine().lines(), &to).is_err());
    assert_eq!(fs::read_dir(&outside.0).unwrap().count(), 0);
}

/// Nor through what stands in the place of a file: a link to another one, to nothing, or to a device that would be written
/// at once; or a folder.
#[test]
fn no_file_is_written_through_another_thing() {
    let from = Folder::new();
    from.write("A.A", b"new");
    let (lines, outside) = (from.lines(), Folder::new());
    outside.write("B.A", b"theirs");
    for target in [outside.0.join("B.A"), outside.0.join("C.A"), "/dev/null".into()] {
        let to = Folder::new();
        std::os::unix::fs::symlink(&target, to.0.join("A.A")).unwrap();
        let restored = restore(&lines, &to);
        assert!(
            matches!(restored, Err(BackupError::Damaged { line: 3, .. })),
            "{target:?} {restored:?}"
        );
    }
    assert_eq!(fs::read(outside.0.join("B.A")).unwrap(), b"theirs");
    assert!(!outside.0.join("C.A").exists());
    let to = Folder::new();
    fs::create_dir(to.0.join("A.A")).unwrap();
    let restored = restore(&lines, &to);
    assert!(
        matches!(restored, Err(BackupError::Damaged { line: 3, .. })),
        "{restored:?}"
    );
}

/// All that the panel takes for the name of a file is carried; what cannot be is said, and there is no backup.
#[test]
fn nothing_is_left_out_in_silence() {
    let from = machine();
    let names = ["50%.H", "$_#-.%+9.H", "A (2).H"];
    for name in names {
        from.write(&format!("programs/{name}"), name.as_bytes());
    }
    let to = Folder::new();
    assert_eq!(restore(&from.lines(), &to), Ok(3 + 3));
    for name in names {
        assert_eq!(
            fs::read(to.0.join("programs").join(name)).unwrap(),
            name.as_bytes()
        );
    }
    let other: &std::ffi::OsStr = std::os::unix::ffi::OsStrExt::from_bytes(b"\xE4.H");
    let deep = "a/b/c/d/e/f/g/h/1.H";
    for (path, said) in [
        (Path::new("programs/\u{E4}.H"), "programs/\u{E4}.H:"),
        (Path::new(other), "\u{FFFD}.H:"),
        (Path::new(deep), "a/b/c/d/e/f/g/h:"),
        (Path::new("A.A "), "A.A :"),
        (Path::new("a/lock/B.A"), "a/lock/B.A:"),
    ] {
        let from = machine();
        let whole = from.0.join(path);
        fs::create_dir_all(whole.parent().unwrap()).unwrap();
        fs::write(whole, "x").unwrap();
        let refused = back_up(&from.0, "mill", |_| Ok(())).unwrap_err().to_string();
        assert!(refused.contains(said), "{refused}");
    }
    // As deep as it may be.
    let from = Folder::new();
    from.write(&deep[2..], b"x");
    assert_eq!(restore(&from.lines(), &Folder::new()), Ok(1));
    // Longer than RESTORE takes; no block of it is on the medium.
    let long = fs::File::create(from.0.join("LONG.A")).unwrap();
    long.set_len(FILE_MAX + 1).unwrap();
    let refused = back_up(&from.0, "mill", |_| Ok(())).unwrap_err().to_string();
    assert!(refused.contains("LONG.A"), "{refused}");
}

/// A backslash takes two characters of a line, and a blank at its end four.
#[test]
fn no_line_is_longer_than_it_may_be() {
    let from = Folder::new();
    from.write("A.A", &[b'\\'; 300]);
    let lines = from.lines();
    assert!(lines.iter().all(|line| line.len() <= LINE), "{lines:?}");
    assert_eq!(restore(&lines, &Folder::new()), Ok(1));
    from.write("A.A", &[[b' '; 250].as_slice(), b"\n", &[0; 50]].concat());
    let lines = from.lines();
    assert!(lines.iter().all(|line| line.len() <= LINE), "{lines:?}");
    let to = Folder::new();
    assert_eq!(restore(&lines, &to), Ok(1));
    assert_eq!(
        fs::read(to.0.join("A.A")).unwrap(),
        fs::read(from.0.join("A.A")).unwrap()
    );
}

/// However many files a machine has, none of them is open while the others come: a process has 1024 descriptors.
#[cfg(target_os = "linux")]
#[test]
fn files_that_have_come_are_not_held_open() {
    let (from, to) = (Folder::new(), Folder::new());
    for number in 0..20 {
        from.write(&format!("{number}.A"), b"x");
    }
    let mut restore = Restore::new(&to.0);
    from.lines().iter().for_each(|line| restore.line(line).unwrap());
    let open = fs::read_dir("/proc/self/fd").unwrap();
    let open = open.filter_map(|entry| fs::read_link(entry.unwrap().path()).ok());
    assert_eq!(open.filter(|path| path.starts_with(&to.0)).count(), 0);
    // Nobody in this process sweeps them away for that.
    files::sweep(&to.0);
    assert_eq!(restore.commit(), Ok(20));
}

/// A file that cannot take its place leaves no folder behind that was made for the next ones.
#[test]
fn folders_that_nobody_needs_go() {
    let (from, to) = (Folder::new(), Folder::new());
    from.write("a/1.A", b"x");
    from.write("b/2.A", b"x");
    let mut restore = Restore::new(&to.0);
    from.lines().iter().for_each(|line| restore.line(line).unwrap());
    fs::create_dir(to.0.join("a/1.A")).unwrap();
    assert!(restore.commit().is_err());
    assert!(to.0.join("a").exists() && !to.0.join("b").exists());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_bytes_come_back(bytes in prop::collection::vec(any::<u8>(), 0..600)) {
        let (from, to) = (Folder::new(), Folder::new());
        from.write("A.A", &bytes);
        // Ends of lines and blanks before them are the line's.
        let lines: Vec<_> = from.lines().iter().map(|line| line.trim_end().to_owned()).collect();
        prop_assert_eq!(restore(&lines, &to), Ok(1));
        prop_assert_eq!(fs::read(to.0.join("A.A")).unwrap(), bytes);
    }
}
