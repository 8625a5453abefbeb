//! How far each grain may go before the lists are made anew, and how the lists foresee where it goes.
//!
//! Around each grain there is a ball that its centre may not leave. The ball drifts with the neighbourhood, and its radius, the leeway
//! s = b + w n, is larger for grains that are faster than their neighbourhood. A pair is listed when two balls, drifting for n steps and
//! then staying, may bring the grains to touch; the lists hold until somebody leaves its ball, whatever made it do so.
//!
//! ```text
//!   x(t) ∈ x₀ + u min(t, n) ± s        u drift, w speed beside it [m a step]; n horizon [steps]; b margin [m]
//! ```
//! Let e be the largest rate at which grains went beyond w t while the last lists held. Balls for n steps then have the mean radius
//! (e + w̄) n. Looks at pairs grow with it like p₀ (1 + 2s/d)³, rebuilds come every n steps; the horizon is that of the least cost.

use crate::Domain;
use crate::domain::Period;
use crate::drifts::Drifts;
use grouser_contact::{Precision, Real, Sphere, Vector};
use serde::{Deserialize, Serialize};

/// Cost of a rebuild per grain, in units of one look at a pair in the force pass (measured, `docs/performance.md`).
const REBUILD_COST: f64 = 80.0;
/// Smallest and largest leeway over the mean diameter [-].
const SMALLEST: f64 = 1e-3;
const LARGEST: f64 = 0.25;
/// Farthest drift, and farthest drift of neighbours against each other, over the mean diameter [-].
const FARTHEST_DRIFT: f64 = 0.5;
const FARTHEST_PARTING: f64 = 0.25;
/// Edge of a neighbourhood over the diameter of the largest grain [-].
const NEIGHBOURHOOD: f64 = 4.0;
/// Margin that lets at least so many steps pass before places are looked at first: a look costs about as much as one at each pair.
const STEPS_BETWEEN_LOOKS: f64 = 2.0;
/// Single precision rounds drifts by less.
const ROUNDED_UP: f64 = 1.0 + 1e-6;

/// What was known of a grain when the lists were made [m a step].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Foreseen {
    /// Mean velocity of the neighbourhood.
    drift: [f32; 3],
    /// Speed beside that drift.
    beside: f32,
}

/// The leeway of every listed grain, and what is left of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "C: Real")]
pub(crate) struct Leeways<C: Real> {
    mean_diameter: f64,
    /// b [m].
    margin: f64,
    /// n [steps].
    horizon: f64,
    /// Positions when the lists were made.
    reference: Vec<Vector<C>>,
    foreseen: Vec<Foreseen>,
    /// Mean leeway [m].
    mean: f64,
    /// Gap between two grains that may close before the lists are made anew [m].
    widest_gap: f64,
    /// The fastest drift [m a step].
    fastest_drift: f64,
    /// Lower bound of what is left to any grain [m].
    left: f64,
    steps: u32,
    /// Of the last step: what no grain moved further than [m], and its length [s].
    travel: f64,
    time_step: f64,
}

impl<C: Real> Leeways<C> {
    /// Before the first lists, of grains of this mean diameter [m]; all have `leeway` [m].
    pub fn new(mean_diameter: f64, leeway: f64) -> Self {
        Self {
            mean_diameter,
            margin: leeway,
            horizon: 0.0,
            reference: Vec::new(),
            foreseen: Vec::new(),
            mean: leeway,
            widest_gap: 0.0,
            fastest_drift: 0.0,
            left: 0.0,
            steps: 0,
            travel: 0.0,
            time_step: 0.0,
        }
    }

    /// Mean gap up to which a pair is listed [m].
    pub fn skin(&self) -> f64 {
        2.0 * self.mean
    }

    /// Gap between two grains that may close before the lists are made anew [m].
    pub fn widest_gap(&self) -> f64 {
        self.widest_gap
    }

    /// Some balls drift.
    pub fn some_drift(&self) -> bool {
        self.fastest_drift > 0.0
    }

    /// Leeway of a grain [m].
    #[inline(always)]
    pub fn of(&self, grain: usize) -> C {
        self.leeway(&self.foreseen[grain])
    }

    #[inline(always)]
    fn leeway(&self, foreseen: &Foreseen) -> C {
        let leeway = self.margin + self.horizon * f64::from(foreseen.beside);
        C::from_f64(leeway.min(LARGEST * self.mean_diameter))
    }

    /// How far the ball of a grain drifts [m].
    #[inline(always)]
    pub fn drift_of(&self, grain: usize) -> Vector<C> {
        drifted(&self.foreseen[grain], self.horizon)
    }

    /// Records that no grain moved further than `travel` [m] in this step of `time_step` [s], and says whether somebody has left its
    /// ball. The sum of travels is an upper bound; only when it is used up are places looked at.
    pub fn are_used_up<P: Precision<Coordinate = C>>(
        &mut self,
        spheres: &[Sphere<P>],
        period: &Period<C>,
        travel: f64,
        time_step: f64,
    ) -> bool {
        (self.steps, self.time_step, self.travel) = (self.steps + 1, time_step, travel);
        self.left -= travel + self.fastest_drift;
        if self.left > 0.0 {
            return false;
        }
        if self.reference.is_empty() {
            return true;
        }
        let steps = f64::from(self.steps).min(self.horizon);
        let mut left = C::from_f64(f64::INFINITY);
        for ((sphere, &old), foreseen) in spheres.iter().zip(&self.reference).zip(&self.foreseen) {
            let moved = period.nearest(sphere.position - old).0 - drifted(foreseen, steps);
            left = (self.leeway(foreseen) - moved.norm()).min(left);
        }
        self.left = left.to_f64();
        self.left <= 0.0
    }

