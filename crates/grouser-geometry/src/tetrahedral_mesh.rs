//! Tetrahedral meshes of four or ten nodes, with named regions, surfaces and node sets.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::quality::shape_figure;
use crate::tetrahedron_shape::{
    CORNERS, EDGES, FACE_CORNERS, FACE_NODES, QUADRATURE_POINTS, jacobian, linear_shape_derivatives,
    quadratic_shape_derivatives,
};
use crate::{TriangleSurface, Vec3};

/// Smallest shape figure of an element that a solid accepts: needles up to about 350 times as long as wide.
const SMALLEST_SHAPE: f64 = 1e-3;

/// Number of nodes of every element of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum ElementOrder {
    /// Four nodes: linear displacement, constant strain.
    #[default]
    Linear,
    /// Ten nodes: quadratic displacement; node order of [`crate::tetrahedron_shape`] (that of Abaqus and VTK).
    Quadratic,
}

impl ElementOrder {
    /// Nodes per element: 4 or 10.
    pub fn n_nodes(self) -> usize {
        match self {
            Self::Linear => 4,
            Self::Quadratic => 10,
        }
    }
}

/// Face of an element, as part of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Facet {
    /// Number of the element, counted from 0.
    pub element: u32,
    /// Face 0…3 of [`crate::tetrahedron_shape::FACE_CORNERS`].
    pub face: u8,
}

/// Solid divided into tetrahedra of positive volume.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TetrahedralMesh {
    /// Positions of the nodes [m].
    pub nodes: Vec<Vec3>,
    /// Four or ten nodes per element.
    pub order: ElementOrder,
    /// Node numbers, [`ElementOrder::n_nodes`] for each element.
    pub connectivity: Vec<u32>,
    /// Index into `region_names` of each element; a region carries one material.
    pub region_of_element: Vec<u32>,
    /// Names of the regions.
    pub region_names: Vec<String>,
    /// Named parts of the boundary.
    pub surfaces: BTreeMap<String, Vec<Facet>>,
    /// Named sets of nodes, sorted.
    pub node_sets: BTreeMap<String, Vec<u32>>,
    /// Numbers that the elements had in their file, for messages; empty where the mesh was generated.
    pub element_labels: Vec<u64>,
}

