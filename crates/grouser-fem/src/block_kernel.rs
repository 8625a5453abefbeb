//! Arithmetic of one block of elements: gather, displacement gradient, stress, force, scatter.

use grouser_geometry::Vec3;

use crate::element_blocks::{Block, Group, MAX_LOCAL_NODES};
use crate::internal_force::BlockResult;
use crate::law::ElasticLaw;
use crate::number::{LANES, Lanes, Real};
use crate::tensor::Tensor;

/// Vectors of a block's nodes, padded to four numbers.
pub(crate) type Local = [[f64; 4]; MAX_LOCAL_NODES];

/// Working memory of one thread, small enough for its first-level cache.
pub(crate) struct Scratch {
    pub displacement: Box<Local>,
    pub velocity: Box<Local>,
    pub force: Box<Local>,
    pub scalar: Box<[f64; MAX_LOCAL_NODES]>,
}

impl Scratch {
    pub fn new() -> Self {
        let zeros = || Box::new([[0.0; 4]; MAX_LOCAL_NODES]);
        Self {
            displacement: zeros(),
            velocity: zeros(),
            force: zeros(),
            scalar: Box::new([0.0; MAX_LOCAL_NODES]),
        }
    }
}

/// Copies the vectors of the block's nodes to the local array.
#[inline]
pub(crate) fn gather(nodes: &[u32], from: &[Vec3], to: &mut Local) {
    for (local, &n) in to.iter_mut().zip(nodes) {
        let v = from[n as usize];
        *local = [v.x, v.y, v.z, 0.0];
    }
}

/// Forces of a block's elements; the fastest instructions of the machine, none of them fused: the same bits everywhere.
pub(crate) fn forces<
    L: ElasticLaw,
    const E: usize,
    const Q: usize,
    const AVERAGED: bool,
    const VISCOUS: bool,
>(
    law: L,
    beta: f64,
    groups: &[Group<E, Q>],
    scratch: &mut Scratch,
) -> BlockResult {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx512f")]
        fn wide<L: ElasticLaw, const E: usize, const Q: usize, const AVERAGED: bool, const VISCOUS: bool>(
            law: L,
            beta: f64,
            groups: &[Group<E, Q>],
            scratch: &mut Scratch,
        ) -> BlockResult {
            group_forces::<L, E, Q, AVERAGED, VISCOUS>(law, beta, groups, scratch)
        }
        #[target_feature(enable = "avx2")]
        fn medium<
            L: ElasticLaw,
            const E: usize,
            const Q: usize,
            const AVERAGED: bool,
            const VISCOUS: bool,
        >(
            law: L,
            beta: f64,
            groups: &[Group<E, Q>],
            scratch: &mut Scratch,
        ) -> BlockResult {
            group_forces::<L, E, Q, AVERAGED, VISCOUS>(law, beta, groups, scratch)
        }
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: the instructions were just found on this machine.
            return unsafe { wide::<L, E, Q, AVERAGED, VISCOUS>(law, beta, groups, scratch) };
        }
        if is_x86_feature_detected!("avx2") {
            // SAFETY: as above.
            return unsafe { medium::<L, E, Q, AVERAGED, VISCOUS>(law, beta, groups, scratch) };
        }
    }
    group_forces::<L, E, Q, AVERAGED, VISCOUS>(law, beta, groups, scratch)
}

#[inline(always)]
fn group_forces<L: ElasticLaw, const E: usize, const Q: usize, const AVERAGED: bool, const VISCOUS: bool>(
    law: L,
    beta: f64,
    groups: &[Group<E, Q>],
    scratch: &mut Scratch,
) -> BlockResult {
    let mut smallest_ratio = Lanes::constant(f64::INFINITY);
    let mut viscous_power = Lanes::constant(0.0);
    for group in groups {
        let displacement = differences(group, &scratch.displacement);
        let velocity = if VISCOUS { differences(group, &scratch.velocity) } else { displacement };
        let mut force = [[Lanes::constant(0.0); 3]; E];
        for q in 0..Q {
            // 3. Displacement gradient H = sum of u_i x grad N_i.
            let gradient = gradient_of(&displacement, &group.gradients[q]);
            let ratio = (gradient + Tensor::identity()).determinant();
            smallest_ratio = smallest_ratio.min(ratio);
            // 4. Stress P, its pressure averaged over the nodes where asked for.
            let response = law.response(&gradient);
            let pressure = if AVERAGED {
                mean_pressure(group, &scratch.scalar)
            } else {
                law.pressure(response.volume_change)
            };
            let mut stress = response.stress_at_constant_volume + response.volume_gradient.times(pressure);
            if VISCOUS {
                let rate = gradient_of(&velocity, &group.gradients[q]);
                let viscous = law.viscous_stress(&gradient, &rate, beta);
                viscous_power = viscous_power + viscous.dot(&rate) * group.weights[q];
                stress = stress + viscous;
            }
            // 5. Nodal forces -V P grad N_i.
            for i in 0..E {
                let g = &group.gradients[q][i];
                for axis in 0..3 {
                    let p = &stress.0[axis];
                    force[i][axis] =
                        force[i][axis] - (p[0] * g[0] + p[1] * g[1] + p[2] * g[2]) * group.weights[q];
                }
            }
        }
        scatter(group, &force, &mut scratch.force);
    }
    let mut smallest = f64::INFINITY;
    for ratio in smallest_ratio.0 {
        if !(ratio >= smallest) {
            smallest = ratio;
        }
    }
    BlockResult { smallest_ratio: smallest, viscous_power: viscous_power.sum() }
}

