//! What happens when, in simulated time.
//!
//! Time is counted in whole microseconds: a sum of periods in floating point would
//! drift, and with it the order of things that fall together.

/// Microseconds of simulated time.
pub(crate) type Micros = u64;

/// Microseconds in seconds.
pub(crate) fn seconds(micros: Micros) -> f64 {
    micros as f64 * 1e-6
}

/// Seconds in microseconds, at least one.
pub(crate) fn micros(seconds: f64) -> Micros {
    ((seconds * 1e6).round() as Micros).max(1)
}

/// Something that happens again and again, first at time 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Periodic {
    period: Micros,
    next: Micros,
}

impl Periodic {
    /// Every so many seconds.
    pub(crate) fn every_s(period_s: f64) -> Self {
        Self { period: micros(period_s), next: 0 }
    }

    /// When it happens next.
    pub(crate) const fn next(&self) -> Micros {
        self.next
    }

    /// Whether it happens now; if so, the time after is set.
    pub(crate) const fn is_due(&mut self, now: Micros) -> bool {
        let due = now >= self.next;
        if due {
            self.next += self.period;
        }
        due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_period_does_not_drift() {
        let mut tick = Periodic::every_s(0.1);
        let times: Vec<f64> = (0..100_000)
            .map(|_| {
                let now = tick.next();
                assert!(tick.is_due(now) && !tick.is_due(now));
                seconds(now)
            })
            .collect();
        assert_eq!((times[0], times[3], times[99_999]), (0.0, 3e5 * 1e-6, 9_999.9));
    }
}
