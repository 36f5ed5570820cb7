//! Promise: the tooltip of a parameter covers no row of the panel.

mod support;

use egui_kittest::kittest::Queryable;
use support::{SMALL, until, window};

#[test]
fn a_tooltip_is_outside_the_panel() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = window(folder.path(), SMALL, "pause\nwait 1");
    assert!(until(&mut window, |app| app.is_idle()));
    (0..3).for_each(|_| window.step());
    let rows = window.get_all_by_label("Hair count").map(|node| node.rect());
    let row = rows.min_by(|a, b| a.min.x.total_cmp(&b.min.x)).expect("there is no row");
    window.hover_at(row.center());
    let mut tip = None;
    for _ in 0..40 {
        window.step();
        std::thread::sleep(std::time::Duration::from_millis(50));
        tip = window.query_by_label_contains("A human head has about").map(|node| node.rect());
        if tip.is_some() {
            break;
        }
    }
    let tip = tip.expect("there is no tooltip");
    assert!(tip.max.x <= row.min.x, "the tooltip {tip} covers the rows at {row}");
}
