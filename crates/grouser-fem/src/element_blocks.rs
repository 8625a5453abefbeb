//! Elements gathered in blocks that stay in a core's nearest cache, eight elements side by side.
//!
//! A block holds up to [`MAX_LOCAL_NODES`] nodes of one material. What an element needs each step is its inverse reference
//! Jacobian, its weight and its local node numbers: 88 bytes for a linear tetrahedron (`docs/theory/elastic_solids.md`).

use grouser_geometry::tetrahedron_shape::{
    QUADRATURE_POINTS, jacobian, linear_shape_derivatives, quadratic_shape_derivatives,
};
use grouser_geometry::{ElementOrder, TetrahedralMesh, Vec3};

use crate::law::Law;
use crate::number::{LANES, Lanes, Real};

/// Most nodes that a block may touch; local arrays of this fixed size need no bounds checks.
pub(crate) const MAX_LOCAL_NODES: usize = 1024;
/// Most elements of a block.
const MAX_ELEMENTS: usize = 1024;

/// Eight elements of `E` + 1 nodes and `Q` quadrature points.
#[derive(Clone, Debug)]
pub(crate) struct Group<const E: usize, const Q: usize> {
    /// Local number of node 0 of each element.
    pub first: [u16; LANES],
    /// Local numbers of nodes 1…E of each element.
    pub others: [[u16; LANES]; E],
    /// ∂N/∂X of nodes 1…E at each quadrature point [1/m]; that of node 0 is minus their sum.
    pub gradients: [[[Lanes; 3]; E]; Q],
    /// Reference volume of each quadrature point [m³]; 0 in lanes without element.
    pub weights: [Lanes; Q],
}

/// Elements of one material that are close to each other.
#[derive(Clone, Debug)]
pub(crate) struct Block<const E: usize, const Q: usize> {
    pub law: Law,
    pub region: u32,
    pub groups: Vec<Group<E, Q>>,
    /// Mesh node of each local node, ascending.
    pub nodes: Vec<u32>,
    /// Mesh element of each lane of the groups, one after the other.
    pub elements: Vec<u32>,
}

/// Where the contributions of the blocks to a node are found.
#[derive(Clone, Debug)]
pub(crate) struct NodeGather {
    /// Range of `sources` of node n: `starts[n]..starts[n + 1]`.
    starts: Vec<u32>,
    /// Places in the concatenated results of the blocks, in ascending order of the blocks.
    sources: Vec<u32>,
}

/// Gradients [1/m] at a quadrature point, one for each node, and its reference volume [m³].
pub(crate) type PointGeometry = (Vec<Vec3>, f64);

/// Shape-function gradients and weights of the quadrature points of element `e`.
pub(crate) fn element_geometry(mesh: &TetrahedralMesh, e: usize) -> Vec<PointGeometry> {
    let positions = mesh.element_positions(e);
    let point = |derivatives: &[Vec3], weight: f64| {
        let j = jacobian(&positions, derivatives);
        let inverse = j.try_inverse().expect("a validated mesh has invertible Jacobians");
        let gradients = derivatives.iter().map(|d| inverse.transpose() * d).collect();
        (gradients, j.determinant() * weight)
    };
    match mesh.order {
        ElementOrder::Linear => vec![point(&linear_shape_derivatives(), 1.0 / 6.0)],
        ElementOrder::Quadratic => {
            QUADRATURE_POINTS.iter().map(|&l| point(&quadratic_shape_derivatives(l), 1.0 / 24.0)).collect()
        }
    }
}

impl<const E: usize, const Q: usize> Block<E, Q> {
    /// Blocks of a mesh; `laws` by region.
    pub fn of_mesh(mesh: &TetrahedralMesh, laws: &[Law]) -> Vec<Self> {
        let centers: Vec<Vec3> = (0..mesh.n_elements())
            .map(|e| mesh.element(e)[..4].iter().map(|&n| mesh.nodes[n as usize]).sum::<Vec3>() / 4.0)
            .collect();
        let mut blocks = Vec::new();
        for (region, &law) in laws.iter().enumerate() {
            let mut elements: Vec<u32> = (0..mesh.n_elements() as u32)
                .filter(|&e| mesh.region_of_element[e as usize] as usize == region)
                .collect();
            split(mesh, &centers, &mut elements, &mut |part| {
                blocks.push(Self::new(mesh, law, region as u32, part));
            });
        }
        blocks
    }

