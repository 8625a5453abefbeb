//! Heights of the ground from a file: a surveyed grid, an image, points as text.

use crate::diagnostic::Diagnostic;
use grouser_geometry::bmp::read_bmp;
use grouser_geometry::esri_ascii::read_esri_ascii;
use grouser_geometry::grey_image::{GreyImage, read_pgm};
use grouser_geometry::xyz_text::read_xyz;
use grouser_geometry::{GridError, HeightGrid};
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// A file of heights, bilinear between its points; the shapes of the relief are added to it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeightFile {
    /// ESRI ASCII grid (`.asc`), points `x y z` as text (`.xyz`, `.txt`, `.csv`), or a grey image of 8 or 16 bits (`.png`, `.pgm`,
    /// `.bmp`); its path from the scenario's folder or else from the current one.
    pub file: String,
    /// Where its first point, lower left, comes to lie [m]; without it where the file says, an image at the origin.
    #[serde(default)]
    pub lower_left_m: Option<[f64; 2]>,
    /// What is subtracted from all heights [m]: a survey counts from the sea.
    #[serde(default)]
    pub datum_m: f64,
    /// What the samples of an image mean.
    #[serde(default)]
    pub image: Option<ImageScale>,
}

/// Scale of an image.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImageScale {
    /// Distance of its samples [m].
    pub pixel_m: f64,
    /// Height of black [m].
    pub black_m: f64,
    /// Height of the brightest grey [m]: sample 255 of 8 bits, 65535 of 16.
    pub white_m: f64,
}

impl HeightFile {
    /// The heights that the file holds, where it comes to lie.
    ///
    /// # Errors
    /// When there is no such file, or what it holds is no ground to drive on.
    pub fn grid(&self) -> Result<HeightGrid, Diagnostic> {
        let path = Path::new(&self.file);
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let source = File::open(path).map(BufReader::new).map_err(|error| {
            Diagnostic::new(format!("{}: {error}", self.file))
                .expected("a file of heights beside the scenario or below the current folder")
                .usual_cause("a misspelt path")
        })?;
        let refused = |error: &dyn Error| {
            Diagnostic::new(format!("{}: {error}", self.file))
                .expected("a height at every point of a regular grid")
                .usual_cause("a file with holes, cut off, or of another kind")
                .remedy(
                    "fill or cut out holes in the program that exports the heights, then export them again",
                )
        };
        let image = match extension.as_str() {
            "asc" => return self.placed(read_esri_ascii(source).map_err(|error| refused(&error))?),
            "xyz" | "txt" | "csv" => return self.placed(read_xyz(source).map_err(|error| refused(&error))?),
            "pgm" => read_pgm(source).map_err(|error| refused(&error))?,
            "bmp" => read_bmp(source).map_err(|error| refused(&error))?,
            "png" => read_png(source).map_err(|text| refused(&*Box::<dyn Error>::from(text)))?,
            other => {
                return Err(Diagnostic::new(format!(
                    "{}: there is no reader for `.{other}` files",
                    self.file
                ))
                .expected("`.asc`, `.xyz`, `.txt`, `.csv`, `.png`, `.pgm` or `.bmp`")
                .usual_cause("heights in the format of another program")
                .remedy("export them as ESRI ASCII grid"));
            }
        };
        let scale = self.image.ok_or_else(|| {
            Diagnostic::new(format!("{}: an image says nothing about lengths", self.file))
                .expected("`image: (pixel_m: …, black_m: …, white_m: …)` beside `file`")
                .usual_cause("an image in the place of a grid file")
        })?;
        let heights = image.to_heights(scale.pixel_m, [0.0, 0.0], scale.black_m, scale.white_m);
        self.placed(heights.map_err(|error| refused(&error))?)
    }

    fn placed(&self, grid: HeightGrid) -> Result<HeightGrid, Diagnostic> {
        let origin = self.lower_left_m.unwrap_or(grid.origin());
        let heights = grid.heights().iter().map(|height| height - self.datum_m).collect();
        HeightGrid::new(grid.n_x(), grid.n_y(), grid.spacing(), origin, heights)
            .map_err(|error: GridError| Diagnostic::new(format!("{}: {error}", self.file)))
    }

    /// Refuses a rectangle of ground, from `corner` over `size` \[m\], of which the file knows only a part.
    ///
    /// # Errors
    /// What lies outside.
    pub fn covers(&self, grid: &HeightGrid, corner: [f64; 2], size: [f64; 2]) -> Result<(), Diagnostic> {
        let (from, to) = (grid.origin(), grid.far_corner());
        let slack = 1e-9 * (to[0] - from[0]).max(to[1] - from[1]);
        let is_inside = (0..2).all(|k| corner[k] >= from[k] - slack && corner[k] + size[k] <= to[k] + slack);
        if is_inside {
            return Ok(());
        }
        let far = [corner[0] + size[0], corner[1] + size[1]];
        Err(Diagnostic::new(format!("{}: its heights end before the ground does", self.file))
            .expected(format!(
                "ground within x {:.3} to {:.3} m, y {:.3} to {:.3} m, where the file has heights; the scene asks for {:.3} to \
                 {:.3} m, {:.3} to {:.3} m",
                from[0], to[0], from[1], to[1], corner[0], far[0], corner[1], far[1]
            ))
            .usual_cause("coordinates of a survey, which do not begin at zero")
            .remedy("set `lower_left_m` of the file, or `corner_m` and `size_m` of the relief"))
    }
}

/// Samples of a grey PNG, 8 or 16 bits.
fn read_png(source: BufReader<File>) -> Result<GreyImage, String> {
    let mut decoder = png::Decoder::new(source);
    decoder.set_transformations(png::Transformations::IDENTITY);
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let size = reader.output_buffer_size().ok_or("an image too large to be read")?;
    let mut bytes = vec![0; size];
    let frame = reader.next_frame(&mut bytes).map_err(|error| error.to_string())?;
    let (colour, depth) = (frame.color_type, frame.bit_depth);
    if colour != png::ColorType::Grayscale {
        return Err(format!(
            "the image holds {colour:?} samples; expected greys; remedy: save it as greyscale"
        ));
    }
    let bytes = &bytes[..frame.buffer_size()];
    let (white, samples) = match depth {
        png::BitDepth::Eight => (255, bytes.iter().map(|&b| u16::from(b)).collect()),
        png::BitDepth::Sixteen => {
            (u16::MAX, bytes.chunks_exact(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect())
        }
        other => return Err(format!("the image has samples of {other:?}; expected 8 or 16 bits")),
    };
    Ok(GreyImage { width: frame.width as usize, height: frame.height as usize, white, samples })
}
