//! From what a mesh file lists – nodes, elements, faces, sets, all by number – to a checked [`TetrahedralMesh`].

use std::collections::{BTreeMap, HashMap};
use std::io;

use thiserror::Error;

use crate::{ElementOrder, MeshError, TetrahedralMesh, Vec3};

/// Why a mesh file could not be read.
#[derive(Debug, Error)]
pub enum MeshFileError {
    /// The source itself failed, or is not text.
    #[error("the mesh file could not be read: {0}; only text files are understood, save the mesh as ASCII")]
    Io(#[from] io::Error),
    /// Another format, or a variant that is not understood.
    #[error("line {line}: {found} is not understood: expected {expected}")]
    Format {
        /// Line, counted from 1.
        line: usize,
        /// What the file is or uses.
        found: String,
        /// What can be read, and the remedy.
        expected: &'static str,
    },
    /// A word that should be something else.
    #[error(
        "line {line}: expected {expected}, found `{found}`; usual cause: a file cut off or edited by hand; remedy: correct the \
         line or export the mesh again"
    )]
    Syntax {
        /// Line, counted from 1.
        line: usize,
        /// What should stand there.
        expected: &'static str,
        /// What stands there.
        found: String,
    },
    /// Two nodes or elements of one number.
    #[error(
        "line {line}: {what} {label} is defined a second time, first in line {first}; usual cause: several parts in one file, each \
         counted from 1; remedy: merge them in the meshing program"
    )]
    Twice {
        /// Line, counted from 1.
        line: usize,
        /// Node or element.
        what: &'static str,
        /// Its number.
        label: u64,
        /// Line of the first definition.
        first: usize,
    },
    /// A number that nothing carries.
    #[error(
        "line {line}: {owner} names {what} {label}, which the file does not define; usual cause: a file cut off, or a set of \
         another part; remedy: export the whole mesh"
    )]
    Unknown {
        /// Line, counted from 1.
        line: usize,
        /// Who names it.
        owner: String,
        /// Node or element.
        what: &'static str,
        /// Its number.
        label: u64,
    },
    /// Elements of four and of ten nodes in one mesh.
    #[error(
        "line {line}: element {element} has {found} nodes, but those before it have {expected}: a mesh is of one order; remedy: set \
         one element order in the meshing program"
    )]
    MixedOrders {
        /// Line, counted from 1.
        line: usize,
        /// Number of the element.
        element: u64,
        /// Its nodes.
        found: usize,
        /// Nodes of the first element.
        expected: usize,
    },
    /// A triangle of a named surface that is no face of a tetrahedron.
    #[error(
        "line {line}: a triangle of surface '{surface}' is no face of any tetrahedron; usual cause: surface and volume were meshed \
         apart; remedy: mesh the volume from this surface, or leave the surface out"
    )]
    NoFace {
        /// Line, counted from 1.
        line: usize,
        /// Name of the surface.
        surface: String,
    },
    /// The mesh is complete but unusable.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Number in a file with the line that it stands in.
pub(crate) type Label = (u64, usize);

/// Tetrahedron as listed, node order of [`crate::tetrahedron_shape`].
#[derive(Clone, Debug)]
pub(crate) struct ListedElement {
    pub label: Label,
    pub region: String,
    pub nodes: Vec<u64>,
}

/// What a file lists, before numbers are resolved.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeshListing {
    /// Nodes in the order of the file.
    nodes: Vec<(Label, Vec3)>,
    node_of_label: HashMap<u64, u32>,
    /// Tetrahedra in the order of the file.
    pub elements: Vec<ListedElement>,
    line_of_element: HashMap<u64, usize>,
    /// Corner numbers of the triangles of each surface, with lines.
    pub faces: BTreeMap<String, Vec<([u64; 3], usize)>>,
    /// Numbers of the nodes of each set.
    pub node_sets: BTreeMap<String, Vec<Label>>,
}

