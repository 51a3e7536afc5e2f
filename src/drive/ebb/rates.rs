//! A piece of motion as the board's `LM` command: for each motor a first rate, a number of steps and an acceleration per tick.
//!
//! Every 40 microseconds the acceleration is added to the rate, the rate to an accumulator, and where that reaches 2^31 the motor makes a
//! step. Both motors must be done at the same tick, or the line bends (command reference of the board, `LM`).

/// Ticks per second.
pub(super) const TICKS: f64 = 25_000.0;
/// An accumulator that reaches this makes a step.
const FULL: i128 = 1 << 31;
/// The greatest rate: less than a step per tick.
const MOST: i128 = FULL - 1;

/// The ticks that a time lasts, but at least so many that no motor makes more than a step in two.
pub(super) fn ticks_of(steps: [i64; 2], seconds: f64) -> u64 {
    let ticks = (seconds * TICKS).round().max(1.0) as u64;
    ticks.max(2 * steps[0].unsigned_abs().max(steps[1].unsigned_abs()))
}

/// The command for a number of steps of both motors within a number of ticks, whose speed changes in the ratio of two speeds; `None` for
/// no step.
pub(super) fn move_command(steps: [i64; 2], ticks: u64, speeds: [f64; 2]) -> Option<String> {
    if steps == [0, 0] {
        return None;
    }
    let [first, second] = steps.map(|steps| rates(i128::from(steps.unsigned_abs()), i128::from(ticks.max(1)), speeds));
    Some(format!("LM,{},{},{},{},{},{},3", first.0, steps[0], first.1, second.0, steps[1], second.1))
}

/// First rate and acceleration by which the steps are made within the ticks, and the last of them not long before.
fn rates(steps: i128, ticks: i128, [from, to]: [f64; 2]) -> (i128, i128) {
    if steps == 0 {
        return (0, 0);
    }
    let mean = (steps * FULL) as f64 / ticks as f64;
    let change = 2.0 * mean * (to - from) / (from + to).max(1e-9);
    // Even, so that half of it is exact; towards zero, so that the rate never falls below.
    let mut acceleration = ((change / ticks as f64) as i128 / 2) * 2;
    let first = |acceleration: i128| {
        // ticks * rate + acceleration * ticks^2 / 2 must reach the steps.
        let needed = steps * FULL - acceleration * ticks * ticks / 2;
        (needed + ticks - 1) / ticks
    };
    while acceleration < 0 && first(acceleration) + acceleration * ticks < 0 {
        acceleration = (acceleration / 4) * 2;
    }
    let mut rate = first(acceleration);
    if !(0..=MOST).contains(&rate) || rate + acceleration * ticks > MOST {
        (acceleration, rate) = (0, first(0).clamp(1, MOST));
    }
    (rate, acceleration)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ticks until a motor has made its steps, as the board counts.
    fn ticks_until(rate: i128, steps: i128, acceleration: i128) -> i128 {
        let (mut rate, mut sum, mut made, mut ticks) = (rate - acceleration / 2, 0, 0, 0);
        while made < steps {
            rate += acceleration;
            assert!(rate >= 0, "a rate below zero rolls over");
            sum += rate;
            ticks += 1;
            if sum >= FULL {
                (sum, made) = (sum - FULL, made + 1);
            }
        }
        ticks
    }

    #[test]
    fn both_motors_end_at_the_same_tick() {
        for (steps, ticks, speeds) in [
            ([400, 137], 2000, [0.0, 50.0]),
            ([400, -137], 2000, [50.0, 0.0]),
            ([1, 80], 900, [20.0, 20.0]),
            ([1, 1], 30, [1.0, 0.5]),
            ([2500, 2499], 2600, [100.0, 120.0]),
            ([0, 7], 500, [0.5, 30.0]),
        ] {
            let command = move_command(steps, ticks, speeds).unwrap();
            let numbers: Vec<i128> = command.split(',').skip(1).map(|number| number.parse().unwrap()).collect();
            for axis in 0..2 {
                let [rate, count, acceleration] = [numbers[3 * axis], numbers[3 * axis + 1].abs(), numbers[3 * axis + 2]];
                if count > 0 {
                    let taken = ticks_until(rate, count, acceleration);
                    assert!(taken <= i128::from(ticks) && i128::from(ticks) - taken <= 2, "{command}: {taken} of {ticks}");
                }
            }
        }
        assert_eq!(move_command([0, 0], 100, [1.0, 1.0]), None);
    }
}
