//! The files that a protocol reads and writes, whatever they lie on.

use std::collections::BTreeMap;
use std::io::{self, Cursor, Read, Write};
use std::sync::{Arc, Mutex, PoisonError};

use bahn_store::{Entry, Existing, Place, Store, StoreError};

/// A file in a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listed {
    /// Name of the file with its extension.
    pub name: String,
    /// Size of the file, bytes.
    pub size: u64,
    /// It must not be replaced.
    pub protected: bool,
}

/// What a protocol needs of the files it transfers. [`Store`] is one; [`Memory`] another.
///
/// It is no `bahn_text::Files`: a transfer lists, protects and writes, and streams files of any length past a slow line.
pub trait Files: Send {
    /// All files, by name.
    fn list(&mut self) -> Vec<Listed>;
    /// A file, without regard to case.
    fn find(&mut self, name: &str) -> Option<Listed> {
        let mut all = self.list().into_iter();
        all.find(|file| file.name.eq_ignore_ascii_case(name))
    }
    /// Opens a file to read it.
    ///
    /// # Errors
    /// When it is not there.
    fn open(&mut self, name: &str) -> Result<Box<dyn Read + Send>, StoreError>;
    /// Begins a file, which is there when it is committed; one of this name is replaced then.
    ///
    /// # Errors
    /// When it is protected, or there is no room.
    fn create(&mut self, name: &str) -> Result<Box<dyn NewFile>, StoreError>;
}

/// A file that is being written: dropped, nothing of it is left.
pub trait NewFile: Write + Send {
    /// Puts it under its name.
    ///
    /// # Errors
    /// When the medium does not take it.
    fn commit(self: Box<Self>) -> Result<(), StoreError>;
}

/// The serial interfaces know no folders: a file is found by its name alone, in the folder of the drive first and then
/// in those below it, in their order. A new file lies in the folder of the drive.
impl Files for Store {
    fn list(&mut self) -> Vec<Listed> {
        let files = self.everywhere();
        files.into_iter().map(|(_, entry)| listed(entry)).collect()
    }

    fn find(&mut self, name: &str) -> Option<Listed> {
        let place = self.whereabouts(name).ok().filter(|place| self.has(place))?;
        let attributes = self.attributes(&place).ok()?;
        let name = name.to_owned();
        Some(listed(Entry { name, attributes }))
    }

    fn open(&mut self, name: &str) -> Result<Box<dyn Read + Send>, StoreError> {
        let file = Store::open(self, &self.whereabouts(name)?)?;
        Ok(Box::new(file))
    }

    fn create(&mut self, name: &str) -> Result<Box<dyn NewFile>, StoreError> {
        let file = Store::create(self, &self.whereabouts(name)?, Existing::Replace)?;
        Ok(Box::new(file))
    }
}

/// The files of some types in the folder of a drive: nothing else there is seen or written, and no folder below it.
#[derive(Clone, Debug)]
pub struct OfKinds {
    store: Store,
    extensions: &'static [&'static str],
}

impl OfKinds {
    /// Of files with these extensions.
    pub fn new(store: Store, extensions: &'static [&'static str]) -> OfKinds {
        OfKinds { store, extensions }
    }

    fn place(&self, name: &str) -> Result<Place, StoreError> {
        match self.knows(name) {
            true => self.store.root().join(name),
            false => Err(StoreError::BadName(name.to_owned())),
        }
    }

    fn knows(&self, name: &str) -> bool {
        let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
        let mut known = self.extensions.iter();
        known.any(|own| own.eq_ignore_ascii_case(extension))
    }
}

impl Files for OfKinds {
    fn list(&mut self) -> Vec<Listed> {
        let entries = self.store.list(&self.store.root()).unwrap_or_default();
        let files = entries.into_iter().filter(|entry| !entry.attributes.is_folder);
        files
            .filter(|entry| self.knows(&entry.name))
            .map(listed)
            .collect()
    }

    fn open(&mut self, name: &str) -> Result<Box<dyn Read + Send>, StoreError> {
        Ok(Box::new(Store::open(&self.store, &self.place(name)?)?))
    }

    fn create(&mut self, name: &str) -> Result<Box<dyn NewFile>, StoreError> {
        let file = Store::create(&self.store, &self.place(name)?, Existing::Replace)?;
        Ok(Box::new(file))
    }
}

fn listed(entry: Entry) -> Listed {
    Listed {
        name: entry.name,
        size: entry.attributes.size,
        protected: entry.attributes.protected,
    }
}

impl NewFile for bahn_store::Writing {
    fn commit(self: Box<Self>) -> Result<(), StoreError> {
        bahn_store::Writing::commit(*self)
    }
}

/// Files in memory: for tests, and for what is read to be looked at only. Clones are the same ones.
///
/// ```
/// use bahn_link::{Files, Memory};
///
/// let mut files = Memory::default();
/// files.put("15.H", "0 BEGIN PGM 15 MM\n1 END PGM 15 MM\n");
/// assert_eq!(files.find("15.h").map(|file| file.size), Some(34));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Memory {
    files: Arc<Mutex<Held>>,
}

/// Text and protection by name.
type Held = BTreeMap<String, (Vec<u8>, bool)>;

impl Memory {
    /// Puts a file there.
    pub fn put(&self, name: &str, content: impl AsRef<[u8]>) {
        let content = (content.as_ref().to_vec(), false);
        self.lock().insert(name.to_owned(), content);
    }

    /// Protects a file against erasing and writing.
    pub fn protect(&self, name: &str) {
        if let Some((_, protected)) = self.lock().get_mut(name) {
            *protected = true;
        }
    }

    /// What is in a file.
    pub fn get(&self, name: &str) -> Option<String> {
        let files = self.lock();
        let (content, _) = files.get(name)?;
        Some(String::from_utf8_lossy(content).into_owned())
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, BTreeMap<String, (Vec<u8>, bool)>> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Files for Memory {
    fn list(&mut self) -> Vec<Listed> {
        let files = self.lock();
        let listed = files.iter().map(|(name, (content, protected))| Listed {
            name: name.clone(),
            size: content.len() as u64,
            protected: *protected,
        });
        listed.collect()
    }

    fn open(&mut self, name: &str) -> Result<Box<dyn Read + Send>, StoreError> {
        let found = self
            .find(name)
            .ok_or_else(|| StoreError::NoFile(name.to_owned()))?;
        let content = self.lock().get(&found.name).map(|(content, _)| content.clone());
        Ok(Box::new(Cursor::new(content.unwrap_or_default())))
    }

    fn create(&mut self, name: &str) -> Result<Box<dyn NewFile>, StoreError> {
        let found = self.find(name);
        if found.as_ref().is_some_and(|found| found.protected) {
            return Err(StoreError::Protected(name.to_owned()));
        }
        Ok(Box::new(InMemory {
            files: self.clone(),
            name: found.map_or_else(|| name.to_owned(), |found| found.name),
            content: Vec::new(),
        }))
    }
}

struct InMemory {
    files: Memory,
    name: String,
    content: Vec<u8>,
}

impl Write for InMemory {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.content.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl NewFile for InMemory {
    fn commit(self: Box<Self>) -> Result<(), StoreError> {
        self.files.put(&self.name, &self.content);
        Ok(())
    }
}
