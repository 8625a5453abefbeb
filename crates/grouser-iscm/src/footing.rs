//! What of an imprint can press on the ground: its points and triangles, found once a drawing.

use crate::imprint::{ACROSS, AROUND, HARDLY_COVERED, Imprint};
use crate::polygon::{PartialLoad, Sag};
use crate::terrain::Terrain;

/// A point of the ground under running gear.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Site {
    /// Node of the terrain.
    pub on_grid: usize,
    /// Place of the underside as drawn \[m\].
    pub position: [f64; 3],
    /// Slope of the underside ∂h/∂x, ∂h/∂y \[-\].
    pub slope: [f64; 2],
    /// Share of the point's cell that this layer of the gear covers.
    pub share: f64,
    /// Which object of the gear lies here.
    pub owner: u16,
    /// Which ground of its cell it stands on.
    pub stand: Stand,
}

/// Which ground of a cell a layer of the gear stands on.
///
/// A cell remembers two grounds, that at its point and that beside it, for the two layers with the largest shares of it: the lower one
/// stands on the deeper ground, so that neither sees the other's print, wherever the point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stand {
    /// Both, as one: it covers the whole cell.
    Whole,
    /// It shares the cell with none and covers its point.
    Point,
    /// It shares the cell with none and does not cover its point.
    Beside,
    /// The deeper one; as long as they are level, that at the point if `is_inside`.
    Lower {
        /// Whether the lower layer covers the point.
        is_inside: bool,
    },
    /// The one that the lower layer leaves.
    Higher {
        /// Whether the lower layer covers the point.
        is_inside: bool,
    },
    /// A third layer, or one with no share: what it stands on is not remembered.
    Neither,
}

impl Stand {
    /// Of layer `k` of `layers` at node (`i`, `j`) of its window.
    pub fn new(layers: &[Imprint], k: usize, i: usize, j: usize) -> Self {
        let (i, j) = (layers[k].i_0 + i, layers[k].j_0 + j);
        // Layer, share of the cell, whether it covers the point; largest share first.
        let none = (usize::MAX, 0.0, false);
        let (mut most, mut second, mut own) = (none, none, none);
        for (n, layer) in layers.iter().enumerate() {
            let (a, b) = (i.wrapping_sub(layer.i_0), j.wrapping_sub(layer.j_0));
            if a >= layer.n_x || b >= layer.n_y {
                continue;
            }
            let part = (n, share(layers, n, i, j), layer.nodes[b * layer.n_x + a].is_inside);
            if n == k {
                own = part;
            }
            if part.1 > most.1 {
                (most, second) = (part, most);
            } else if part.1 > second.1 {
                second = part;
            }
        }
        if own.1 > 1.0 - 1e-9 {
            Self::Whole
        } else if k != most.0 && k != second.0 {
            Self::Neither
        } else if second.1 == 0.0 {
            if own.2 { Self::Point } else { Self::Beside }
        } else {
            let lower = if most.0 < second.0 { most } else { second };
            let is_inside = lower.2;
            if lower.0 == k { Self::Lower { is_inside } } else { Self::Higher { is_inside } }
        }
    }

    /// Whether that is the ground at the point.
    #[inline(always)]
    fn is_at_point(self, terrain: &Terrain, node: usize) -> bool {
        let is_lower_at_point = |is_inside: bool| {
            let (at_point, beside) = (terrain.height(node), terrain.height_beside(node));
            if at_point == beside { is_inside } else { at_point < beside }
        };
        match self {
            Self::Point | Self::Whole => true,
            Self::Beside | Self::Neither => false,
            Self::Lower { is_inside } => is_lower_at_point(is_inside),
            Self::Higher { is_inside } => !is_lower_at_point(is_inside),
        }
    }

    /// Height of the ground of `terrain` at `node` that it sees \[m\].
    #[inline(always)]
    pub fn height(self, terrain: &Terrain, node: usize) -> f64 {
        if self.is_at_point(terrain, node) { terrain.height(node) } else { terrain.height_beside(node) }
    }

    /// Presses that ground down to `height` \[m\].
    pub fn stamp(self, terrain: &mut Terrain, node: usize, height: f64) {
        match self {
            Self::Whole => terrain.stamp(node, height),
            Self::Neither => (),
            _ if self.is_at_point(terrain, node) => terrain.stamp_point(node, height),
            _ => terrain.stamp_beside(node, height),
        }
    }
}

/// A triangle between three points of the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet {
    /// Its corners.
    pub sites: [u32; 3],
    /// How the underside sags between them.
    pub sag: Sag,
    /// Object of the gear with the largest share of its corners.
    pub owner: u16,
}

