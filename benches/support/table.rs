//! The times of scenes as ratios.

use super::Row;

/// The head of the lines.
pub fn header() -> String {
    format!(
        "{:>8} {:>5} {:>9} | {:>8} {:>9} {:>8} {:>7} {:>7} {:>7} {:>7} {:>7} | {:>8} {:>9} {:>9} {:>6} {:>9} | bytes a cell",
        "scene",
        "size",
        "frontiers",
        "byte sum",
        "textbook",
        "bitplane",
        "patch",
        "again",
        "resent",
        "grown",
        "on",
        "bitplane/",
        "textbook/",
        "bitplane/",
        "again",
        "(resent -",
    ) + &format!(
        "\n{:>24} | {:>8} {:>9} {:>8} {:>7} {:>7} {:>7} {:>7} {:>7} | {:>9} {:>9} {:>9} {:>6} {:>9} | scratch kept",
        "", "ms", "ms", "ms", "ms", "ms", "ms", "ms", "ms", "byte sum", "bitplane", "patch", "", "patch)/sum",
    )
}

/// The ratios of a scene.
fn ratios(row: &Row) -> [f64; 5] {
    [
        row.bitplane_ms / row.byte_sum_ms,
        row.textbook_ms / row.bitplane_ms,
        row.bitplane_ms / row.patch_ms,
        row.bitplane_ms / row.patch_again_ms,
        (row.resent_ms - row.patch_ms) / row.byte_sum_ms,
    ]
}

/// One scene.
pub fn line(row: &Row) -> String {
    let [sums, textbook, patch, again, resent] = ratios(row);
    format!(
        "{:>8} {:>5} {:>9} | {:>8.3} {:>9.3} {:>8.3} {:>7.3} {:>7.3} {:>7.3} {:>7.3} {:>7.3} | {sums:>9.2} {textbook:>9.1} \
         {patch:>9.1} {again:>6.1} {resent:>9.2} | {:>7.2} {:>4.2}",
        row.scene,
        row.size,
        row.frontiers,
        row.byte_sum_ms,
        row.textbook_ms,
        row.bitplane_ms,
        row.patch_ms,
        row.patch_again_ms,
        row.resent_ms,
        row.grown_ms[0],
        row.grown_ms[1],
        row.memory[0],
        row.memory[1],
    )
}

/// A number with the digits that mean something.
fn short(value: f64) -> String {
    let digits = (1 - value.abs().max(1e-3).log10().floor() as i32).clamp(0, 3) as usize;
    format!("{value:.digits$}")
}

/// All scenes, for a document.
pub fn markdown(rows: &[Row]) -> String {
    let head = "| scene | edge, cells | byte sum | textbook | bitplane | patch | again | resent | grown | on | state |\n\
                |---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    let line = |row: &Row| {
        let [patch, patch_again, grown, grown_again] =
            [row.patch_ms, row.patch_again_ms, row.grown_ms[0], row.grown_ms[1]];
        let times =
            [row.byte_sum_ms, row.textbook_ms, row.bitplane_ms, patch, patch_again, row.resent_ms, grown, grown_again];
        let times = times.map(short).join(" | ");
        format!("| {} | {} | {times} | {:.2}, {:.2} |\n", row.scene, row.size, row.memory[0], row.memory[1])
    };
    rows.iter().map(line).fold(head.to_owned(), |all, line| all + &line)
}
