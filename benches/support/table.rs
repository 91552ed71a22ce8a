//! The times of scenes as ratios.

use super::Row;

/// The head of the lines.
pub fn header() -> String {
    format!(
        "{:>8} {:>5} {:>9} | {:>10} {:>10} {:>10} {:>9} {:>9} | {:>9} {:>9} {:>9} {:>9} | bytes a cell",
        "scene",
        "size",
        "frontiers",
        "byte sum",
        "textbook",
        "bitplane",
        "patch",
        "resent",
        "bitplane/",
        "textbook/",
        "bitplane/",
        "(resent -",
    ) + &format!(
        "\n{:>24} | {:>10} {:>10} {:>10} {:>9} {:>9} | {:>9} {:>9} {:>9} {:>9} | scratch kept",
        "", "ms", "ms", "ms", "ms", "ms", "byte sum", "bitplane", "patch", "patch)/sum",
    )
}

/// The four ratios of a scene.
fn ratios(row: &Row) -> [f64; 4] {
    [
        row.bitplane_ms / row.byte_sum_ms,
        row.textbook_ms / row.bitplane_ms,
        row.bitplane_ms / row.patch_ms,
        (row.resent_ms - row.patch_ms) / row.byte_sum_ms,
    ]
}

/// One scene.
pub fn line(row: &Row) -> String {
    let [sums, textbook, patch, resent] = ratios(row);
    format!(
        "{:>8} {:>5} {:>9} | {:>10.3} {:>10.3} {:>10.3} {:>9.3} {:>9.3} | {sums:>9.2} {textbook:>9.1} {patch:>9.1} \
         {resent:>9.2} | {:>7.2} {:>4.2}",
        row.scene,
        row.size,
        row.frontiers,
        row.byte_sum_ms,
        row.textbook_ms,
        row.bitplane_ms,
        row.patch_ms,
        row.resent_ms,
        row.memory[0],
        row.memory[1],
    )
}

/// All scenes, for a document.
pub fn markdown(rows: &[Row]) -> String {
    let head = "| scene | edge, cells | frontiers | byte sum, ms | textbook, ms | bitplane, ms | patch, ms | resent, ms \
                | bitplane / byte sum | textbook / bitplane | bitplane / patch |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    let line = |row: &Row| {
        let [sums, textbook, patch, _] = ratios(row);
        format!(
            "| {} | {} | {} | {:.3} | {:.3} | {:.3} | {:.3} | {:.3} | {sums:.1} | {textbook:.0} | {patch:.0} |\n",
            row.scene,
            row.size,
            row.frontiers,
            row.byte_sum_ms,
            row.textbook_ms,
            row.bitplane_ms,
            row.patch_ms,
            row.resent_ms,
        )
    };
    rows.iter().map(line).fold(head.to_owned(), |all, line| all + &line)
}
