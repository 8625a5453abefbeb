//! Gmsh meshes, text format 2.2 and 4.1: tetrahedra of four or ten nodes, named by physical groups.

use std::collections::HashMap;
use std::io::Read;

use crate::mesh_file::{ListedElement, MeshFileError, MeshListing};
use crate::{TetrahedralMesh, Vec3};

/// Reads a Gmsh mesh [m]: physical volumes become regions (`physical 3` where unnamed, `solid` without group), physical
/// surfaces become surfaces, physical curves and points node sets.
///
/// # Errors
/// [`MeshFileError`] with line and remedy; the mesh is checked by [`TetrahedralMesh::validate`].
pub fn read_gmsh(mut source: impl Read) -> Result<TetrahedralMesh, MeshFileError> {
    let mut text = String::new();
    source.read_to_string(&mut text)?;
    let mut reader = Reader { lines: Lines { rest: text.lines(), line: 0 }, ..Default::default() };
    reader.read()?;
    reader.listing.finish()
}

/// Sizes of groups are declared, not trusted: nothing is reserved for them.
#[derive(Default)]
struct Reader<'a> {
    lines: Lines<'a>,
    is_version_4: bool,
    names: HashMap<(i64, i64), String>,
    /// Physical groups of each entity (dimension, tag), format 4.1.
    groups_of_entity: HashMap<(i64, i64), Vec<i64>>,
    listing: MeshListing,
}

impl<'a> Reader<'a> {
    fn read(&mut self) -> Result<(), MeshFileError> {
        const FORMAT: &str = "a Gmsh file that begins with `$MeshFormat` (format 2.2 or 4.1, ASCII)";
        match self.lines.next_filled() {
            Some("$MeshFormat") => {}
            other => {
                let found = format!("`{}`", short(other.unwrap_or("end of file")));
                return Err(MeshFileError::Format { line: self.lines.line.max(1), found, expected: FORMAT });
            }
        }
        let words = self.lines.words("version, file type and data size")?;
        let line = self.lines.line;
        self.is_version_4 = match words[0] {
            "2" | "2.0" | "2.1" | "2.2" => false,
            "4.1" => true,
            version => {
                let expected = "2.2 or 4.1 (Gmsh: -format msh41)";
                return Err(MeshFileError::Format {
                    line,
                    found: format!("format {}", short(version)),
                    expected,
                });
            }
        };
        if words.get(1) != Some(&"0") {
            let expected = "file type 0, text (Gmsh: -bin leaves it away, Mesh.Binary = 0)";
            return Err(MeshFileError::Format { line, found: "a binary file".to_owned(), expected });
        }
        self.end("$EndMeshFormat")?;
        while let Some(section) = self.lines.next_filled() {
            match (section, self.is_version_4) {
                ("$PhysicalNames", _) => self.physical_names()?,
                ("$Entities", true) => self.entities()?,
                ("$Nodes", false) => self.nodes_2()?,
                ("$Nodes", true) => self.nodes_4()?,
                ("$Elements", false) => self.elements_2()?,
                ("$Elements", true) => self.elements_4()?,
                (other, _) => self.skip(other)?,
            }
        }
        Ok(())
    }

    fn end(&mut self, name: &'static str) -> Result<(), MeshFileError> {
        let found = self.lines.next_filled();
        if found == Some(name) {
            Ok(())
        } else {
            Err(self.lines.syntax(name, found.unwrap_or("end of file")))
        }
    }

    fn skip(&mut self, section: &str) -> Result<(), MeshFileError> {
        let Some(name) = section.strip_prefix('$') else {
            return Err(self.lines.syntax("a section such as `$Nodes`", section));
        };
        let end = format!("$End{name}");
        while let Some(line) = self.lines.next_filled() {
            if line == end {
                return Ok(());
            }
        }
        Err(self.lines.syntax("the end of the section that the file begins last", "end of file"))
    }

    fn physical_names(&mut self) -> Result<(), MeshFileError> {
        const EXPECTED: &str = "dimension, tag and \"name\" of a physical group";
        let [n] = self.lines.integers("the number of physical names")?;
        for _ in 0..n {
            let line = self.lines.line(EXPECTED)?;
            let parts = || {
                let (dimension, rest) = line.split_once(char::is_whitespace)?;
                let (tag, name) = rest.trim_start().split_once(char::is_whitespace)?;
                let name = name.trim().strip_prefix('"')?.strip_suffix('"')?;
                Some(((dimension.parse().ok()?, tag.parse().ok()?), name.to_owned()))
            };
            let (key, name) = parts().ok_or_else(|| self.lines.syntax(EXPECTED, line))?;
            self.names.insert(key, name);
        }
        self.end("$EndPhysicalNames")
    }