/// u_i − u_0 of nodes 1…E.
#[inline(always)]
fn differences<const E: usize, const Q: usize>(group: &Group<E, Q>, local: &Local) -> [[Lanes; 3]; E] {
    let mut first = [Lanes::constant(0.0); 3];
    let mut result = [[Lanes::constant(0.0); 3]; E];
    for lane in 0..LANES {
        let u = local[group.first[lane] as usize % MAX_LOCAL_NODES];
        for axis in 0..3 {
            first[axis].0[lane] = u[axis];
        }
    }
    for i in 0..E {
        for lane in 0..LANES {
            let u = local[group.others[i][lane] as usize % MAX_LOCAL_NODES];
            for axis in 0..3 {
                result[i][axis].0[lane] = u[axis];
            }
        }
        for axis in 0..3 {
            result[i][axis] = result[i][axis] - first[axis];
        }
    }
    result
}

#[inline(always)]
fn gradient_of<const E: usize>(d: &[[Lanes; 3]; E], g: &[[Lanes; 3]; E]) -> Tensor<Lanes> {
    Tensor::from_fn(|row, column| {
        let mut sum = d[0][row] * g[0][column];
        for i in 1..E {
            sum = sum + d[i][row] * g[i][column];
        }
        sum
    })
}

#[inline(always)]
fn mean_pressure<const E: usize, const Q: usize>(
    group: &Group<E, Q>,
    pressure: &[f64; MAX_LOCAL_NODES],
) -> Lanes {
    let mut mean = Lanes::constant(0.0);
    for lane in 0..LANES {
        let mut sum = pressure[group.first[lane] as usize % MAX_LOCAL_NODES];
        for i in 0..E {
            sum += pressure[group.others[i][lane] as usize % MAX_LOCAL_NODES];
        }
        mean.0[lane] = sum / (E + 1) as f64;
    }
    mean
}

/// Adds the forces of nodes 1…E and minus their sum on node 0, lane after lane.
#[inline(always)]
fn scatter<const E: usize, const Q: usize>(group: &Group<E, Q>, force: &[[Lanes; 3]; E], to: &mut Local) {
    let mut first = [Lanes::constant(0.0); 3];
    for f in force {
        for axis in 0..3 {
            first[axis] = first[axis] - f[axis];
        }
    }
    for lane in 0..LANES {
        let target = &mut to[group.first[lane] as usize % MAX_LOCAL_NODES];
        for axis in 0..3 {
            target[axis] += first[axis].0[lane];
        }
        for i in 0..E {
            let target = &mut to[group.others[i][lane] as usize % MAX_LOCAL_NODES];
            for axis in 0..3 {
                target[axis] += force[i][axis].0[lane];
            }
        }
    }
}

/// Volume of each element times θ, a quarter to each of its nodes.
#[inline(always)]
pub(crate) fn volume_changes<L: ElasticLaw, const E: usize, const Q: usize>(
    law: L,
    block: &Block<E, Q>,
    scratch: &mut Scratch,
) {
    scratch.scalar[..block.nodes.len()].fill(0.0);
    for group in &block.groups {
        let displacement = differences(group, &scratch.displacement);
        let theta = law.response(&gradient_of(&displacement, &group.gradients[0])).volume_change;
        let quarter = (theta * group.weights[0]).scaled(0.25);
        for lane in 0..LANES {
            scratch.scalar[group.first[lane] as usize % MAX_LOCAL_NODES] += quarter.0[lane];
            for i in 0..E {
                scratch.scalar[group.others[i][lane] as usize % MAX_LOCAL_NODES] += quarter.0[lane];
            }
        }
    }
}
