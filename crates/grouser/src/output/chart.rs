//! Charts: curves and points over two axes, drawn once for SVG and for PNG.

mod canvas;
mod legend;

use legend::{INDENT, MARGIN, ROW};
use plotters::coord::Shift;
use plotters::prelude::*;

/// A chart.
#[derive(Debug, Clone, Default)]
pub struct Chart {
    /// Heading.
    pub title: String,
    /// What the horizontal axis shows, with unit.
    pub x_label: String,
    /// What the vertical axis shows, with unit.
    pub y_label: String,
    /// What is drawn.
    pub series: Vec<Series>,
}

/// One set of points.
#[derive(Debug, Clone)]
pub struct Series {
    /// Name in the legend; without one the series is not in it.
    pub name: String,
    /// Which of the palette's colours; series of one thing share it.
    pub colour: usize,
    /// How it is drawn.
    pub mark: Mark,
    /// Points.
    pub points: Vec<(f64, f64)>,
}

/// How points are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A line through them.
    Line,
    /// A broken line through them.
    Dashes,
    /// A ring at each.
    Ring,
}

/// Distinct in light, in dark, and to colour-blind eyes (after Okabe and Ito).
const PALETTE: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 160, 220),
];
const INK: RGBColor = RGBColor(17, 17, 17);
const SIZE: (u32, u32) = (860, 520);

type Failure = Box<dyn std::error::Error + Send + Sync>;

impl Chart {
    /// As SVG with its own white ground.
    pub fn to_svg(&self) -> Result<String, Failure> {
        canvas::svg(SIZE, |area| {
            area.fill(&WHITE).map_err(|error| error.to_string())?;
            self.draw(area, 1.0)
        })
    }

    /// As SVG to be put into a page: no ground, and ink in the page's own colour.
    pub fn to_inline_svg(&self) -> Result<String, Failure> {
        let svg = canvas::svg(SIZE, |area| self.draw(area, 1.0))?;
        Ok(svg.replace("#111111", "currentColor"))
    }

