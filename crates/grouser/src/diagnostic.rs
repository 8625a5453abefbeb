//! What is wrong with an input, said so that the reader can mend it: what, where, what was expected, the usual
//! cause, the remedy.

use std::fmt;

/// One message about an input.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Diagnostic {
    /// What is wrong.
    pub what: String,
    /// Where it stands.
    pub place: Option<Place>,
    /// What would have been right.
    pub expected: String,
    /// How this mistake usually comes about.
    pub usual_cause: String,
    /// What to do.
    pub remedy: String,
}

/// A stretch of one line of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// File, or the argument that the text came from.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// The whole line.
    pub text: String,
    /// Characters to underline.
    pub length: usize,
}

impl Diagnostic {
    /// A message without a place.
    pub fn new(what: impl Into<String>) -> Self {
        Diagnostic { what: what.into(), ..Diagnostic::default() }
    }

    /// Says what would have been right.
    pub fn expected(mut self, text: impl Into<String>) -> Self {
        self.expected = text.into();
        self
    }

    /// Says how the mistake usually comes about.
    pub fn usual_cause(mut self, text: impl Into<String>) -> Self {
        self.usual_cause = text.into();
        self
    }

    /// Says what to do.
    pub fn remedy(mut self, text: impl Into<String>) -> Self {
        self.remedy = text.into();
        self
    }
}

impl Place {
    /// The place of a range of bytes of `text`. An empty or many-line range is cut to its first line.
    pub fn of(file: &str, text: &str, range: std::ops::Range<usize>) -> Place {
        let start = floor(text, range.start.min(text.len()));
        let end = floor(text, range.end.clamp(start, text.len()));
        let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |at| start + at);
        Place {
            file: file.to_owned(),
            line: 1 + text[..start].matches('\n').count(),
            column: 1 + text[line_start..start].chars().count(),
            text: text[line_start..line_end].trim_end().to_owned(),
            length: text[start..end.min(line_end).max(start)].chars().count().max(1),
        }
    }
}

/// The nearest character boundary at or before a byte.
fn floor(text: &str, mut at: usize) -> usize {
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

impl Diagnostic {
    /// The message as advice about an input that is taken all the same.
    pub fn as_advice(&self) -> impl fmt::Display {
        fmt::from_fn(|f| self.write("advice", f))
    }

    fn write(&self, head: &str, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{head}: {}", self.what)?;
        if let Some(place) = &self.place {
            let Place { file, line, column, text, length } = place;
            let margin = " ".repeat(line.to_string().len());
            let (blank, carets) = (" ".repeat(column - 1), "^".repeat(*length));
            write!(f, "\n{margin}--> {file}:{line}:{column}")?;
            write!(f, "\n{margin} |\n{line} | {text}\n{margin} | {blank}{carets}")?;
        }
        for (label, text) in
            [("expected", &self.expected), ("usual cause", &self.usual_cause), ("remedy", &self.remedy)]
        {
            if !text.is_empty() {
                write!(f, "\n  {label}: {text}")?;
            }
        }
        Ok(())
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.write("error", f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_points_below_the_value_as_a_compiler_does() {
        let text = "(\n  radius_m: -1,\n)";
        let mut message = Diagnostic::new("radius_m is -1").expected("a positive length [m]");
        message.place = Some(Place::of("a.ron", text, 14..16));
        assert_eq!(
            message.to_string(),
            "error: radius_m is -1\n --> a.ron:2:13\n  |\n2 |   radius_m: -1,\n  |             ^^\n  expected: a positive length [m]"
        );
    }

    #[test]
    fn places_beyond_the_text_or_inside_a_character_are_moved_back() {
        assert_eq!(Place::of("f", "äö", 1..99).column, 1);
        assert_eq!(Place::of("f", "", 5..9).line, 1);
    }
}
