//! A tire on hard flat ground: force and patch over deflection, for four-node (`linear`), averaged-pressure (`averaged`) and ten-node
//! (`quadratic`) elements.
//!
//! `cargo run --release -p grouser-fem --example tire_on_a_plane -- quadratic 12000 0.127` (elements, rim width in m)

use std::error::Error;

use grouser_fem::{LinearSolver, Material, Settings, Solid, StaticOptions, VolumetricTreatment};
use grouser_geometry::{LugPattern, TireTread};

/// Inflation [Pa].
const INFLATION: f64 = 1.4e5;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [kind, n_elements, rim_width] = &words[..] else {
        return Err("expected: linear | averaged | quadratic, number of elements, rim width in m".into());
    };
    let tread = TireTread {
        size: "165/65R13".into(),
        rim_width: rim_width.parse()?,
        wall_thickness: 0.016,
        groove_depth: 0.015,
        pattern: LugPattern::Alternating { count: 20, land: 0.5 },
        n_elements: n_elements.parse()?,
    };
    let mut mesh = tread.mesh()?;
    let mut settings = Settings::default();
    // Under uniform pressure corners of faces of six nodes carry nothing: ground is felt by the middles of their sides.
    let mut first_that_feels = 0;
    match kind.as_str() {
        "linear" => {}
        "averaged" => settings.volumetric = VolumetricTreatment::NodalAverage,
        "quadratic" => {
            first_that_feels = mesh.nodes.len() as u32;
            mesh = mesh.to_quadratic();
        }
        other => return Err(format!("`{other}` is no kind of element").into()),
    }
    let rubber = Material::hooke(1100.0, 20e6, 0.45);
    let mut tire = Solid::new(mesh.clone(), vec![rubber; mesh.region_names.len()], settings)?;
    tire.fix("rim")?;
    tire.inflate("inner", INFLATION)?;
    let options = StaticOptions { solver: LinearSolver::SparseCholesky, ..StaticOptions::default() };
    tire.solve_statics(&options)?;
    let rim = mesh.nodes_of("rim")?;
    let mut outer = mesh.nodes_of("outer")?;
    outer.retain(|n| *n >= first_that_feels && rim.binary_search(n).is_err());
    let lowest = outer.iter().map(|&n| tire.position(n).z).fold(f64::INFINITY, f64::min);
    println!("{} elements, {} nodes, radius inflated {:.4} m", mesh.n_elements(), mesh.nodes.len(), -lowest);
    let mut touching: Vec<u32> = Vec::new();
    for deflection in (2..=26).step_by(2).map(|mm| f64::from(mm) * 1e-3) {
        let ground = lowest + deflection;
        // Nodes below the ground are held on it, held ones that are pulled are let go.
        for _ in 0..30 {
            let force = |n: &u32| {
                let place = tire.supports().keys().position(|m| m == n);
                place.map_or(0.0, |k| tire.state.reaction[k].z)
            };
            let is_held = |n: &u32| touching.binary_search(n).is_ok();
            let next: Vec<u32> = (outer.iter())
                .filter(|n| if is_held(n) { force(n) >= 0.0 } else { tire.position(**n).z < ground })
                .copied()
                .collect();
            if next == touching && next.iter().all(|&n| (tire.position(n).z - ground).abs() < 1e-9) {
                break;
            }
            touching.iter().for_each(|&n| tire.release(n, 2));
            next.iter().for_each(|&n| tire.prescribe(n, 2, ground - mesh.nodes[n as usize].z, 0.0));
            touching = next;
            tire.solve_statics(&options)?;
        }
        let extent = |c: usize| {
            let places = touching.iter().map(|&n| tire.position(n)[c]);
            let (low, high) =
                places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
            high - low
        };
        let held = |n: &u32| tire.supports().keys().position(|m| m == n).expect("it is held");
        let load: f64 = touching.iter().map(|n| tire.state.reaction[held(n)].z).sum();
        println!(
            "deflection {:.0} mm, force {load:.0} N, patch {:.3} x {:.3} m",
            1e3 * deflection,
            extent(0),
            extent(1)
        );
    }
    Ok(())
}