/// A point hardly covered, of whose depth `own` counts, and the neighbours that give the rest: a range of `Footing::seen`.
#[derive(Clone, Debug)]
struct Edge {
    site: u32,
    own: f64,
    seen: std::ops::Range<usize>,
}

/// Points and triangles under one layer of running gear.
#[derive(Clone, Debug, Default)]
pub(crate) struct Footing {
    /// The points.
    pub sites: Vec<Site>,
    /// The triangles of which a part is covered.
    pub facets: Vec<Facet>,
    edges: Vec<Edge>,
    /// Points and their weights, which add up to one for each edge.
    seen: Vec<(u32, f64)>,
}

const NONE: u32 = u32::MAX;

impl Footing {
    /// Of layer `k` of `layers`, the lowest first, on a grid of `n_grid` nodes along x; what lower layers cover is gone for it.
    ///
    /// Wheels, the last layer of all, have a curved underside; shoes are flat.
    pub fn new(layers: &[Imprint], k: usize, n_grid: usize, partial: PartialLoad) -> Self {
        let (imprint, is_curved) = (&layers[k], k + 1 == layers.len());
        let n_x = imprint.n_x;
        let mut shares = vec![0.0; imprint.nodes.len()];
        for (n, node) in imprint.nodes.iter().enumerate().filter(|(_, node)| node.coverage > 0.0) {
            shares[n] = if k == 0 {
                node.coverage
            } else {
                share(layers, k, imprint.i_0 + n % n_x, imprint.j_0 + n / n_x)
            };
        }
        let mut footing = Self::default();
        let mut site_of = vec![NONE; imprint.nodes.len()];
        for j in 0..imprint.n_y.saturating_sub(1) {
            for i in 0..n_x.saturating_sub(1) {
                let is_covered = |(a, b): (usize, usize)| shares[b * n_x + a] > 0.0;
                if ![(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)].into_iter().any(is_covered) {
                    continue;
                }
                // Diagonals alternate so that no direction is preferred.
                let triangles = if (imprint.i_0 + i + imprint.j_0 + j) % 2 == 0 {
                    [[(i, j), (i + 1, j), (i + 1, j + 1)], [(i, j), (i + 1, j + 1), (i, j + 1)]]
                } else {
                    [[(i, j), (i + 1, j), (i, j + 1)], [(i + 1, j), (i + 1, j + 1), (i, j + 1)]]
                };
                for corners in triangles.into_iter().filter(|corners| corners.iter().any(|&c| is_covered(c)))
                {
                    let sag = if is_curved && partial == PartialLoad::Proportional {
                        Sag::new(imprint.sag(corners))
                    } else {
                        Sag::default()
                    };
                    let owner = owner(corners.map(|(a, b)| {
                        let n = b * n_x + a;
                        (imprint.nodes[n].owner, shares[n])
                    }));
                    let sites = corners.map(|at| footing.site(at, layers, k, n_grid, &shares, &mut site_of));
                    footing.facets.push(Facet { sites, sag, owner });
                }
            }
        }
        if partial == PartialLoad::Proportional {
            footing.see_neighbours(imprint, &shares, &site_of);
        }
        footing
    }

    /// What is hardly covered, or stands on what is not remembered, takes its depth from its neighbours.
    fn see_neighbours(&mut self, imprint: &Imprint, shares: &[f64], site_of: &[u32]) {
        let n_x = imprint.n_x;
        for n in (0..shares.len()).filter(|&n| site_of[n] != NONE) {
            let is_unknown = |n: usize| self.sites[site_of[n] as usize].stand == Stand::Neither;
            let own = if is_unknown(n) { 0.0 } else { shares[n] / HARDLY_COVERED };
            if own >= 1.0 {
                continue;
            }
            let (first, mut sum) = (self.seen.len(), 0.0);
            for (di, dj) in AROUND {
                let (a, b) = ((n % n_x).wrapping_add_signed(di), (n / n_x).wrapping_add_signed(dj));
                let near = b.wrapping_mul(n_x).wrapping_add(a);
                if a >= n_x
                    || b >= imprint.n_y
                    || site_of[near] == NONE
                    || shares[near] == 0.0
                    || is_unknown(near)
                {
                    continue;
                }
                let weight = shares[near] * if di == 0 || dj == 0 { 1.0 } else { ACROSS };
                self.seen.push((site_of[near], weight));
                sum += weight;
            }
            if sum > 0.0 {
                self.seen[first..].iter_mut().for_each(|seen| seen.1 *= (1.0 - own) / sum);
                self.edges.push(Edge { site: site_of[n], own, seen: first..self.seen.len() });
            }
        }
    }

