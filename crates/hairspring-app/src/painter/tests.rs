//! Tests of the painter of the CPU, without a window.

use super::{Painter, cpu::CpuPainter, receive};
use crate::{
    document::Document,
    session::{Action, Session},
    snapshot::{Snapshot, ViewParameters},
    view::View,
};
use eframe::egui;
use std::{
    sync::{Arc, mpsc::channel},
    time::Duration,
};

/// Waits until `done`.
fn wait(mut done: impl FnMut() -> bool) {
    let tries = (0..12_000).find(|_| {
        std::thread::sleep(Duration::from_millis(5));
        done()
    });
    assert!(tries.is_some(), "it did not happen within a minute");
}

/// A paused scene, and how it is seen.
fn paused() -> (Arc<Snapshot>, ViewParameters) {
    let text = "[builtin]\nstrands = 10\nguides = 5\n";
    let document = Document::new("scene.toml".as_ref(), text.into()).unwrap();
    let mut session = Session::new(document, 1, None, || ()).unwrap();
    session.act(Action::Play(false)).unwrap();
    wait(|| session.latest().is_some());
    let (snapshot, mut view) = (session.latest().unwrap(), View::default());
    view.frame(&session, &snapshot, 1.0);
    let parameters = view.view_parameters(&snapshot.stages[0], 1.0).unwrap();
    (snapshot, parameters)
}

#[test]
fn a_picture_of_another_size_is_not_whole() {
    let (snapshot, view) = paused();
    let ctx = egui::Context::default();
    let mut painter = CpuPainter::new(&ctx, None, 1);
    for size in [[64, 48], [96, 48]] {
        painter.request(&ctx, &snapshot, 0, &view, size);
        assert!(!painter.is_whole(&snapshot), "{size:?}: before it is drawn");
        wait(|| {
            painter.receive(&ctx);
            painter.request(&ctx, &snapshot, 0, &view, size);
            painter.is_whole(&snapshot)
        });
    }
}

#[test]
fn a_snapshot_that_arrives_with_a_finished_picture_wakes_the_window() {
    let (snapshot, view) = paused();
    let ctx = egui::Context::default();
    let (ask, asked) = channel();
    let ask = std::sync::Mutex::new(ask);
    ctx.set_request_repaint_callback(move |_| _ = ask.lock().unwrap().send(()));
    // egui requests a repaint after each of its first frames. These requests are not what is tested.
    let settle = || {
        (0..3).for_each(|_| _ = ctx.run_ui(egui::RawInput::default(), |_| ()));
        while asked.try_recv().is_ok() {}
    };
    settle();
    let mut painter = CpuPainter::new(&ctx, None, 1);
    painter.request(&ctx, &snapshot, 0, &view, [64, 48]);
    let mut painters = [Painter::Cpu(Box::new(painter))];
    let wake = painters[0].wake(&ctx);
    asked.recv_timeout(Duration::from_secs(60)).expect("a finished picture wakes the window");
    settle();
    wake();
    assert!(asked.try_recv().is_err(), "the window has a picture to receive");
    // The simulation publishes a snapshot while the window reads the one before it.
    receive(&mut painters, &ctx, &wake);
    assert!(asked.try_recv().is_ok(), "the snapshot is never shown");
}
