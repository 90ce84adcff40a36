//! Conversations as they stand on the line, what is refused, and what noise does.

mod line;
mod noise;
mod sessions;
mod tcp;

use std::path::PathBuf;
use std::sync::Arc;

use super::*;

/// A device with a folder of its own, gone after the test.
pub(super) struct Desk {
    pub folder: PathBuf,
    pub device: Arc<StillDevice>,
    pub site: Arc<Site>,
}

impl Desk {
    pub fn new(name: &str) -> Desk {
        Desk::named(name, "BAHN TNC 415", Passwords::default())
    }

    pub fn named(name: &str, control: &str, passwords: Passwords) -> Desk {
        let folder = std::env::temp_dir().join(format!("bahn-lsv2-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        let device = Arc::new(StillDevice::new(&folder).unwrap().named(control));
        let site = Arc::new(Site::new(Arc::clone(&device) as Arc<dyn Device>, passwords));
        Desk { folder, device, site }
    }

    pub fn session(&self) -> Session {
        Session::new(&self.site)
    }

    /// A file of the part programs.
    pub fn file(&self, name: &str) -> PathBuf {
        self.folder.join("programs").join(name)
    }

    /// What lies in the folder of the part programs, hidden or not.
    pub fn on_medium(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.join("programs")).unwrap();
        let name =
            |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().file_name().into_string().unwrap();
        let mut names: Vec<String> = entries.map(name).collect();
        names.sort();
        names
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

/// Holds a conversation: what is sent, and what is answered to it; nothing where it is empty.
pub(super) fn converse(session: &mut Session, conversation: &[(&[u8], &[u8])]) {
    for (place, (sent, answered)) in conversation.iter().enumerate() {
        let telegram = Telegram::from_bytes(sent).unwrap();
        let answer = session
            .take(&telegram)
            .map(|answer| answer.bytes())
            .unwrap_or_default();
        assert_eq!(
            answer.escape_ascii().to_string(),
            answered.escape_ascii().to_string(),
            "to {} at {place}",
            sent.escape_ascii()
        );
    }
}

/// A session with logins.
pub(super) fn logged_in(desk: &Desk, levels: &[Level]) -> Session {
    let mut session = desk.session();
    for level in levels {
        let login = Telegram::new(Command(*b"A_LG"))
            .string(level.name())
            .string("807667");
        assert_eq!(session.take(&login).unwrap().command, Command::T_OK);
    }
    session
}
