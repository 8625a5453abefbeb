//! A height grid as a picture: one square of pixels a point, north up, white for zero to dark for the largest value.

use grouser_geometry::HeightGrid;

/// Colours between which values are blended; light and dark in order, so that the picture survives grey print.
const COLOURS: [[f64; 3]; 5] = [
    [247.0, 247.0, 247.0],
    [190.0, 210.0, 230.0],
    [86.0, 160.0, 200.0],
    [20.0, 90.0, 150.0],
    [90.0, 20.0, 60.0],
];

/// The picture as PNG; values from zero to `largest` take the whole range of colours.
///
/// # Errors
/// When the picture cannot be encoded.
pub fn heat_map(grid: &HeightGrid, largest: f64) -> Result<Vec<u8>, png::EncodingError> {
    // At least 900 pixels wide.
    let zoom = 900_usize.div_ceil(grid.n_x()).max(1);
    let (width, height) = (grid.n_x() * zoom, grid.n_y() * zoom);
    let mut pixels = Vec::with_capacity(3 * width * height);
    for row in (0..grid.n_y()).rev() {
        let mut line = Vec::with_capacity(3 * width);
        for column in 0..grid.n_x() {
            let value = grid.heights()[row * grid.n_x() + column];
            let colour = colour(if largest > 0.0 { value / largest } else { 0.0 });
            (0..zoom).for_each(|_| line.extend(colour));
        }
        (0..zoom).for_each(|_| pixels.extend(&line));
    }
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(bytes)
}

fn colour(share: f64) -> [u8; 3] {
    let place = share.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let k = (place as usize).min(COLOURS.len() - 2);
    let t = place - k as f64;
    std::array::from_fn(|c| (COLOURS[k][c] + t * (COLOURS[k + 1][c] - COLOURS[k][c])).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picture_has_north_up_and_the_largest_value_darkest() {
        let grid =
            HeightGrid::covering(
                [0.0, 0.0],
                [899.0, 1.0],
                1.0,
                |x, y| if y > 0.5 && x < 1.5 { 2.0 } else { 0.0 },
            );
        let bytes = heat_map(&grid.unwrap(), 2.0).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width, info.height), (900, 2));
        assert_eq!((pixels[0..3].to_vec(), pixels[6..9].to_vec()), (vec![90, 20, 60], vec![247, 247, 247]));
    }
}
