//! Sinkage at which the ground carries the load, and slip at which the wheel pulls.

use super::{OperatingPoint, WheelError};

/// Root of a rising function between `low`, where it is not above zero, and `high`, where it is (Illinois).
pub(super) fn rising_root(
    mut f: impl FnMut(f64) -> f64,
    [mut low, mut high]: [f64; 2],
    [mut f_low, mut f_high]: [f64; 2],
    tolerance: f64,
) -> f64 {
    let (mut x, mut before, mut side) = (high, f64::INFINITY, 0);
    for _ in 0..200 {
        if high - low <= tolerance || (x - before).abs() <= tolerance {
            break;
        }
        before = x;
        let t = (low * f_high - high * f_low) / (f_high - f_low);
        x = if t > low && t < high { t } else { 0.5 * (low + high) };
        let value = f(x);
        if value > 0.0 {
            (high, f_high) = (x, value);
            f_low *= if side > 0 { 0.5 } else { 1.0 };
            side = 1;
        } else {
            (low, f_low) = (x, value);
            f_high *= if side < 0 { 0.5 } else { 1.0 };
            side = -1;
        }
    }
    x
}

/// The sinkage \[m\] at which `force` \[N\] equals the load, searched from `guess` between almost nothing and `deepest` \[m\].
///
/// Force over sinkage is close to a power: the logarithms of both are searched, relative `tolerance`.
pub(super) fn sinkage_in_balance(
    mut force: impl FnMut(f64) -> f64,
    load: f64,
    guess: f64,
    deepest: f64,
    tolerance: f64,
) -> Result<f64, WheelError> {
    let mut surplus = |x: f64| {
        let carried = force(x.exp());
        if carried > 0.0 { (carried / load).ln().clamp(-40.0, 40.0) } else { -40.0 }
    };
    let (least, most) = ((1e-12 * deepest).ln(), deepest.ln());
    let mut at = guess.ln().clamp(least, most);
    let mut value = surplus(at);
    loop {
        if value == 0.0 {
            return Ok(at.exp());
        }
        // The force rises at least with the sinkage: a step by the whole surplus passes the root.
        let next = (at - value - 0.02 * value.signum() * value.abs().min(1.0)).clamp(least, most);
        if next == at || value.is_nan() {
            let sinkage = at.exp();
            return Err(WheelError::NotCarried { carried: force(sinkage), sinkage, load });
        }
        let there = surplus(next);
        if (there > 0.0) != (value > 0.0) {
            let (low, high) =
                if value > 0.0 { ([next, there], [at, value]) } else { ([at, value], [next, there]) };
            let root = rising_root(surplus, [low[0], high[0]], [low[1], high[1]], tolerance);
            return Ok(root.exp());
        }
        (at, value) = (next, there);
    }
}

/// The least slip at which a wheel pulls `drawbar_pull` \[N\]; `at_slip` is either fidelity.
///
/// Slips from −0.99 to 0.99 are searched upwards in steps of 0.02, then the first crossing is closed in on to 1e-10.
pub fn slip_for_drawbar_pull(
    mut at_slip: impl FnMut(f64) -> Result<OperatingPoint, WheelError>,
    drawbar_pull: f64,
) -> Result<OperatingPoint, WheelError> {
    let (least_slip, most_slip, step) = (-0.99, 0.99, 0.02);
    let least = at_slip(least_slip)?.drawbar_pull;
    let (mut low, mut f_low, mut most) = (least_slip, least - drawbar_pull, least);
    if f_low > 0.0 {
        return Err(WheelError::NoSlip { pull: drawbar_pull, least_slip, most_slip, least, most });
    }
    for k in 1..=99 {
        let high = least_slip + step * f64::from(k);
        let pull = at_slip(high)?.drawbar_pull;
        most = most.max(pull);
        if pull > drawbar_pull {
            let mut failure = None;
            let surplus = |slip| match at_slip(slip) {
                Ok(point) => point.drawbar_pull - drawbar_pull,
                Err(error) => {
                    failure = Some(error);
                    0.0
                }
            };
            let slip = rising_root(surplus, [low, high], [f_low, pull - drawbar_pull], 1e-10);
            return match failure {
                Some(error) => Err(error),
                None => at_slip(slip),
            };
        }
        (low, f_low) = (high, pull - drawbar_pull);
    }
    Err(WheelError::NoSlip { pull: drawbar_pull, least_slip, most_slip, least, most })
}
