//! Abaqus input files: tetrahedra of four or ten nodes, with their sets, sections and surfaces.

use std::collections::{BTreeMap, HashMap};
use std::io::Read;

use crate::gmsh::short;
use crate::mesh_file::{Label, ListedElement, MeshFileError, MeshListing};
use crate::tetrahedron_shape::FACE_CORNERS;
use crate::{TetrahedralMesh, Vec3};

/// Reads the mesh of an Abaqus input file [m, or the unit of the file].
///
/// Elements `C3D4…` and `C3D10…` become tetrahedra. Regions are the element sets of the solid sections, otherwise the sets that
/// the elements are listed in, otherwise `solid`. `*NSET` gives node sets; `*SURFACE` of type ELEMENT and element sets of
/// triangles (as Gmsh writes) give surfaces. Lines, shells and whatever describes no mesh are passed over.
///
/// # Errors
/// [`MeshFileError`] with line and remedy; the mesh is checked by [`TetrahedralMesh::validate`].
pub fn read_abaqus(mut source: impl Read) -> Result<TetrahedralMesh, MeshFileError> {
    let mut text = String::new();
    source.read_to_string(&mut text)?;
    let mut reader = Reader::default();
    let mut lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim())).peekable();
    let is_data = |line: &str| !line.starts_with('*');
    if !text.lines().any(|line| line.trim_start().starts_with('*')) {
        let found = format!("`{}`", short(text.lines().next().unwrap_or("").trim()));
        let expected = "an Abaqus input file with keywords such as `*NODE`";
        return Err(MeshFileError::Format { line: 1, found, expected });
    }
    while let Some((line, content)) = lines.next() {
        if content.is_empty() || content.starts_with("**") {
            continue;
        }
        if is_data(content) {
            const EXPECTED: &str = "a keyword that begins with `*`";
            return Err(MeshFileError::Syntax { line, expected: EXPECTED, found: short(content) });
        }
        let mut head = content.to_owned();
        // A keyword goes on in the next line after a comma.
        while head.ends_with(',') && lines.peek().is_some_and(|(_, next)| is_data(next)) {
            head.extend(lines.next().map(|(_, next)| next));
        }
        let keyword = Keyword::new(line, &head);
        let mut data = Vec::new();
        while let Some(&(line, content)) = lines.peek().filter(|(_, c)| is_data(c) || c.starts_with("**")) {
            lines.next();
            if is_data(content) && !content.is_empty() {
                data.push((line, content));
            }
        }
        reader.keyword(&keyword, &data)?;
    }
    reader.finish()
}

/// A keyword with its parameters; names in capitals, values as written.
struct Keyword {
    line: usize,
    name: String,
    parameters: Vec<(String, String)>,
}

impl Keyword {
    fn new(line: usize, text: &str) -> Self {
        let mut parts = text.trim_start_matches('*').split(',').map(str::trim);
        let name = parts.next().unwrap_or("").to_ascii_uppercase();
        let parameter = |part: &str| {
            let (name, value) = part.split_once('=').unwrap_or((part, ""));
            (name.trim().to_ascii_uppercase(), value.trim().trim_matches('"').to_owned())
        };
        Self { line, name, parameters: parts.filter(|p| !p.is_empty()).map(parameter).collect() }
    }

    fn get(&self, name: &str) -> Option<&str> {
        self.parameters.iter().find(|(n, _)| n == name).map(|(_, value)| &value[..])
    }

    fn required(&self, name: &'static str, expected: &'static str) -> Result<&str, MeshFileError> {
        let missing = || MeshFileError::Syntax { line: self.line, expected, found: format!("no {name}") };
        self.get(name).filter(|value| !value.is_empty()).ok_or_else(missing)
    }
}

/// Sets by their name in capitals: Abaqus does not tell cases apart; with the first spelling.
#[derive(Default)]
struct Sets(BTreeMap<String, (String, Vec<Label>)>);

impl Sets {
    fn of(&mut self, name: &str) -> &mut Vec<Label> {
        &mut self.0.entry(name.to_ascii_uppercase()).or_insert_with(|| (name.to_owned(), Vec::new())).1
    }

    fn get(&self, name: &str) -> Option<&Vec<Label>> {
        self.0.get(&name.to_ascii_uppercase()).map(|(_, set)| set)
    }
}

/// Face of an element (`S1` … `S4`) or of each element of a set.
struct SurfacePart {
    line: usize,
    owner: String,
    face: usize,
}

#[derive(Default)]
struct Reader {
    listing: MeshListing,
    node_sets: Sets,
    element_sets: Sets,
    /// Corners of elements that are triangles.
    triangles: HashMap<u64, ([u64; 3], usize)>,
    /// Sets with a solid section.
    sections: Vec<(String, usize)>,
    surfaces: BTreeMap<String, Vec<SurfacePart>>,
}

/// Data lines with their numbers.
type Data<'a> = [(usize, &'a str)];

