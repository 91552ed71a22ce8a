//! ROS time: `/use_sim_time` against `/clock`.

use super::super::facts::{ClockFacts, STANDS_FROM_S};
use super::super::finding::Finding;
use crate::ros::directory::list;

const CHECK: &str = "clock";
const START: &str = "start the simulator or `rosbag play --clock`; on a real robot `rosparam set /use_sim_time \
                     false`, and start all nodes again";

/// What is to be said of ROS time.
pub fn judge(clock: &ClockFacts) -> Finding {
    let ClockFacts { publishers, now_s, stands_s, pace, .. } = clock;
    let publish = if publishers.len() == 1 { "publishes" } else { "publish" };
    if !clock.is_simulated {
        if publishers.is_empty() {
            return Finding::ok(CHECK, "time is this computer's own");
        }
        let what =
            format!("{} {publish} /clock and /use_sim_time is not set: nodes go by different times", list(publishers));
        let remedy =
            "`rosparam set /use_sim_time true` and start all nodes again; on a real robot stop what publishes /clock";
        return Finding::error(CHECK, what, remedy);
    }
    if *now_s <= 0.0 {
        let who = if publishers.is_empty() {
            "nobody publishes it".to_owned()
        } else {
            format!("though {} {publish} it", list(publishers))
        };
        return Finding::error(CHECK, format!("use_sim_time is set and no /clock has come: {who}"), START);
    }
    if *stands_s >= STANDS_FROM_S {
        let what = format!("/clock of {} stands at {now_s:.1} s", list(publishers));
        return Finding::error(CHECK, what, format!("let the simulator or the bag go on; else {START}"));
    }
    if publishers.len() > 1 {
        let what = format!("{} publish /clock: time jumps between them", list(publishers));
        return Finding::warning(CHECK, what, "stop all but one of them");
    }
    Finding::ok(CHECK, format!("/clock of {} runs at {pace:.1} times real time", list(publishers)))
}

#[cfg(test)]
mod tests {
    use super::super::super::finding::FindingLevel::{Error, Ok, Warning};
    use super::*;

    fn check(is_simulated: bool, publishers: &[&str], now_s: f64, stands_s: f64) -> Finding {
        let publishers = publishers.iter().map(|name| (*name).to_owned()).collect();
        judge(&ClockFacts { is_simulated, publishers, now_s, stands_s, pace: 2.0 })
    }

    #[test]
    fn a_clock_that_goes_and_none_where_none_is_wanted_are_well() {
        assert_eq!(check(false, &[], 1.7e9, 0.0).level, Ok);
        let runs = check(true, &["/sim"], 12.0, 0.0);
        assert_eq!((runs.level, runs.what.as_str()), (Ok, "/clock of /sim runs at 2.0 times real time"));
    }

    #[test]
    fn a_clock_that_is_missing_stands_or_is_not_wanted_is_named() {
        let missing = check(true, &[], 0.0, 9.0);
        assert_eq!(missing.level, Error);
        assert_eq!(missing.what, "use_sim_time is set and no /clock has come: nobody publishes it");
        assert!(missing.remedy.unwrap().contains("rosparam set /use_sim_time false"));
        assert!(check(true, &["/bag"], 0.0, 9.0).what.ends_with("though /bag publishes it"));
        let stands = check(true, &["/sim"], 12.0, 3.0);
        assert_eq!((stands.level, stands.what.as_str()), (Error, "/clock of /sim stands at 12.0 s"));
        let unset = check(false, &["/bag"], 1.7e9, 0.0);
        assert_eq!(unset.level, Error);
        assert!(unset.what.starts_with("/bag publishes /clock and /use_sim_time is not set"), "{unset:?}");
        assert_eq!(check(true, &["/bag", "/sim"], 12.0, 0.0).level, Warning);
    }
}
