//! The two grounds that charts are drawn on.

use super::Failure;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use std::sync::Once;

/// PNGs are drawn this many times larger and averaged, which smooths their edges.
pub const OVERSAMPLING: u32 = 3;

/// Draws an SVG.
pub fn svg(
    size: (u32, u32),
    draw: impl FnOnce(&DrawingArea<SVGBackend, Shift>) -> Result<(), Failure>,
) -> Result<String, Failure> {
    embed_font();
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        draw(&area)?;
        area.present().map_err(|error| error.to_string())?;
    }
    // Fixed size in, any width out.
    let fixed = format!("<svg width=\"{0}\" height=\"{1}\"", size.0, size.1);
    Ok(text
        .replacen(&fixed, "<svg", 1)
        .replace("font-family=\"sans-serif\"", "font-family=\"Ubuntu, system-ui, sans-serif\""))
}

/// Draws a PNG; `size` counts the pixels before averaging.
pub fn png(
    size: (u32, u32),
    draw: impl FnOnce(&DrawingArea<BitMapBackend, Shift>) -> Result<(), Failure>,
) -> Result<Vec<u8>, Failure> {
    embed_font();
    let mut pixels = vec![0_u8; (3 * size.0 * size.1) as usize];
    {
        let area = BitMapBackend::with_buffer(&mut pixels, size).into_drawing_area();
        draw(&area)?;
        area.present().map_err(|error| error.to_string())?;
    }
    let (width, height) = (size.0 / OVERSAMPLING, size.1 / OVERSAMPLING);
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(&averaged(&pixels, width, height))?;
    Ok(bytes)
}

fn averaged(pixels: &[u8], width: u32, height: u32) -> Vec<u8> {
    let n = OVERSAMPLING;
    let mut smooth = Vec::with_capacity((3 * width * height) as usize);
    for y in 0..height {
        for x in 0..width {
            for channel in 0..3 {
                let inside = (0..n * n).map(|i| (n * x + i % n, n * y + i / n));
                let sum: u32 = inside
                    .map(|(x, y)| u32::from(pixels[(3 * (y * n * width + x) + channel) as usize]))
                    .sum();
                smooth.push((sum / (n * n)) as u8);
            }
        }
    }
    smooth
}

/// Text needs a font where the system has none.
fn embed_font() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let font = epaint_default_fonts::UBUNTU_LIGHT;
        let _ = register_font("sans-serif", FontStyle::Normal, font);
    });
}
