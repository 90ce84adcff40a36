//! The settings in force while blocks are decoded, and the variables of the channel that change them.

use std::collections::HashMap;

use bahn_din::{FunctionLetter, Variable, Variables};
use bahn_path::Synchronisation;

use super::fault::number;
use crate::settings::{ChannelSettings, FunctionSettings, INTERNAL_M};
use crate::synch::Synch;

/// Settings as a program has left them so far.
#[derive(Clone, Debug)]
pub(crate) struct InForce {
    pub(crate) settings: ChannelSettings,
    /// V.G.RW: the distance to go of edge banding, mm.
    pub(crate) residual_mm: f64,
    /// V.E. variables that were written.
    external: HashMap<Variable, f64>,
    /// Code of the fault that a variable has answered with last.
    pub(crate) code: Option<String>,
}

/// 0.1 µm and µs are these parts of a mm and a second.
const PER_MM: f64 = 1e4;
const PER_S: f64 = 1e6;

impl InForce {
    pub(crate) fn new(settings: &ChannelSettings) -> InForce {
        InForce {
            residual_mm: f64::from(settings.edge_banding.residual_path) / PER_MM,
            settings: settings.clone(),
            external: HashMap::new(),
            code: None,
        }
    }

    fn function(&mut self, m: bool, variable: &Variable) -> Result<&mut FunctionSettings, String> {
        let table = if m {
            &mut self.settings.m
        } else {
            &mut self.settings.h
        };
        variable
            .index
            .and_then(|index| table.get_mut(index))
            .ok_or_else(|| format!("{} has no function of this number", variable.name))
    }

    /// An error with a number of the manuals.
    fn refuse<T>(&mut self, code: u32, message: String) -> Result<T, String> {
        self.code = Some(number(code));
        Err(message)
    }
}

/// M or H, and what of it.
fn member(name: &str) -> Option<(bool, &str)> {
    let m = name.strip_prefix("V.G.M_FCT[].").map(|member| (true, member));
    m.or_else(|| name.strip_prefix("V.G.H_FCT[].").map(|member| (false, member)))
}

impl Variables for InForce {
    fn read(&mut self, variable: &Variable) -> Result<f64, String> {
        match variable.name.as_ref() {
            "V.G.RW" => return Ok(self.residual_mm),
            "V.SPDL.M_FCT_FREE" => return Ok(f64::from(u8::from(self.settings.spindle_m_free))),
            name if name.starts_with("V.E.") => {
                return Ok(self.external.get(variable).copied().unwrap_or(0.0));
            }
            _ => {}
        }
        let Some((m, member)) = member(&variable.name) else {
            return Err(format!("{} is not known here", variable.name));
        };
        let function = self.function(m, variable)?.clone();
        let by_time = function.synch.is_some_and(|synch| synch.kind.leads_by_time());
        match member {
            "SYNCH" => Ok(function.synch.map_or(-1.0, |synch| f64::from(synch.bits()))),
            "PRE_OUTP_PATH" if by_time => {
                self.refuse(21512, "its type has no lead along the path".to_owned())
            }
            "PRE_OUTP_PATH" => Ok(f64::from(function.lead) / PER_MM),
            "PRE_OUTP_TIME" if !by_time => self.refuse(21513, "its type has no lead in time".to_owned()),
            "PRE_OUTP_TIME" => Ok(f64::from(function.lead) / PER_S),
            _ => Err(format!("{} is not known here", variable.name)),
        }
    }

    fn write(&mut self, variable: &Variable, value: f64) -> Result<(), String> {
        let positive = |parts: f64| {
            let scaled = (value * parts).round();
            if (0.0..=f64::from(u32::MAX)).contains(&scaled) {
                Ok(scaled as u32)
            } else {
                Err(format!("{value} is out of range"))
            }
        };
        match variable.name.as_ref() {
            "V.G.RW" => {
                self.residual_mm = f64::from(positive(PER_MM)?) / PER_MM;
                return Ok(());
            }
            "V.SPDL.M_FCT_FREE" => {
                self.settings.spindle_m_free = value != 0.0;
                return Ok(());
            }
            name if name.starts_with("V.E.") => {
                self.external.insert(variable.clone(), value);
                return Ok(());
            }
            _ => {}
        }
        let Some((m, member)) = member(&variable.name) else {
            return Err(format!("{} is not known here", variable.name));
        };
        match member {
            "SYNCH" => {
                let synch = if value == -1.0 {
                    None
                } else {
                    Some(Synch::from_bits(positive(1.0)?).map_err(|error| error.to_string())?)
                };
                let m_only = |kind: Synchronisation| kind.is_late() || kind == Synchronisation::MosTs;
                if let Some(synch) = synch.filter(|synch| !m && m_only(synch.kind)) {
                    return Err(format!("{} is for M functions only", synch.kind));
                }
                self.function(m, variable)?.synch = synch;
            }
            "PRE_OUTP_PATH" => self.function(m, variable)?.lead = positive(PER_MM)?,
            "PRE_OUTP_TIME" => self.function(m, variable)?.lead = positive(PER_S)?,
            _ => return Err(format!("{} is not known here", variable.name)),
        }
        Ok(())
    }

    fn exists(&self, letter: FunctionLetter, number: u16) -> bool {
        let (table, internal) = match letter {
            FunctionLetter::M => (&self.settings.m, INTERNAL_M.contains(&u32::from(number))),
            FunctionLetter::H => (&self.settings.h, false),
        };
        let known = table.get(number.into());
        internal || known.is_some_and(|function| function.synch.is_some())
    }
}
