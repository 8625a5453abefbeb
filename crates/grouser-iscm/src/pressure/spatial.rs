//! Several relationships at positions, blended with Gaussian weights (P2 Eqs. (2), (3)).

use std::io::Read;

use serde::{Deserialize, Serialize};

use super::{PressureArray, PressureError, PressureField, PressureLaw, Table};
use grouser_geometry::HeightGrid;

/// A relationship and where it was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LocatedLaw {
    /// Position \[m\].
    pub position: [f64; 2],
    /// The relationship there.
    pub law: PressureLaw,
}

/// Relationships at positions and the width of their influence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpatialLaws {
    /// Relationships and their positions, all different.
    pub laws: Vec<LocatedLaw>,
    /// Standard deviation c of the Gaussian \[m\]; beyond 5 c it is zero.
    pub standard_deviation: f64,
}

/// Absolute weights w_S of relationships at `positions` for the point `at` (P2 Eq. (2)); a single one weighs 1.
pub fn weights(positions: &[[f64; 2]], at: [f64; 2], standard_deviation: f64) -> Vec<f64> {
    let c = standard_deviation;
    let distance_from: Vec<f64> = positions
        .iter()
        .map(|r| {
            let squared = (r[0] - at[0]).powi(2) + (r[1] - at[1]).powi(2);
            if squared > 25.0 * c * c { 1.0 } else { -(-squared / (2.0 * c * c)).exp_m1() }
        })
        .collect();
    (0..positions.len())
        .map(|i| distance_from.iter().enumerate().filter(|&(k, _)| k != i).map(|(_, d)| d).product())
        .collect()
}

impl SpatialLaws {
    /// The blended relationship of every node of `grid` (P2 Eq. (3)), `resolution` \[m\] down to `max_sinkage` \[m\].
    pub fn field(
        &self,
        grid: &HeightGrid,
        resolution: f64,
        max_sinkage: f64,
    ) -> Result<PressureField, PressureError> {
        super::positive("spatial", "standard_deviation", self.standard_deviation)?;
        let positions: Vec<[f64; 2]> = self.laws.iter().map(|l| l.position).collect();
        for (second, r) in positions.iter().enumerate() {
            let closest = 1e-6 * self.standard_deviation;
            let first = positions[..second].iter().position(|q| (q[0] - r[0]).hypot(q[1] - r[1]) <= closest);
            if let Some(first) = first {
                let [x, y] = *r;
                return Err(PressureError::Coincident { first: first + 1, second: second + 1, x, y });
            }
        }
        let depth = self.laws.iter().map(|l| l.law.max_sinkage()).fold(max_sinkage, f64::min);
        let arrays = self
            .laws
            .iter()
            .map(|l| PressureArray::new(&l.law, resolution, depth))
            .collect::<Result<Vec<_>, _>>()?;
        let n_levels =
            arrays.iter().map(|a| a.pressures().len()).min().filter(|&n| n > 1).ok_or(PressureError::None)?;
        let mut pressures = Vec::with_capacity(grid.n_nodes() * n_levels);
        for j in 0..grid.n_y() {
            for i in 0..grid.n_x() {
                let w = weights(&positions, grid.position(i, j), self.standard_deviation);
                let total: f64 = w.iter().sum();
                let start = pressures.len();
                pressures.resize(start + n_levels, 0.0);
                for (w_i, array) in w.iter().zip(&arrays) {
                    for (sum, p) in pressures[start..].iter_mut().zip(array.pressures()) {
                        *sum += w_i / total * p;
                    }
                }
            }
        }
        Ok(PressureField::per_node(resolution, n_levels, pressures))
    }
}