    /// The site at node (`i`, `j`) of the window, a new one where there was none.
    #[inline]
    fn site(
        &mut self,
        (i, j): (usize, usize),
        layers: &[Imprint],
        k: usize,
        n_grid: usize,
        shares: &[f64],
        site_of: &mut [u32],
    ) -> u32 {
        let imprint = &layers[k];
        let n = j * imprint.n_x + i;
        if site_of[n] == NONE {
            site_of[n] = self.sites.len() as u32;
            let gear = &imprint.nodes[n];
            let [x, y] = imprint.position(i, j);
            self.sites.push(Site {
                on_grid: (imprint.j_0 + j) * n_grid + imprint.i_0 + i,
                position: [x, y, gear.height],
                slope: gear.slope,
                share: shares[n],
                owner: gear.owner,
                stand: Stand::new(layers, k, i, j),
            });
        }
        site_of[n]
    }

    /// The depth below the ground that each edge sees, from each point's `own` depth \[m\].
    pub fn seen_depths(&self, own: impl Fn(u32) -> f64) -> impl Iterator<Item = (u32, f64)> {
        self.edges.iter().map(move |edge| {
            let seen = self.seen[edge.seen.clone()].iter().map(|&(site, weight)| weight * own(site));
            (edge.site, edge.own * own(edge.site) + seen.sum::<f64>())
        })
    }
}

/// The owner with the largest share of three corners.
fn owner(corners: [(u16, f64); 3]) -> u16 {
    let held = |owner: u16| -> f64 { corners.iter().filter(|c| c.0 == owner).map(|c| c.1).sum() };
    let [a, b, c] = corners.map(|corner| corner.0);
    [b, c].into_iter().fold(a, |best, other| if held(other) > held(best) { other } else { best })
}

/// Share of the cell of node (`i`, `j`) of the terrain that layer `k` covers and lower ones leave to it.
///
/// Parts of a shoe lie one on the other, so that a higher one has what it covers more than a lower one. Wheels lie across shoes.
pub(crate) fn share(layers: &[Imprint], k: usize, i: usize, j: usize) -> f64 {
    let coverage = |layer: &Imprint| {
        let (a, b) = (i.wrapping_sub(layer.i_0), j.wrapping_sub(layer.j_0));
        if a < layer.n_x && b < layer.n_y { layer.nodes[b * layer.n_x + a].coverage } else { 0.0 }
    };
    let (own, lower) = (coverage(&layers[k]), layers[..k].iter().map(coverage).fold(0.0, f64::max));
    if k + 1 == layers.len() { own * (1.0 - lower) } else { f64::max(own - lower, 0.0) }
}

#[cfg(test)]
mod tests {
    use grouser_geometry::{HeightGrid, Pose, Vec3};

    use crate::contact::{FootImprint, Integration};
    use crate::imprint::{Imprint, Plate};
    use crate::polygon::{PartialLoad, SubTriangles};
    use crate::pressure::{Linear, PressureArray, PressureField, PressureLaw};
    use crate::terrain::Terrain;

    /// Mean over places of force on flat shoes with a grouser each that stand in their own print, over the exact one, less one \[-\].
    fn error(spacing: f64) -> f64 {
        let law = PressureLaw::Linear(Linear { stiffness: 1e6 });
        let (partial, n_shoes, pitch) = (PartialLoad::Proportional, 10, 0.104);
        let plate = Plate { along: [-0.0416, 0.0416], across: [-0.3, 0.3], depth: 0.03 };
        let grouser = Plate { along: [-0.02, 0.02], across: [-0.3, 0.3], depth: 0.06 };
        let (z_plate, z_grouser) = (0.10, 0.13);
        let exact = f64::from(n_shoes) * 0.6 * 1e6 * (0.04 * z_grouser + 0.0432 * z_plate);
        let places = 16;
        let mean = (0..places).map(|place| {
            let grid = HeightGrid::covering([-0.5, -0.5], [2.0, 1.0], spacing, |_, _| 0.0).unwrap();
            let array = PressureArray::new(&law, 0.005, 0.5).unwrap();
            let mut terrain = Terrain::new(grid, PressureField::uniform(array)).unwrap();
            let blank = || Imprint::new(terrain.grid(), [-0.2, -0.4], [1.3, 0.4], 1.0, partial);
            let (mut grousers, mut shoes) = (blank(), blank());
            for k in 0..n_shoes {
                let x = f64::from(k) * pitch + f64::from(place) * spacing / f64::from(places);
                let at = Pose::translation(x, 0.003, -z_plate + plate.depth);
                grousers.draw_plate(&at, &grouser, 0);
                shoes.draw_plate(&at, &plate, 0);
            }
            grousers.carry_edges(terrain.grid());
            shoes.carry_edges(terrain.grid());
            let foot = FootImprint::new(
                vec![grousers, shoes, blank()],
                Vec3::zeros(),
                terrain.grid().n_x(),
                partial,
            );
            foot.stamp(&mut terrain, &Pose::identity());
            let integration = Integration { sub_triangles: SubTriangles::new(4), partial };
            foot.load(&terrain, &Pose::identity(), &integration, |_| ()).wrench.force.z
        });
        mean.sum::<f64>() / f64::from(places) / exact - 1.0
    }