/// Why a mesh cannot carry a computation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// No element at all.
    #[error(
        "the mesh has no tetrahedra: expected at least one; the file may hold only surface or beam elements – mesh the volume (Gmsh: -3)"
    )]
    Empty,
    /// An array has the wrong length.
    #[error(
        "the mesh has {found} {what} but needs {expected}: the arrays of a mesh must agree; build it with a generator or a reader"
    )]
    Length {
        /// Name of the array.
        what: &'static str,
        /// Its length.
        found: usize,
        /// Length that the others ask for.
        expected: usize,
    },
    /// An element names a node that does not exist.
    #[error(
        "element {element} names node {node}, but the mesh has {n_nodes} nodes: the connectivity counts from 0; shift numbers that count from 1"
    )]
    UnknownNode {
        /// Number of the element.
        element: u64,
        /// Number that it names.
        node: u32,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// A coordinate is infinite or not a number.
    #[error("node {node} lies at a position that is not finite: check the file's coordinates")]
    PositionNotFinite {
        /// Number of the node.
        node: usize,
    },
    /// Elements without positive volume.
    #[error(
        "{count} of the elements are inverted or flat, first element {element} with volume {volume:e} m³: expected positive volume (corners 0, 1, 2 clockwise seen from outside corner 3's side); usual causes are a mirrored mesh, another node order or mid-side nodes pushed too far – remesh, or straighten the sides"
    )]
    Inverted {
        /// Number of the first such element.
        element: u64,
        /// A sixth of its smallest Jacobian determinant [m³].
        volume: f64,
        /// How many there are.
        count: usize,
    },
    /// A node that no element uses: it has no mass and cannot move.
    #[error(
        "node {node} belongs to no element: expected nodes of tetrahedra only; remove it (the readers do so)"
    )]
    UnusedNode {
        /// Number of the node.
        node: usize,
    },
    /// Elements so flat that they would set the step and spoil the stiffness.
    #[error(
        "{count} of the elements are slivers, worst element {element} with shape figure {shape:.1e} (1: regular, expected at least \
         {least}); usual cause: a surface mesh much finer than the volume, or nodes almost in one plane; remedy: optimise the mesh (Gmsh: \
         -optimize_netgen) or remesh"
    )]
    Sliver {
        /// Number of the worst such element.
        element: u64,
        /// Its shape figure, see [`crate::QualityReport`].
        shape: f64,
        /// Smallest shape figure that is accepted.
        least: f64,
        /// How many there are.
        count: usize,
    },
    /// A face belongs to more than two elements.
    #[error(
        "a face of element {element} belongs to more than two elements: elements overlap or are listed twice; remove duplicates"
    )]
    SharedFace {
        /// Number of one of the elements.
        element: u64,
    },
    /// Some elements share no node with the others.
    #[error(
        "the mesh falls into {n_parts} unconnected parts (element {element} is not connected to element {first}): merge coincident nodes (Gmsh: Coherence Mesh), or make each part a solid of its own"
    )]
    Unconnected {
        /// Number of parts.
        n_parts: usize,
        /// First element of the first part.
        first: u64,
        /// First element of the second part.
        element: u64,
    },
    /// No surface or node set of that name.
    #[error("the mesh has no surface or node set named '{name}': it has {known}")]
    UnknownName {
        /// Name asked for.
        name: String,
        /// Names that exist, joined by commas.
        known: String,
    },
}

fn smallest_quadratic_jacobian(positions: &[Vec3], points: &[[f64; 4]]) -> f64 {
    points
        .iter()
        .map(|&l| jacobian(positions, &quadratic_shape_derivatives(l)).determinant())
        .fold(f64::INFINITY, f64::min)
}

impl TetrahedralMesh {
    /// Number of elements.
    pub fn n_elements(&self) -> usize {
        self.connectivity.len() / self.order.n_nodes()
    }

    /// Node numbers of element `e`.
    pub fn element(&self, e: usize) -> &[u32] {
        let n = self.order.n_nodes();
        &self.connectivity[n * e..n * (e + 1)]
    }

    /// Positions of the nodes of element `e` [m].
    pub fn element_positions(&self, e: usize) -> Vec<Vec3> {
        self.element(e).iter().map(|&n| self.nodes[n as usize]).collect()
    }

    /// Number of element `e` for messages: that of its file, or `e`.
    pub fn element_label(&self, e: usize) -> u64 {
        self.element_labels.get(e).copied().unwrap_or(e as u64)
    }

    /// Volume of element `e` [m³]; for curved sides by quadrature of degree 2.
    pub fn element_volume(&self, e: usize) -> f64 {
        let positions = self.element_positions(e);
        match self.order {
            ElementOrder::Linear => jacobian(&positions, &linear_shape_derivatives()).determinant() / 6.0,
            ElementOrder::Quadratic => {
                QUADRATURE_POINTS
                    .iter()
                    .map(|&l| jacobian(&positions, &quadratic_shape_derivatives(l)).determinant())
                    .sum::<f64>()
                    / 24.0
            }
        }
    }

    /// Total volume [m³].
    pub fn volume(&self) -> f64 {
        (0..self.n_elements()).map(|e| self.element_volume(e)).sum()
    }

    /// Smallest Jacobian determinant over an element's quadrature points [m³] (6 × the volume if straight).
    pub fn smallest_jacobian(&self, e: usize) -> f64 {
        let positions = self.element_positions(e);
        match self.order {
            ElementOrder::Linear => jacobian(&positions, &linear_shape_derivatives()).determinant(),
            ElementOrder::Quadratic => smallest_quadratic_jacobian(&positions, &QUADRATURE_POINTS),
        }
    }