    /// Plans how long the next lists shall hold by what these have seen, of which `n_pairs` are listed.
    pub fn plan<P: Precision<Coordinate = C>>(
        &mut self,
        spheres: &[Sphere<P>],
        period: &Period<C>,
        n_pairs: usize,
    ) {
        if self.steps == 0 || self.reference.is_empty() {
            return;
        }
        let (n, steps, diameter) = (self.foreseen.len() as f64, f64::from(self.steps), self.mean_diameter);
        let (mut beyond, mut mean_speed) = (0.0_f64, 0.0);
        for ((sphere, &old), foreseen) in spheres.iter().zip(&self.reference).zip(&self.foreseen) {
            let moved = period.nearest(sphere.position - old).0 - drifted(foreseen, steps);
            beyond = beyond.max(moved.norm().to_f64() / steps - f64::from(foreseen.beside));
            let beside = sphere.velocity.cast::<f64>() * self.time_step - drifted(foreseen, 1.0);
            mean_speed += beside.norm() / n;
        }
        let spread = beyond + mean_speed;
        let cubed = |x: f64| x * x * x;
        let pairs_without_skin = n_pairs as f64 / n / cubed(1.0 + self.skin() / diameter);
        let mut skin = self.skin();
        for _ in 0..8 {
            let widened = 1.0 + skin / diameter;
            let growth = 3.0 * pairs_without_skin.max(0.5) / diameter * widened * widened;
            skin = (2.0 * spread * REBUILD_COST / growth).sqrt();
        }
        let gently = skin.clamp(0.5 * self.skin(), 2.0 * self.skin());
        let leeway = (0.5 * gently).clamp(SMALLEST * diameter, LARGEST * diameter);
        self.horizon = leeway / spread.max(f64::MIN_POSITIVE);
        self.margin = (beyond * self.horizon).max(SMALLEST * diameter);
    }

    /// Foresees where grains go that are about to be listed; `widest` [m] is the diameter of the largest one. Where grains sleep,
    /// balls do not drift.
    pub fn foresee<P: Precision<Coordinate = C>>(
        &mut self,
        spheres: &[Sphere<P>],
        domain: &Domain,
        widest: f64,
        may_drift: bool,
    ) {
        let (time_step, diameter) = (self.time_step, self.mean_diameter);
        let drifts =
            if may_drift { Drifts::of(spheres, domain, NEIGHBOURHOOD * widest) } else { Drifts::none() };
        self.foreseen.clear();
        let mut fastest = 0.0_f64;
        self.foreseen.extend(spheres.iter().enumerate().map(|(grain, sphere)| {
            let drift = drifts.of_grain(grain);
            let beside = (sphere.velocity.cast::<f64>() - drift).norm() * time_step;
            fastest = fastest.max(beside);
            Foreseen { drift: drift.to_array().map(|c| (c * time_step) as f32), beside: beside as f32 }
        }));
        self.fastest_drift = ROUNDED_UP * drifts.fastest * time_step;
        let parting = ROUNDED_UP * drifts.parting * time_step;
        for (rate, farthest) in
            [(self.fastest_drift, FARTHEST_DRIFT), (parting, FARTHEST_PARTING), (fastest, LARGEST)]
        {
            let most = farthest * diameter / rate.max(f64::MIN_POSITIVE);
            if self.horizon > most {
                self.margin = (self.margin * most / self.horizon).max(SMALLEST * diameter);
                self.horizon = most;
            }
        }
        self.margin = self.margin.max(STEPS_BETWEEN_LOOKS * (self.travel + self.fastest_drift));
        let (mut sum, mut least, mut largest) = (0.0, f64::INFINITY, 0.0_f64);
        for foreseen in &self.foreseen {
            let leeway = self.leeway(foreseen).to_f64();
            (sum, least, largest) = (sum + leeway, least.min(leeway), largest.max(leeway));
        }
        self.mean = sum / self.foreseen.len().max(1) as f64;
        self.widest_gap = 2.0 * largest + parting * self.horizon;
        (self.left, self.steps) = (least, 0);
    }

    /// Listed grains lie in another order now: grain `order[place]` has come to `place`.
    pub fn reorder<P: Precision<Coordinate = C>>(&mut self, spheres: &[Sphere<P>], order: &[u32]) {
        self.foreseen = order.iter().map(|&grain| self.foreseen[grain as usize]).collect();
        self.reference.clear();
        self.reference.extend(spheres.iter().map(|sphere| sphere.position));
    }

    /// Memory held [bytes].
    pub fn bytes(&self) -> usize {
        size_of::<Vector<C>>() * self.reference.capacity() + size_of::<Foreseen>() * self.foreseen.capacity()
    }
}

/// Drift of a ball in so many steps [m].
#[inline(always)]
fn drifted<C: Real>(foreseen: &Foreseen, steps: f64) -> Vector<C> {
    Vector::from(foreseen.drift.map(|c| C::from_f64(f64::from(c) * steps)))
}

/// Lower bound of the squared distance [m²] from the origin of a point on its straight way from `from` by `by`. The foot of the
/// perpendicular is nearer than both ends by (|by|/2)² at most, in squares.
#[inline(always)]
pub(crate) fn nearest_on_the_way<C: Real>(from: Vector<C>, by: Vector<C>) -> C {
    let ends = from.norm_squared().min((from + by).norm_squared());
    ends - by.norm_squared() * C::from_f64(0.25)
}