    fn new(mesh: &TetrahedralMesh, law: Law, region: u32, elements: &[u32]) -> Self {
        let nodes = nodes_of(mesh, elements);
        let local = |node: u32| nodes.partition_point(|&n| n < node) as u16;
        let elements = arrange(elements, |e| mesh.element(e as usize).iter().map(|&n| local(n)));
        let mut groups = Vec::with_capacity(elements.len().div_ceil(LANES));
        for members in elements.chunks(LANES) {
            let mut group = Group {
                first: [0; LANES],
                others: [[0; LANES]; E],
                gradients: [[[Lanes::constant(0.0); 3]; E]; Q],
                weights: [Lanes::constant(0.0); Q],
            };
            for (lane, &e) in members.iter().enumerate() {
                let numbers = mesh.element(e as usize);
                group.first[lane] = local(numbers[0]);
                for i in 0..E {
                    group.others[i][lane] = local(numbers[i + 1]);
                }
                for (q, (gradients, weight)) in element_geometry(mesh, e as usize).into_iter().enumerate() {
                    group.weights[q].0[lane] = weight;
                    for i in 0..E {
                        for axis in 0..3 {
                            group.gradients[q][i][axis].0[lane] = gradients[i + 1][axis];
                        }
                    }
                }
            }
            groups.push(group);
        }
        Self { law, region, groups, nodes, elements }
    }
}

/// Elements in an order in which eight that are computed side by side share no node where that can be had: their forces are then
/// added in memory without waiting for each other.
fn arrange<N: Iterator<Item = u16>>(elements: &[u32], local_nodes: impl Fn(u32) -> N) -> Vec<u32> {
    const WORDS: usize = MAX_LOCAL_NODES / 64;
    let mut full = Vec::with_capacity(elements.len());
    let mut open: Vec<(Vec<u32>, [u64; WORDS])> = Vec::new();
    for &e in elements {
        let is_taken =
            |used: &[u64; WORDS]| local_nodes(e).any(|n| used[n as usize / 64] >> (n % 64) & 1 == 1);
        let place = open.iter().position(|(_, used)| !is_taken(used)).unwrap_or_else(|| {
            open.push((Vec::with_capacity(LANES), [0; WORDS]));
            open.len() - 1
        });
        let (members, used) = &mut open[place];
        members.push(e);
        local_nodes(e).for_each(|n| used[n as usize / 64] |= 1 << (n % 64));
        if members.len() == LANES {
            full.append(&mut open.remove(place).0);
        }
    }
    open.into_iter().for_each(|(mut members, _)| full.append(&mut members));
    full
}

/// Cuts the elements in halves across the longest extent until each part fits a block.
fn split(mesh: &TetrahedralMesh, centers: &[Vec3], elements: &mut [u32], emit: &mut impl FnMut(&[u32])) {
    if elements.is_empty() {
        return;
    }
    if elements.len() <= MAX_ELEMENTS && nodes_of(mesh, elements).len() <= MAX_LOCAL_NODES {
        // Elements in the order of the mesh: neighbours in memory stay neighbours.
        elements.sort_unstable();
        return emit(elements);
    }
    let at = |e: u32| centers[e as usize];
    let low = elements.iter().fold(Vec3::repeat(f64::INFINITY), |low, &e| low.inf(&at(e)));
    let high = elements.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |high, &e| high.sup(&at(e)));
    let axis = (high - low).imax();
    let middle = elements.len() / 2;
    elements.select_nth_unstable_by(middle, |&a, &b| at(a)[axis].total_cmp(&at(b)[axis]).then(a.cmp(&b)));
    let (left, right) = elements.split_at_mut(middle);
    split(mesh, centers, left, emit);
    split(mesh, centers, right, emit);
}

fn nodes_of(mesh: &TetrahedralMesh, elements: &[u32]) -> Vec<u32> {
    let mut nodes: Vec<u32> = elements.iter().flat_map(|&e| mesh.element(e as usize)).copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

impl NodeGather {
    /// Sources of each of `n_nodes` nodes in blocks with the given local nodes.
    pub fn new<'a>(n_nodes: usize, blocks: impl Iterator<Item = &'a [u32]> + Clone) -> Self {
        let mut starts = vec![0; n_nodes + 1];
        for &n in blocks.clone().flatten() {
            starts[n as usize + 1] += 1;
        }
        for n in 0..n_nodes {
            starts[n + 1] += starts[n];
        }
        let mut next = starts.clone();
        let mut sources = vec![0; starts[n_nodes] as usize];
        for (place, &n) in blocks.flatten().enumerate() {
            sources[next[n as usize] as usize] = place as u32;
            next[n as usize] += 1;
        }
        Self { starts, sources }
    }

    /// Number of places.
    pub fn n_sources(&self) -> usize {
        self.sources.len()
    }

    /// Places of node `n`.
    #[inline]
    pub fn of(&self, n: usize) -> &[u32] {
        &self.sources[self.starts[n] as usize..self.starts[n + 1] as usize]
    }
}
