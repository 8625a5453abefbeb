//! A scenario's text with overrides written into it, which still knows where each byte came from.

use super::{Found, Path, locate};
use crate::diagnostic::{Diagnostic, Place};
use std::ops::Range;

/// The text of a scenario file, and what replaced parts of it.
pub struct Source {
    name: String,
    original: String,
    text: String,
    edits: Vec<Edit>,
}

/// A stretch of the present text that is not from the file.
struct Edit {
    now: Range<usize>,
    replaced: Range<usize>,
    origin: String,
}

impl Source {
    /// The text of a file; `name` is what messages call it.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        let text = text.into();
        Source { name: name.into(), original: text.clone(), text, edits: Vec::new() }
    }

    /// The text with every override in place.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Writes `value` where `path` stands, or where it would stand when the text leaves it out.
    /// `origin` is what messages about this value name as its source.
    pub fn set(&mut self, path: &str, value: &str, origin: &str) -> Result<(), Diagnostic> {
        let wrong_path = || {
            Diagnostic::new(format!("{origin}: there is no value at `{path}`"))
                .expected(
                    "a path such as soil.layers[0].depth_m: names of the scenario, lists by number from 0",
                )
                .usual_cause("a part of the path is misspelt, or a number is beyond the end of its list")
                .remedy("`grouser check SCENE` prints the resolved scenario with every name")
        };
        let parsed = Path::parse(path).ok_or_else(wrong_path)?;
        // A broken text is reported when it is read.
        let Some(found) = locate(&self.text, &parsed) else { return Ok(()) };
        let (span, new) = match found {
            Found::Value(span) => (span, value.to_owned()),
            Found::Absent { entries: Some(at), rest, is_map, .. } => {
                if rest.iter().any(|name| name.starts_with('[')) {
                    return Err(wrong_path());
                }
                (at..at, entry(&rest, value, is_map) + ", ")
            }
            Found::Absent { .. } => return Err(wrong_path()),
        };
        self.replace(span, &new, origin);
        Ok(())
    }

    /// Where a range of bytes of the present text came from.
    pub fn place(&self, range: Range<usize>) -> Place {
        match self.edits.iter().find(|edit| edit.now.start <= range.start && range.end <= edit.now.end) {
            Some(edit) => {
                let inside = range.start - edit.now.start..range.end - edit.now.start;
                Place::of(&format!("{}, {}", self.name, edit.origin), &self.text[edit.now.clone()], inside)
            }
            None => {
                let original = self.before(range.start)..self.before(range.end);
                Place::of(&self.name, &self.original, original)
            }
        }
    }

    /// Where a path's value, or the innermost struct that would hold it, stands.
    pub fn place_of(&self, path: &str) -> Option<Place> {
        match locate(&self.text, &Path::parse(path)?)? {
            Found::Value(span) => Some(self.place(span)),
            Found::Absent { within, .. } => Some(self.place(within)),
        }
    }

    /// Position in the original text of a position of the present one.
    fn before(&self, at: usize) -> usize {
        match self.edits.iter().rev().find(|edit| edit.now.start <= at) {
            None => at,
            Some(edit) if at < edit.now.end => edit.replaced.start,
            Some(edit) => at - edit.now.end + edit.replaced.end,
        }
    }

    fn replace(&mut self, span: Range<usize>, new: &str, origin: &str) {
        let replaced = self.before(span.start)..self.before(span.end);
        let mut added = Edit { now: span.start..span.start + new.len(), replaced, origin: origin.to_owned() };
        let longer = new.len() as isize - span.len() as isize;
        let shift = |at: usize| at.strict_add_signed(longer);
        self.text.replace_range(span.clone(), new);
        self.edits.retain_mut(|edit| {
            if edit.now.end <= span.start && edit.now.start < span.start {
                return true;
            }
            if span.end <= edit.now.start {
                edit.now = shift(edit.now.start)..shift(edit.now.end);
                return true;
            }
            if edit.now.start <= span.start && span.end <= edit.now.end && edit.now != span {
                // Inside an earlier override: one stretch, both origins.
                added.now = edit.now.start..shift(edit.now.end);
                added.replaced = edit.replaced.clone();
                added.origin = format!("{} and {origin}", edit.origin);
            }
            false
        });
        let at = self.edits.partition_point(|edit| edit.now.start < added.now.start);
        self.edits.insert(at, added);
    }
}

/// An entry that is missing, with the structs around its value: `dials: (rotation: Fixed)`.
fn entry(names: &[String], value: &str, is_map: bool) -> String {
    let (first, rest) = names.split_first().expect("an absent value has a name");
    let inner = if rest.is_empty() { value.to_owned() } else { format!("({})", entry(rest, value, false)) };
    if is_map { format!("\"{first}\": {inner}") } else { format!("{first}: {inner}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "(\n  a: 1,\n  b: (c: 22, d: [3, 4]),\n  e: 5,\n)";

    #[test]
    fn values_are_replaced_and_missing_ones_inserted() {
        let mut source = Source::new("s.ron", TEXT);
        source.set("b.c", "-7.5", "--set b.c").unwrap();
        source.set("b.d[1]", "40", "--set b.d[1]").unwrap();
        source.set("b.x.y", "true", "--set b.x.y").unwrap();
        assert_eq!(source.text(), "(\n  a: 1,\n  b: (x: (y: true), c: -7.5, d: [3, 40]),\n  e: 5,\n)");
    }

    #[test]
    fn places_of_the_file_survive_overrides_and_overrides_name_their_argument() {
        let mut source = Source::new("s.ron", TEXT);
        source.set("a", "123456", "--set a").unwrap();
        source.set("b.d[0]", "333", "--set b.d[0]").unwrap();
        source.set("b.new", "9", "--set b.new").unwrap();
        source.set("a", "0", "--set a again").unwrap();
        let e = source.place_of("e").unwrap();
        assert_eq!((e.file.as_str(), e.line, e.column, e.text.as_str()), ("s.ron", 4, 6, "  e: 5,"));
        let four = source.place_of("b.d[1]").unwrap();
        assert_eq!((four.line, four.column), (3, 21));
        let c = source.place_of("b.c").unwrap();
        assert_eq!((c.line, c.column), (3, 10));
        assert_eq!(source.place_of("a").unwrap().file, "s.ron, --set a again");
        assert_eq!(source.place_of("b.d[0]").unwrap().text, "333");
    }

    #[test]
    fn an_override_inside_an_override_names_both() {
        let mut source = Source::new("s.ron", TEXT);
        source.set("b", "(c: 1, d: [1, 2])", "quick").unwrap();
        source.set("b.d[1]", "200", "--set").unwrap();
        assert_eq!(source.place_of("b.d[1]").unwrap().file, "s.ron, quick and --set");
        assert_eq!(source.place_of("e").unwrap().line, 4);
    }

    #[test]
    fn paths_that_lead_nowhere_are_refused() {
        let mut source = Source::new("s.ron", TEXT);
        for path in ["a.b", "b.d[2]", "", "b..c", "b.d.c"] {
            assert!(source.set(path, "1", "--set").is_err(), "{path}");
        }
    }
}