    /// As PNG of twice the size, smoothed.
    pub fn to_png(&self) -> Result<Vec<u8>, Failure> {
        let scale = 2 * canvas::OVERSAMPLING;
        canvas::png((SIZE.0 * scale, SIZE.1 * scale), |area| {
            area.fill(&WHITE).map_err(|error| error.to_string())?;
            self.draw(area, f64::from(scale))
        })
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64) -> Result<(), Failure> {
        let px = |length: f64| (length * scale).round() as u32;
        let text = |size: f64| ("sans-serif", size * scale).into_font();
        let x = self.range(|p| p.0);
        let (corner, y) = self.legend_place(x, self.range(|p| p.1));
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, text(19.0).color(&INK))
            .margin(px(12.0))
            .margin_right(px(22.0))
            .x_label_area_size(px(48.0))
            .y_label_area_size(px(64.0))
            .build_cartesian_2d(x.0..x.1, y.0..y.1)
            .map_err(|error| error.to_string())?;
        let digits = |range: (f64, f64)| {
            let decimals = (1.0 - (range.1 - range.0).abs().log10().floor()).clamp(0.0, 6.0) as usize;
            move |value: &f64| format!("{:.decimals$}", if value.abs() < 1e-12 { 0.0 } else { *value })
        };
        chart
            .configure_mesh()
            .x_desc(&self.x_label)
            .y_desc(&self.y_label)
            .axis_desc_style(text(15.0).color(&INK))
            .label_style(text(13.0).color(&INK))
            .x_label_formatter(&digits(x))
            .y_label_formatter(&digits(y))
            .x_labels(8)
            .y_labels(8)
            .axis_style(ShapeStyle::from(&INK.mix(0.6)).stroke_width(px(1.0)))
            .bold_line_style(ShapeStyle::from(&INK.mix(0.12)).stroke_width(px(1.0)))
            .light_line_style(TRANSPARENT)
            .draw()
            .map_err(|error| error.to_string())?;
        for series in &self.series {
            let style = self.style(series, px(2.0));
            let points = series.points.iter().copied().filter(|(x, y)| x.is_finite() && y.is_finite());
            match series.mark {
                Mark::Line => chart.draw_series(LineSeries::new(points, style)).map(drop),
                Mark::Dashes => {
                    chart.draw_series(DashedLineSeries::new(points, px(7.0), px(5.0), style)).map(drop)
                }
                Mark::Ring => chart.draw_series(points.map(|at| Circle::new(at, px(4.0), style))).map(drop),
            }
            .map_err(|error| error.to_string())?;
        }
        let (across, down) = chart.plotting_area().get_pixel_range();
        let (width, height) = self.legend_size();
        let from_edge = |length: f64| (length * scale).round() as i32;
        let left = if corner.is_right {
            across.end - from_edge(width + MARGIN)
        } else {
            across.start + from_edge(MARGIN)
        };
        let top = if corner.is_low { down.end - from_edge(height) } else { down.start + from_edge(MARGIN) };
        self.legend(area, (left, top), scale)
    }

    /// One line a series, from a place to the right and downwards.
    fn legend<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        (left, top): (i32, i32),
        scale: f64,
    ) -> Result<(), Failure> {
        let px = |length: f64| (length * scale).round() as i32;
        for (row, series) in self.series.iter().filter(|series| !series.name.is_empty()).enumerate() {
            let style = self.style(series, px(2.0) as u32);
            let (x, y) = (left, top + px(4.0) + row as i32 * px(ROW));
            let line = |from: f64, to: f64| PathElement::new([(x + px(from), y), (x + px(to), y)], style);
            match series.mark {
                Mark::Line => area.draw(&line(0.0, 24.0)),
                Mark::Dashes => area.draw(&line(0.0, 9.0)).and_then(|()| area.draw(&line(14.0, 23.0))),
                Mark::Ring => area.draw(&Circle::new((x + px(12.0), y), px(4.0), style)),
            }
            .and_then(|()| {
                let font = ("sans-serif", 14.0 * scale).into_font().color(&INK);
                area.draw(&Text::new(series.name.as_str(), (x + px(INDENT), y - px(7.0)), font))
            })
            .map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    fn style(&self, series: &Series, width: u32) -> ShapeStyle {
        ShapeStyle::from(&PALETTE[series.colour % PALETTE.len()]).stroke_width(width)
    }

    /// The range of a coordinate, rounded outwards by a twentieth; zero is in it when near.
    fn range(&self, of: impl Fn(&(f64, f64)) -> f64) -> (f64, f64) {
        let values = self.series.iter().flat_map(|series| &series.points).map(of).filter(|v| v.is_finite());
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            return (0.0, 1.0);
        }
        let span = if high > low { high - low } else { high.abs().max(1.0) };
        let low = if low >= 0.0 && low < 0.4 * span { 0.0 } else { low - 0.05 * span };
        (low, high + 0.05 * span)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart() -> Chart {
        let line = |mark, colour, k: f64| Series {
            name: format!("series {colour} {mark:?}"),
            colour,
            mark,
            points: (0..40).map(|i| (0.5 * f64::from(i), k * (0.5 * f64::from(i)).powf(1.5))).collect(),
        };
        Chart {
            title: "Pressure under plates".into(),
            x_label: "sinkage z [mm]".into(),
            y_label: "mean pressure p [kPa]".into(),
            series: vec![line(Mark::Line, 0, 0.3), line(Mark::Dashes, 1, 0.4), line(Mark::Ring, 2, 0.5)],
        }
    }

    #[test]
    fn svg_shows_every_series_and_label() {
        let svg = chart().to_svg().unwrap();
        for text in ["Pressure under plates", "sinkage z [mm]", "mean pressure p [kPa]", "series 2 Ring"] {
            assert!(svg.contains(text), "{text}");
        }
        assert!(svg.matches("<circle").count() == 41 && svg.contains("#0072B2"));
        let inline = chart().to_inline_svg().unwrap();
        assert!(
            inline.contains("currentColor") && !inline.contains("#111111") && !inline.contains("#FFFFFF")
        );
    }

    #[test]
    fn png_has_the_palette_in_it() {
        let bytes = chart().to_png().unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let (width, height) = (2 * SIZE.0, 2 * SIZE.1);
        assert_eq!(pixels.len(), (3 * width * height) as usize);
        for RGBColor(r, g, b) in &PALETTE[..3] {
            assert!(pixels.chunks_exact(3).any(|pixel| pixel == [*r, *g, *b]));
        }
    }

    #[test]
    fn an_empty_chart_and_numbers_that_are_none_are_drawn() {
        let mut chart = chart();
        chart.series[0].points = vec![(f64::NAN, 1.0), (1.0, f64::INFINITY)];
        chart.series.truncate(1);
        chart.to_svg().unwrap();
        chart.series.clear();
        chart.to_png().unwrap();
    }
}