    /// Whether curved sides fold element `e` over at a corner: the quadrature points may still be sound.
    pub fn is_folded(&self, e: usize) -> bool {
        self.order == ElementOrder::Quadratic
            && smallest_quadratic_jacobian(&self.element_positions(e), &CORNERS) <= 0.0
    }

    /// Checks everything that a solid relies on: lengths, node numbers, finite positions, positive volumes at the quadrature
    /// points, no slivers, faces shared by at most two elements, one connected part, no unused node.
    ///
    /// # Errors
    /// The first [`MeshError`] found, with the element's number.
    pub fn validate(&self) -> Result<(), MeshError> {
        let n_elements = self.n_elements();
        if n_elements == 0 {
            return Err(MeshError::Empty);
        }
        let expected = n_elements * self.order.n_nodes();
        if self.connectivity.len() != expected {
            return Err(MeshError::Length { what: "node numbers", found: self.connectivity.len(), expected });
        }
        if self.region_of_element.len() != n_elements {
            let found = self.region_of_element.len();
            return Err(MeshError::Length { what: "region numbers", found, expected: n_elements });
        }
        if let Some(&largest) =
            self.region_of_element.iter().max().filter(|&&r| r as usize >= self.region_names.len())
        {
            let (found, expected) = (self.region_names.len(), largest as usize + 1);
            return Err(MeshError::Length { what: "region names", found, expected });
        }
        if let Some(i) = self.connectivity.iter().position(|&n| n as usize >= self.nodes.len()) {
            let element = self.element_label(i / self.order.n_nodes());
            return Err(MeshError::UnknownNode {
                element,
                node: self.connectivity[i],
                n_nodes: self.nodes.len(),
            });
        }
        if let Some(node) = self.nodes.iter().position(|x| !x.iter().all(|c| c.is_finite())) {
            return Err(MeshError::PositionNotFinite { node });
        }
        let mut is_used = vec![false; self.nodes.len()];
        self.connectivity.iter().for_each(|&n| is_used[n as usize] = true);
        if let Some(node) = is_used.iter().position(|is_used| !is_used) {
            return Err(MeshError::UnusedNode { node });
        }
        self.refuse_inverted()?;
        self.refuse_slivers()?;
        self.boundary()?;
        self.refuse_unconnected()
    }

    fn refuse_inverted(&self) -> Result<(), MeshError> {
        // A Jacobian lost in rounding against the element's own size counts as flat.
        let is_flat = |e: &usize| {
            let x = self.element_positions(*e);
            let size = EDGES.iter().map(|&[i, j]| (x[i] - x[j]).norm()).fold(0.0, f64::max);
            self.smallest_jacobian(*e) <= 1e-12 * size.powi(3)
        };
        let bad: Vec<usize> = (0..self.n_elements()).filter(is_flat).collect();
        match bad.first() {
            None => Ok(()),
            Some(&e) => Err(MeshError::Inverted {
                element: self.element_label(e),
                volume: self.smallest_jacobian(e) / 6.0,
                count: bad.len(),
            }),
        }
    }

    fn refuse_slivers(&self) -> Result<(), MeshError> {
        let shapes = (0..self.n_elements()).map(|e| (shape_figure(&self.element_positions(e)), e));
        let slivers: Vec<(f64, usize)> = shapes.filter(|&(shape, _)| shape < SMALLEST_SHAPE).collect();
        match slivers.iter().min_by(|a, b| a.0.total_cmp(&b.0)) {
            None => Ok(()),
            Some(&(shape, e)) => {
                let (element, least, count) = (self.element_label(e), SMALLEST_SHAPE, slivers.len());
                Err(MeshError::Sliver { element, shape, least, count })
            }
        }
    }

