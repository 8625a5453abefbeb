//! Wavefront OBJ files: positions and faces, in double precision.

use std::io::{self, Read};

use thiserror::Error;

use crate::polygon::triangulate;
use crate::{TriangleSurface, Vec3};

/// Why an OBJ file could not be read.
#[derive(Debug, Error)]
pub enum ObjError {
    /// The source itself failed, or is not text.
    #[error("the OBJ data could not be read: {0}; OBJ is a text format, binary variants are not understood")]
    Io(#[from] io::Error),
    /// A word that should be something else.
    #[error(
        "line {line}, column {column}: expected {expected}, found `{found}`; usual cause: a file cut off or edited by hand; \
         remedy: correct the line or export the mesh again"
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
    /// A face names a vertex that is not there (yet).
    #[error(
        "line {line}, column {column}: the face names vertex {index}, but {n_vertices} vertices precede it (valid: 1 to \
         {n_vertices}, or -1 to -{n_vertices} counted backwards); usual cause: several files pasted together without \
         renumbering; remedy: export again"
    )]
    VertexOutOfRange {
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// The number in the file.
        index: i64,
        /// Vertices defined so far.
        n_vertices: usize,
    },
    /// A polygon that crosses itself, touches itself or has no area.
    #[error(
        "line {line}: the face of {n_corners} corners crosses itself or has no area, so it cannot be cut into triangles; \
         usual cause: corners in the wrong order, or a face with a hole; remedy: triangulate the mesh in the program that \
         exports it"
    )]
    NotSimple {
        /// Line, counted from 1.
        line: usize,
        /// Number of corners.
        n_corners: usize,
    },
}

/// Reads the positions (`v`) and faces (`f`) of an OBJ file; normals, textures, groups and materials are passed over.
///
/// Convex polygons become fans of triangles, others are cut ear by ear. OBJ knows no unit and no axis convention: scale and turn the result as needed.
pub fn read_obj(mut source: impl Read) -> Result<TriangleSurface, ObjError> {
    let mut text = String::new();
    source.read_to_string(&mut text)?;
    let mut surface = TriangleSurface::default();
    for (number, content) in text.lines().enumerate() {
        let mut words = Words { line: number + 1, content, rest: content.split('#').next().unwrap_or("") };
        match words.next().map(|(_, word)| word) {
            Some("v") => surface.vertices.push(position(&mut words)?),
            Some("f") => {
                let corners = face(&mut words, surface.vertices.len())?;
                let positions: Vec<Vec3> = corners.iter().map(|&v| surface.vertices[v as usize]).collect();
                let cut = triangulate(&positions)
                    .ok_or(ObjError::NotSimple { line: number + 1, n_corners: corners.len() })?;
                surface.triangles.extend(cut.iter().map(|t| t.map(|k| corners[k])));
            }
            _ => {}
        }
    }
    Ok(surface)
}

fn position(words: &mut Words) -> Result<Vec3, ObjError> {
    let mut p = Vec3::zeros();
    for i in 0..3 {
        let expected = "a coordinate (three numbers after `v`)";
        let (column, word) = words.next().ok_or_else(|| words.missing(expected))?;
        p[i] = word.parse().map_err(|_| words.syntax(column, expected, word))?;
    }
    Ok(p)
}

fn face(words: &mut Words, n_vertices: usize) -> Result<Vec<u32>, ObjError> {
    let mut corners = Vec::with_capacity(4);
    while let Some((column, word)) = words.next() {
        let index: i64 = (word.split('/').next().unwrap_or("").parse())
            .map_err(|_| words.syntax(column, "a vertex number (`7`, `7/2`, `7//3` or `7/2/3`)", word))?;
        let from_zero = if index > 0 { index - 1 } else { n_vertices as i64 + index };
        if index == 0 || from_zero < 0 || from_zero >= n_vertices as i64 {
            return Err(ObjError::VertexOutOfRange { line: words.line, column, index, n_vertices });
        }
        corners.push(from_zero as u32);
    }
    if corners.len() < 3 {
        return Err(words.missing("at least three vertex numbers after `f`"));
    }
    Ok(corners)
}

/// The words of a line with their columns.
struct Words<'a> {
    line: usize,
    content: &'a str,
    rest: &'a str,
}

impl<'a> Words<'a> {
    fn next(&mut self) -> Option<(usize, &'a str)> {
        let rest = self.rest.trim_start();
        let word = rest.split_whitespace().next()?;
        let column = rest.as_ptr() as usize - self.content.as_ptr() as usize + 1;
        self.rest = &rest[word.len()..];
        Some((column, word))
    }

    fn missing(&self, expected: &'static str) -> ObjError {
        self.syntax(self.content.trim_end().len() + 1, expected, "end of line")
    }

    fn syntax(&self, column: usize, expected: &'static str, found: &str) -> ObjError {
        ObjError::Syntax { line: self.line, column, expected, found: found.to_string() }
    }
}