    #[test]
    fn shoes_are_carried_beside_the_prints_of_their_grousers() {
        // Where plates saw the ground in the grousers' prints they lost −17, −29, −23, −22 and −15 %.
        let errors = [0.05, 0.04, 0.025, 0.02, 0.0125].map(error);
        assert!(errors.iter().all(|error| error.abs() < 1e-3), "{errors:?}");
    }

    /// Mean over places of the force on plates 2.08 cm apart and on a wheel above these gaps, which stand in their own print, over the exact
    /// ones, less one; and of the force left on all of it 1 mm higher, over the exact one before \[-\].
    fn errors_of_gaps(spacing: f64) -> [f64; 3] {
        let law = PressureLaw::Linear(Linear { stiffness: 1e6 });
        let (partial, n_shoes, pitch) = (PartialLoad::Proportional, 10, 0.104);
        let plate = Plate { along: [-0.0416, 0.0416], across: [-0.3, 0.3], depth: 0.0 };
        let (z_plate, z_wheel) = (0.10, 0.07);
        let exact =
            [f64::from(n_shoes) * 0.0832 * 0.6 * z_plate, f64::from(n_shoes - 1) * 0.0208 * 0.5 * z_wheel]
                .map(|volume| 1e6 * volume);
        let places = 16;
        let mut sums = [0.0; 3];
        for place in 0..places {
            let grid = HeightGrid::covering([-0.5, -0.5], [2.0, 1.0], spacing, |_, _| 0.0).unwrap();
            let array = PressureArray::new(&law, 0.005, 0.5).unwrap();
            let mut terrain = Terrain::new(grid, PressureField::uniform(array)).unwrap();
            let blank = || Imprint::new(terrain.grid(), [-0.2, -0.4], [1.3, 0.4], 1.0, partial);
            let (mut shoes, mut wheel) = (blank(), blank());
            let first = f64::from(place) * spacing / f64::from(places);
            for k in 0..n_shoes {
                let at = Pose::translation(first + f64::from(k) * pitch, 0.003, -z_plate);
                shoes.draw_plate(&at, &plate, 0);
            }
            let above =
                Plate { along: [0.0, f64::from(n_shoes - 1) * pitch], across: [-0.25, 0.25], depth: 0.0 };
            wheel.draw_plate(&Pose::translation(first, 0.003, -z_wheel), &above, 1);
            shoes.carry_edges(terrain.grid());
            wheel.carry_edges(terrain.grid());
            let n_grid = terrain.grid().n_x();
            let foot = FootImprint::new(vec![blank(), shoes, wheel], Vec3::zeros(), n_grid, partial);
            foot.stamp(&mut terrain, &Pose::identity());
            let integration = Integration { sub_triangles: SubTriangles::new(4), partial };
            foot.load(&terrain, &Pose::identity(), &integration, |polygon| {
                sums[polygon.layer - 1] += polygon.force.z;
            });
            let lifted = Pose::translation(0.0, 0.0, 1e-3);
            sums[2] += foot.load(&terrain, &lifted, &integration, |_| ()).wrench.force.z;
        }
        let mean = sums.map(|sum| sum / f64::from(places));
        [mean[0] / exact[0] - 1.0, mean[1] / exact[1] - 1.0, mean[2] / (exact[0] + exact[1])]
    }

    #[test]
    fn wheels_stand_on_the_ground_between_plates() {
        let errors = [0.05, 0.04, 0.03, 0.025, 0.02, 0.0125].map(errors_of_gaps);
        // Where the wheel saw the ground under the plates it lost −99, −50, −35, −26, −13 and −8 %; the walls of the gaps still carried 39,
        // 29, 24, 22, 19 and 13 % of everything once it was lifted.
        for [plates, wheel, lifted] in errors {
            assert!(plates.abs() < 1e-4 && wheel.abs() < 2e-3 && lifted.abs() < 2e-4, "{errors:.5?}");
        }
    }
}