    fn entities(&mut self) -> Result<(), MeshFileError> {
        let counts: [i64; 4] = self.lines.integers("numbers of points, curves, surfaces and volumes")?;
        for (dimension, count) in counts.into_iter().enumerate() {
            for _ in 0..count {
                const EXPECTED: &str = "an entity: tag, extent, number of physical groups and their tags";
                let words = self.lines.words(EXPECTED)?;
                let first = if dimension == 0 { 4 } else { 7 };
                let integer = |k: usize| words.get(k).and_then(|w| w.parse::<i64>().ok());
                let groups = || {
                    let n = usize::try_from(integer(first)?).ok().filter(|&n| n < words.len())?;
                    (0..n).map(|k| integer(first + 1 + k)).collect::<Option<Vec<i64>>>()
                };
                let (tag, groups) =
                    integer(0).zip(groups()).ok_or_else(|| self.lines.syntax(EXPECTED, words[0]))?;
                self.groups_of_entity.insert((dimension as i64, tag), groups);
            }
        }
        self.end("$EndEntities")
    }

    fn nodes_2(&mut self) -> Result<(), MeshFileError> {
        const EXPECTED: &str = "a node: its number and three coordinates";
        let [n] = self.lines.integers("the number of nodes")?;
        for _ in 0..n {
            let words = self.lines.words(EXPECTED)?;
            let label = self.lines.label(words[0], EXPECTED)?;
            let position = self.lines.position(&words[1..], EXPECTED)?;
            self.listing.add_node((label, self.lines.line), position)?;
        }
        self.end("$EndNodes")
    }

    fn nodes_4(&mut self) -> Result<(), MeshFileError> {
        let [n_blocks, ..]: [i64; 4] =
            self.lines.integers("numbers of blocks and nodes, smallest and largest tag")?;
        for _ in 0..n_blocks {
            let [_, _, _, n]: [i64; 4] =
                self.lines.integers("a block of nodes: dimension, entity, parametric, number of nodes")?;
            let mut labels = Vec::new();
            for _ in 0..n {
                let words = self.lines.words("the tag of a node")?;
                labels.push((self.lines.label(words[0], "the tag of a node")?, self.lines.line));
            }
            for label in labels {
                const EXPECTED: &str = "three coordinates of a node";
                let words = self.lines.words(EXPECTED)?;
                let position = self.lines.position(&words, EXPECTED)?;
                self.listing.add_node(label, position)?;
            }
        }
        self.end("$EndNodes")
    }

    fn elements_2(&mut self) -> Result<(), MeshFileError> {
        const EXPECTED: &str = "an element: number, type, number of tags, tags and nodes";
        let [n] = self.lines.integers("the number of elements")?;
        for _ in 0..n {
            let words = self.lines.words(EXPECTED)?;
            let [label, kind, n_tags] = self.lines.leading(&words, EXPECTED)?;
            let tags = usize::try_from(n_tags).ok().and_then(|n| words.get(3..)?.split_at_checked(n));
            let (tags, nodes) = tags.ok_or_else(|| self.lines.syntax(EXPECTED, words[0]))?;
            let group = tags
                .first()
                .map_or(Ok(0), |w| w.parse())
                .map_err(|_| self.lines.syntax(EXPECTED, tags[0]))?;
            let label = u64::try_from(label).map_err(|_| self.lines.syntax(EXPECTED, words[0]))?;
            self.element(label, kind, nodes, &[group])?;
        }
        self.end("$EndElements")
    }

    fn elements_4(&mut self) -> Result<(), MeshFileError> {
        let [n_blocks, ..]: [i64; 4] =
            self.lines.integers("numbers of blocks and elements, smallest and largest tag")?;
        for _ in 0..n_blocks {
            let [dimension, entity, kind, n]: [i64; 4] =
                self.lines.integers("a block of elements: dimension, entity, type, number of elements")?;
            let groups = self.groups_of_entity.get(&(dimension, entity)).cloned().unwrap_or_default();
            for _ in 0..n {
                const EXPECTED: &str = "an element: its tag and its nodes";
                let words = self.lines.words(EXPECTED)?;
                let label = self.lines.label(words[0], EXPECTED)?;
                self.element(label, kind, &words[1..], &groups)?;
            }
        }
        self.end("$EndElements")
    }