    fn refuse_unconnected(&self) -> Result<(), MeshError> {
        let mut root: Vec<u32> = (0..self.nodes.len() as u32).collect();
        fn find(root: &mut [u32], mut n: u32) -> u32 {
            while root[n as usize] != n {
                root[n as usize] = root[root[n as usize] as usize];
                n = root[n as usize];
            }
            n
        }
        for e in 0..self.n_elements() {
            let first = find(&mut root, self.element(e)[0]);
            for &n in &self.element(e)[1..] {
                let other = find(&mut root, n);
                root[other as usize] = first;
            }
        }
        let mut part_of_root = BTreeMap::new();
        for e in 0..self.n_elements() {
            let r = find(&mut root, self.element(e)[0]);
            part_of_root.entry(r).or_insert(e);
        }
        let mut firsts: Vec<usize> = part_of_root.into_values().collect();
        firsts.sort_unstable();
        if firsts.len() > 1 {
            let (first, element) = (self.element_label(firsts[0]), self.element_label(firsts[1]));
            return Err(MeshError::Unconnected { n_parts: firsts.len(), first, element });
        }
        Ok(())
    }

    /// Corner nodes of a facet, anticlockwise seen from outside.
    pub fn facet_corners(&self, facet: Facet) -> [u32; 3] {
        let nodes = self.element(facet.element as usize);
        FACE_CORNERS[facet.face as usize].map(|i| nodes[i])
    }

    /// All nodes of a facet: three corners, and for ten-node elements the three mid-side nodes after them.
    pub fn facet_nodes(&self, facet: Facet) -> Vec<u32> {
        let nodes = self.element(facet.element as usize);
        let n = if self.order == ElementOrder::Linear { 3 } else { 6 };
        FACE_NODES[facet.face as usize][..n].iter().map(|&i| nodes[i]).collect()
    }

    /// Facets that belong to exactly one element, in the order of the elements.
    ///
    /// # Errors
    /// [`MeshError::SharedFace`] where three elements share a face.
    pub fn boundary(&self) -> Result<Vec<Facet>, MeshError> {
        let mut faces: Vec<([u32; 3], Facet)> =
            self.all_facets().map(|f| (self.sorted_corners(f), f)).collect();
        faces.sort_unstable();
        let mut boundary = Vec::new();
        for group in faces.chunk_by(|a, b| a.0 == b.0) {
            match group {
                [(_, facet)] => boundary.push(*facet),
                [_, _] => {}
                more => {
                    return Err(MeshError::SharedFace {
                        element: self.element_label(more[0].1.element as usize),
                    });
                }
            }
        }
        boundary.sort_unstable();
        Ok(boundary)
    }

    /// Facets whose corners are the given triples, in that order; `None` for a triple that is no face of an element.
    pub fn facets_of_corners(&self, triples: &[[u32; 3]]) -> Vec<Option<Facet>> {
        let mut faces: Vec<([u32; 3], Facet)> =
            self.all_facets().map(|f| (self.sorted_corners(f), f)).collect();
        faces.sort_unstable();
        let find = |mut triple: [u32; 3]| {
            triple.sort_unstable();
            let i = faces.partition_point(|(corners, _)| *corners < triple);
            faces.get(i).filter(|(corners, _)| *corners == triple).map(|&(_, facet)| facet)
        };
        triples.iter().map(|&triple| find(triple)).collect()
    }

    fn all_facets(&self) -> impl Iterator<Item = Facet> {
        (0..self.n_elements() as u32).flat_map(|element| (0..4).map(move |face| Facet { element, face }))
    }

    fn sorted_corners(&self, facet: Facet) -> [u32; 3] {
        let mut corners = self.facet_corners(facet);
        corners.sort_unstable();
        corners
    }

