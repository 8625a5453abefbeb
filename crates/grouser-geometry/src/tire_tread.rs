//! Lugged tire treads from a size code: a wall that bulges from bead to bead, with lugs on its crown.
//!
//! ```text
//!        lug ▁▁      ▁▁         axis of the tire: y; the wall's section lies in the half plane x > 0, z = 0 and turns
//!       ____|__|____|__|___     about y. Surfaces: rim (ends of the wall), inner, outer (everything else).
//!      /  ______________  \
//!     |  /    crown      \  |
//!      \ \  side walls   / /
//!       rim             rim
//! ```

use std::f64::consts::{FRAC_PI_2, TAU};

use serde::{Deserialize, Serialize};

use crate::lug_pattern::Pitch;
use crate::{Facet, Lattice, LugPattern, TetrahedralMesh, Vec3};

/// Nominal dimensions of a tire.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TireSize {
    /// Section width [m].
    pub width: f64,
    /// Height of the section over its width.
    pub aspect_ratio: f64,
    /// Diameter of the rim [m].
    pub rim_diameter: f64,
}

/// What a tread looks like; see [`TireTread::mesh`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TireTread {
    /// Size code such as `165/65R13`.
    pub size: String,
    /// Distance between the flanges of the rim [m], that of the beads' outer faces; the section of a tire is wider and bulges.
    pub rim_width: f64,
    /// Thickness of the wall [m].
    pub wall_thickness: f64,
    /// Height of the lugs above the wall [m].
    pub groove_depth: f64,
    /// Pattern of the lugs.
    pub pattern: LugPattern,
    /// Number of tetrahedra to aim at.
    pub n_elements: usize,
}

/// Why a tread is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TireError {
    /// The size code cannot be read.
    #[error(
        "tire size '{code}' is not understood: expected width in mm / aspect ratio in % R rim diameter in inches, such as 165/65R13"
    )]
    SizeCode {
        /// The code.
        code: String,
    },
    /// Walls and grooves do not fit the section.
    #[error(
        "wall thickness {wall} m and groove depth {groove} m do not fit a section {height} m high: both must be positive and fill less than half of it"
    )]
    Thickness {
        /// Thickness of the wall [m].
        wall: f64,
        /// Depth of the grooves [m].
        groove: f64,
        /// Height of the section [m].
        height: f64,
    },
    /// The beads of the wall do not fit between the flanges, or the wall would not bulge.
    #[error(
        "rim width {rim} m does not suit a section {width} m wide with a wall of {wall} m: expected {least:.4} to {width} m; usual \
         cause: inches or millimetres; a 165/65R13 is measured on a rim of 5 inches, 0.127 m"
    )]
    RimWidth {
        /// Width of the rim [m].
        rim: f64,
        /// Width of the section [m].
        width: f64,
        /// Thickness of the wall [m].
        wall: f64,
        /// Smallest width that is accepted [m].
        least: f64,
    },
    /// Lugs that cover nothing or everything.
    #[error(
        "lugs cover {land} of the pitch: expected between 0 and 1, road tires near 0.7, field tires near 0.3; usual cause: per cent; without \
         grooves it is a smooth tread"
    )]
    Land {
        /// Length of a lug over the pitch.
        land: f64,
    },
    /// Too few elements for the pattern.
    #[error(
        "{n_elements} tetrahedra are too few for this tread: expected at least {least}, four cells around the tire for each lug; ask for more elements or fewer lugs"
    )]
    TooFewElements {
        /// Elements asked for.
        n_elements: usize,
        /// Elements that the pattern needs.
        least: usize,
    },
}

/// Cells along one side wall and along the crown, finest first; the crown has an even number, for two halves.
const CELLS_ALONG: [[usize; 2]; 2] = [[5, 10], [4, 8]];
/// Cells across the wall and across a lug.
const WALL_CELLS: usize = 1;
const LUG_CELLS: usize = 1;
/// Width of the crown over the inner width of the section [-].
const CROWN_SHARE: f64 = 0.8;

/// How a tread is divided.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cells {
    /// Along one side wall.
    side: usize,
    /// Along the crown.
    crown: usize,
    /// Around the tire.
    around: usize,
    /// Lugs on each half; 1 where there are none.
    n_lugs: usize,
    /// Length of a lug over the pitch.
    land: f64,
}

