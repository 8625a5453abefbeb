//! A chain of stiff links between two held ends, over wheels and on ground: where its joints come to rest.

use super::banded::Banded;
use nalgebra::{Matrix6, SMatrix, Vector6};

/// Axial stiffness of a link and normal stiffness of a wheel \[N/m\]: two steel bars of 20 mm × 20 mm, 0.16 m long.
const STIFF: f64 = 1e9;
/// Pull of links with which the search begins \[N\].
const FIRST_PULL: f64 = 1e4;
/// Axial stiffness of a link that is pushed \[N/m\]: a loose chain folds instead of carrying; this keeps its joints apart.
const FOLDED: f64 = 1e4;
/// Pull of a link, or push of a wheel, per distance by which it may have come loose during the search \[N/m\].
const LOOSE: f64 = 1e7;
/// Stiffness added to each joint while searching \[N/m\]; it slows the search a little and changes no balance.
const STEADYING: f64 = 1e3;
/// Largest motion of a joint in a step of the search \[m\].
const LARGEST_STEP: f64 = 0.02;
/// Motion of joints at which the search ends \[m\].
const SETTLED: f64 = 1e-8;
/// Most steps of the search.
const MAX_STEPS: usize = 60;

/// A chain with its joints in the plane (x, z) of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Length of each link \[m\]; the first and last hang on the ends.
    pub lengths: Vec<f64>,
    /// Weight of each link (x, z) \[N\].
    pub weights: Vec<[f64; 2]>,
    /// Wheels (x, z, radius of the link line) \[m\].
    pub circles: Vec<[f64; 3]>,
}

/// A place where the ground presses on a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// The link; none where the gear moves with the body.
    pub link: Option<usize>,
    /// Share of the link's way from its first joint to its second.
    pub share: f64,
    /// Outward normal of the ground in the plane of the chain, scaled to a vertical part of one.
    pub normal: [f64; 2],
    /// Rise of the gear here per displacement and rotation of the body.
    pub with_body: Vector6<f64>,
}

/// The answer of the ground at a touch: vertical force \[N\] and its decrease with the gear's rise \[N/m\].
pub type Answer = (f64, f64);

/// A chain at rest.
#[derive(Clone, Debug)]
pub struct Settled {
    /// Its joints with both ends.
    pub joints: Vec<[f64; 2]>,
    /// Pull of each link \[N\].
    pub pulls: Vec<f64>,
    /// −∂(force, moment)/∂(displacement, rotation) of the body by all touches, the joints following.
    pub stiffness: Matrix6<f64>,
    /// Steps of the search.
    pub n_steps: usize,
}

/// Pulls of the links and pushes of the wheels on each joint \[N\], of their own beside the joints' positions.
#[derive(Clone)]
struct Reactions {
    pulls: Vec<f64>,
    pushes: Vec<Vec<f64>>,
}

