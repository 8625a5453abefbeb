//! Grey images as BMP files: 8 bits a sample, not compressed.

use std::io::Read;

use crate::grey_image::{GreyImage, GreyImageError};

/// Reads a BMP image of 8 bits a sample whose palette holds greys only.
pub fn read_bmp(mut source: impl Read) -> Result<GreyImage, GreyImageError> {
    let mut bytes = Vec::new();
    source.read_to_end(&mut bytes)?;
    let refused = |found: String| GreyImageError::NotBmp { found };
    let number = |at: usize, n: usize| -> Option<u32> {
        let part = bytes.get(at..at + n)?;
        Some(part.iter().rev().fold(0, |sum, &byte| sum << 8 | u32::from(byte)))
    };
    if bytes.get(..2) != Some(b"BM") {
        return Err(refused("another kind of file".into()));
    }
    let header = || Some((number(10, 4)?, number(14, 4)?, number(18, 4)? as i32, number(22, 4)? as i32));
    let layout = || Some((number(28, 2)?, number(30, 4)?, number(46, 4)?));
    let (Some((data, header_size, width, height)), Some((bits, compression, n_colours))) =
        (header(), layout())
    else {
        return Err(refused("a header that is cut off".into()));
    };
    if bits != 8 || compression != 0 {
        return Err(refused(format!("{bits} bits a sample, compression {compression}")));
    }
    let n_colours = if n_colours == 0 { 256 } else { n_colours.min(256) as usize };
    let palette = 14 + header_size as usize;
    let mut greys = [0_u16; 256];
    for (k, grey) in greys.iter_mut().enumerate().take(n_colours) {
        match bytes.get(palette + 4 * k..palette + 4 * k + 3) {
            Some([b, g, r]) if b == g && g == r => *grey = u16::from(*g),
            Some([b, g, r]) => return Err(refused(format!("the colour ({r}, {g}, {b}) in its palette"))),
            _ => return Err(refused("a palette that is cut off".into())),
        }
    }
    // Rows lie from the bottom up, unless the height is negative, and are filled up to four bytes.
    let (width, is_upside_down) = (usize::try_from(width).unwrap_or(0), height > 0);
    let height = height.unsigned_abs() as usize;
    let expected = width
        .checked_mul(height)
        .filter(|&n| (1..=1 << 28).contains(&n))
        .ok_or_else(|| refused(format!("{width} × {height} samples")))?;
    let line = width.div_ceil(4) * 4;
    let mut samples = Vec::with_capacity(expected);
    for row in 0..height {
        let start = data as usize + line * if is_upside_down { height - 1 - row } else { row };
        let Some(row) = bytes.get(start..start + width) else {
            return Err(GreyImageError::TooShort {
                found: bytes.len().saturating_sub(data as usize),
                expected,
            });
        };
        samples.extend(row.iter().map(|&index| greys[usize::from(index)]));
    }
    Ok(GreyImage { width, height, white: 255, samples })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 3 × 2 samples, rows from the bottom up, each filled up to four bytes.
    fn image(height: i32, blue: u8) -> Vec<u8> {
        let mut bytes = b"BM\0\0\0\0\0\0\0\0\x3e\0\0\0\x28\0\0\0\x03\0\0\0".to_vec();
        bytes.extend(height.to_le_bytes());
        bytes.extend(b"\x01\0\x08\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x02\0\0\0\0\0\0\0");
        bytes.extend([0, 0, 0, 0, blue, 200, 200, 0]);
        bytes.extend([0, 1, 0, 9, 1, 1, 0, 9]);
        bytes
    }

    #[test]
    fn rows_come_from_the_top_and_greys_from_the_palette() {
        let read = |height| read_bmp(&image(height, 200)[..]).unwrap();
        assert_eq!((read(2).width, read(2).height), (3, 2));
        assert_eq!(read(2).samples, [200, 200, 0, 0, 200, 0]);
        assert_eq!(read(-2).samples, [0, 200, 0, 200, 200, 0]);
    }

    #[test]
    fn colours_and_short_files_are_refused() {
        let coloured = read_bmp(&image(2, 10)[..]);
        assert!(
            matches!(coloured, Err(GreyImageError::NotBmp { found }) if found.contains("(200, 200, 10)"))
        );
        let whole = image(2, 200);
        for n in 0..whole.len() - 1 {
            assert!(read_bmp(&whole[..n]).is_err(), "{n} bytes");
        }
    }
}