impl TireSize {
    /// Reads a size code: width in mm, aspect ratio in per cent, rim diameter in inches.
    ///
    /// # Errors
    /// [`TireError::SizeCode`].
    pub fn parse(code: &str) -> Result<Self, TireError> {
        let parse = || {
            let (width, rest) = code.split_once('/')?;
            let (aspect, rim) = rest.split_once(['R', 'r'])?;
            let [width, aspect, rim] =
                [width, aspect, rim].map(|s| s.trim().parse::<f64>().ok().filter(|v| *v > 0.0));
            Some(Self { width: width? / 1e3, aspect_ratio: aspect? / 100.0, rim_diameter: rim? * 0.0254 })
        };
        parse().ok_or_else(|| TireError::SizeCode { code: code.to_owned() })
    }

    /// Outer radius: half of rim diameter plus section height [m].
    pub fn outer_radius(&self) -> f64 {
        self.rim_diameter / 2.0 + self.aspect_ratio * self.width
    }
}

impl TireTread {
    /// Tetrahedra of the tread around the y axis, centred in the origin; regions `carcass` (wall) and `tread` (lugs),
    /// surfaces `rim`, `inner` and `outer`.
    ///
    /// # Errors
    /// [`TireError`].
    pub fn mesh(&self) -> Result<TetrahedralMesh, TireError> {
        let size = TireSize::parse(&self.size)?;
        let height = size.aspect_ratio * size.width;
        let (wall, groove) = (self.wall_thickness, self.groove_depth);
        if !(wall > 0.0 && groove > 0.0 && wall + groove < 0.5 * height && 2.0 * wall < 0.5 * size.width) {
            return Err(TireError::Thickness { wall, groove, height });
        }
        let rim_limits = [(2.0 * CROWN_SHARE - 1.0) * (size.width - 2.0 * wall) + 2.0 * wall, size.width];
        if !(rim_limits[0] <= self.rim_width && self.rim_width <= rim_limits[1]) {
            let (rim, width, least) = (self.rim_width, size.width, rim_limits[0]);
            return Err(TireError::RimWidth { rim, width, wall, least });
        }
        let section = self.cells()?;
        let Cells { side, crown, around, .. } = section;
        let pitch = Pitch::new(around / (2 * section.n_lugs), section.land);
        let is_lug = |s: usize, a: usize| {
            let Some(place) = s.checked_sub(side).filter(|&place| place < crown) else { return false };
            self.pattern == LugPattern::Smooth || pitch.is_lug(a, place >= crown / 2)
        };
        let along = 2 * side + crown;
        let lattice = Lattice { cells: [along, around, WALL_CELLS + LUG_CELLS], is_closed: true };
        let keep = |[s, a, layer]: [usize; 3]| layer < WALL_CELLS || is_lug(s, a);
        let map = |[s, a, layer]: [usize; 3]| {
            let depth = if layer <= WALL_CELLS {
                wall * layer as f64 / WALL_CELLS as f64
            } else {
                wall + groove * (layer - WALL_CELLS) as f64 / LUG_CELLS as f64
            };
            let [radius, y] = self.section(size, [side, crown], s, depth);
            let angle = TAU * pitch.place(a % around) / around as f64;
            Vec3::new(radius * angle.cos(), y, radius * angle.sin())
        };
        let mut mesh = lattice.mesh(keep, map);
        self.name_parts(&mut mesh, keep, lattice.cells);
        Ok(mesh)
    }

