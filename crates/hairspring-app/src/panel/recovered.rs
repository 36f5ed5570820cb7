//! Offers the scenes that crashed windows left.

use crate::{recovery::FoundScene, session::Action};
use eframe::egui;
use std::time::Duration;

/// Shows the offer; scenes that are decided on leave the list.
pub fn show(ctx: &egui::Context, found: &mut Vec<FoundScene>, actions: &mut Vec<Action>) {
    if found.is_empty() {
        return;
    }
    let mut later = false;
    let window = egui::Window::new("Unsaved changes of an earlier run").collapsible(false).resizable(false);
    window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO).show(ctx, |ui| {
        ui.label("The window ended before these scenes were saved.");
        ui.add_space(4.0);
        found.retain(|scene| {
            let mut stays = true;
            ui.horizontal(|ui| {
                if ui.button("Recover").clicked() {
                    actions.push(Action::Recover(scene.clone()));
                    stays = false;
                }
                if ui.button("Discard").clicked() {
                    scene.discard();
                    stays = false;
                }
                let name = scene.scene.path.file_name().unwrap_or_default().to_string_lossy();
                let name = if scene.scene.stored.is_some() { name } else { "a scene without a file".into() };
                ui.label(format!("{name}, {} ago", age(scene.age)))
                    .on_hover_text(scene.scene.path.display().to_string());
            });
            stays
        });
        ui.add_space(4.0);
        later = ui.button("Later").on_hover_text("They are offered again at the next start.").clicked();
    });
    if later {
        found.clear();
    }
}

/// The age of a scene in words, such as `2 minutes`.
fn age(age: Duration) -> String {
    let seconds = age.as_secs();
    let (number, unit) = match seconds {
        0..120 => (seconds, "second"),
        120..7_200 => (seconds / 60, "minute"),
        7_200..172_800 => (seconds / 3_600, "hour"),
        _ => (seconds / 86_400, "day"),
    };
    format!("{number} {unit}{}", if number == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_age_is_readable() {
        let ages = [1, 45, 150, 7_300, 400_000].map(|s| age(Duration::from_secs(s)));
        assert_eq!(ages, ["1 second", "45 seconds", "2 minutes", "2 hours", "4 days"]);
    }
}
