//! VTK series read back by a reader that is not ours.

use crate::process::succeeds;
use std::process::Command;

/// Reads every frame of every index in a folder with VTK's own XML readers, and compares times and sizes.
const READER: &str = r#"
import pathlib, sys, xml.etree.ElementTree as tree
try:
    import pyvista
except ImportError:
    sys.exit("error: Python has no pyvista; install it with `pip install pyvista`")
folder, n_bad, n_read = pathlib.Path(sys.argv[1]), 0, 0
for index in sorted(folder.glob("**/*.pvd")):
    for entry in tree.parse(index).iter("DataSet"):
        n_read += 1
        mesh = pyvista.read(index.parent / entry.get("file"))
        time = float(mesh.field_data["TimeValue"][0]) if "TimeValue" in mesh.field_data else float("nan")
        arrays = {name: mesh.point_data[name] for name in mesh.point_data.keys()}
        arrays |= {f"cell {name}": mesh.cell_data[name] for name in mesh.cell_data.keys()}
        finite = bool((abs(mesh.points) < 1e300).all()) and all((abs(a) < 1e300).all() for a in arrays.values())
        right = finite and abs(time - float(entry.get("timestep"))) <= 1e-12 * max(1, abs(time)) and mesh.n_points > 0
        n_bad += not right
        print("ok    " if right else "WRONG ", index.name, entry.get("file"), f"t = {time:g} s,",
              f"{mesh.n_points} points, {mesh.n_cells} cells,", ", ".join(arrays) or "no arrays")
print(f"{n_read} frames read with VTK {pyvista.vtk_version_info}, {n_bad} wrong")
sys.exit(1 if n_bad or not n_read else 0)
"#;

/// Reads the series of a run's folder; needs Python with pyvista and says so where it is missing.
pub fn read_back(rest: &[String]) -> bool {
    let [folder] = rest else {
        eprintln!("error: expected one folder of a run, for instance `cargo xtask vtk out/bevameter`");
        return false;
    };
    succeeds(Command::new("python3").args(["-c", READER, folder]))
}
