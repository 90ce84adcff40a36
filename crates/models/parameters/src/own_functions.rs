//! M functions that a machine builder synchronises otherwise than the table of the model: the types of the TF5200
//! [004:54-90].
//!
//! Decision: When M, S and T functions go out, to whom, and where the path waits for them is one table for all
//! models; a machine builder gives his own free M functions any type of the TF5200 but those of measuring events
//! (also `parameters/data/technology-functions.tsv`)

use std::collections::BTreeMap;
use std::sync::Arc;

use bahn_path::{Ahead, At, OutputPlace, Synchronisation};

use crate::ControlModel;
use crate::technology::{Output, Technology};

/// When a function goes out and where the path waits for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OwnFunction {
    /// It goes to the PLC.
    Out {
        /// At the start or the end of its block, or ahead of its place.
        at: At,
        /// Where the path waits for its acknowledgement.
        synchronisation: Synchronisation,
    },
    /// It goes to nobody: here the functions of type `MVS_SLP` must be acknowledged [004:75].
    Point,
}

/// How far ahead a function goes out, as it is written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lead {
    /// Distance along the path, mm.
    pub distance_mm: Option<f64>,
    /// Time before its place, s.
    pub time_s: Option<f64>,
}

/// The functions of a machine builder by their codes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OwnFunctions(Arc<BTreeMap<u16, OwnFunction>>);

/// Why a function cannot be synchronised so.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum OwnFunctionError {
    /// There is no such type.
    UnknownType,
    /// The type needs a way: `MEP_MOS`, `MEP_SVS`.
    NeedsWay,
    /// The type needs a time: `MET_MOS`, `MET_SVS`.
    NeedsTime,
    /// The type goes out where its block begins or ends, and has no lead.
    HasNoLead,
    /// It is not handed to the PLC, or the control itself does something with it.
    NotFree(u16),
    /// It stands there twice.
    Twice(u16),
}

impl std::fmt::Display for OwnFunctionError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            OwnFunctionError::UnknownType => {
                let types = OwnFunction::types().map(Synchronisation::name);
                let names = types.chain([POINT]).collect::<Vec<_>>().join(", ");
                write!(f, "there is no such synchronisation; there are {names}")
            }
            OwnFunctionError::NeedsWay => write!(f, "the type needs `lead`, mm"),
            OwnFunctionError::NeedsTime => write!(f, "the type needs `lead_ms`"),
            OwnFunctionError::HasNoLead => write!(f, "the type has no lead"),
            OwnFunctionError::NotFree(code) => write!(f, "M{code} is no free function of this control"),
            OwnFunctionError::Twice(code) => write!(f, "M{code} stands there twice"),
        }
    }
}

impl std::error::Error for OwnFunctionError {}

/// The place of a program that TF5200 writes `#EXPL SYN`.
const POINT: &str = "EXPL_SYN";

impl OwnFunction {
    /// The types that a function may have [004:54-57]: those of edge banding have their measuring event in another control, and
    /// for the time of `MOS_TS` the PLC has no word.
    fn types() -> impl Iterator<Item = Synchronisation> {
        Synchronisation::all().filter(|kind| {
            let goes_out = !matches!(kind.output(), OutputPlace::Nowhere | OutputPlace::Event);
            goes_out && *kind != Synchronisation::MosTs
        })
    }

    /// The function of a type.
    ///
    /// ```
    /// use bahn_parameters::own_functions::{Lead, OwnFunction};
    /// use bahn_path::{Ahead, At, Synchronisation};
    ///
    /// let lead = Lead { distance_mm: Some(25.0), time_s: None };
    /// let (at, synchronisation) = (At::Ahead(Ahead::Distance(25.0)), Synchronisation::MepSvs);
    /// assert_eq!(OwnFunction::of("MEP_SVS", lead), Ok(OwnFunction::Out { at, synchronisation }));
    /// ```
    ///
    /// # Errors
    /// When there is no such type, or the lead does not fit it.
    pub fn of(name: &str, lead: Lead) -> Result<OwnFunction, OwnFunctionError> {
        let lead = (lead.distance_mm, lead.time_s);
        if name == POINT {
            let none = lead == (None, None);
            return none
                .then_some(OwnFunction::Point)
                .ok_or(OwnFunctionError::HasNoLead);
        }
        let known = OwnFunction::types().find(|known| known.name() == name);
        let synchronisation = known.ok_or(OwnFunctionError::UnknownType)?;
        let at = match (synchronisation.output(), lead) {
            (OutputPlace::Distance, (Some(way), None)) => At::Ahead(Ahead::Distance(way)),
            (OutputPlace::Distance, _) => return Err(OwnFunctionError::NeedsWay),
            (OutputPlace::Time, (None, Some(time))) => At::Ahead(Ahead::Time(time)),
            (OutputPlace::Time, _) => return Err(OwnFunctionError::NeedsTime),
            (OutputPlace::After, (None, None)) => At::End,
            (_, (None, None)) => At::Start,
            _ => return Err(OwnFunctionError::HasNoLead),
        };
        Ok(OwnFunction::Out { at, synchronisation })
    }
}

impl OwnFunctions {
    /// Adds an M function of a model.
    ///
    /// # Errors
    /// When it is none that the control hands to the PLC without doing something itself, or is there already.
    pub fn add(
        &mut self,
        model: ControlModel,
        code: u16,
        function: OwnFunction,
    ) -> Result<(), OwnFunctionError> {
        let technology = Technology::of_m(model, code);
        let free = |technology: &&Technology| {
            technology.output == Output::Plc && technology.actions().next().is_none()
        };
        if technology.filter(free).is_none() {
            return Err(OwnFunctionError::NotFree(code));
        }
        match Arc::make_mut(&mut self.0).insert(code, function) {
            None => Ok(()),
            Some(_) => Err(OwnFunctionError::Twice(code)),
        }
    }

    /// Whether any function goes out ahead of its place.
    pub fn lead(&self) -> bool {
        let mut all = self.0.values();
        all.any(|function| matches!(function, OwnFunction::Out { at: At::Ahead(_), .. }))
    }

    /// What the machine builder says of an M function.
    pub fn get(&self, code: u16) -> Option<OwnFunction> {
        self.0.get(&code).copied()
    }
}
