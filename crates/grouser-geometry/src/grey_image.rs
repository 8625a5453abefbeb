//! Ground as a grey image: dark is low, bright is high.

use std::io::{self, Read};

use thiserror::Error;

use crate::height_grid::{GridError, HeightGrid};

/// A grey image: samples in rows from the top, `white` the value of the brightest grey.
#[derive(Clone, Debug, PartialEq)]
pub struct GreyImage {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Value of the brightest grey: 255 for 8 bit, 65535 for 16 bit.
    pub white: u16,
    /// Samples, row by row from the top.
    pub samples: Vec<u16>,
}

/// Why an image is no ground.
#[derive(Debug, Error)]
pub enum GreyImageError {
    /// The source itself failed.
    #[error("the image could not be read: {0}")]
    Io(#[from] io::Error),
    /// Not a PGM file.
    #[error(
        "expected a grey image in PGM format (P2 or P5, up to 16 bit), found {found}; remedy: convert the image, e.g. to 16-bit \
         PGM"
    )]
    NotPgm {
        /// What was found.
        found: String,
    },
    /// Not a BMP file of greys.
    #[error(
        "expected a BMP image of 8 grey bits a sample, not compressed, found {found}; remedy: save it as greys, e.g. as 16-bit PNG \
         or PGM"
    )]
    NotBmp {
        /// What was found.
        found: String,
    },
    /// The image ends early.
    #[error("the image has {found} samples, expected {expected}; usual cause: a file cut off")]
    TooShort {
        /// Samples found.
        found: usize,
        /// Samples expected.
        expected: usize,
    },
    /// The image makes no grid.
    #[error(transparent)]
    Grid(#[from] GridError),
}

impl GreyImage {
    /// Ground of nodes `spacing` \[m\] apart; black lies at `low` \[m\], the brightest grey at `high` \[m\].
    ///
    /// The bottom row of the image is the row of nodes through `origin` \[m\].
    pub fn to_heights(
        &self,
        spacing: f64,
        origin: [f64; 2],
        low: f64,
        high: f64,
    ) -> Result<HeightGrid, GreyImageError> {
        if self.samples.len() != self.width * self.height {
            let expected = self.width * self.height;
            return Err(GreyImageError::TooShort { found: self.samples.len(), expected });
        }
        let scale = (high - low) / f64::from(self.white.max(1));
        let rows = self.samples.chunks(self.width.max(1)).rev();
        let heights = rows.flatten().map(|&grey| low + scale * f64::from(grey)).collect();
        Ok(HeightGrid::new(self.width, self.height, spacing, origin, heights)?)
    }
}

/// Reads a PGM image, plain (P2) or binary (P5), 8 or 16 bit.
pub fn read_pgm(mut source: impl Read) -> Result<GreyImage, GreyImageError> {
    let mut bytes = Vec::new();
    source.read_to_end(&mut bytes)?;
    let mut at = 0;
    let mut word = || {
        loop {
            while bytes.get(at).is_some_and(u8::is_ascii_whitespace) {
                at += 1;
            }
            if bytes.get(at) != Some(&b'#') {
                break;
            }
            at += bytes[at..].iter().position(|&b| b == b'\n').unwrap_or(bytes.len() - at);
        }
        let start = at;
        while bytes.get(at).is_some_and(|b| !b.is_ascii_whitespace()) {
            at += 1;
        }
        (String::from_utf8_lossy(&bytes[start..at.min(start + 20)]).into_owned(), at)
    };
    let (magic, _) = word();
    let not_pgm = |found: String| GreyImageError::NotPgm { found: format!("`{found}`") };
    if magic != "P2" && magic != "P5" {
        return Err(not_pgm(magic));
    }
    let mut number = || {
        let (text, end) = word();
        text.parse::<usize>().map(|n| (n, end)).map_err(|_| not_pgm(text))
    };
    let ((width, _), (height, _), (white, end)) = (number()?, number()?, number()?);
    let white = u16::try_from(white)
        .ok()
        .filter(|&w| w > 0)
        .ok_or_else(|| not_pgm(format!("brightest grey {white}")))?;
    let expected = width
        .checked_mul(height)
        .filter(|&n| n <= 1 << 28)
        .ok_or_else(|| not_pgm(format!("{width} × {height}")))?;
    let samples: Vec<u16> = if magic == "P2" {
        (0..expected).map_while(|_| number().ok().and_then(|(n, _)| u16::try_from(n).ok())).collect()
    } else {
        let data = bytes.get(end + 1..).unwrap_or(&[]);
        if white > 255 {
            data.chunks_exact(2).take(expected).map(|b| u16::from_be_bytes([b[0], b[1]])).collect()
        } else {
            data.iter().take(expected).map(|&b| u16::from(b)).collect()
        }
    };
    if samples.len() != expected {
        return Err(GreyImageError::TooShort { found: samples.len(), expected });
    }
    Ok(GreyImage { width, height, white, samples })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_and_sixteen_bit_images_give_heights() {
        let eight = read_pgm(&b"P5 # ground\n2 2 255\n\x00\xff\x33\x66"[..]).unwrap();
        let grid = eight.to_heights(0.5, [0.0, 0.0], 1.0, 2.0).unwrap();
        assert!(
            (grid.height_at(0.0, 0.0) - 1.2).abs() < 1e-12 && (grid.height_at(0.5, 0.5) - 2.0).abs() < 1e-12
        );
        let sixteen = read_pgm(&b"P5\n2 2\n65535\n\x00\x00\xff\xff\x80\x00\x00\x01"[..]).unwrap();
        assert_eq!(sixteen.samples, [0, 65535, 32768, 1]);
        assert_eq!(read_pgm(&b"P2 2 2 9 0 1 2 9"[..]).unwrap().samples, [0, 1, 2, 9]);
    }

    #[test]
    fn other_formats_and_short_files_are_refused() {
        assert!(matches!(read_pgm(&b"\x89PNG\r\n"[..]), Err(GreyImageError::NotPgm { .. })));
        assert!(matches!(
            read_pgm(&b"P5 2 2 255\n\x00"[..]),
            Err(GreyImageError::TooShort { found: 1, expected: 4 })
        ));
    }
}
