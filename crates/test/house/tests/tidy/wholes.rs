//! Types that have become too much: many fields, and methods in several files.
//!
//! What holds the parts of a room together only orders: what its parts do stands with them, and they get what they
//! may touch. Whoever adds a file of methods to a type of many fields gives that file all of them.

use std::collections::{BTreeMap, BTreeSet};

use crate::names::{Files, Texts};
use crate::source::is_of_name;

/// A type with more fields has its methods in one file.
const FIELDS_MAX: usize = 12;

/// The types of a room that have more than [`FIELDS_MAX`] fields and methods of their own in several files, each with
/// these files.
pub fn too_much<'a>(files: &Files<'a>) -> BTreeMap<&'a str, BTreeSet<&'a str>> {
    let mut with_methods: BTreeMap<(&str, &str), BTreeSet<&str>> = BTreeMap::new();
    for file in files.names() {
        for path in types_with_methods(files.body(file)) {
            let path: Vec<&str> = path.split("::").collect();
            let own = (file, path[path.len() - 1]);
            let of = files.named(file, &path).unwrap_or(own);
            with_methods.entry(of).or_default().insert(file);
        }
    }
    let large = files.names().flat_map(|file| {
        let structs = structs(files.body(file)).into_iter();
        let large = structs.filter(|(_, fields)| *fields > FIELDS_MAX);
        large.map(move |(name, _)| (file, name))
    });
    large
        .filter_map(|whole| Some((whole.1, with_methods.remove(&whole)?)))
        .filter(|(_, files)| files.len() > 1)
        .collect()
}

/// The structures with named fields of a text, each with the number of its fields.
fn structs(code: &str) -> Vec<(&str, usize)> {
    let heads = code
        .match_indices("struct ")
        .filter(|(at, _)| !code[..*at].ends_with(is_of_name));
    heads
        .filter_map(|(at, mark)| {
            let rest = &code[at + mark.len()..];
            let name = &rest[..rest.find(|c| !is_of_name(c))?];
            let open = rest.find(['{', ';', '('])?;
            let fields = rest[open..].strip_prefix('{')?;
            Some((name, count_fields(fields)))
        })
        .collect()
}

/// How many fields stand before the brace that closes a structure: a colon outside of all brackets and paths each.
fn count_fields(text: &str) -> usize {
    let mut depth = 0;
    let mut count = 0;
    let mut before = ' ';
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '}' if depth == 0 => break,
            '{' | '(' | '[' | '<' => depth += 1,
            '}' | ')' | ']' => depth -= 1,
            '>' if before != '-' => depth -= 1,
            ':' if depth == 0 && before != ':' && letters.peek() != Some(&':') => count += 1,
            _ => {}
        }
        before = letter;
    }
    count
}

/// The types, as they are written, that have methods in a text which are those of no trait.
fn types_with_methods(code: &str) -> Vec<&str> {
    let heads = code.match_indices("impl").filter_map(|(at, mark)| {
        let is_word = code[..at].chars().next_back().is_none_or(char::is_whitespace);
        let head = code[at + mark.len()..].split('{').next()?;
        (is_word && !head.contains(" for ")).then_some(head)
    });
    let types = heads.map(|head| {
        // After the generic parameters of `impl<'a> Type<'a>`.
        let name = match head.strip_prefix('<') {
            Some(generic) => generic.split_once("> ").map_or("", |(_, name)| name),
            None => head.trim_start(),
        };
        name.split(['<', ' ', '\n']).next().unwrap_or_default()
    });
    types.filter(|name| !name.is_empty()).collect()
}

#[test]
fn methods_are_distinguished_from_those_of_traits() {
    assert_eq!(types_with_methods("struct Run;\nimpl Run {"), ["Run"]);
    assert_eq!(
        types_with_methods("impl<'a> crate::run::Run<'a> {"),
        ["crate::run::Run"]
    );
    assert!(types_with_methods("impl Drop for Run {").is_empty());
    assert!(types_with_methods("impl<T> Run for Machine<T> {").is_empty());
}

#[test]
fn methods_are_those_of_the_type_that_is_meant() {
    let fields: String = (0..13).map(|field| format!("f{field}: u8,")).collect();
    let whole = format!("mod a;\nmod b;\nmod c;\npub struct Run {{ {fields} }}\nimpl Run {{}}");
    let own = "struct Run;\nimpl Run {}";
    let part = "use super::Run;\nimpl Run {}";
    let found = |c: &str| {
        let files = [
            ("run", whole.as_str()),
            ("run::a", part),
            ("run::b", "impl super::Run {}"),
            ("run::c", c),
        ];
        let texts = Texts::of(files.map(|(name, text)| (name.to_owned(), text.to_owned())));
        too_much(&Files::of(&texts))
            .into_values()
            .map(|files| files.len())
            .collect::<Vec<_>>()
    };
    assert_eq!(found(own), [3]);
    assert_eq!(found(part), [4]);
}

#[test]
fn fields_are_counted() {
    let code =
        "pub struct A<'a> {\n pub b: Map<u8, [Vec<x::Y>; 2]>,\n c: fn(d: u8) -> e::F,\n}\nstruct G(u8);";
    assert_eq!(structs(code), [("A", 2)]);
}