    /// The division for the number of elements asked for.
    fn cells(&self) -> Result<Cells, TireError> {
        let (n_lugs, land, share) = match self.pattern {
            LugPattern::Smooth => (1, 0.5, 1.0),
            LugPattern::Alternating { land, .. } if !(land > 0.0 && land < 1.0) => {
                return Err(TireError::Land { land });
            }
            LugPattern::Alternating { count, land } => (count.max(1), land, land),
        };
        // Four cells for each pitch at least, and whole half-pitches.
        let step = 4 * n_lugs;
        let per_slice = |[side, crown]: [usize; 2]| {
            6.0 * (((2 * side + crown) * WALL_CELLS) as f64 + share * (crown * LUG_CELLS) as f64)
        };
        let divided = CELLS_ALONG.map(|cells| {
            let around =
                ((self.n_elements as f64 / per_slice(cells) / step as f64).round() as usize).max(1) * step;
            let [side, crown] = cells;
            (around as f64 * per_slice(cells), Cells { side, crown, around, n_lugs, land })
        });
        // The finest that is close enough, or else the closest.
        let missed = |n: f64| (n / self.n_elements as f64).ln().abs();
        let is_close = |n: f64| (n / self.n_elements as f64 - 1.0).abs() < 0.1 + 1e-9;
        let closest = || divided.iter().min_by(|a, b| missed(a.0).total_cmp(&missed(b.0)));
        let &(n, cells) =
            divided.iter().find(|(n, _)| is_close(*n)).or_else(closest).expect("there are divisions");
        // Fewer than half of the coarsest.
        if 2.0 * (self.n_elements as f64) < n {
            return Err(TireError::TooFewElements { n_elements: self.n_elements, least: n as usize });
        }
        Ok(cells)
    }

    /// Radius and y of the point at place `s` along the wall, `depth` [m] outside its inner face.
    fn section(&self, size: TireSize, [side, crown_cells]: [usize; 2], s: usize, depth: f64) -> [f64; 2] {
        // Inner face: inside wall and lugs.
        let half_width = size.width / 2.0 - self.wall_thickness;
        let top = size.outer_radius() - self.wall_thickness - self.groove_depth;
        let crown = CROWN_SHARE * half_width;
        let (place, end) = (s as f64, (2 * side + crown_cells) as f64);
        let side = side as f64;
        if place < side || place > end - side {
            let (t, sign) = if place < side { (place / side, -1.0) } else { ((end - place) / side, 1.0) };
            // An arc of an ellipse from the bead (t = 0) over the widest place to the edge of the crown (t = 1).
            let bulge = half_width - crown;
            let bead = self.rim_width / 2.0 - self.wall_thickness;
            let lowest = -((bead - crown) / bulge).min(1.0).acos();
            let half_height = (top - size.rim_diameter / 2.0) / (1.0 - lowest.sin());
            let angle = lowest + t * (FRAC_PI_2 - lowest);
            let point = [top - half_height * (1.0 - angle.sin()), sign * (crown + bulge * angle.cos())];
            let normal = [bulge * angle.sin(), sign * half_height * angle.cos()];
            let length = normal[0].hypot(normal[1]);
            [point[0] + depth * normal[0] / length, point[1] + depth * normal[1] / length]
        } else {
            let t = (place - side) / (end - 2.0 * side);
            [top + depth, crown * (2.0 * t - 1.0)]
        }
    }

