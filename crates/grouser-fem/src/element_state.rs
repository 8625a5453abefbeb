//! One element at a time: displacement gradients, stresses, energies and tangent stiffness for statics, bounds and output.
//!
//! This plain path is independent of the blocked kernel of the explicit step and serves as its reference.

use grouser_geometry::nalgebra::{DMatrix, Matrix3};
use grouser_geometry::{TetrahedralMesh, Vec3};

use crate::element_blocks::{PointGeometry, element_geometry};
use crate::law::{ElasticLaw, Law};
use crate::number::{Dual, Real};
use crate::tensor::Tensor;
use crate::with_law;

/// Elements of a mesh under a displacement field.
pub(crate) struct ElementStates<'a> {
    pub mesh: &'a TetrahedralMesh,
    /// Law of each region.
    pub laws: &'a [Law],
    /// Displacement of each node [m].
    pub displacement: &'a [Vec3],
    /// Nodal averages where the elements use them.
    pub average: Option<SlotAverages>,
}

/// Volumes and volume changes around each node, one slot for each (region, node).
pub(crate) struct SlotAverages {
    n_nodes: usize,
    /// Quarter of the adjoining volume [m³].
    pub volume: Vec<f64>,
    /// Averaged volume change θ.
    pub volume_change: Vec<f64>,
}

/// Displacement gradient H = Σ u_i ⊗ ∇N_i.
pub(crate) fn gradient_of(displacements: &[Vec3], gradients: &[Vec3]) -> Tensor<f64> {
    let sum: Matrix3<f64> = displacements.iter().zip(gradients).map(|(u, g)| u * g.transpose()).sum();
    Tensor::from_matrix(&sum)
}

impl<'a> ElementStates<'a> {
    pub fn new(
        mesh: &'a TetrahedralMesh,
        laws: &'a [Law],
        displacement: &'a [Vec3],
        is_averaged: bool,
    ) -> Self {
        let mut states = Self { mesh, laws, displacement, average: None };
        if is_averaged {
            let n_nodes = mesh.nodes.len();
            let mut average = SlotAverages {
                n_nodes,
                volume: vec![0.0; n_nodes * laws.len()],
                volume_change: vec![0.0; n_nodes * laws.len()],
            };
            for e in 0..mesh.n_elements() {
                for (h, _, weight) in states.points(e) {
                    let theta = with_law!(states.law(e), |law| law.response(&h).volume_change);
                    for slot in states.slots(e) {
                        average.volume[slot] += weight / 4.0;
                        average.volume_change[slot] += weight / 4.0 * theta;
                    }
                }
            }
            for (theta, volume) in average.volume_change.iter_mut().zip(&average.volume) {
                *theta = if *volume > 0.0 { *theta / volume } else { 0.0 };
            }
            states.average = Some(average);
        }
        states
    }

    /// Law of element `e`.
    pub fn law(&self, e: usize) -> Law {
        self.laws[self.mesh.region_of_element[e] as usize]
    }

    /// Slots of the four corners of element `e` in the nodal averages.
    pub fn slots(&self, e: usize) -> [usize; 4] {
        let (n_nodes, region) = (self.mesh.nodes.len(), self.mesh.region_of_element[e] as usize);
        std::array::from_fn(|i| region * n_nodes + self.mesh.element(e)[i] as usize)
    }

    /// Displacement gradient, shape-function gradients and reference volume of each quadrature point of element `e`.
    pub fn points(&self, e: usize) -> impl Iterator<Item = (Tensor<f64>, Vec<Vec3>, f64)> {
        let u: Vec<Vec3> = self.mesh.element(e).iter().map(|&n| self.displacement[n as usize]).collect();
        element_geometry(self.mesh, e)
            .into_iter()
            .map(move |(gradients, weight): PointGeometry| (gradient_of(&u, &gradients), gradients, weight))
    }

    /// U'(θ) averaged over the corners of element `e`, where averages are used [Pa].
    fn averaged_pressure(&self, e: usize) -> Option<f64> {
        let average = self.average.as_ref()?;
        let law = self.law(e);
        let pressure = |slot: usize| with_law!(law, |l| l.pressure(average.volume_change[slot]));
        Some(self.slots(e).into_iter().map(pressure).sum::<f64>() / 4.0)
    }

    /// First Piola–Kirchhoff stress [Pa] of element `e` at displacement gradient `h`.
    pub fn stress(&self, e: usize, h: &Tensor<f64>) -> Tensor<f64> {
        self.stress_of(e, h)
    }