impl Chain {
    /// T3: the rest near `start` (both ends and the joints between), with the ground's `answer` at each touch after it rose \[m\] since the
    /// joints lay at `from`.
    ///
    /// Newton's method with the pulls as unknowns: a joint that moves across its link by d stretches it by d²/2l, which says nothing about
    /// its pull. Along each step the energy m g h + ∫F dz falls as long as the forces do work; the step ends where they no longer do.
    pub fn settle(
        &self,
        from: &[[f64; 2]],
        start: &[[f64; 2]],
        touches: &[Touch],
        answer: impl Fn(usize, f64) -> Answer,
    ) -> Settled {
        let n = from.len() - 2;
        let mut joints = start.to_vec();
        let ask = |joints: &[[f64; 2]]| -> Vec<Answer> {
            touches.iter().enumerate().map(|(n, touch)| answer(n, Self::rise(touch, joints, from))).collect()
        };
        let mut answers = ask(&joints);
        let mut known =
            Reactions { pulls: vec![FIRST_PULL; n + 1], pushes: vec![vec![0.0; self.circles.len()]; n + 2] };
        let mut n_steps = 0;
        while n_steps < MAX_STEPS && n > 0 {
            n_steps += 1;
            let (forces, mut stiffness) = self.balance(&joints, touches, &answers, &known);
            stiffness.factorise();
            let mut step: Vec<SMatrix<f64, 1, 1>> = forces.iter().map(|f| SMatrix::from([*f])).collect();
            stiffness.solve(&mut step);
            let mut step: Vec<f64> = step.iter().map(|d| d.x).collect();
            let largest = step.iter().map(|d| d.abs()).fold(0.0, f64::max);
            let next = self.reactions(&joints, &step, &known);
            let differ = |(a, b): (&f64, &f64)| (*a > 0.0) != (*b > 0.0);
            let has_changed = known.pulls.iter().zip(&next.pulls).any(differ)
                || known.pushes.iter().flatten().zip(next.pushes.iter().flatten()).any(differ);
            known = next;
            let scale = (LARGEST_STEP / largest.max(1e-300)).min(1.0);
            step.iter_mut().for_each(|d| *d *= scale);
            let moved = |t: f64| -> Vec<[f64; 2]> {
                let mut moved = joints.clone();
                for k in 0..n {
                    moved[k + 1][0] += t * step[2 * k];
                    moved[k + 1][1] += t * step[2 * k + 1];
                }
                moved
            };
            let work = |joints: &[[f64; 2]], answers: &[Answer]| -> f64 {
                let forces = self.forces(joints, touches, answers, &known);
                forces[1..=n].iter().flatten().zip(&step).map(|(f, d)| f * d).sum()
            };
            let (before, mut t, mut there) = (work(&joints, &answers), 1.0, moved(1.0));
            answers = ask(&there);
            let mut after = work(&there, &answers);
            if before > 0.0 && after < -0.5 * before {
                let (mut a, mut f_a, mut b, mut f_b) = (0.0, before, 1.0, after);
                for _ in 0..20 {
                    t = (a * f_b - b * f_a) / (f_b - f_a);
                    there = moved(t);
                    answers = ask(&there);
                    after = work(&there, &answers);
                    if after.abs() <= 0.3 * before {
                        break;
                    }
                    if after > 0.0 {
                        (a, f_a) = (t, after);
                        f_b *= 0.5;
                    } else {
                        (b, f_b) = (t, after);
                        f_a *= 0.5;
                    }
                }
            }
            joints = there;
            if t * scale * largest <= SETTLED && !has_changed {
                break;
            }
        }
        let (_, stiffness) = self.balance(&joints, touches, &answers, &known);
        let condensed = self.condense(touches, &answers, stiffness);
        Settled { joints, pulls: known.pulls, stiffness: condensed, n_steps }
    }

    /// Rise of the gear at a touch when the joints have moved from `drawn` to `joints`.
    fn rise(touch: &Touch, joints: &[[f64; 2]], drawn: &[[f64; 2]]) -> f64 {
        let Some(a) = touch.link else { return 0.0 };
        let along = |k: usize| {
            let [d_a, d_b] = [a, a + 1].map(|j| joints[j][k] - drawn[j][k]);
            (1.0 - touch.share) * d_a + touch.share * d_b
        };
        touch.normal[0] * along(0) + touch.normal[1] * along(1)
    }

    /// Unit vector and length from `a` to `b`.
    fn towards(a: [f64; 2], b: [f64; 2]) -> ([f64; 2], f64) {
        let d = [b[0] - a[0], b[1] - a[1]];
        let length = d[0].hypot(d[1]).max(1e-12);
        ([d[0] / length, d[1] / length], length)
    }

    /// Axial stiffness of a link \[N/m\], stiff as far as it is pulled: one whose joints moved across it by d is d²/2l longer.
    fn axial(&self, link: usize, length: f64, known: f64) -> f64 {
        if length - self.lengths[link] + known / LOOSE > 0.0 { STIFF } else { FOLDED }
    }

    /// Push of a wheel on a joint as far as it is in touch with it: a joint that slid off by d²/2r still is.
    fn is_pushed(circle: &[f64; 3], joint: [f64; 2], known: f64) -> bool {
        let (_, distance) = Self::towards([circle[0], circle[1]], joint);
        circle[2] - distance + known / LOOSE > 0.0
    }

    /// Pulls and pushes after the joints moved by `step`, to first order.
    fn reactions(&self, joints: &[[f64; 2]], step: &[f64], known: &Reactions) -> Reactions {
        let n = joints.len() - 2;
        let d =
            |joint: usize, k: usize| if (1..=n).contains(&joint) { step[2 * (joint - 1) + k] } else { 0.0 };
        let pull = |link: usize| {
            let (e, length) = Self::towards(joints[link], joints[link + 1]);
            let stretch: f64 = (0..2).map(|k| e[k] * (d(link + 1, k) - d(link, k))).sum();
            self.axial(link, length, known.pulls[link]) * (length - self.lengths[link] + stretch)
        };
        let push = |joint: usize, circle: usize| {
            let c = &self.circles[circle];
            if !Self::is_pushed(c, joints[joint], known.pushes[joint][circle]) {
                return 0.0;
            }
            let (e, distance) = Self::towards([c[0], c[1]], joints[joint]);
            STIFF * (c[2] - distance - e[0] * d(joint, 0) - e[1] * d(joint, 1)).max(0.0)
        };
        let of_joint = |joint: usize| {
            let is_held = joint == 0 || joint == n + 1;
            (0..self.circles.len()).map(|c| if is_held { 0.0 } else { push(joint, c) }).collect()
        };
        Reactions { pulls: (0..=n).map(pull).collect(), pushes: (0..n + 2).map(of_joint).collect() }
    }