    fn name_parts(&self, mesh: &mut TetrahedralMesh, keep: impl Fn([usize; 3]) -> bool, cells: [usize; 3]) {
        mesh.region_names = vec!["carcass".to_owned(), "tread".to_owned()];
        let kept = (0..cells[0])
            .flat_map(|s| (0..cells[1]).flat_map(move |a| (0..cells[2]).map(move |layer| [s, a, layer])))
            .filter(|&c| keep(c));
        mesh.region_of_element = kept.flat_map(|[_, _, layer]| [u32::from(layer >= WALL_CELLS); 6]).collect();
        let mut take = |name: &str| mesh.surfaces.remove(name).unwrap_or_default();
        let inner = take("third_min");
        let mut rim: Vec<Facet> = [take("first_min"), take("first_max")].concat();
        rim.sort_unstable();
        mesh.surfaces.clear();
        let mut outer = mesh.boundary().expect("a lattice shares each face between two cells at most");
        outer.retain(|f| inner.binary_search(f).is_err() && rim.binary_search(f).is_err());
        mesh.surfaces.insert("inner".to_owned(), inner);
        mesh.surfaces.insert("rim".to_owned(), rim);
        mesh.surfaces.insert("outer".to_owned(), outer);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quality::QualityReport;

    fn tread(pattern: LugPattern) -> TireTread {
        TireTread {
            size: "165/65R13".to_owned(),
            rim_width: 0.127,
            wall_thickness: 0.016,
            groove_depth: 0.015,
            pattern,
            n_elements: 24_000,
        }
    }

    #[test]
    fn size_code_gives_the_radius_of_the_standard() {
        // 330.2 mm + 2 x 0.65 x 165 mm = 544.7 mm across.
        let size = TireSize::parse("165/65R13").unwrap();
        assert!((size.outer_radius() - 0.272_35).abs() < 1e-12);
        assert!(TireSize::parse("wide").unwrap_err().to_string().contains("165/65R13"));
    }

    #[test]
    fn treads_are_sound_meshes_of_about_the_size_asked_for() {
        // Cells of a land that is no multiple of a quarter are not all of one length.
        for (land, least_angle) in [(None, 10.0), (Some(0.25), 10.0), (Some(0.5), 10.0), (Some(0.7), 9.5_f64)]
        {
            let pattern = land.map_or(LugPattern::Smooth, |land| LugPattern::Alternating { count: 20, land });
            let mesh = tread(pattern).mesh().unwrap();
            mesh.validate().unwrap();
            let n = mesh.n_elements() as f64;
            assert!((n / 24_000.0 - 1.0).abs() < 0.1 + 1e-9, "{pattern:?}: {n}");
            let largest = mesh.nodes.iter().map(|x| x.x.hypot(x.z)).fold(0.0, f64::max);
            assert!((largest - 0.272_35).abs() < 1e-9);
            let quality = QualityReport::of(&mesh);
            assert!(quality.smallest_dihedral_angle > least_angle.to_radians(), "{pattern:?}: {quality:?}");
            // Every edge of the whole boundary is shared by two facets: rim, inner and outer close the solid.
            let parts: usize = ["rim", "inner", "outer"].iter().map(|s| mesh.facets(s).unwrap().len()).sum();
            assert_eq!(parts, mesh.boundary().unwrap().len());
            let (surface, _) = mesh.triangle_surface(&mesh.boundary().unwrap());
            assert!((surface.solid_properties().volume / mesh.volume() - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn lugs_alternate_between_the_halves() {
        let mesh = tread(LugPattern::Alternating { count: 20, land: 0.5 }).mesh().unwrap();
        let volume = |is_left: bool| -> f64 {
            (0..mesh.n_elements())
                .filter(|&e| mesh.region_of_element[e] == 1)
                .filter(|&e| (mesh.element_positions(e).iter().map(|x| x.y).sum::<f64>() < 0.0) == is_left)
                .map(|e| mesh.element_volume(e))
                .sum()
        };
        assert!(volume(true) > 0.0 && (volume(true) / volume(false) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn walls_are_widest_between_bead_and_crown_and_stand_on_their_rim() {
        let mesh = tread(LugPattern::Smooth).mesh().unwrap();
        let widest = mesh.nodes.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap();
        let height = (widest.x.hypot(widest.z) - 0.1651) / (0.272_35 - 0.1651);
        assert!((widest.y / 0.0825 - 1.0).abs() < 0.01, "{widest:?}");
        assert!((0.2..0.6).contains(&height), "{height}");
        // The wall meets the rim at a slant, so its outer corner lies a little inside the flange.
        let beads = mesh.nodes_of("rim").unwrap().into_iter().map(|n| mesh.nodes[n as usize].y.abs());
        let (inner, outer) = beads.fold((f64::INFINITY, 0.0), |(i, o): (f64, f64), y| (i.min(y), o.max(y)));
        assert!((inner - 0.0475).abs() < 1e-12 || (outer - 0.0475).abs() < 1e-12, "{inner} {outer}");
        assert!(outer <= 0.0635 + 1e-12);
    }

    #[test]
    fn what_cannot_be_a_tire_is_refused() {
        let mut too_thick = tread(LugPattern::Smooth);
        too_thick.wall_thickness = 0.06;
        assert!(matches!(too_thick.mesh(), Err(TireError::Thickness { .. })));
        let mut too_coarse = tread(LugPattern::Alternating { count: 20, land: 0.5 });
        too_coarse.n_elements = 500;
        assert!(matches!(too_coarse.mesh(), Err(TireError::TooFewElements { .. })));
        let covered = tread(LugPattern::Alternating { count: 20, land: 25.0 });
        assert!(covered.mesh().unwrap_err().to_string().contains("expected between 0 and 1"));
        let mut on_inches = tread(LugPattern::Smooth);
        on_inches.rim_width = 5.0;
        assert!(on_inches.mesh().unwrap_err().to_string().contains("expected 0.1118 to 0.165 m"));
    }
}
