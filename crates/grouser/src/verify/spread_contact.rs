//! A bead whose force is spread over a block finer than its contact: `docs/theory/coupling.md`, local indentation.

use super::Row;
use super::coupling::{LAW, RADIUS, bead};
use grouser_contact::{Interaction, Load, Material as Grain, PairTable, Tail, Vector};
use grouser_coupling::{DeformingContacts, Margin, Mirror, Spread, Step};
use grouser_fem::verification::boussinesq;
use grouser_fem::{LinearSolver, Material as Elastic, Settings, Solid, StaticOptions, VolumetricTreatment};
use grouser_geometry::{Lattice, Vec3};
use std::error::Error;

/// Young's modulus [Pa] and Poisson's ratio of the block.
const YOUNG: f64 = 1e7;
const POISSON: f64 = 0.3;
/// Contact radius that Hertz's theory gives to bead and block together [m].
const CONTACT_RADIUS: f64 = 3e-4;
/// Distance of the block's far sides from the contact, over the contact radius.
const EXTENT: f64 = 16.0;

/// Radius over which forces are spread, over the contact radius: forces of the stiffest bead are just within [`Spread`]'s limit.
const SPREAD: f64 = 3.5;

/// Force on a bead held where Hertz's contact has `share` of the contact radius, over Hertz's; on a block of `n` × `n` × `n`/2 cells;
/// `young` is the bead's modulus [Pa].
fn held(n: usize, young: f64, share: f64) -> Result<f64, Box<dyn Error>> {
    let grain = Grain { young_pa: young, poisson: POISSON, density_kg_m3: 2500.0 };
    let block = Grain { young_pa: YOUNG, ..grain };
    let interaction = |_, _| Interaction { restitution: 0.5, friction: 0.0 };
    let table: PairTable = PairTable::new(&[grain, block], Tail::CutCorrected, interaction)?;
    let approach = (share * CONTACT_RADIUS).powi(2) / RADIUS;
    let hertz = table.pair(0, 1).normal_modulus * RADIUS.sqrt() * approach.powf(1.5);

    // Cells grow from the contact outwards.
    let (side, growth) = (EXTENT * CONTACT_RADIUS, 3.0_f64);
    let at = |k: usize, cells: usize| side * (growth * k as f64 / cells as f64).sinh() / growth.sinh();
    let across = |k: usize| if 2 * k < n { -at(n / 2 - k, n / 2) } else { at(k - n / 2, n / 2) };
    let map = |p: [usize; 3]| Vec3::new(across(p[0]), across(p[1]), -at(n / 2 - p[2], n / 2));
    let mesh = Lattice { cells: [n, n, n / 2], is_closed: false }.mesh(|_| true, map);
    let settings = Settings { volumetric: VolumetricTreatment::NodalAverage, ..Settings::default() };
    let mut solid = Solid::new(mesh, vec![Elastic::hooke(1000.0, YOUNG, POISSON)], settings)?;
    for far in ["first_min", "first_max", "second_min", "second_max", "third_min"] {
        for node in solid.mesh().nodes_of(far)? {
            let u = boussinesq(&solid.mesh().nodes[node as usize], hertz, YOUNG, POISSON);
            (0..3).for_each(|c| solid.prescribe(node, c, u[c], 0.0));
        }
    }
    let top = solid.mesh().facets("third_max")?;
    let faces: Vec<Vec<u32>> = top.iter().map(|&f| solid.mesh().facet_nodes(f)).collect();
    let mut contacts: DeformingContacts<Vector<f64>> =
        DeformingContacts::new(Mirror::new(&faces, 1)?, |node| solid.position(node), 1, Margin::DEFAULT);
    let spread = Spread { radius: SPREAD * CONTACT_RADIUS, plane_modulus: YOUNG / (1.0 - POISSON * POISSON) };
    contacts = contacts.with_spread(spread, |node| solid.position(node));

    let held = bead(Vec3::new(0.13 * CONTACT_RADIUS, 0.07 * CONTACT_RADIUS, RADIUS - approach));
    let step = Step { law: &LAW, table: &table, time_step: 1e-6, fastest: 0.0 };
    let mut force_on_bead = |solid: &Solid| {
        contacts.follow(|node| solid.position(node), |_| Vec3::zeros());
        let mut loads = [Load::default()];
        contacts.forces((&[held], &[0]), &mut loads, &step, |_| ());
        let mut on_nodes = Vec::new();
        contacts.spread(|node, force| on_nodes.push((node, force)));
        (loads[0].force.z, on_nodes)
    };
    let options = StaticOptions { solver: LinearSolver::ConjugateGradients, ..Default::default() };
    // The force that presses the block is the one that the bead then feels: secants of the difference.
    let (mut pressing, mut before) = (0.7 * hertz, None);
    let (mut found, mut on_nodes) = force_on_bead(&solid);
    for _ in 0..8 {
        solid.state.applied.fill(Vec3::zeros());
        on_nodes.iter().for_each(|&(n, f)| solid.state.applied[n as usize] += f * (pressing / found));
        solid.solve_statics(&options)?;
        (found, on_nodes) = force_on_bead(&solid);
        let missing = found - pressing;
        if missing.abs() < 1e-6 * hertz {
            break;
        }
        let slope = before.map_or(-2.0, |(at, then): (f64, f64)| (missing - then) / (pressing - at));
        before = Some((pressing, missing));
        pressing -= missing / slope;
    }
    Ok(found / hertz)
}

/// The force goes to Hertz's as the elements shrink, for a bead of the block's own stuff and for a hard one.
pub fn bead_pressed_into_fine_cells() -> Vec<Row> {
    let case = ("bead pressed into ever finer cells", "Hertz (Johnson, Contact Mechanics)");
    let mut rows = Vec::new();
    for (stuff, young) in [("the same stuff", YOUNG), ("a hundred times as stiff", 100.0 * YOUNG)] {
        let of = |n, share| held(n, young, share).unwrap_or(f64::NAN);
        let [coarse, fine] = [12, 24].map(|n| of(n, 1.0));
        let order = ((coarse - 1.0) / (fine - 1.0)).abs().log2();
        let cells = "forces spread over 8 cells";
        rows.push(Row::absolute(case, format!("{stuff}: order of the force"), "-", order, (1.5, 0.4)));
        for (share, force) in [(1.0, fine), (0.6, of(24, 0.6))] {
            let what = format!("{stuff}, {share} of the contact radius, {cells}: force over Hertz's");
            rows.push(Row::absolute(case, what, "-", force, (1.0, 0.02)));
        }
    }
    rows
}
