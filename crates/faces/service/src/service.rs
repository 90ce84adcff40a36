//! The handle on a machine that runs.
//!
//! Decision: A program that a run has, interrupted or not, is neither replaced, renamed nor deleted by any interface,
//! as the panel does not let it be erased or edited; a datum table or pallet table that machine.toml names may be
//! replaced, and is there as long as the machine needs it (also `store/src/in_use.rs`)
//!
//! Decision: The folders of part programs and of the PLC are made where a machine lacks them, since every interface
//! shows them as drives

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use bahn_access::Role;
use bahn_host::{LoadedMachine, Reader, Stamped};
use bahn_panel::{Key, Link, Live, Station};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_store::{Change, InUse, PLC, Store, StoreError, TNC};

use crate::error::ServiceError;
use crate::log::Log;
use crate::tables;

/// What does not change while a machine is on.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Name of the machine.
    pub name: String,
    /// Model whose limits, keys and functions the control has.
    pub model: ControlModel,
    /// Keys of the keyboard of the model.
    pub keyboard: Vec<Key>,
    /// Names of the keys of the machine operating panel.
    pub machine_keys: Vec<String>,
    /// Letters of the axes.
    pub axes: String,
    /// Name of the main file of the PLC program.
    pub plc_program: String,
}

impl Machine {
    /// What of a station does not change while it runs.
    pub fn of(station: &Station) -> Machine {
        let folder = &station.machine().folder;
        let plc = Path::new(&folder.plc).file_name().unwrap_or_default();
        Machine {
            name: folder.name.clone(),
            model: station.control().model(),
            keyboard: station.keyboard().collect(),
            machine_keys: station.machine_keys(),
            axes: station.control().axis_letters().collect(),
            plc_program: plc.to_string_lossy().into_owned(),
        }
    }
}

/// A machine that runs, for any thread. Clones are handles on the same one.
#[derive(Clone)]
pub struct MachineService {
    pub(crate) shared: Arc<Shared>,
    role: Role,
}

/// What all handles share.
pub(crate) struct Shared {
    pub link: Link,
    pub machine: Machine,
    pub folders: Folders,
    pub store: Store,
    /// The files of the PLC, and the lists of machine parameters, each as a drive of its own.
    pub plc_files: Option<Store>,
    pub lists: Option<Store>,
    pub log: Arc<Log>,
    /// What has happened since the machine runs; nobody reads on here.
    pub notices: Reader<Stamped>,
    /// A message of the PLC goes to one host.
    pub messages: Mutex<()>,
    /// One change of the list of machine parameters at a time.
    pub writes: Mutex<()>,
}

/// Where the machine has its files.
pub(crate) struct Folders {
    pub root: PathBuf,
    /// The list of machine parameters that machine.toml names.
    pub list: String,
    /// The tool table, when there is one.
    pub tools: Option<PathBuf>,
}

impl MachineService {
    /// A machine that runs, for who may operate it. Its folders of files are made where they are missing.
    ///
    /// # Errors
    /// When a folder cannot be made, or the machine has ended.
    pub fn of(live: &Live) -> Result<MachineService, ServiceError> {
        let link = live.link();
        let (machine, loaded) = link.look(|station| (Machine::of(station), Loaded::of(station.machine())))?;
        let log = Arc::new(Log::new(live.notices()));
        Log::follow_beside(&log, link.clone());
        let shared = Shared {
            store: loaded.store(link.clone())?,
            plc_files: Store::of_drive(PLC, &loaded.plc).ok(),
            lists: Store::of_drive(TNC, &loaded.folders.root).ok(),
            folders: loaded.folders,
            machine,
            log,
            notices: live.notices(),
            messages: Mutex::default(),
            writes: Mutex::default(),
            link,
        };
        Ok(MachineService {
            shared: Arc::new(shared),
            role: Role::Operate,
        })
    }

    /// The same machine with another role, which never allows more than this handle does.
    #[must_use]
    pub fn with_role(&self, role: Role) -> MachineService {
        MachineService {
            shared: Arc::clone(&self.shared),
            role: role.min(self.role),
        }
    }

    /// What this handle allows.
    pub fn role(&self) -> Role {
        self.role
    }

    /// What does not change while the machine is on.
    pub fn machine(&self) -> &Machine {
        &self.shared.machine
    }

    /// Only who operates goes on.
    pub(crate) fn operates(&self) -> Result<(), ServiceError> {
        match self.role {
            Role::Operate => Ok(()),
            Role::Look => Err(ServiceError::OnlyLooks),
        }
    }

    /// What is seen of the station between two cycles.
    pub(crate) fn look<T: Send + 'static>(
        &self,
        what: impl FnOnce(&Station) -> T + Send + 'static,
    ) -> Result<T, ServiceError> {
        Ok(self.shared.link.look(what)?)
    }

    /// What is done with the station between two cycles, after which its screen is made anew.
    pub(crate) fn with<T: Send + 'static>(
        &self,
        what: impl FnOnce(&mut Station) -> T + Send + 'static,
    ) -> Result<T, ServiceError> {
        Ok(self.shared.link.with(what)?)
    }
}

/// What a machine was loaded with.
struct Loaded {
    /// What it says of files.
    list: ParameterList,
    programs: PathBuf,
    plc: PathBuf,
    tables: tables::Files,
    folders: Folders,
}

impl Loaded {
    fn of(machine: &LoadedMachine) -> Loaded {
        let (root, folder) = (&machine.root, &machine.folder);
        Loaded {
            list: machine.parameters.clone(),
            programs: machine.programs(0),
            plc: plc_folder(machine),
            tables: tables::Files::of(root, folder),
            folders: Folders {
                root: root.clone(),
                list: folder.parameters.clone(),
                tools: folder.tools.as_ref().map(|name| root.join(name)),
            },
        }
    }

    /// The files of the machine. Those that a run has are left as they are, and those without which the machine is not
    /// switched on again stay there.
    fn store(&self, link: Link) -> Result<Store, StoreError> {
        for folder in [&self.plc, &self.programs] {
            std::fs::create_dir_all(folder)
                .map_err(|error| StoreError::Medium(format!("cannot make {}: {error}", folder.display())))?;
        }
        let in_use = InUse(Box::new(move |place, change| {
            let Some(name) = place.name().filter(|_| place.drive() != PLC) else {
                return false;
            };
            let name = name.to_owned();
            let asked = link.look(move |station| match change {
                Change::Content => station.runs(&name),
                Change::Name => station.needs(&name),
            });
            // A machine that has ended has nothing in use.
            asked.unwrap_or(false)
        }));
        let store = Store::of_machine_with(&self.programs, &self.plc, self.tables.views()?, in_use)?;
        Ok(store.ruled_by(&self.list))
    }
}

/// The folder of the PLC program; a main file beside machine.toml does not open the whole folder. With the standard program of the
/// control it is `plc`, made where it is not there: nothing has to lie in it.
pub fn plc_folder(machine: &LoadedMachine) -> PathBuf {
    let own = machine.root.join("plc");
    let Some(main) = machine.folder.plc_file() else {
        // Where it cannot be made the store says that it is not there.
        let _ = std::fs::create_dir_all(&own);
        return own;
    };
    let main = machine.root.join(main);
    match main.parent().filter(|folder| **folder != machine.root) {
        Some(folder) => folder.to_owned(),
        None => own,
    }
}
