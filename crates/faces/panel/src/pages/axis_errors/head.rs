//! HEAD LINE: what stands in the head of a table, each word of it entered by itself [000:3772-3779].

use bahn_parameters::PLC_AXIS_NAMES as AXES;

use super::text::{ErrorFile, text_of};
use crate::page::Turn;
use crate::pages::menu::{Item, Items, Menu};
use crate::pages::number::Number;
use crate::site::Site;

/// A word of the head line.
#[derive(Clone, Copy)]
pub(super) enum Field {
    /// A number with its name, at this place of the line.
    Number(&'static str, usize),
    /// One of the axes, at this place.
    Axis(&'static str, usize),
    /// Whether this axis stands after a place: a column of the table.
    Column(usize, usize),
}

/// The head line of a table.
pub(super) struct Head {
    file: ErrorFile,
    /// The line of the file, without empty ones.
    line: usize,
    fields: Vec<Field>,
}

/// Opens the head line of a file with its fields.
pub(super) fn open(file: ErrorFile, line: usize, fields: Vec<Field>) -> Turn {
    Turn::Open(Box::new(Menu::new(Head { file, line, fields })))
}

/// The words of a head line; none of a file that cannot be read.
fn words(file: &ErrorFile, line: usize) -> Vec<String> {
    let lines = file.lines().unwrap_or_default();
    let words = lines.get(line).map(|line| line.split_whitespace());
    words.into_iter().flatten().map(str::to_owned).collect()
}

fn write(file: &ErrorFile, line: usize, words: &[String], site: &mut Site) -> Result<(), String> {
    let mut lines = file.lines()?;
    if let Some(own) = lines.get_mut(line) {
        *own = words.join(" ");
    }
    file.store(&text_of(&lines), site)
}

impl Items for Head {
    fn title(&self, site: &Site) -> String {
        site.words("HEAD LINE")
    }

    fn items(&self, site: &Site) -> Vec<Item> {
        let words = words(&self.file, self.line);
        let word = |place: usize| words.get(place).cloned().unwrap_or_default();
        let item = |field: &Field| match *field {
            Field::Number(name, place) => Item::new(name, word(place)),
            Field::Axis(name, place) => Item::new(site.words(name), word(place)),
            Field::Column(axis, from) => {
                let name = AXES.get(axis).copied().unwrap_or_default();
                let there = words.iter().skip(from).any(|word| word == name);
                Item::new(
                    format!("{name}=F()"),
                    site.words(if there { "ON" } else { "OFF" }),
                )
            }
        };
        self.fields.iter().map(item).collect()
    }

    fn choose(&mut self, place: usize, site: &mut Site) -> Turn {
        let mut words = words(&self.file, self.line);
        match self.fields.get(place).copied() {
            Some(Field::Number(name, at)) => return self.ask(name, at),
            Some(Field::Axis(_, at)) => {
                let Some(word) = words.get_mut(at) else {
                    return Turn::Refused;
                };
                let own = AXES.iter().position(|axis| axis == word).unwrap_or(0);
                let next = AXES.get((own + 1) % AXES.len()).copied();
                *word = next.unwrap_or_default().to_owned();
            }
            Some(Field::Column(axis, from)) => {
                let name = AXES.get(axis).copied().unwrap_or_default();
                match words.iter().skip(from).position(|word| word == name) {
                    Some(at) => drop(words.remove(from + at)),
                    None => words.push(name.to_owned()),
                }
            }
            None => return Turn::Refused,
        }
        match write(&self.file, self.line, &words, site) {
            Ok(()) => Turn::Done,
            Err(why) => Turn::Say(why),
        }
    }
}

impl Head {
    fn ask(&self, name: &str, at: usize) -> Turn {
        let (file, line) = (self.file.clone(), self.line);
        Turn::Open(Number::turning(format!("{name} ="), move |value, site| {
            let mut words = words(&file, line);
            if let Some(word) = words.get_mut(at) {
                *word = value.to_string();
            }
            match write(&file, line, &words, site) {
                Ok(()) => Turn::Close,
                Err(why) => Turn::Say(why),
            }
        }))
    }
}
