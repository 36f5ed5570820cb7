//! Promise: at every size of the window, the figures on the picture cover neither the panel nor the playback controls.

mod support;

use egui_kittest::kittest::Queryable;
use support::{SMALL, until, window};

#[test]
fn figures_stay_on_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = window(folder.path(), SMALL, "pause\nwait 1\ncompare on\nwait 1");
    assert!(until(&mut window, |app| app.is_idle()));
    for size in [[1600.0, 1000.0], [800.0, 600.0], [640.0, 480.0]] {
        window.set_size(size.into());
        (0..4).for_each(|_| window.step());
        let panel = window.get_by_label("Style").rect();
        let controls = window.get_by_label("Play").rect();
        for text in ["simulated with", "right: stretch", "CPU: "] {
            let figures = window.get_by_label_contains(text).rect();
            assert!(figures.max.x <= panel.min.x, "{size:?}: {figures} covers the panel at {panel}");
            assert!(figures.max.y <= controls.min.y, "{size:?}: {figures} covers the controls at {controls}");
        }
    }
}
