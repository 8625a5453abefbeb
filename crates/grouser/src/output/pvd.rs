//! A time series of VTK files, and the index (`.pvd`) that ParaView opens.

use super::{PolyData, write_atomic};
use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::Path;

/// Frames of one thing: `<name>.pvd` and `vtk/<name>_000000.vtp`, ….
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Series {
    name: String,
    times: Vec<f64>,
}

impl Series {
    /// A series without frames.
    pub fn new(name: impl Into<String>) -> Self {
        Series { name: name.into(), times: Vec::new() }
    }

    /// Name of the series.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Name of the index in the run's folder.
    pub fn index(&self) -> String {
        format!("{}.pvd", self.name)
    }

    /// Writes the next frame, then the index with it.
    pub fn push(&mut self, folder: &Path, data: &PolyData) -> io::Result<()> {
        fs::create_dir_all(folder.join("vtk"))?;
        write_atomic(&folder.join(self.frame(self.times.len())), &data.to_bytes())?;
        self.times.push(data.time);
        write_atomic(&folder.join(self.index()), self.to_xml().as_bytes())
    }

    fn frame(&self, number: usize) -> String {
        format!("vtk/{}_{number:06}.vtp", self.name)
    }

    fn to_xml(&self) -> String {
        let mut text =
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n"
                .to_owned();
        for (number, time) in self.times.iter().enumerate() {
            text += &format!("<DataSet timestep=\"{time}\" file=\"{}\"/>\n", self.frame(number));
        }
        text + "</Collection>\n</VTKFile>\n"
    }
}