/// Reads measured relationships: lines `name x y sinkage pressure` \[m, m, m, Pa\], one point each, points of one name together.
///
/// Blanks, tabs, commas or semicolons separate; `#` starts a comment.
pub fn read_located_laws(mut source: impl Read) -> Result<Vec<LocatedLaw>, PressureError> {
    let mut text = String::new();
    if let Err(error) = source.read_to_string(&mut text) {
        return Err(PressureError::Line { line: 1, found: error.to_string() });
    }
    let mut names: Vec<(String, usize)> = Vec::new();
    let mut laws: Vec<([f64; 2], Vec<[f64; 2]>)> = Vec::new();
    for (number, content) in text.lines().enumerate() {
        let content = content.split('#').next().unwrap_or("").trim();
        if content.is_empty() {
            continue;
        }
        let words: Vec<&str> = content.split([' ', '\t', ',', ';']).filter(|w| !w.is_empty()).collect();
        let numbers: Vec<f64> = words.iter().skip(1).map_while(|w| w.parse().ok()).collect();
        let [x, y, sinkage, pressure] = numbers[..] else {
            return Err(PressureError::Line { line: number + 1, found: content.into() });
        };
        if names.last().is_none_or(|(name, _)| name != words[0]) {
            names.push((words[0].into(), number + 1));
            laws.push(([x, y], Vec::new()));
        }
        let (position, points) = laws.last_mut().expect("a law was pushed with its name");
        if *position != [x, y] {
            return Err(PressureError::Line { line: number + 1, found: content.into() });
        }
        points.push([sinkage, pressure]);
    }
    let located = laws.into_iter().zip(names).map(|((position, points), (name, line))| {
        let law = PressureLaw::Table(Table { points });
        match law.check() {
            Ok(()) => Ok(LocatedLaw { position, law }),
            Err(reason) => Err(PressureError::Located { name, line, reason: Box::new(reason) }),
        }
    });
    located.collect()
}

#[cfg(test)]
mod tests {
    use super::super::Linear;
    use super::*;

    /// P2 Fig. 2: 10, 1 and 8.5 MPa/m at x = 1 m, y = 1, 2, 3 m.
    fn figure_2() -> Vec<LocatedLaw> {
        let located =
            |y, stiffness| LocatedLaw { position: [1.0, y], law: PressureLaw::Linear(Linear { stiffness }) };
        vec![located(1.0, 10e6), located(2.0, 1e6), located(3.0, 8.5e6)]
    }

    #[test]
    fn one_relationship_weighs_one_everywhere() {
        assert_eq!(weights(&[[0.0, 0.0]], [3.0, 4.0], 0.5), [1.0]);
    }

    #[test]
    fn a_relationship_rules_alone_at_its_own_position() {
        let positions: Vec<_> = figure_2().iter().map(|l| l.position).collect();
        let w = weights(&positions, [1.0, 2.0], 0.5);
        assert!(w[0] == 0.0 && w[2] == 0.0 && w[1] > 0.7);
    }

    #[test]
    fn coincident_positions_are_refused() {
        let mut laws = figure_2();
        laws[2].position = [1.0, 1.0];
        let grid = HeightGrid::covering([0.0, 0.0], [2.0, 4.0], 0.5, |_, _| 0.0).unwrap();
        let error = SpatialLaws { laws, standard_deviation: 0.5 }.field(&grid, 0.01, 0.5).unwrap_err();
        assert!(matches!(error, PressureError::Coincident { first: 1, second: 3, .. }), "{error}");
    }

    #[test]
    fn a_data_file_is_read_and_its_bad_lines_are_named() {
        let laws =
            read_located_laws("# name x y z p\na 0 0 0.1 1e4\na 0 0 0.2 2e4\nb,1,0,0.2,5e4\n".as_bytes())
                .unwrap();
        assert_eq!(laws.len(), 2);
        assert!((laws[0].law.pressure(0.15) - 1.5e4).abs() < 1e-9);
        let error = read_located_laws("a 0 0 0.1\n".as_bytes()).unwrap_err();
        assert!(matches!(error, PressureError::Line { line: 1, .. }));
        let error = read_located_laws("a 0 0 0.2 1\na 0 0 0.1 2\n".as_bytes()).unwrap_err();
        assert!(matches!(error, PressureError::Located { line: 1, .. }), "{error}");
    }
}
