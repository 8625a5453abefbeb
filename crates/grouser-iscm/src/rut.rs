//! Rut depth by windows along a track (P2 §2.5).

use crate::terrain::Terrain;

/// Deepest sinkage \[m\] in each window of `window` \[m\] length and `width` \[m\] along the line from `from` to `to` \[m\].
pub fn rut_depths(terrain: &Terrain, from: [f64; 2], to: [f64; 2], width: f64, window: f64) -> Vec<f64> {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = dx.hypot(dy);
    if !(length > 0.0 && window > 0.0) {
        return Vec::new();
    }
    let n = (length / window + 1e-9).floor() as usize;
    let mut depths = vec![0.0_f64; n];
    let grid = terrain.grid();
    for j in 0..grid.n_y() {
        for i in 0..grid.n_x() {
            let [x, y] = grid.position(i, j);
            let along = ((x - from[0]) * dx + (y - from[1]) * dy) / length;
            let across = ((y - from[1]) * dx - (x - from[0]) * dy) / length;
            let k = (along / window).floor();
            if across.abs() <= width / 2.0 && k >= 0.0 && (k as usize) < n {
                let k = k as usize;
                depths[k] = depths[k].max(terrain.deepest_level(j * grid.n_x() + i));
            }
        }
    }
    depths
}