impl MeshListing {
    /// Adds a node.
    pub fn add_node(&mut self, (label, line): Label, position: Vec3) -> Result<(), MeshFileError> {
        if let Some(first) = self.node_of_label.insert(label, self.nodes.len() as u32) {
            let first = self.nodes[first as usize].0.1;
            return Err(MeshFileError::Twice { line, what: "node", label, first });
        }
        self.nodes.push(((label, line), position));
        Ok(())
    }

    /// Adds a tetrahedron of four or ten nodes.
    pub fn add_element(&mut self, element: ListedElement) -> Result<(), MeshFileError> {
        let ((label, line), found) = (element.label, element.nodes.len());
        if let Some(first) = self.line_of_element.insert(label, line) {
            return Err(MeshFileError::Twice { line, what: "element", label, first });
        }
        match self.elements.first().map(|e| e.nodes.len()) {
            Some(expected) if expected != found => {
                Err(MeshFileError::MixedOrders { line, element: label, found, expected })
            }
            _ => {
                self.elements.push(element);
                Ok(())
            }
        }
    }

    /// Resolves all numbers and checks the mesh; nodes that no tetrahedron uses are left out.
    pub fn finish(self) -> Result<TetrahedralMesh, MeshFileError> {
        let mut mesh = TetrahedralMesh::default();
        if self.elements.first().is_some_and(|e| e.nodes.len() == 10) {
            mesh.order = ElementOrder::Quadratic;
        }
        let mut is_used = vec![false; self.nodes.len()];
        for element in &self.elements {
            for label in &element.nodes {
                let owner = || format!("element {}", element.label.0);
                is_used[self.place((*label, element.label.1), owner)?] = true;
            }
        }
        // Number of each kept node, in the order of the file.
        let mut node_of_place = vec![u32::MAX; self.nodes.len()];
        for (place, _) in is_used.iter().enumerate().filter(|(_, is_used)| **is_used) {
            node_of_place[place] = mesh.nodes.len() as u32;
            mesh.nodes.push(self.nodes[place].1);
        }
        let node = |label: u64| node_of_place[self.node_of_label[&label] as usize];
        for element in &self.elements {
            mesh.connectivity.extend(element.nodes.iter().map(|&label| node(label)));
            let region = mesh.region_names.iter().position(|name| *name == element.region);
            let region = region.unwrap_or_else(|| {
                mesh.region_names.push(element.region.clone());
                mesh.region_names.len() - 1
            });
            mesh.region_of_element.push(region as u32);
            mesh.element_labels.push(element.label.0);
        }
        for (name, set) in &self.node_sets {
            let owner = || format!("node set '{name}'");
            let mut nodes = Vec::with_capacity(set.len());
            for &label in set {
                nodes.push(node_of_place[self.place(label, owner)?]);
            }
            nodes.retain(|&n| n != u32::MAX);
            nodes.sort_unstable();
            nodes.dedup();
            mesh.node_sets.insert(name.clone(), nodes);
        }
        mesh.validate()?;
        for (surface, faces) in &self.faces {
            let owner = || format!("surface '{surface}'");
            let mut triples = Vec::with_capacity(faces.len());
            for &(corners, line) in faces {
                let mut triple = [0; 3];
                for (k, label) in corners.into_iter().enumerate() {
                    triple[k] = node_of_place[self.place((label, line), owner)?];
                }
                triples.push(triple);
            }
            let mut facets = Vec::with_capacity(faces.len());
            for (facet, &(_, line)) in mesh.facets_of_corners(&triples).into_iter().zip(faces) {
                facets.push(facet.ok_or_else(|| MeshFileError::NoFace { line, surface: surface.clone() })?);
            }
            facets.sort_unstable();
            facets.dedup();
            mesh.surfaces.insert(surface.clone(), facets);
        }
        Ok(mesh)
    }

    /// Place in `nodes` of a number that `owner` names.
    fn place(&self, (label, line): Label, owner: impl Fn() -> String) -> Result<usize, MeshFileError> {
        match self.node_of_label.get(&label) {
            Some(&place) => Ok(place as usize),
            None => Err(MeshFileError::Unknown { line, owner: owner(), what: "node", label }),
        }
    }
}
