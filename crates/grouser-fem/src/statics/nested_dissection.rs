//! Order of elimination by geometric nested dissection (George 1973, SIAM J. Numer. Anal. 10, 345).

use grouser_geometry::Vec3;

use super::block_matrix::BlockMatrix;

/// Parts of this many nodes are not cut any further.
const LEAF: usize = 48;

/// Nodes in an order that keeps the Cholesky factor of `matrix` sparse: both halves of the cloud first, then the nodes that
/// separate them.
pub fn order(matrix: &BlockMatrix, positions: &[Vec3]) -> Vec<u32> {
    let mut nodes: Vec<u32> = (0..positions.len() as u32).collect();
    // 0: outside the present part, otherwise the number of the half.
    let mut half = vec![0u32; positions.len()];
    let mut order = Vec::with_capacity(nodes.len());
    let mut stamp = 0;
    dissect(matrix, positions, &mut nodes, &mut half, &mut stamp, &mut order);
    order
}

fn dissect(
    matrix: &BlockMatrix,
    positions: &[Vec3],
    nodes: &mut [u32],
    half: &mut [u32],
    stamp: &mut u32,
    order: &mut Vec<u32>,
) {
    if nodes.len() <= LEAF {
        nodes.sort_unstable();
        order.extend_from_slice(nodes);
        return;
    }
    let at = |n: u32| positions[n as usize];
    let low = nodes.iter().fold(Vec3::repeat(f64::INFINITY), |low, &n| low.inf(&at(n)));
    let high = nodes.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |high, &n| high.sup(&at(n)));
    let axis = (high - low).imax();
    let middle = nodes.len() / 2;
    nodes.select_nth_unstable_by(middle, |&a, &b| at(a)[axis].total_cmp(&at(b)[axis]).then(a.cmp(&b)));
    let (left, right) = nodes.split_at_mut(middle);
    *stamp += 1;
    let right_stamp = *stamp;
    right.iter().for_each(|&n| half[n as usize] = right_stamp);
    let touches_right = |&n: &u32| matrix.row(n as usize).any(|(j, _)| half[j] == right_stamp);
    let (mut separator, mut left): (Vec<u32>, Vec<u32>) = left.iter().partition(|n| touches_right(n));
    separator.sort_unstable();
    dissect(matrix, positions, &mut left, half, stamp, order);
    dissect(matrix, positions, right, half, stamp, order);
    order.append(&mut separator);
}
