//! The page of a comparison stands alone and shows what was reached.

use super::super::sample;
use super::*;

#[test]
fn the_page_stands_alone_and_holds_every_run() {
    let presets = ["liang", "liang_closest", "liang_max_gain", "<q>"];
    let plan = sample::plan(&presets, &["museum", "maze"], &[1, 2]);
    let mut comparison = sample::comparison(plan, |p| 100.0 + 50.0 * p as f64);
    let page = comparison.to_html().unwrap();
    assert_eq!(page, comparison.to_html().unwrap());
    for elsewhere in ["href=\"http", "src=\"http", "<script", "@import", "<q>"] {
        assert!(!page.contains(elsewhere), "{elsewhere}");
    }
    assert_eq!(page.matches("<polyline class=\"way\"").count(), 2 * 4);
    assert_eq!(page.matches("<tr class=\"run\">").count(), 2 * 4 * 2);
    assert!(page.contains("431") && page.contains("proposed"));
    assert!(!page.contains("not made"));
    comparison.runs.truncate(1);
    assert!(comparison.to_html().unwrap().contains("15 runs of the plan were not made"));
}

#[test]
fn multiples_of_the_oracles_time_have_a_column_where_it_takes_part() {
    let page = |presets: &[&str]| {
        let plan = sample::plan(presets, &["w"], &[1]);
        sample::comparison(plan, |p| [150.0, 100.0][p]).to_html().unwrap()
    };
    let with = page(&["a", "oracle"]);
    // One over all worlds and one in the only world.
    assert_eq!((with.matches("<b>1.50</b>").count(), with.matches("oracle's").count()), (2, 3));
    assert!(!page(&["a"]).contains("oracle"));
}

#[test]
fn what_is_not_reached_is_shown_as_such() {
    let cell = spread_cell(&Spread::of([Some(10.0), None, None]), 0);
    assert_eq!((cell.median.as_str(), cell.range.as_str(), cell.reached.as_str()), ("∞", "∞–∞", "1/3"));
    assert_eq!(spread_cell(&Spread::of([None]), 0).median, "–");
}
