//! All runs as comma-separated values (RFC 4180), one line each.

use super::Comparison;
use crate::report::series::COVERAGE_SHARES;

impl Comparison {
    /// The table. What the computer took stands in the last three columns; what was not
    /// reached is empty.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let percents = || COVERAGE_SHARES.into_iter().map(|(_, share)| (share * 100.0).round());
        let mut head: Vec<String> = [
            "run",
            "preset",
            "world",
            "start",
            "start_x_m",
            "start_y_m",
            "seed",
            "end_reason",
            "succeeded",
            "coverage",
            "sim_time_s",
            "distance_m",
            "goals_sent",
            "goals_failed",
            "collisions",
        ]
        .map(str::to_owned)
        .to_vec();
        head.extend(percents().map(|percent| format!("t{percent}_s")));
        head.extend(percents().map(|percent| format!("d{percent}_m")));
        head.extend(["decision_median_ms", "decision_max_ms", "wall_s"].map(str::to_owned));
        let mut csv = line(&head);
        for run in &self.runs {
            let mut fields = vec![
                run.index.to_string(),
                run.preset.clone(),
                run.world.clone(),
                run.start_number.to_string(),
                run.start.x.to_string(),
                run.start.y.to_string(),
                run.seed.to_string(),
                run.end_name(),
                run.succeeded().to_string(),
                run.coverage.to_string(),
                run.sim_time_s.to_string(),
                run.distance_m.to_string(),
                run.goals_sent.to_string(),
                run.goals_failed.to_string(),
                run.collisions.to_string(),
            ];
            for by_share in [&run.time_to_coverage_s, &run.distance_to_coverage_m] {
                let value = |name: &str| by_share.get(name).copied().flatten().map(|v| v.to_string());
                fields.extend(COVERAGE_SHARES.iter().map(|(name, _)| value(name).unwrap_or_default()));
            }
            let wall = [run.wall.decision_ms.median, run.wall.decision_ms.max, run.wall.total_s];
            fields.extend(wall.map(|value| format!("{value:.3}")));
            csv.push_str(&line(&fields));
        }
        csv
    }
}

/// One line; fields are quoted where they must be.
fn line(fields: &[String]) -> String {
    let quoted = |field: &String| {
        if field.contains([',', '"', '\n', '\r']) {
            format!("\"{}\"", field.replace('"', "\"\""))
        } else {
            field.clone()
        }
    };
    let fields: Vec<String> = fields.iter().map(quoted).collect();
    fields.join(",") + "\n"
}

#[cfg(test)]
mod tests {
    use super::super::sample;

    #[test]
    fn a_line_for_each_run() {
        let mut comparison = sample::comparison(sample::plan(&["a, \"b\""], &["w"], &[1, 2]), |_| 100.0);
        comparison.runs[1].time_to_coverage_s.insert("0.99".to_owned(), None);
        let csv = comparison.to_csv();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(lines.len(), 3);
        assert!(lines[0].ends_with(
            "t50_s,t80_s,t90_s,t95_s,t99_s,d50_m,d80_m,d90_m,d95_m,d99_m,decision_median_ms,decision_max_ms,wall_s"
        ));
        assert_eq!(
            lines[1],
            "0,\"a, \"\"b\"\"\",w,1,1,1,1,complete,true,1,100,50,5,1,0,50,80,90,95,99,25,40,45,47.5,49.5,1.000,2.000,0.500"
        );
        assert!(lines[2].contains(",50,80,90,95,,25,"));
    }
}
