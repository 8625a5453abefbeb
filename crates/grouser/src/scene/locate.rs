//! Where in a RON text a value stands: `soil.layers[0].sizes` → bytes 412..447.
//!
//! Positions are lost once serde has built a scenario, so messages about values and textual overrides find them
//! again here. Payloads of enum variants and of `Some` are transparent: `Grains((container: …))` and
//! `Grains(container: …)` are both entered by `soil.container`.

use std::fmt;
use std::ops::Range;

/// A way from the top of a scenario to one of its values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Path(Vec<Segment>);

#[derive(Debug, Clone, PartialEq, Eq)]
enum Segment {
    Name(String),
    Index(usize),
}

/// What a path led to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Found {
    /// The value's bytes.
    Value(Range<usize>),
    /// The text leaves this value out; the innermost struct or map on the way is written at `within`, its entries begin
    /// at `entries`, `rest` is missing in it, and `is_map` says how entries are written.
    Absent {
        /// Bytes of the innermost value on the way.
        within: Range<usize>,
        /// Where its first entry would begin; none when it has no entries.
        entries: Option<usize>,
        /// Names missing below it.
        rest: Vec<String>,
        /// True for `{…}`.
        is_map: bool,
    },
}

impl Path {
    /// Reads `a.b[2].c`. None when it is not of this form.
    pub fn parse(text: &str) -> Option<Path> {
        let mut segments = Vec::new();
        for part in text.split('.') {
            let (name, mut indices) = part.split_at(part.find('[').unwrap_or(part.len()));
            if name.is_empty() {
                return None;
            }
            segments.push(Segment::Name(name.to_owned()));
            while !indices.is_empty() {
                let (number, rest) = indices.strip_prefix('[')?.split_once(']')?;
                segments.push(Segment::Index(number.parse().ok()?));
                indices = rest;
            }
        }
        Some(Path(segments))
    }
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for (i, segment) in self.0.iter().enumerate() {
            match segment {
                Segment::Name(name) if i == 0 => write!(f, "{name}")?,
                Segment::Name(name) => write!(f, ".{name}")?,
                Segment::Index(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}

/// Finds a value in a RON text. None when the text is not RON.
pub fn locate(text: &str, path: &Path) -> Option<Found> {
    let mut scanner = Scanner { text: text.as_bytes(), at: 0, depth: 0 };
    scanner.skip_blank();
    let mut node = scanner.value()?;
    for (depth, segment) in path.0.iter().enumerate() {
        match node.enter(segment) {
            Ok(child) => node = child,
            Err(last) => {
                let rest = path.0[depth..].iter().map(|segment| match segment {
                    Segment::Name(name) => name.clone(),
                    Segment::Index(index) => format!("[{index}]"),
                });
                let entries = matches!(last.kind, Kind::Named(..)).then_some(last.open);
                let is_map = matches!(last.kind, Kind::Named(_, true));
                return Some(Found::Absent { within: last.span, entries, rest: rest.collect(), is_map });
            }
        }
    }
    Some(Found::Value(node.span))
}

/// A value of the text: its bytes, where its entries begin, and what is in it.
struct Node {
    span: Range<usize>,
    open: usize,
    kind: Kind,
}

enum Kind {
    /// Number, text, name without payload.
    Leaf,
    /// `Name(value)`: one unnamed payload behind a name.
    Payload(Box<Node>),
    /// `[…]` or an unnamed tuple.
    Items(Vec<Node>),
    /// Struct, or map (`true`).
    Named(Vec<(String, Node)>, bool),
}

impl Node {
    /// The child of that name or index; the innermost transparent payload when there is none.
    fn enter(self, segment: &Segment) -> Result<Node, Node> {
        match (self.kind, segment) {
            (Kind::Payload(payload), segment) => payload.enter(segment),
            (Kind::Items(mut items), Segment::Index(index)) if *index < items.len() => {
                Ok(items.swap_remove(*index))
            }
            (Kind::Named(entries, is_map), Segment::Name(name)) => {
                match entries.iter().position(|(key, _)| key == name) {
                    Some(at) => Ok(entries.into_iter().nth(at).expect("position of an entry").1),
                    None => Err(Node { kind: Kind::Named(entries, is_map), ..self }),
                }
            }
            (kind, _) => Err(Node { kind, ..self }),
        }
    }
}

struct Scanner<'a> {
    text: &'a [u8],
    at: usize,
    depth: usize,
}

/// Deeper nesting is no scenario (and RON refuses it too).
const DEEPEST: usize = 128;

impl Scanner<'_> {
    fn value(&mut self) -> Option<Node> {
        self.depth += 1;
        let node = if self.depth > DEEPEST { None } else { self.value_here() };
        self.depth -= 1;
        node
    }

    fn value_here(&mut self) -> Option<Node> {
        let start = self.at;
        match self.peek()? {
            b'(' => self.group(start, false),
            b'[' => self.list(start),
            b'{' => self.map(start),
            b'"' => self.quoted(start),
            b'\'' => {
                self.at += if self.text.get(self.at + 1) == Some(&b'\\') { 2 } else { 1 };
                self.skip_past(b"'")?;
                self.leaf(start)
            }
            b'r' if matches!(self.text.get(self.at + 1), Some(b'"' | b'#')) => self.raw_quoted(start),
            c if c.is_ascii_alphabetic() || c == b'_' => {
                self.word();
                let end = self.at;
                self.skip_blank();
                if self.peek() == Some(b'(') {
                    return self.group(start, true);
                }
                self.at = end;
                self.leaf(start)
            }
            _ => {
                while self.peek().is_some_and(|c| !c.is_ascii_whitespace() && !b",)]}:/".contains(&c)) {
                    self.at += 1;
                }
                (self.at > start).then_some(())?;
                self.leaf(start)
            }
        }
    }

    /// `( … )`: a struct when its first entry is `name:`, otherwise a tuple.
    fn group(&mut self, start: usize, has_name: bool) -> Option<Node> {
        self.at += 1;
        let open = self.at;
        let (mut named, mut items) = (Vec::new(), Vec::new());
        while !self.closes(b')')? {
            match self.field_name() {
                Some(name) => named.push((name, self.value()?)),
                None => items.push(self.value()?),
            }
            self.comma();
        }
        let kind = if items.is_empty() {
            Kind::Named(named, false)
        } else if has_name && items.len() == 1 {
            Kind::Payload(Box::new(items.pop()?))
        } else {
            Kind::Items(items)
        };
        Some(Node { span: start..self.at, open, kind })
    }

    fn list(&mut self, start: usize) -> Option<Node> {
        self.at += 1;
        let (open, mut items) = (self.at, Vec::new());
        while !self.closes(b']')? {
            items.push(self.value()?);
            self.comma();
        }
        Some(Node { span: start..self.at, open, kind: Kind::Items(items) })
    }

    fn map(&mut self, start: usize) -> Option<Node> {
        self.at += 1;
        let (open, mut entries) = (self.at, Vec::new());
        while !self.closes(b'}')? {
            let key = self.value()?.span;
            self.skip_blank();
            (self.peek()? == b':').then(|| self.at += 1)?;
            self.skip_blank();
            let key = String::from_utf8_lossy(&self.text[key]).trim_matches('"').to_owned();
            entries.push((key, self.value()?));
            self.comma();
        }
        Some(Node { span: start..self.at, open, kind: Kind::Named(entries, true) })
    }

    fn quoted(&mut self, start: usize) -> Option<Node> {
        self.at += 1;
        loop {
            match self.peek()? {
                b'\\' => self.at += 2,
                b'"' => break,
                _ => self.at += 1,
            }
        }
        self.at += 1;
        self.leaf(start)
    }

    fn raw_quoted(&mut self, start: usize) -> Option<Node> {
        self.at += 1;
        let hashes = self.text[self.at..].iter().take_while(|&&c| c == b'#').count();
        self.at += hashes + 1;
        let mut end = vec![b'#'; hashes + 1];
        end[0] = b'"';
        self.skip_past(&end)?;
        self.leaf(start)
    }

    fn leaf(&self, start: usize) -> Option<Node> {
        (self.at <= self.text.len()).then_some(Node { span: start..self.at, open: self.at, kind: Kind::Leaf })
    }

    /// `name:` before a field's value; nothing is consumed when there is none.
    fn field_name(&mut self) -> Option<String> {
        let start = self.at;
        let name = self.word();
        self.skip_blank();
        if name.is_some() && self.peek() == Some(b':') && self.text.get(self.at + 1) != Some(&b':') {
            self.at += 1;
            self.skip_blank();
            return name;
        }
        self.at = start;
        None
    }

    fn word(&mut self) -> Option<String> {
        let start = self.at;
        if self.text[start..].starts_with(b"r#") {
            self.at += 2;
        }
        while self.peek().is_some_and(|c| c.is_ascii_alphanumeric() || c == b'_') {
            self.at += 1;
        }
        (self.at > start).then(|| String::from_utf8_lossy(&self.text[start..self.at]).replace("r#", ""))
    }

    /// True, and past it, when the bracket closes here; false when an entry follows; none at the text's end.
    fn closes(&mut self, bracket: u8) -> Option<bool> {
        self.skip_blank();
        let closes = self.peek()? == bracket;
        self.at += usize::from(closes);
        Some(closes)
    }

    fn comma(&mut self) {
        self.skip_blank();
        self.at += usize::from(self.peek() == Some(b','));
    }

    /// Skips white space, comments and `#![enable(…)]`.
    fn skip_blank(&mut self) {
        loop {
            let rest = &self.text[self.at.min(self.text.len())..];
            match rest {
                [c, ..] if c.is_ascii_whitespace() => self.at += 1,
                [b'/', b'/', ..] => self.at += rest.iter().take_while(|&&c| c != b'\n').count(),
                [b'#', b'!', ..] => self.at += rest.iter().take_while(|&&c| c != b']').count() + 1,
                [b'/', b'*', ..] => {
                    let mut depth = 0;
                    while self.at < self.text.len() {
                        match &self.text[self.at..] {
                            [b'/', b'*', ..] => (depth, self.at) = (depth + 1, self.at + 2),
                            [b'*', b'/', ..] => (depth, self.at) = (depth - 1, self.at + 2),
                            _ => self.at += 1,
                        }
                        if depth == 0 {
                            break;
                        }
                    }
                }
                _ => return,
            }
        }
    }

    fn skip_past(&mut self, end: &[u8]) -> Option<()> {
        self.at += 1;
        let from = self.at.min(self.text.len());
        self.at = from + self.text[from..].windows(end.len()).position(|window| window == end)? + end.len();
        Some(())
    }

    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"#![enable(implicit_some)]
// a comment with ( brackets
(
    title: "a \" quote, (and) brackets", /* nested /* comment */ */
    soil: Grains((
        layers: [(radius: 1e-3), (radius: Uniform(radius_m: (0.1, 0.2)))],
    )),
    materials: {"sand": (young_pa: 1_000.5), "steel": Some(( young_pa: -2 ))},
    flag: true,
    raw: r"c:\",
)"#;

    fn found(path: &str) -> &'static str {
        match locate(TEXT, &Path::parse(path).unwrap()).unwrap() {
            Found::Value(span) => &TEXT[span],
            absent => panic!("{path}: {absent:?}"),
        }
    }

