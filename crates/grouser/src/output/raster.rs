//! Pictures of spheres and triangles without any window: a depth buffer, one light, a PNG.

use grouser_geometry::Vec3;

/// Samples along each edge of a pixel.
const SAMPLES: usize = 2;

/// Where a picture is seen from: without perspective, so that lengths can be read off.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Point in the middle of the picture [m].
    pub centre: Vec3,
    /// Direction of view.
    pub forward: Vec3,
    /// Direction that points up in the picture.
    pub up: Vec3,
    /// Width and height of what is seen [m].
    pub size: [f64; 2],
}

/// A picture being drawn.
pub struct Raster {
    view: View,
    right: Vec3,
    n: [usize; 2],
    scale: f64,
    pixels: Vec<[f32; 3]>,
    depth: Vec<f64>,
}

impl Raster {
    /// An empty picture `width` pixels wide.
    pub fn new(view: View, width: usize) -> Self {
        let height = ((width as f64 * view.size[1] / view.size[0]).round() as usize).max(1);
        let n = [width * SAMPLES, height * SAMPLES];
        Self {
            view,
            right: view.forward.cross(&view.up),
            n,
            scale: n[0] as f64 / view.size[0],
            pixels: vec![[1.0; 3]; n[0] * n[1]],
            depth: vec![f64::INFINITY; n[0] * n[1]],
        }
    }

    /// Column, row and depth of a point, in samples and metres.
    fn project(&self, point: &Vec3) -> [f64; 3] {
        let from_centre = point - self.view.centre;
        [
            from_centre.dot(&self.right) * self.scale + self.n[0] as f64 / 2.0,
            self.n[1] as f64 / 2.0 - from_centre.dot(&self.view.up) * self.scale,
            from_centre.dot(&self.view.forward),
        ]
    }

    fn put(&mut self, column: usize, row: usize, depth: f64, colour: [f32; 3], light: f64) {
        let place = row * self.n[0] + column;
        if depth < self.depth[place] {
            self.depth[place] = depth;
            let shade = (0.4 + 0.6 * light) as f32;
            self.pixels[place] = colour.map(|part| part * shade);
        }
    }

    fn span(from: f64, to: f64, n: usize) -> std::ops::Range<usize> {
        (from.floor().max(0.0) as usize)..(to.ceil().clamp(0.0, n as f64) as usize)
    }

    /// A sphere.
    pub fn sphere(&mut self, centre: &Vec3, radius: f64, colour: [f32; 3]) {
        let ([x, y, depth], r) = (self.project(centre), radius * self.scale);
        for row in Self::span(y - r, y + r, self.n[1]) {
            for column in Self::span(x - r, x + r, self.n[0]) {
                let (dx, dy) = ((column as f64 + 0.5 - x) / r, (row as f64 + 0.5 - y) / r);
                let rest = 1.0 - dx * dx - dy * dy;
                if rest > 0.0 {
                    let towards = rest.sqrt();
                    let light = (0.7 * towards - 0.5 * dy - 0.3 * dx).clamp(0.0, 1.0);
                    self.put(column, row, depth - radius * towards, colour, light);
                }
            }
        }
    }

    /// A triangle, seen from both sides.
    pub fn triangle(&mut self, corners: &[Vec3; 3], colour: [f32; 3]) {
        let [a, b, c] = corners.map(|corner| self.project(&corner));
        let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
        let Some(normal) = normal.try_normalize(0.0) else { return };
        let facing = -normal.dot(&self.view.forward).signum();
        let towards = normal * facing;
        let light = 0.7 * -towards.dot(&self.view.forward) + 0.5 * towards.dot(&self.view.up)
            - 0.3 * towards.dot(&self.right);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0.0 {
            return;
        }
        let low = |axis: usize| a[axis].min(b[axis]).min(c[axis]);
        let high = |axis: usize| a[axis].max(b[axis]).max(c[axis]);
        for row in Self::span(low(1), high(1), self.n[1]) {
            for column in Self::span(low(0), high(0), self.n[0]) {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let share = |p: [f64; 3], q: [f64; 3]| {
                    ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])) / area
                };
                let (l_a, l_b, l_c) = (share(b, c), share(c, a), share(a, b));
                if l_a >= 0.0 && l_b >= 0.0 && l_c >= 0.0 {
                    let depth = l_a * a[2] + l_b * b[2] + l_c * c[2];
                    self.put(column, row, depth, colour, light.clamp(0.0, 1.0));
                }
            }
        }
    }

    /// A bar along the right edge that shows the colours from −1 (bottom) to 1 (top).
    pub fn colour_bar(&mut self) {
        let (width, n) = (self.n[0] / 40, self.n);
        let (low, high) = (n[1] / 10, n[1] - n[1] / 10);
        // On a margin of its own: what is drawn does not go on behind it.
        for row in self.pixels.chunks_exact_mut(n[0]) {
            row[n[0] - 3 * width..].fill([1.0; 3]);
        }
        for row in low..high {
            let value = 1.0 - 2.0 * (row - low) as f64 / (high - low) as f64;
            for column in n[0] - 2 * width..n[0] - width {
                self.pixels[row * n[0] + column] = signed_colour(value);
            }
        }
    }

    /// The file.
    pub fn to_png(&self) -> Vec<u8> {
        let [width, height] = self.n.map(|n| n / SAMPLES);
        let mut bytes = Vec::with_capacity(3 * width * height);
        for row in 0..height {
            for column in 0..width {
                for part in 0..3 {
                    let mut sum = 0.0;
                    for (i, j) in (0..SAMPLES * SAMPLES).map(|k| (k / SAMPLES, k % SAMPLES)) {
                        sum += self.pixels[(row * SAMPLES + i) * self.n[0] + column * SAMPLES + j][part];
                    }
                    bytes.push((255.0 * sum / (SAMPLES * SAMPLES) as f32).clamp(0.0, 255.0) as u8);
                }
            }
        }
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&bytes));
        written.expect("writing to memory does not fail");
        file
    }
}

/// Blue for −1, light grey for 0, red for 1; beyond, the ends.
pub fn signed_colour(value: f64) -> [f32; 3] {
    let t = value.clamp(-1.0, 1.0) as f32;
    let (grey, red, blue) = ([0.88, 0.88, 0.86], [0.80, 0.12, 0.10], [0.10, 0.25, 0.75]);
    let end = if t < 0.0 { blue } else { red };
    std::array::from_fn(|part| grey[part] + (end[part] - grey[part]) * t.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(png: &[u8]) -> (usize, Vec<u8>) {
        let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        (info.width as usize, pixels)
    }

    #[test]
    fn what_is_nearer_hides_what_is_behind_it_and_lengths_are_kept() {
        let view = View { centre: Vec3::zeros(), forward: Vec3::y(), up: Vec3::z(), size: [2.0, 1.0] };
        let mut raster = Raster::new(view, 200);
        raster.sphere(&Vec3::new(0.0, 0.5, 0.0), 0.4, [1.0, 0.0, 0.0]);
        // A triangle in front of its right half.
        let corners = [Vec3::new(0.0, 0.0, -1.0), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
        raster.triangle(&corners, [0.0, 0.0, 1.0]);
        let (width, pixels) = decoded(&raster.to_png());
        let at = |column: usize| &pixels[3 * (50 * width + column)..][..3];
        assert!(at(90)[0] > 100 && at(90)[2] == 0, "the left half of the sphere is red");
        assert!(at(110)[2] > 90 && at(110)[0] == 0, "the right half is behind the triangle");
        assert_eq!(at(50), [255; 3], "0.4 m from the middle the sphere ends");
    }
}