    /// Names the facets of the boundary whose corners all satisfy `is_on_surface(position)`.
    ///
    /// # Errors
    /// [`MeshError::SharedFace`] as [`Self::boundary`].
    pub fn name_surface(
        &mut self,
        name: &str,
        is_on_surface: impl Fn(Vec3) -> bool,
    ) -> Result<(), MeshError> {
        let mut facets = self.boundary()?;
        facets.retain(|&f| self.facet_corners(f).iter().all(|&n| is_on_surface(self.nodes[n as usize])));
        self.surfaces.insert(name.to_owned(), facets);
        Ok(())
    }

    /// Facets of a named surface.
    ///
    /// # Errors
    /// [`MeshError::UnknownName`].
    pub fn facets(&self, name: &str) -> Result<&[Facet], MeshError> {
        self.surfaces.get(name).map(Vec::as_slice).ok_or_else(|| self.unknown(name))
    }

    /// Nodes of a named surface or node set, sorted.
    ///
    /// # Errors
    /// [`MeshError::UnknownName`].
    pub fn nodes_of(&self, name: &str) -> Result<Vec<u32>, MeshError> {
        let mut nodes: Vec<u32> = match (self.surfaces.get(name), self.node_sets.get(name)) {
            (Some(facets), _) => facets.iter().flat_map(|&f| self.facet_nodes(f)).collect(),
            (None, Some(set)) => set.clone(),
            (None, None) => return Err(self.unknown(name)),
        };
        nodes.sort_unstable();
        nodes.dedup();
        Ok(nodes)
    }

    fn unknown(&self, name: &str) -> MeshError {
        let known: Vec<&str> =
            self.surfaces.keys().chain(self.node_sets.keys()).map(String::as_str).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        MeshError::UnknownName { name: name.to_owned(), known }
    }

    /// Triangles of some facets with the mesh node of each vertex; a face of six nodes gives four triangles.
    pub fn triangle_surface(&self, facets: &[Facet]) -> (TriangleSurface, Vec<u32>) {
        let mut node_of_vertex: Vec<u32> = facets.iter().flat_map(|&f| self.facet_nodes(f)).collect();
        node_of_vertex.sort_unstable();
        node_of_vertex.dedup();
        let vertex = |node: u32| node_of_vertex.partition_point(|&n| n < node) as u32;
        let mut triangles = Vec::new();
        for &facet in facets {
            let v: Vec<u32> = self.facet_nodes(facet).into_iter().map(vertex).collect();
            match v[..] {
                [a, b, c] => triangles.push([a, b, c]),
                [a, b, c, ab, bc, ca] => {
                    triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]])
                }
                _ => unreachable!("a facet has three or six nodes"),
            }
        }
        let vertices = node_of_vertex.iter().map(|&n| self.nodes[n as usize]).collect();
        (TriangleSurface { vertices, triangles }, node_of_vertex)
    }

    /// The same mesh with ten-node elements: a node in the middle of each straight side. Quadratic meshes are returned as they are.
    pub fn to_quadratic(&self) -> Self {
        if self.order == ElementOrder::Quadratic {
            return self.clone();
        }
        let side = |e: usize, [i, j]: [usize; 2]| {
            let nodes = self.element(e);
            (nodes[i].min(nodes[j]), nodes[i].max(nodes[j]))
        };
        let mut sides: Vec<(u32, u32)> =
            (0..self.n_elements()).flat_map(|e| EDGES.map(|edge| side(e, edge))).collect();
        sides.sort_unstable();
        sides.dedup();
        let mut nodes = self.nodes.clone();
        nodes.extend(sides.iter().map(|&(a, b)| (self.nodes[a as usize] + self.nodes[b as usize]) / 2.0));
        let mut connectivity = Vec::with_capacity(10 * self.n_elements());
        for e in 0..self.n_elements() {
            connectivity.extend_from_slice(self.element(e));
            connectivity.extend(
                EDGES.map(|edge| (self.nodes.len() + sides.partition_point(|&s| s < side(e, edge))) as u32),
            );
        }
        Self { nodes, order: ElementOrder::Quadratic, connectivity, ..self.clone() }
    }
}
