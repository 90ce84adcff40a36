//! What becomes of the functions of a block: their types, ranges and spindles, or what is wrong with them.

use std::sync::Arc;

use bahn_din::{Command, Function, Kind, Place, Target, Unit};
use bahn_path::{Ahead, Axis, Synchronisation};

use super::fault::{named, numbered};
use super::order::{Letter, Order, OrderId, Orders, RangeId, State};
use super::ranges::{Ranges, SLOTS};
use crate::report::{Fault, Value};
use crate::settings::{
    ChannelSettings, FUNCTIONS, FunctionSettings, SPINDLE_M, SpindleFunction, SpindleSettings,
};
use crate::synch::Synch;

/// 0.1 µm and µs are these parts of a mm and a second.
const PER_MM: f64 = 1e4;
const PER_S: f64 = 1e6;

/// The functions of a block, as the channel is set now.
pub(crate) struct Resolve<'a> {
    pub(crate) settings: &'a ChannelSettings,
    pub(crate) ranges: &'a mut Ranges,
    pub(crate) orders: &'a mut Orders,
    /// A cycle: a lead in time is never less (public: message 21203).
    pub(crate) cycle_s: f64,
}

/// Where a function goes and what is said of it there.
struct Handling {
    synch: Synch,
    range: Option<RangeId>,
    /// A spindle of the NC executes it.
    spindle: Option<usize>,
    waits: bool,
    lead: Option<Ahead>,
    process_us: u32,
    /// Reserved for spindles: it has no additive value.
    reserved: bool,
}