    /// Forces on all joints by ground, weight, and the known pulls and pushes in their present directions.
    fn forces(
        &self,
        joints: &[[f64; 2]],
        touches: &[Touch],
        answers: &[Answer],
        known: &Reactions,
    ) -> Vec<[f64; 2]> {
        let n = joints.len() - 2;
        let mut forces = vec![[0.0; 2]; n + 2];
        for link in 0..=n {
            let (e, _) = Self::towards(joints[link], joints[link + 1]);
            for r in 0..2 {
                forces[link][r] += known.pulls[link] * e[r] + 0.5 * self.weights[link][r];
                forces[link + 1][r] += -known.pulls[link] * e[r] + 0.5 * self.weights[link][r];
            }
        }
        for (j, joint) in joints.iter().enumerate().take(n + 1).skip(1) {
            for (c, circle) in self.circles.iter().enumerate() {
                let (e, distance) = Self::towards([circle[0], circle[1]], *joint);
                let push = match known.pushes[j][c] {
                    0.0 => STIFF * (circle[2] - distance).max(0.0),
                    known => known,
                };
                forces[j][0] += push * e[0];
                forces[j][1] += push * e[1];
            }
        }
        for (touch, &(force, _)) in touches.iter().zip(answers) {
            let Some(a) = touch.link.filter(|_| force != 0.0) else { continue };
            for (j, share) in [(a, 1.0 - touch.share), (a + 1, touch.share)] {
                forces[j][0] += force * share * touch.normal[0];
                forces[j][1] += force * share * touch.normal[1];
            }
        }
        forces
    }

    /// Forces on the free joints, with stretch and overlap as stiff springs, and their decrease with motion, kept positive definite.
    fn balance(
        &self,
        joints: &[[f64; 2]],
        touches: &[Touch],
        answers: &[Answer],
        known: &Reactions,
    ) -> (Vec<f64>, Banded) {
        let n = joints.len() - 2;
        let mut sprung = known.clone();
        let mut k = Banded::diagonal(STEADYING, 2 * n);
        for link in 0..=n {
            let (e, length) = Self::towards(joints[link], joints[link + 1]);
            let axial = self.axial(link, length, known.pulls[link]);
            sprung.pulls[link] = axial * (length - self.lengths[link]);
            let across = known.pulls[link].max(0.0) / length; // a pushed link folds
            let between = |r: usize, c: usize| {
                let unit = if r == c { 1.0 } else { 0.0 };
                axial * e[r] * e[c] + across * (unit - e[r] * e[c])
            };
            k.add_between(
                link,
                link + 1,
                [[between(0, 0), between(0, 1)], [between(1, 0), between(1, 1)]],
                n,
            );
        }
        for (j, joint) in joints.iter().enumerate().take(n + 1).skip(1) {
            for (c, circle) in self.circles.iter().enumerate() {
                sprung.pushes[j][c] = 0.0;
                if Self::is_pushed(circle, *joint, known.pushes[j][c]) {
                    let (e, distance) = Self::towards([circle[0], circle[1]], *joint);
                    sprung.pushes[j][c] = STIFF * (circle[2] - distance);
                    for r in 0..2 {
                        for s in 0..2 {
                            k.add(2 * (j - 1) + r, 2 * (j - 1) + s, STIFF * e[r] * e[s]);
                        }
                    }
                }
            }
        }
        for (touch, &(_, slope)) in touches.iter().zip(answers) {
            let Some(a) = touch.link.filter(|_| slope != 0.0) else { continue };
            let shares = [(a, 1.0 - touch.share), (a + 1, touch.share)];
            for (j, share) in shares.into_iter().filter(|s| (1..=n).contains(&s.0)) {
                for (i, other) in shares.into_iter().filter(|s| (1..=n).contains(&s.0)) {
                    for r in 0..2 {
                        for c in 0..2 {
                            let value = slope * share * other * touch.normal[r] * touch.normal[c];
                            k.add(2 * (j - 1) + r, 2 * (i - 1) + c, value);
                        }
                    }
                }
            }
        }
        let forces = self.forces(joints, touches, answers, &sprung);
        (forces[1..=n].iter().flatten().copied().collect(), k)
    }

