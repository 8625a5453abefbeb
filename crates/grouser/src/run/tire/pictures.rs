//! A tire on its bed as P0 shows it (Figs. 16 to 19), and for ParaView.

use super::tread::Tread;
use crate::output::PointField;
use crate::output::raster::{Raster, View, signed_colour};
use crate::output::vtu::Tetrahedra;
use grouser_contact::{Precision, Real, Sphere};
use grouser_fem::ElementFields;
use grouser_geometry::nalgebra::Matrix3;
use grouser_geometry::{TriangleSurface, Vec3};

/// Speed along x that has the full colour [m/s].
const FULL_SPEED: f64 = 0.5;
/// Strain that has the full colour [-].
const FULL_STRAIN: f64 = 0.1;
/// Width of a picture [pixels].
const WIDTH: usize = 720;
/// Colour of what has no strain.
const RUBBER: [f32; 3] = [0.35, 0.35, 0.37];

/// A triangle of the tire with its strains along x and z (P0's ε22 and ε33).
pub struct Patch {
    corners: [Vec3; 3],
    strains: Option<[f64; 2]>,
}

/// A grain as it is drawn.
pub struct Ball {
    centre: Vec3,
    radius: f64,
    /// Velocity along x [m/s].
    along: f64,
}

/// Grains as they are drawn.
pub fn balls<P: Precision>(spheres: &[Sphere<P>]) -> Vec<Ball> {
    let ball = |sphere: &Sphere<P>| {
        let p = sphere.position;
        Ball {
            centre: Vec3::new(p.x.to_f64(), p.y.to_f64(), p.z.to_f64()),
            radius: sphere.radius.to_f64(),
            along: sphere.velocity.x.to_f64(),
        }
    };
    spheres.iter().map(ball).collect()
}

/// What is drawn.
pub struct Seen {
    /// Grains.
    pub spheres: Vec<Ball>,
    /// Surface of the tire.
    pub skin: Vec<Patch>,
    /// Place of the axle [m].
    pub axle: Vec3,
    /// Height of the undisturbed bed [m].
    pub level: f64,
    /// Outer radius of the tire [m].
    pub radius: f64,
}

/// Strain of every element along the world's axes.
fn world_strains(tread: &Tread) -> Vec<(Matrix3<f64>, ElementFields)> {
    let turn = |strain: Matrix3<f64>| {
        if tread.is_attached() {
            let r = tread.solid.state.frame.rotation.to_rotation_matrix();
            r.matrix() * strain * r.matrix().transpose()
        } else {
            strain
        }
    };
    tread.solid.element_fields().into_iter().map(|fields| (turn(fields.strain), fields)).collect()
}

/// The skin of a tread with its strains, or of a rigid tire.
pub fn skin(tread: Option<&Tread>, outer: &TriangleSurface) -> Vec<Patch> {
    let Some(tread) = tread else {
        let patch = |t: usize| Patch { corners: outer.corners(t), strains: None };
        return (0..outer.triangles.len()).map(patch).collect();
    };
    let (strains, mesh) = (world_strains(tread), tread.solid.mesh());
    let facets = mesh.surfaces.values().flatten();
    let patch = |&facet| {
        let corners = mesh.facet_corners(facet).map(|node| tread.place(node));
        let strain = strains[facet.element as usize].0;
        Patch { corners, strains: Some([strain[(0, 0)], strain[(2, 2)]]) }
    };
    facets.map(patch).collect()
}

/// The tread as a `.vtu` file: displaced nodes, strain, stress and von Mises stress of the elements.
pub fn tetrahedra(tread: &Tread, time: f64) -> Tetrahedra<'static> {
    let (fields, mesh) = (world_strains(tread), tread.solid.mesh());
    let component = |row: usize, column: usize| {
        PointField::Scalar(fields.iter().map(|(strain, _)| strain[(row, column)]).collect())
    };
    let place = |node: usize| tread.place(node as u32).into();
    let displacement = tread.solid.state.displacement.iter().map(|u| [u.x, u.y, u.z]).collect();
    Tetrahedra {
        time,
        points: (0..mesh.nodes.len()).map(place).collect(),
        connectivity: mesh.connectivity.clone(),
        per_cell: mesh.order.n_nodes(),
        point_fields: vec![("displacement", PointField::Vector(displacement))],
        cell_fields: vec![
            ("strain_xx", component(0, 0)),
            ("strain_zz", component(2, 2)),
            ("von_mises", PointField::Scalar(fields.iter().map(|(_, f)| f.von_mises()).collect())),
            ("energy", PointField::Scalar(fields.iter().map(|(_, f)| f.energy).collect())),
        ],
    }
}

impl Seen {
    /// Name of the view, caption, file.
    pub fn pictures(&self) -> Vec<(&'static str, String, Vec<u8>)> {
        let side = 2.4 * self.radius;
        let middle = Vec3::new(self.axle.x, self.axle.y, self.level + 0.35 * self.radius);
        let view = |forward: Vec3, up: Vec3, size: [f64; 2], centre: Vec3| View { centre, forward, up, size };
        let (x, y, z) = (Vec3::x(), Vec3::y(), Vec3::z());
        let grains = format!("grains by velocity along the travel, ± {FULL_SPEED} m/s");
        let tire = |axis: &str| format!("tire by strain along the {axis}, ± {}", FULL_STRAIN);
        let all = |_: &Ball| true;
        let behind_cut = |sphere: &Ball| sphere.centre.y >= self.axle.y;
        let lowest = self.skin.iter().flat_map(|p| p.corners).fold(f64::INFINITY, |low, c| low.min(c.z));
        let at_lugs =
            |sphere: &Ball| sphere.centre.z < lowest + 0.04 && sphere.centre.z > lowest - 2.0 * sphere.radius;
        vec![
            (
                "back",
                format!("seen from behind; {grains}, {}", tire("vertical")),
                self.draw(view(x, z, [side, 0.75 * side], middle), &all, Some(1)),
            ),
            (
                "side",
                format!("seen from the side, the bed cut below the tire; {grains}, {}", tire("vertical")),
                self.draw(view(y, z, [1.4 * side, 0.8 * side], middle), &behind_cut, Some(1)),
            ),
            (
                "footprint",
                format!("the layer at the height of the lugs from above; {grains}"),
                self.draw(view(-z, y, [1.2 * side, 0.8 * side], middle), &at_lugs, None),
            ),
            (
                "below_zz",
                format!("from below; {}", tire("vertical")),
                self.draw(view(z, y, [side, 0.5 * side], middle), &|_| false, Some(1)),
            ),
            (
                "below_xx",
                format!("from below; {}", tire("travel")),
                self.draw(view(z, y, [side, 0.5 * side], middle), &|_| false, Some(0)),
            ),
        ]
    }

    fn draw(&self, view: View, is_shown: &dyn Fn(&Ball) -> bool, strain: Option<usize>) -> Vec<u8> {
        let mut raster = Raster::new(view, WIDTH);
        for sphere in self.spheres.iter().filter(|sphere| is_shown(sphere)) {
            let colour = signed_colour(sphere.along / FULL_SPEED);
            raster.sphere(&sphere.centre, sphere.radius, colour);
        }
        if let Some(which) = strain {
            for patch in &self.skin {
                let colour =
                    patch.strains.map_or(RUBBER, |strains| signed_colour(strains[which] / FULL_STRAIN));
                raster.triangle(&patch.corners, colour);
            }
        }
        raster.colour_bar();
        raster.to_png()
    }
}