    fn element(
        &mut self,
        label: u64,
        kind: i64,
        words: &[&str],
        groups: &[i64],
    ) -> Result<(), MeshFileError> {
        let (dimension, n_nodes) = match kind {
            15 => (0, 1),
            1 => (1, 2),
            8 => (1, 3),
            2 => (2, 3),
            9 => (2, 6),
            4 => (3, 4),
            11 => (3, 10),
            _ => {
                let found = format!("element {label} of type {kind}");
                let expected = "tetrahedra of 4 or 10 nodes with their triangles, lines and points (types 4, 11, 2, 9, 1, 8, 15)";
                return Err(MeshFileError::Format { line: self.lines.line, found, expected });
            }
        };
        const EXPECTED: &str = "as many node numbers as the element's type has nodes";
        if words.len() != n_nodes {
            return Err(self.lines.syntax(EXPECTED, words.last().unwrap_or(&"end of line")));
        }
        let mut nodes = Vec::with_capacity(n_nodes);
        for word in words {
            nodes.push(self.lines.label(word, EXPECTED)?);
        }
        let line = self.lines.line;
        let name = |group: &i64| {
            let unnamed = || if *group == 0 { "solid".to_owned() } else { format!("physical {group}") };
            self.names.get(&(dimension, *group)).cloned().unwrap_or_else(unnamed)
        };
        match nodes[..] {
            _ if dimension == 3 => {
                if n_nodes == 10 {
                    // Gmsh lists the sides (2, 3) and (1, 3) the other way round.
                    nodes.swap(8, 9);
                }
                let region = name(groups.first().unwrap_or(&0));
                self.listing.add_element(ListedElement { label: (label, line), region, nodes })?;
            }
            [a, b, c, ..] if dimension == 2 => {
                for group in groups.iter().filter(|g| **g != 0) {
                    let name = name(group);
                    self.listing.faces.entry(name).or_default().push(([a, b, c], line));
                }
            }
            _ => {
                for group in groups.iter().filter(|g| **g != 0) {
                    let name = name(group);
                    self.listing.node_sets.entry(name).or_default().extend(nodes.iter().map(|&n| (n, line)));
                }
            }
        }
        Ok(())
    }
}

/// Lines of the file with their number.
struct Lines<'a> {
    rest: std::str::Lines<'a>,
    line: usize,
}

impl Default for Lines<'_> {
    fn default() -> Self {
        Self { rest: "".lines(), line: 0 }
    }
}

impl<'a> Lines<'a> {
    fn next_filled(&mut self) -> Option<&'a str> {
        loop {
            let line = self.rest.next()?.trim();
            self.line += 1;
            if !line.is_empty() {
                return Some(line);
            }
        }
    }

    fn line(&mut self, expected: &'static str) -> Result<&'a str, MeshFileError> {
        match self.next_filled() {
            Some(line) if !line.starts_with('$') => Ok(line),
            other => Err(self.syntax(expected, other.unwrap_or("end of file"))),
        }
    }

    /// Words of the next line, at least one.
    fn words(&mut self, expected: &'static str) -> Result<Vec<&'a str>, MeshFileError> {
        Ok(self.line(expected)?.split_whitespace().collect())
    }

    /// Exactly `N` integers of the next line, none negative.
    fn integers<const N: usize>(&mut self, expected: &'static str) -> Result<[i64; N], MeshFileError> {
        let words = self.words(expected)?;
        if words.len() != N {
            return Err(self.syntax(expected, words[N.min(words.len() - 1)]));
        }
        self.leading(&words, expected)
    }

    /// The first `N` words as integers, none negative.
    fn leading<const N: usize>(
        &self,
        words: &[&str],
        expected: &'static str,
    ) -> Result<[i64; N], MeshFileError> {
        let mut numbers = [0; N];
        for (k, number) in numbers.iter_mut().enumerate() {
            let word = words.get(k).copied().unwrap_or("end of line");
            *number = word.parse().ok().filter(|n| *n >= 0).ok_or_else(|| self.syntax(expected, word))?;
        }
        Ok(numbers)
    }

    fn label(&self, word: &str, expected: &'static str) -> Result<u64, MeshFileError> {
        word.parse().map_err(|_| self.syntax(expected, word))
    }

    /// The first three words as coordinates.
    fn position(&self, words: &[&str], expected: &'static str) -> Result<Vec3, MeshFileError> {
        let mut position = Vec3::zeros();
        for k in 0..3 {
            let word = words.get(k).copied().unwrap_or("end of line");
            position[k] = word.parse().map_err(|_| self.syntax(expected, word))?;
        }
        Ok(position)
    }

    fn syntax(&self, expected: &'static str, found: &str) -> MeshFileError {
        MeshFileError::Syntax { line: self.line.max(1), expected, found: short(found) }
    }
}

/// At most forty characters of a word.
pub(crate) fn short(word: &str) -> String {
    word.chars().take(40).collect()
}