    fn stress_of<S: Real>(&self, e: usize, h: &Tensor<S>) -> Tensor<S> {
        with_law!(self.law(e), |law| {
            let r = law.response(h);
            let pressure = match self.averaged_pressure(e) {
                Some(p) => S::constant(p),
                None => law.pressure(r.volume_change),
            };
            r.stress_at_constant_volume + r.volume_gradient.times(pressure)
        })
    }

    /// Stored energy of element `e` [J]; with averaged pressure its corners' shares of the nodal energies.
    pub fn energy(&self, e: usize) -> f64 {
        with_law!(self.law(e), |law| {
            self.points(e)
                .map(|(h, _, weight)| {
                    let volumetric = match &self.average {
                        None => law.volume_energy(law.response(&h).volume_change),
                        Some(a) => {
                            self.slots(e).iter().map(|&s| law.volume_energy(a.volume_change[s])).sum::<f64>()
                                / 4.0
                        }
                    };
                    weight * (law.energy_at_constant_volume(&h) + volumetric)
                })
                .sum()
        })
    }

    /// Tangent stiffness of element `e` [N/m], 3 × 3 for each pair of nodes; with averaged pressure at fixed nodal pressures.
    pub fn stiffness(&self, e: usize) -> DMatrix<f64> {
        let n = self.mesh.order.n_nodes();
        let mut stiffness = DMatrix::zeros(3 * n, 3 * n);
        for (h, gradients, weight) in self.points(e) {
            // dP for a unit change of each component of F, exact by dual numbers.
            let moduli: [[Tensor<f64>; 3]; 3] = std::array::from_fn(|k| {
                std::array::from_fn(|l| {
                    let direction = Tensor::from_fn(|i, j| Dual {
                        value: h.0[i][j],
                        derivative: f64::from(u8::from((i, j) == (k, l))),
                    });
                    let stress = self.stress_of(e, &direction);
                    Tensor::from_fn(|i, j| stress.0[i][j].derivative)
                })
            });
            for b in 0..n {
                for k in 0..3 {
                    // dP when node b moves along k.
                    let change: Tensor<f64> = Tensor::from_fn(|i, j| {
                        (0..3).map(|l| moduli[k][l].0[i][j] * gradients[b][l]).sum::<f64>() * weight
                    });
                    for a in 0..n {
                        for i in 0..3 {
                            let row = &change.0[i];
                            stiffness[(3 * a + i, 3 * b + k)] +=
                                row[0] * gradients[a].x + row[1] * gradients[a].y + row[2] * gradients[a].z;
                        }
                    }
                }
            }
        }
        stiffness
    }

    /// For each slot of the nodal averages with volume: U''(θ)/V and the gradient of V θ by the displacements of its nodes.
    pub fn slot_gradients(&self) -> Vec<SlotGradient> {
        let Some(average) = &self.average else { return Vec::new() };
        let mut slots: Vec<SlotGradient> = vec![SlotGradient::default(); average.volume.len()];
        for e in 0..self.mesh.n_elements() {
            let law = self.law(e);
            for (h, gradients, weight) in self.points(e) {
                let by_f = with_law!(law, |l| l.response(&h).volume_gradient).to_matrix();
                for slot in self.slots(e) {
                    for (i, &node) in self.mesh.element(e).iter().enumerate() {
                        slots[slot].entries.push((node, by_f * gradients[i] * (weight / 4.0)));
                    }
                }
            }
        }
        for (s, slot) in slots.iter_mut().enumerate().filter(|(_, slot)| !slot.entries.is_empty()) {
            let law = self.laws[s / average.n_nodes];
            let theta = Dual { value: average.volume_change[s], derivative: 1.0 };
            slot.factor = with_law!(law, |l| l.pressure(theta)).derivative / average.volume[s];
            slot.entries.sort_by_key(|&(node, _)| node);
            slot.entries.dedup_by(|next, kept| {
                let is_same = next.0 == kept.0;
                if is_same {
                    kept.1 += next.1;
                }
                is_same
            });
        }
        slots.retain(|slot| !slot.entries.is_empty());
        slots
    }
}

/// Rank-one part of the tangent that one averaged nodal pressure adds: factor · g gᵀ.
#[derive(Clone, Debug, Default)]
pub(crate) struct SlotGradient {
    pub factor: f64,
    pub entries: Vec<(u32, Vec3)>,
}