impl Reader {
    fn keyword(&mut self, keyword: &Keyword, data: &Data<'_>) -> Result<(), MeshFileError> {
        match &keyword.name[..] {
            "NODE" => self.nodes(keyword, data),
            "ELEMENT" => self.elements(keyword, data),
            "NSET" => {
                let name = keyword.required("NSET", "`NSET=name` after `*NSET`")?.to_owned();
                set_members(keyword, data, &name, &mut self.node_sets)
            }
            "ELSET" => {
                let name = keyword.required("ELSET", "`ELSET=name` after `*ELSET`")?.to_owned();
                set_members(keyword, data, &name, &mut self.element_sets)
            }
            "SOLID SECTION" => {
                let name = keyword.required("ELSET", "`ELSET=name` after `*SOLID SECTION`")?;
                self.sections.push((name.to_owned(), keyword.line));
                Ok(())
            }
            "SURFACE" => self.surface(keyword, data),
            "INSTANCE" if !data.is_empty() => {
                unsupported(keyword.line, "an instance that is moved or turned")
            }
            "INCLUDE" => unsupported(keyword.line, "an included file"),
            "NGEN" | "NFILL" | "NCOPY" | "NMAP" | "ELGEN" | "ELCOPY" | "SYSTEM" => {
                unsupported(keyword.line, "a generated or transformed mesh")
            }
            _ => Ok(()),
        }
    }

    fn nodes(&mut self, keyword: &Keyword, data: &Data<'_>) -> Result<(), MeshFileError> {
        const EXPECTED: &str = "a node: its number and three coordinates";
        for &(line, content) in data {
            let mut words = words(content);
            let label = (number(line, words.next(), EXPECTED)?, line);
            let mut position = Vec3::zeros();
            for k in 0..3 {
                position[k] = number(line, words.next(), EXPECTED)?;
            }
            self.listing.add_node(label, position)?;
            if let Some(set) = keyword.get("NSET") {
                self.node_sets.of(set).push(label);
            }
        }
        Ok(())
    }

    fn elements(&mut self, keyword: &Keyword, data: &Data<'_>) -> Result<(), MeshFileError> {
        let kind = keyword.required("TYPE", "`TYPE=…` after `*ELEMENT`")?.to_ascii_uppercase();
        let Some((n_nodes, is_solid)) = nodes_of_kind(&kind) else {
            if kind.starts_with("C3D") || kind.starts_with("SC") {
                return unsupported(keyword.line, &format!("an element of type {}", short(&kind)));
            }
            return Ok(());
        };
        const EXPECTED: &str = "an element: its number and as many nodes as its type has";
        let mut lines = data.iter();
        while let Some(&(line, content)) = lines.next() {
            let mut numbers = Vec::with_capacity(n_nodes + 1);
            for word in words(content) {
                numbers.push(number(line, Some(word), EXPECTED)?);
            }
            // The nodes of one element may take several lines.
            while numbers.len() <= n_nodes {
                let Some(&(line, content)) = lines.next() else {
                    return Err(syntax(line, EXPECTED, "end of the list"));
                };
                for word in words(content) {
                    numbers.push(number(line, Some(word), EXPECTED)?);
                }
            }
            if numbers.len() != n_nodes + 1 {
                return Err(syntax(line, EXPECTED, &format!("{} numbers", numbers.len())));
            }
            let (label, nodes) = ((numbers[0], line), numbers.split_off(1));
            let set = keyword.get("ELSET").filter(|set| !set.is_empty());
            if is_solid {
                let region = set.unwrap_or("solid").to_owned();
                self.listing.add_element(ListedElement { label, region, nodes })?;
            } else {
                self.triangles.insert(label.0, ([nodes[0], nodes[1], nodes[2]], line));
            }
            if let Some(set) = set {
                self.element_sets.of(set).push(label);
            }
        }
        Ok(())
    }

    fn surface(&mut self, keyword: &Keyword, data: &Data<'_>) -> Result<(), MeshFileError> {
        if keyword.get("TYPE").is_some_and(|kind| !kind.eq_ignore_ascii_case("ELEMENT")) {
            return Ok(());
        }
        let name = keyword.required("NAME", "`NAME=name` after `*SURFACE`")?;
        let parts = self.surfaces.entry(name.to_owned()).or_default();
        for &(line, content) in data {
            const EXPECTED: &str = "an element or element set and a face S1 … S4";
            let mut words = words(content);
            let owner = words.next().ok_or_else(|| syntax(line, EXPECTED, content))?.to_owned();
            let face = match words.next().map(str::to_ascii_uppercase).as_deref() {
                Some("S1") => 0,
                Some("S2") => 1,
                Some("S3") => 2,
                Some("S4") => 3,
                other => return Err(syntax(line, EXPECTED, other.unwrap_or("end of line"))),
            };
            parts.push(SurfacePart { line, owner, face });
        }
        Ok(())
    }

