//! Mean velocities of neighbourhoods: cells of a coarse grid.

use crate::Domain;
use crate::cell_grid::CellGrid;
use grouser_contact::{Precision, Sphere, Vector};

/// Mean velocities of neighbourhoods [m/s].
pub(crate) struct Drifts {
    /// Neighbourhood of each grain.
    cells: Vec<u32>,
    means: Vec<Vector<f64>>,
    /// The largest of them.
    pub fastest: f64,
    /// The largest difference between a neighbourhood and one beside it.
    pub parting: f64,
}

impl Drifts {
    /// Those of neighbourhoods of edge `edge` [m] or more.
    pub fn of<P: Precision>(spheres: &[Sphere<P>], domain: &Domain, edge: f64) -> Self {
        let grid = CellGrid::new(spheres, domain, edge);
        let cells: Vec<u32> = spheres.iter().map(|sphere| grid.cell_of(sphere)).collect();
        let mut sums = vec![(Vector::ZERO, 0.0); grid.counts.iter().product()];
        for (sphere, &cell) in spheres.iter().zip(&cells) {
            let (sum, n) = &mut sums[cell as usize];
            *sum += sphere.velocity.cast();
            *n += 1.0;
        }
        let is_there: Vec<bool> = sums.iter().map(|&(_, n)| n > 0.0).collect();
        let means: Vec<Vector<f64>> =
            sums.into_iter().map(|(sum, n)| if n > 0.0 { sum * (1.0 / n) } else { sum }).collect();
        let (mut fastest, mut parting) = (0.0_f64, 0.0_f64);
        for (cell, &mean) in means.iter().enumerate() {
            fastest = fastest.max(mean.norm_squared());
            grid.visit_cells_around(cell, |other| {
                if is_there[cell] && is_there[other] {
                    parting = parting.max((mean - means[other]).norm_squared());
                }
            });
        }
        Self { cells, means, fastest: fastest.sqrt(), parting: parting.sqrt() }
    }

    /// Nobody drifts.
    pub fn none() -> Self {
        Self { cells: Vec::new(), means: Vec::new(), fastest: 0.0, parting: 0.0 }
    }

    /// That of a grain's neighbourhood; zero where there are none.
    pub fn of_grain(&self, grain: usize) -> Vector<f64> {
        self.cells.get(grain).map_or(Vector::ZERO, |&cell| self.means[cell as usize])
    }
}