impl Resolve<'_> {
    /// The orders of a block, in the order of its text.
    pub(crate) fn block(&mut self, unit: &Unit) -> Result<Vec<OrderId>, Fault> {
        let place = Arc::new(unit.place.clone());
        let mut ids = Vec::new();
        for function in &unit.functions {
            if let Some(order) = self.function(function, &place)? {
                self.twice(&order, &ids)?;
                ids.push(self.orders.push(order));
            }
        }
        self.late(&ids, &place)?;
        self.independent(unit, &ids)?;
        Ok(ids)
    }

    /// The functions of a block that is passed over, with value and the name of range or spindle: those that would have
    /// been output or executed, and the speed of a spindle in any case. Without what is wrong with them.
    pub(crate) fn skipped(&mut self, unit: &Unit) -> Vec<(String, Value, String)> {
        let place = Arc::new(unit.place.clone());
        let mut list = Vec::new();
        for function in &unit.functions {
            let order = self.function(function, &place).ok().flatten();
            let name = |range| names(range, self.settings).into_iter().next();
            if let Some(order) = order {
                let range = order.range.or(order.spindle.map(RangeId::Spindle));
                let target = range.and_then(name).unwrap_or_default();
                list.push((order.label(), order.value, target));
            } else if let Kind::S(rpm) = function.kind {
                let target = match &function.target {
                    Some(Target::Spindle(name)) => name.to_string(),
                    _ => self.settings.main_spindle_name.clone(),
                };
                let called = self.settings.spindle_called(&target);
                let known = called.and_then(|(index, _)| name(RangeId::Spindle(index)));
                list.push(("S".to_owned(), Value::Number(rpm), known.unwrap_or(target)));
            }
        }
        list
    }

    fn function(&mut self, function: &Function, place: &Arc<Place>) -> Result<Option<Order>, Fault> {
        let (letter, number) = match function.kind {
            Kind::M(number) => (Letter::M, number),
            Kind::H(number) => (Letter::H, number),
            Kind::S(_) => (Letter::S, 0),
        };
        let handling = match function.kind {
            Kind::S(_) => self.speed(function, place)?,
            _ => self.switch(letter, number, function.target.as_ref(), place)?,
        };
        let Some(handling) = handling else {
            return Ok(None);
        };
        let value = match (function.kind, function.value) {
            (Kind::S(rpm), _) => Value::Number(rpm),
            (_, Some(_)) if handling.reserved => {
                let message = format!("M{number} has no additive value");
                return Err(named(place, "additive-value", message));
            }
            (_, Some(value)) => Value::Integer(value.into()),
            (_, None) => Value::None,
        };
        if handling.range.is_none() && handling.spindle.is_none() {
            return Ok(None);
        }
        if let Some(range) = handling.range {
            let settings = self.settings;
            self.ranges.open(range, || names(range, settings));
        }
        Ok(Some(Order {
            letter,
            number,
            value,
            synch: handling.synch,
            range: handling.range,
            spindle: handling.spindle,
            waits: handling.waits,
            lead: handling.lead,
            process_s: f64::from(handling.process_us) / PER_S,
            place: place.clone(),
            state: State::default(),
        }))
    }

    /// An M or H function.
    fn switch(
        &self,
        letter: Letter,
        number: u16,
        target: Option<&Target>,
        place: &Place,
    ) -> Result<Option<Handling>, Fault> {
        let spindle = match target {
            Some(Target::Spindle(name)) => Some(self.spindle(Some(name), number, place)?),
            _ => None,
        };
        let is_m = letter == Letter::M;
        let of_spindle = is_m && matches!(number, 3 | 4 | 5 | 19) && !self.settings.spindle_m_free;
        let of_gear = is_m && (40..=45).contains(&number) && self.settings.gear_change;
        match target {
            Some(Target::Axis(axis)) => {
                return self.ordinary(letter, number, Some(RangeId::Axis(*axis)), place);
            }
            _ if of_spindle => {
                let (index, settings) = match spindle {
                    Some(spindle) => spindle,
                    None => self.spindle(None, number, place)?,
                };
                let own = settings.m(number.into()).unwrap_or_default();
                return Ok(Some(spindle_handling(index, settings, own)));
            }
            Some(_) if of_gear => {
                let message = format!("M{number} is of the main spindle and goes to no other range");
                return Err(named(place, "gear-change", message));
            }
            _ if of_gear => {
                let (index, _) = self.spindle(None, number, place)?;
                let handling = self.ordinary(letter, number, Some(RangeId::Spindle(index)), place)?;
                return Ok(handling.map(|handling| Handling {
                    reserved: true,
                    ..handling
                }));
            }
            _ => {}
        }
        if let Some((index, settings)) = spindle {
            if settings.plc_control {
                let message = format!("{letter:?}{number} is not available for a spindle of the PLC");
                return Err(numbered(place, 21202, message));
            }
            return self.ordinary(letter, number, Some(RangeId::Spindle(index)), place);
        }
        self.ordinary(letter, number, None, place)
    }

    /// What the list says of M or H functions; without a range it says that, too.
    fn ordinary(
        &self,
        letter: Letter,
        number: u16,
        range: Option<RangeId>,
        place: &Place,
    ) -> Result<Option<Handling>, Fault> {
        let table = if letter == Letter::M {
            &self.settings.m
        } else {
            &self.settings.h
        };
        let Some(own) = table.get(number.into()) else {
            let message = format!("{letter:?}{number} is above {}", FUNCTIONS - 1);
            return Err(numbered(place, 20160, message));
        };
        let is_spindle_m = letter == Letter::M && SPINDLE_M.contains(&number.into());
        let Some(synch) = own.synch else {
            // Without an entry they are internal [004:48]; when they are free, as any other [004:159].
            if is_spindle_m && !self.settings.spindle_m_free {
                return Ok(None);
            }
            let message = format!("{letter:?}{number} has no synchronisation type");
            return Err(numbered(place, 20157, message));
        };
        let Some(synch) = output_type(synch) else {
            return Ok(None);
        };
        let range = match (range, own.default_target.as_deref()) {
            (Some(range), _) => range,
            (None, Some(name)) if !name.is_empty() => self.range_called(name, place)?,
            (None, _) => RangeId::Channel,
        };
        let lead = self.lead(own, synch, range, place)?;
        Ok(Some(Handling {
            synch,
            range: Some(range),
            spindle: None,
            waits: synch.kind.is_waited_for(),
            lead,
            process_us: own.process_time_us,
            reserved: letter == Letter::M && number == 6 && self.settings.m6_implicit_call,
        }))
    }

    fn lead(
        &self,
        own: &FunctionSettings,
        synch: Synch,
        range: RangeId,
        place: &Place,
    ) -> Result<Option<Ahead>, Fault> {
        let distance = f64::from(own.lead) / PER_MM;
        match synch.kind {
            kind if kind.leads_by_time() => {
                Ok(Some(Ahead::Time((f64::from(own.lead) / PER_S).max(self.cycle_s))))
            }
            kind if kind.is_pre_output() => Ok(Some(Ahead::Distance(distance))),
            kind if kind.takes_micro_joint() && own.lead > 0 => {
                if self.settings.micro_joint.enabled && range == RangeId::Channel {
                    return Ok(Some(Ahead::Distance(distance)));
                }
                if self.settings.micro_joint.enabled {
                    let name = names(range, self.settings).into_iter().next().unwrap_or_default();
                    let message = format!(
                        "a lead with {kind} is a Micro Joint, which is of the range of the channel: {name} takes no lead"
                    );
                    return Err(named(place, "micro-joint", message));
                }
                let message = format!("a lead with {kind} is a Micro Joint, which is not enabled");
                Err(named(place, "licence", message))
            }
            _ => Ok(None),
        }
    }

    /// How an S word is handed over.
    fn speed(&self, function: &Function, place: &Place) -> Result<Option<Handling>, Fault> {
        let name = match &function.target {
            Some(Target::Spindle(name)) => Some(name.as_ref()),
            _ => None,
        };
        let called = name.map_or_else(
            || self.settings.main_spindle(),
            |name| self.settings.spindle_called(name),
        );
        let Some((index, settings)) = called else {
            return match name {
                Some(name) => Err(unknown_spindle(name, place)),
                None => Ok(None),
            };
        };
        let Some(synch) = output_type(settings.s.synch.unwrap_or_default()) else {
            return Ok(None);
        };
        Ok(Some(Handling {
            synch,
            range: Some(range_of(index, settings)),
            spindle: None,
            waits: synch.kind.is_waited_for(),
            lead: None,
            process_us: settings.s.process_time_us,
            reserved: false,
        }))
    }

    /// The spindle of this name, or the main spindle.
    fn spindle(
        &self,
        name: Option<&str>,
        number: u16,
        place: &Place,
    ) -> Result<(usize, &SpindleSettings), Fault> {
        match name {
            Some(name) => {
                let called = self.settings.spindle_called(name);
                called.ok_or_else(|| unknown_spindle(name, place))
            }
            None => self.settings.main_spindle().ok_or_else(|| {
                let message = format!("M{number} is not free, and no spindle is configured");
                numbered(place, 21548, message)
            }),
        }
    }

    /// The axis or spindle that the list names.
    fn range_called(&self, name: &str, place: &Place) -> Result<RangeId, Fault> {
        if let Some((index, _)) = self.settings.spindle_called(name) {
            return Ok(RangeId::Spindle(index));
        }
        let axis = match name.as_bytes() {
            [letter] => Axis::from_letter(*letter),
            _ => None,
        };
        axis.map(RangeId::Axis).ok_or_else(|| {
            let message = format!("the channel has no axis and no spindle {name}");
            named(place, "unknown-axis", message)
        })
    }

    /// The same function does not stand twice in a block for the same target (public: messages 20155, 20156, 20765, 20766).
    fn twice(&self, order: &Order, ids: &[OrderId]) -> Result<(), Fault> {
        let others = ids.iter().filter_map(|id| self.orders.get(*id));
        let is_spindle = |order: &Order| order.letter == Letter::M && matches!(order.number, 3 | 4 | 5 | 19);
        for other in others {
            let same_target = (other.range, other.spindle) == (order.range, order.spindle);
            let same = same_target && (other.letter, other.number) == (order.letter, order.number);
            let label = order.label();
            let place = &order.place;
            if same_target && order.spindle.is_some() && is_spindle(order) && is_spindle(other) {
                let message = format!("{label} beside {} for the same spindle", other.label());
                return Err(numbered(place, 20155, message));
            }
            if same && order.letter != Letter::S {
                let code = if order.letter == Letter::M { 20765 } else { 20766 };
                return Err(numbered(
                    place,
                    code,
                    format!("{label} twice for the same target"),
                ));
            }
            if order.synch.kind == Synchronisation::MneSns && other.synch.kind == Synchronisation::MneSns {
                let message = format!("{label} is the second MNE_SNS of the block");
                return Err(numbered(place, 20156, message));
            }
        }
        Ok(())
    }

    /// More late functions than a range can take (public: messages 50388, 50389).
    fn late(&self, ids: &[OrderId], place: &Place) -> Result<(), Fault> {
        let orders = ids.iter().filter_map(|id| self.orders.get(*id));
        let late = orders.filter(|order| order.synch.kind.is_late() && order.waits);
        let mut counts: Vec<(RangeId, usize)> = Vec::new();
        for range in late.filter_map(|order| order.range) {
            match counts.iter_mut().find(|(one, _)| *one == range) {
                Some((_, count)) => *count += 1,
                None => counts.push((range, 1)),
            }
        }
        match counts.iter().find(|(_, count)| *count > SLOTS) {
            None => Ok(()),
            Some((range, count)) => {
                let code = if *range == RangeId::Channel { 50388 } else { 50389 };
                let message = format!("{count} late functions in a block, more than {SLOTS}");
                Err(numbered(place, code, message))
            }
        }
    }

    /// An axis that moves on its own takes no function by default in this block (public: message 21179).
    fn independent(&self, unit: &Unit, ids: &[OrderId]) -> Result<(), Fault> {
        for command in &unit.commands {
            let Command::Independent(independent) = command else {
                continue;
            };
            let by_default = unit.functions.iter().any(|function| {
                let table = match function.kind {
                    Kind::M(number) => self.settings.m.get(number.into()),
                    Kind::H(number) => self.settings.h.get(number.into()),
                    Kind::S(_) => None,
                };
                let name = independent.axis.letter().to_string();
                let default = table.and_then(|function| function.default_target.as_ref());
                function.target.is_none() && default.is_some_and(|default| *default == name)
            });
            if by_default && !ids.is_empty() {
                let message = format!(
                    "{} moves on its own and takes a function by default",
                    independent.axis
                );
                return Err(numbered(&unit.place, 21179, message));
            }
        }
        Ok(())
    }
}

