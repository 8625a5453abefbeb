//! STL files: triangles without neighbours, binary (single precision) or text.

use std::collections::HashMap;
use std::io::{self, Read, Write};

use thiserror::Error;

use crate::{TriangleSurface, Vec3};

/// Why an STL file could not be read.
#[derive(Debug, Error)]
pub enum StlError {
    /// The source itself failed.
    #[error("the STL data could not be read: {0}")]
    Io(#[from] io::Error),
    /// Neither a text file nor a binary one of the length that it announces.
    #[error(
        "not an STL file: {n_bytes} bytes, where a binary STL of {n_announced} triangles has {n_expected} and a text STL \
         begins with `solid` and holds `facet`; usual cause: a truncated download, or another format under this name; \
         remedy: export the mesh again"
    )]
    NotStl {
        /// Bytes in the file.
        n_bytes: usize,
        /// Triangles that the header announces, if it is a binary one.
        n_announced: u64,
        /// Bytes that such a file would have.
        n_expected: u64,
    },
    /// A text file with an unexpected word.
    #[error(
        "line {line}, column {column}: expected {expected}, found `{found}`; usual cause: a file cut off or edited by hand; \
         remedy: export the mesh again"
    )]
    Syntax {
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// What should stand there.
        expected: &'static str,
        /// What stands there.
        found: String,
    },
    /// More than 2³² corners.
    #[error(
        "the file holds {0} corners, more than 32-bit vertex numbers can count; remedy: coarsen the mesh"
    )]
    TooLarge(usize),
}

/// Reads a binary or a text STL. STL knows no unit: scale the result if the file is in millimetres.
///
/// Corners with equal coordinates become one vertex, so that neighbouring triangles are joined; files whose rounding
/// differs from triangle to triangle need [`TriangleSurface::welded`] in addition. The normals in the file are ignored:
/// the order of the corners decides.
pub fn read_stl(mut source: impl Read) -> Result<TriangleSurface, StlError> {
    let mut bytes = Vec::new();
    source.read_to_end(&mut bytes)?;
    let n_announced =
        bytes.get(80..84).map_or(0, |b| u64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])));
    let n_expected = 84 + 50 * n_announced;
    if bytes.len() >= 84 && bytes.len() as u64 == n_expected {
        return joined(binary_corners(&bytes));
    }
    match std::str::from_utf8(&bytes) {
        Ok(text) if text.trim_start().starts_with("solid") => joined(text_corners(text)?),
        _ => Err(StlError::NotStl { n_bytes: bytes.len(), n_announced, n_expected }),
    }
}

/// Writes a binary STL; coordinates are rounded to single precision, as the format demands.
pub fn write_binary_stl(surface: &TriangleSurface, mut sink: impl Write) -> io::Result<()> {
    let mut header = [b' '; 80];
    header[..7].copy_from_slice(b"grouser");
    sink.write_all(&header)?;
    sink.write_all(&(surface.triangles.len() as u32).to_le_bytes())?;
    for t in 0..surface.triangles.len() {
        let [a, b, c] = surface.corners(t);
        for x in [surface.normal(t), a, b, c].iter().flat_map(|v| v.iter()) {
            sink.write_all(&(*x as f32).to_le_bytes())?;
        }
        sink.write_all(&[0, 0])?;
    }
    Ok(())
}

/// Writes a text STL with all digits of the coordinates: reading it back gives the same numbers.
pub fn write_text_stl(surface: &TriangleSurface, mut sink: impl Write) -> io::Result<()> {
    writeln!(sink, "solid grouser")?;
    for t in 0..surface.triangles.len() {
        let n = surface.normal(t);
        writeln!(sink, "facet normal {:e} {:e} {:e}\n outer loop", n.x, n.y, n.z)?;
        for p in surface.corners(t) {
            writeln!(sink, "  vertex {:e} {:e} {:e}", p.x, p.y, p.z)?;
        }
        writeln!(sink, " endloop\nendfacet")?;
    }
    writeln!(sink, "endsolid grouser")
}

fn binary_corners(bytes: &[u8]) -> Vec<Vec3> {
    let coordinate = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    bytes[84..]
        .chunks_exact(50)
        .flat_map(|triangle| triangle[12..48].chunks_exact(12))
        .map(|p| Vec3::new(coordinate(&p[0..4]), coordinate(&p[4..8]), coordinate(&p[8..12])))
        .collect()
}

fn text_corners(text: &str) -> Result<Vec<Vec3>, StlError> {
    let mut corners = Vec::new();
    let mut n_in_loop = 0;
    for (number, content) in text.lines().enumerate() {
        let syntax = |at: &str, expected| StlError::Syntax {
            line: number + 1,
            column: at.as_ptr() as usize - content.as_ptr() as usize + 1,
            expected,
            found: at.split_whitespace().next().unwrap_or("end of line").to_string(),
        };
        let rest = content.trim_start();
        match rest.split_whitespace().next() {
            Some("vertex") => {
                let mut p = Vec3::zeros();
                let mut rest = rest["vertex".len()..].trim_start();
                for i in 0..3 {
                    let word = rest.split_whitespace().next().unwrap_or("");
                    p[i] = word
                        .parse()
                        .map_err(|_| syntax(rest, "a coordinate (three numbers after `vertex`)"))?;
                    rest = rest[word.len()..].trim_start();
                }
                corners.push(p);
                n_in_loop += 1;
            }
            Some("outer") => n_in_loop = 0,
            Some("endloop") if n_in_loop != 3 => {
                return Err(syntax(rest, "exactly three `vertex` lines before `endloop`"));
            }
            None | Some("solid" | "facet" | "endloop" | "endfacet" | "endsolid" | "color") => {}
            Some(_) => {
                return Err(syntax(
                    rest,
                    "`facet`, `outer loop`, `vertex`, `endloop`, `endfacet` or `endsolid`",
                ));
            }
        }
    }
    let n_left_over = corners.len() % 3;
    if n_left_over != 0 {
        return Err(StlError::Syntax {
            line: text.lines().count(),
            column: 1,
            expected: "three `vertex` lines in every facet",
            found: format!("{n_left_over} left over at the end of the file"),
        });
    }
    Ok(corners)
}

/// Triangles from every three corners; equal positions share a vertex, numbered by first use.
fn joined(corners: Vec<Vec3>) -> Result<TriangleSurface, StlError> {
    if u32::try_from(corners.len()).is_err() {
        return Err(StlError::TooLarge(corners.len()));
    }
    let mut number_of: HashMap<[u64; 3], u32> = HashMap::with_capacity(corners.len() / 4);
    let mut surface = TriangleSurface::default();
    let mut number = |p: &Vec3| {
        let key = [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits()); // −0 and 0 are one place
        *number_of.entry(key).or_insert_with(|| {
            surface.vertices.push(*p);
            surface.vertices.len() as u32 - 1
        })
    };
    let triangles = corners.chunks_exact(3).map(|c| [number(&c[0]), number(&c[1]), number(&c[2])]).collect();
    surface.triangles = triangles;
    Ok(surface)
}