    /// T4: what the body feels when the joints follow: K_bb − K_bj K_jj⁻¹ K_jb.
    fn condense(&self, touches: &[Touch], answers: &[Answer], mut k: Banded) -> Matrix6<f64> {
        let n = self.lengths.len() - 1;
        let mut body = Matrix6::zeros();
        let mut between: Vec<SMatrix<f64, 1, 6>> = vec![SMatrix::zeros(); 2 * n];
        for (touch, &(_, slope)) in touches.iter().zip(answers) {
            if slope == 0.0 {
                continue;
            }
            let row = touch.with_body.transpose();
            body += touch.with_body * (row * slope);
            let Some(a) = touch.link else { continue };
            for (j, share) in [(a, 1.0 - touch.share), (a + 1, touch.share)] {
                if (1..=n).contains(&j) {
                    for r in 0..2 {
                        between[2 * (j - 1) + r] += row * (slope * share * touch.normal[r]);
                    }
                }
            }
        }
        k.add_to_diagonal(-(1.0 - 1e-3) * STEADYING);
        k.factorise();
        let mut follow = between.clone();
        k.solve(&mut follow);
        for (b, f) in between.iter().zip(&follow) {
            body -= b.transpose() * f;
        }
        body
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::track::Catenary;

    fn straight(n: usize, length: f64, weight: f64) -> (Chain, Vec<[f64; 2]>) {
        let lengths = vec![length / n as f64; n];
        let weights = vec![[0.0, -weight / n as f64]; n];
        let joints = (0..=n).map(|k| [k as f64 / n as f64, 0.0]).collect();
        (Chain { lengths, weights, circles: Vec::new() }, joints)
    }

    #[test]
    fn a_chain_without_ground_hangs_as_a_catenary() {
        let error = |n: usize| {
            let (chain, from) = straight(n, 1.02, 500.0);
            let rest = chain.settle(&from, &from, &[], |_, _| (0.0, 0.0));
            // As long as its links have become under the pull.
            let link = |p: &[[f64; 2]]| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]);
            let length = rest.joints.windows(2).map(link).sum();
            let exact = Catenary::new([0.0, 0.0], [1.0, 0.0], length).at(0.5)[1];
            assert!(exact < -0.08 && rest.n_steps < MAX_STEPS, "{exact} {}", rest.n_steps);
            (rest.joints[n / 2][1] - exact).abs()
        };
        let (coarse, fine) = (error(10), error(40));
        assert!(fine < 4e-5 && (coarse / fine).log2() / 2.0 > 1.8, "{coarse} {fine}");
    }

    #[test]
    fn a_taut_chain_under_even_pressure_is_an_arc() {
        // Pressure q normal to the chain bends it to a circle; half its angle α obeys sin α/α = chord/length.
        let n = 40;
        let (chain, from) = straight(n, 1.02, 0.0);
        let touches: Vec<Touch> = (1..n - 1)
            .flat_map(|link| [0.25, 0.75].map(|share| (link, share)))
            .map(|(link, share)| Touch {
                link: Some(link),
                share,
                normal: [0.0, 1.0],
                with_body: Vector6::zeros(),
            })
            .collect();
        // Vertical load alone, spread evenly over the chord to first order: a parabola for little slack.
        let load = 1000.0 / touches.len() as f64;
        let rest = chain.settle(&from, &from, &touches, |_, _| (load, 0.0));
        let sag = rest.joints[n / 2][1];
        let parabola = (3.0_f64 * 0.02 / 8.0).sqrt();
        assert!((sag / parabola - 1.0).abs() < 0.02, "{sag} {parabola}");
    }

    #[test]
    fn what_the_body_feels_is_the_derivative_of_what_it_gets() {
        // A spring bed of 50 kN/m each under every link; the chain is held, bends and carries in part.
        let n = 12;
        let (chain, from) = straight(n, 1.001, 200.0);
        let with_body = Vector6::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
        let touches: Vec<Touch> = (1..n - 1)
            .map(|link| Touch { link: Some(link), share: 0.5, normal: [0.0, 1.0], with_body })
            .collect();
        let bed = |raised: f64| {
            move |n: usize, rise: f64| {
                let z = 0.01 + 0.002 * n as f64 - rise - raised;
                (5e4 * z.max(0.0), if z > 0.0 { 5e4 } else { 0.0 })
            }
        };
        let carried = |raised: f64| -> f64 {
            let rest = chain.settle(&from, &from, &touches, bed(raised));
            let rise = |touch: &Touch| Chain::rise(touch, &rest.joints, &from);
            touches.iter().enumerate().map(|(n, touch)| bed(raised)(n, rise(touch)).0).sum()
        };
        let step = 1e-5;
        let slope = (carried(-step) - carried(step)) / (2.0 * step);
        let felt = chain.settle(&from, &from, &touches, bed(0.0)).stiffness[(2, 2)];
        assert!(felt < 0.9 * 5e4 * (n - 2) as f64 && (felt / slope - 1.0).abs() < 1e-3, "{felt} {slope}");
    }
}