fn unknown_spindle(name: &str, place: &Place) -> Fault {
    numbered(place, 21548, format!("no spindle {name} is configured"))
}

/// What is output and has no type is not waited for; `NO_SYNCH` is not output. FAW_SYNCH is set in addition to a type and says
/// itself that the function is output [004:54], so it stands alone as well (inferred).
fn output_type(synch: Synch) -> Option<Synch> {
    match synch.kind {
        Synchronisation::NoSynch if synch.flush_and_wait => Some(Synch {
            kind: Synchronisation::Mos,
            ..synch
        }),
        Synchronisation::NoSynch => None,
        _ => Some(synch),
    }
}

/// The range of a spindle: with `plc_control` all of it goes through that of the channel [004:171].
fn range_of(index: usize, settings: &SpindleSettings) -> RangeId {
    if settings.plc_control {
        RangeId::Channel
    } else {
        RangeId::Spindle(index)
    }
}

/// M3, M4, M5 and M19 in the set-ups of a spindle [004:159-171].
fn spindle_handling(index: usize, settings: &SpindleSettings, own: SpindleFunction) -> Handling {
    let mut synch = own.synch.unwrap_or_default();
    let by_plc = settings.plc_spindle || settings.plc_control;
    let is_output = by_plc || synch.plc_info;
    let waits = is_output && synch.kind.is_waited_for();
    let spindle = (!by_plc).then_some(index);
    // Without a type of its own it is output and not waited for.
    if is_output && synch.kind == Synchronisation::NoSynch {
        synch.kind = Synchronisation::Mos;
    }
    Handling {
        synch,
        range: is_output.then(|| range_of(index, settings)),
        spindle,
        waits,
        lead: None,
        process_us: own.process_time_us,
        reserved: true,
    }
}

/// How a range is called: in reports first, then in capitals as scripts are read.
pub(crate) fn names(range: RangeId, settings: &ChannelSettings) -> Vec<String> {
    let mut names = match range {
        RangeId::Channel => vec!["channel".to_owned()],
        RangeId::Axis(axis) => vec![axis.letter().to_string()],
        RangeId::Spindle(index) => {
            let name = settings.spindles.get(&index).map(|spindle| spindle.name(index));
            let main = settings.main_spindle().filter(|(main, _)| *main == index);
            let main = main.map(|_| settings.main_spindle_name.clone());
            name.into_iter().chain(main).collect()
        }
    };
    for at in 0..names.len() {
        let capitals = names[at].to_uppercase();
        if !names.contains(&capitals) {
            names.push(capitals);
        }
    }
    names
}