    #[test]
    fn values_are_found_through_structs_lists_maps_and_payloads() {
        assert_eq!(found("soil.layers[0].radius"), "1e-3");
        assert_eq!(found("soil.layers[1].radius.radius_m[1]"), "0.2");
        assert_eq!(found("materials.sand.young_pa"), "1_000.5");
        assert_eq!(found("materials.steel.young_pa"), "-2");
        assert_eq!(found("flag"), "true");
        assert_eq!(found("raw"), r#"r"c:\""#);
        assert_eq!(found("soil.layers[1].radius"), "Uniform(radius_m: (0.1, 0.2))");
    }

    #[test]
    fn a_value_left_out_names_the_struct_that_would_hold_it() {
        let missing = locate(TEXT, &Path::parse("soil.settle.energy").unwrap()).unwrap();
        let Found::Absent { entries: Some(at), rest, is_map: false, .. } = missing else {
            panic!("{missing:?}")
        };
        assert_eq!(rest, ["settle", "energy"]);
        assert!(TEXT[..at].ends_with("Grains(("));
    }

    #[test]
    fn broken_text_and_broken_paths_are_none_not_a_panic() {
        for end in 0..TEXT.len() {
            let _ = locate(&TEXT[..end], &Path::parse("soil.layers[0]").unwrap());
        }
        assert_eq!(locate(&"a(".repeat(100_000), &Path::parse("a").unwrap()), None);
        for path in ["", ".", "a..b", "a[", "a[x]", "[0]"] {
            assert_eq!(Path::parse(path), None, "{path}");
        }
        assert_eq!(Path::parse("a.b[0][1].c").unwrap().to_string(), "a.b[0][1].c");
    }
}