    fn finish(mut self) -> Result<TetrahedralMesh, MeshFileError> {
        let place_of_label: HashMap<u64, usize> =
            self.listing.elements.iter().enumerate().map(|(place, e)| (e.label.0, place)).collect();
        for (name, line) in &self.sections {
            let unknown = || syntax(*line, "a solid section of an element set that the file defines", name);
            for (label, _) in self.element_sets.get(name).ok_or_else(unknown)? {
                if let Some(&place) = place_of_label.get(label) {
                    self.listing.elements[place].region.clone_from(name);
                }
            }
        }
        // Sets of triangles are surfaces.
        for (name, set) in self.element_sets.0.values() {
            let faces: Vec<_> =
                set.iter().filter_map(|(label, _)| self.triangles.get(label)).copied().collect();
            if !faces.is_empty() {
                self.listing.faces.insert(name.clone(), faces);
            }
        }
        for (name, parts) in &self.surfaces {
            let mut faces = Vec::new();
            for part in parts {
                let single = part.owner.parse().ok().map(|label: u64| vec![(label, part.line)]);
                let set = single.as_ref().or_else(|| self.element_sets.get(&part.owner));
                let unknown =
                    || syntax(part.line, "an element or element set that the file defines", &part.owner);
                for (label, _) in set.ok_or_else(unknown)? {
                    let Some(&place) = place_of_label.get(label) else {
                        let (line, owner) = (part.line, format!("surface '{name}'"));
                        return Err(MeshFileError::Unknown { line, owner, what: "element", label: *label });
                    };
                    let nodes = &self.listing.elements[place].nodes;
                    faces.push((FACE_CORNERS[part.face].map(|k| nodes[k]), part.line));
                }
            }
            self.listing.faces.entry(name.clone()).or_default().extend(faces);
        }
        self.listing.node_sets = self.node_sets.0.into_values().collect();
        self.listing.finish()
    }
}

/// Adds what a set lists: numbers, names of other sets, or ranges where it says GENERATE.
fn set_members(keyword: &Keyword, data: &Data<'_>, name: &str, sets: &mut Sets) -> Result<(), MeshFileError> {
    const EXPECTED: &str = "numbers or names of sets (with GENERATE: first, last, step)";
    /// A range longer than this is a mistake in the file, not a mesh.
    const LONGEST_RANGE: u64 = 100_000_000;
    sets.of(name);
    for &(line, content) in data {
        if keyword.get("GENERATE").is_some() {
            let mut words = words(content);
            let first: u64 = number(line, words.next(), EXPECTED)?;
            let last: u64 = number(line, words.next(), EXPECTED)?;
            let step: u64 = words.next().map_or(Ok(1), |word| number(line, Some(word), EXPECTED))?;
            if step == 0 || last < first || (last - first) / step > LONGEST_RANGE {
                return Err(syntax(line, EXPECTED, content));
            }
            sets.of(name).extend((first..=last).step_by(step as usize).map(|label| (label, line)));
            continue;
        }
        for word in words(content) {
            // `instance.7` names node 7 of an instance.
            let plain = word.rsplit_once('.').map_or(word, |(_, label)| label);
            let members = match plain.parse::<u64>() {
                Ok(label) => vec![(label, line)],
                Err(_) => sets.get(word).cloned().ok_or_else(|| syntax(line, EXPECTED, word))?,
            };
            sets.of(name).extend(members);
        }
    }
    Ok(())
}

/// Nodes of an element type that can be used, and whether it is a tetrahedron (otherwise a triangle).
fn nodes_of_kind(kind: &str) -> Option<(usize, bool)> {
    let is_variant = |rest: &str| rest.chars().all(|c| c.is_ascii_alphabetic());
    let is = |prefix: &str| kind.strip_prefix(prefix).is_some_and(is_variant);
    let is_one_of = |kinds: &[&str]| kinds.iter().any(|kind| is(kind));
    if is("C3D4") {
        Some((4, true))
    } else if is("C3D10") {
        Some((10, true))
    } else if is_one_of(&["S3", "CPS3", "CPE3", "M3D3", "SFM3D3", "STRI3", "R3D3"]) {
        Some((3, false))
    } else if is_one_of(&["CPS6", "CPE6", "M3D6", "SFM3D6", "STRI65"]) {
        Some((6, false))
    } else {
        None
    }
}

fn words(content: &str) -> impl Iterator<Item = &str> {
    content.split(',').map(str::trim).filter(|word| !word.is_empty())
}

fn number<T: std::str::FromStr>(
    line: usize,
    word: Option<&str>,
    expected: &'static str,
) -> Result<T, MeshFileError> {
    let word = word.unwrap_or("end of line");
    word.parse().map_err(|_| syntax(line, expected, word))
}

fn syntax(line: usize, expected: &'static str, found: &str) -> MeshFileError {
    MeshFileError::Syntax { line, expected, found: short(found) }
}

fn unsupported(line: usize, what: &str) -> Result<(), MeshFileError> {
    let expected =
        "one part in place, all nodes and tetrahedra (C3D4, C3D10) listed; remedy: export an orphan mesh";
    Err(MeshFileError::Format { line, found: what.to_owned(), expected })
}
