//! Pointer input in the picture: rotates the view, drags handles, and moves the current tool.

use super::{FINGERS, Tool, View};
use crate::{
    drag_limiter::Push, handle::Handle, orbit::Lens, pointer_collider::Pushed, session::Action,
    snapshot::Snapshot,
};
use eframe::egui;
use glam::{Vec2, Vec3};

/// Distance within which the pointer picks a handle [points].
const TOUCH: f32 = 10.0;

/// A handle that is being dragged.
pub(super) struct Held {
    handle: usize,
    depth: f32,
    /// Offset from the pointer to the handle, which is not always picked at its center [m].
    off: Vec3,
}

/// An object that is dragged across the picture at its own depth [m].
pub(super) struct Drag {
    depth: f32,
    from: Vec3,
    at: Vec3,
}

impl View {
    /// Handles pointer input in the picture at `rect`, with these handles.
    pub fn touch(
        &mut self,
        ui: &egui::Ui,
        response: &egui::Response,
        snapshot: &Snapshot,
        handles: &[Handle],
        actions: &mut Vec<Action>,
    ) {
        if !handles.is_empty() && self.pull(ui, response, handles, actions) {
            return;
        }
        let rect = response.rect;
        let Some(orbit) = &mut self.orbit else { return };
        let part = |v: egui::Vec2| Vec2::new(v.x, v.y) / rect.height().max(1.0);
        let place =
            |p: egui::Pos2| Vec2::new((p.x - rect.left()) / rect.width(), (p.y - rect.top()) / rect.height());
        let (shift, scroll, zoom) =
            ui.input(|i| (i.modifiers.shift, i.smooth_scroll_delta().y, i.zoom_delta()));
        if response.hovered() {
            orbit.zoom((scroll * 0.003).exp() * zoom);
        }
        use egui::PointerButton::{Middle, Primary, Secondary};
        let aspect = rect.width() / rect.height().max(1.0);
        let moved = part(response.drag_delta());
        let look = self.tool == Tool::Look || self.tool == Tool::Pick;
        if response.dragged_by(Middle) || (look && shift && response.dragged_by(Primary)) {
            orbit.pan(moved, aspect);
        } else if response.dragged_by(Secondary) || (look && response.dragged_by(Primary)) {
            orbit.drag(moved);
        }
        let lens = Lens::new(&orbit.seen(aspect), aspect);
        let pointer = response.interact_pointer_pos().map(place);
        if self.tool == Tool::Pick
            && response.clicked()
            && let Some(at) = pointer
        {
            let (from, way) = lens.ray(at);
            actions.push(Action::Pick(from, way));
        }
        if look {
            return;
        }
        let Some(at) = pointer else { return };
        let (from, way) = lens.ray(at);
        if response.drag_started_by(Primary) {
            let depth = depth_of_hair(snapshot, &lens, at).unwrap_or(orbit.distance);
            let place = from + way * depth;
            self.drag = Some(Drag { depth, from: place, at: place });
            match self.tool {
                Tool::Grab => actions.push(Action::Grab(place, self.reach)),
                Tool::Ball | Tool::Palm => actions.push(Action::Push(Some(self.push(&lens, place)))),
                Tool::Comb => {
                    actions.push(Action::Comb(place, lens.right() * (FINGERS * self.reach), self.reach))
                }
                _ => {}
            }
        } else if let Some(drag) = &mut self.drag
            && response.dragged_by(Primary)
        {
            drag.at = from + way * drag.depth;
            match self.tool {
                Tool::Grab | Tool::Comb => actions.push(Action::Carry(drag.at)),
                Tool::Ball | Tool::Palm => {
                    let at = drag.at;
                    actions.push(Action::Push(Some(self.push(&lens, at))));
                }
                Tool::Head => {
                    // Farther than an arm's length, the head would leave the picture.
                    self.head = ((drag.at - drag.from).clamp_length_max(0.5), Vec3::ZERO);
                    actions.push(Action::Head(self.head.0));
                }
                Tool::Look | Tool::Pick => {}
            }
        }
        if response.drag_stopped() && self.drag.take().is_some() {
            match self.tool {
                Tool::Grab | Tool::Comb => actions.push(Action::LetGo),
                Tool::Ball | Tool::Palm => actions.push(Action::Push(None)),
                _ => {}
            }
        }
    }

    /// Picks, drags and releases a handle. Returns whether the pointer is on one.
    fn pull(
        &mut self,
        ui: &egui::Ui,
        response: &egui::Response,
        handles: &[Handle],
        actions: &mut Vec<Action>,
    ) -> bool {
        use egui::PointerButton::Primary;
        let rect = response.rect;
        let Some(lens) = self.lens(rect) else { return false };
        let place = |p: egui::Pos2| (p - rect.min) / rect.size();
        let ray = |p: egui::Pos2| lens.ray(Vec2::new(place(p).x, place(p).y));
        let near = |pointer: egui::Pos2| {
            let off = |handle: &Handle| {
                let (at, depth) = lens.project(handle.at)?;
                let at = rect.min + egui::vec2(at.x, at.y) * rect.size();
                Some((at.distance(pointer), depth)).filter(|(off, _)| *off < TOUCH)
            };
            let some = handles.iter().enumerate().filter_map(|(k, handle)| Some((k, off(handle)?)));
            some.min_by(|a, b| a.1.0.total_cmp(&b.1.0)).map(|(k, (_, depth))| (k, depth))
        };
        if response.drag_started_by(Primary)
            && let Some(pressed) = ui.input(|i| i.pointer.press_origin())
            && let Some((handle, depth)) = near(pressed)
        {
            let (from, way) = ray(pressed);
            self.held = Some(Held { handle, depth, off: handles[handle].at - (from + way * depth) });
        }
        if let Some(held) = &self.held {
            let (handle, pointer) = (handles.get(held.handle), response.interact_pointer_pos());
            if let (Some(handle), Some(pointer), true) = (handle, pointer, response.dragged_by(Primary)) {
                let (from, way) = ray(pointer);
                ui.set_cursor_icon(egui::CursorIcon::Grabbing);
                if response.drag_delta() != egui::Vec2::ZERO {
                    actions.push(handle.pulled(from + way * held.depth + held.off));
                }
                return true;
            }
            self.held = None;
        }
        self.over = response.hover_pos().and_then(near).map(|(k, _)| k);
        if self.over.is_some() {
            ui.set_cursor_icon(egui::CursorIcon::Grab);
        }
        // A press on a handle must not reach the tool before it becomes a drag.
        self.over.is_some() && response.is_pointer_button_down_on()
    }

    /// The handle that the pointer is on or drags.
    pub fn touched(&self) -> Option<usize> {
        self.held.as_ref().map(|held| held.handle).or(self.over)
    }

    /// Moves the head back to where it was dragged from, as on a critically damped spring. Called once per
    /// frame of `dt` [s].
    pub fn settle(&mut self, dt: f32, actions: &mut Vec<Action>) -> bool {
        let (place, speed) = self.head;
        if self.drag.is_some() || (place == Vec3::ZERO && speed == Vec3::ZERO) {
            return false;
        }
        // Critically damped, about 3 times per second; exact for any dt.
        let w = 18.0;
        let decay = (-w * dt).exp();
        let slope = speed + place * w;
        self.head = ((place + slope * dt) * decay, (speed - slope * w * dt) * decay);
        if self.head.0.length() < 1e-5 {
            self.head = (Vec3::ZERO, Vec3::ZERO);
        }
        actions.push(Action::Head(self.head.0));
        true
    }

    /// Center and radius of a dragged grab or comb [m].
    pub fn reached(&self) -> Option<(Vec3, f32)> {
        let drag = self.drag.as_ref()?;
        Some((drag.at, self.reach))
    }

    /// The pushed object with its target at the pointer position `at`.
    fn push(&self, lens: &Lens, at: Vec3) -> Push {
        let what = if self.tool == Tool::Palm { Pushed::Hand(self.length) } else { Pushed::Ball(self.reach) };
        Push { what, at, axes: [lens.right(), lens.up()] }
    }
}

/// Depth of the hair that is nearest to a point of the picture [m]; `None` if there is none nearby.
fn depth_of_hair(snapshot: &Snapshot, lens: &Lens, at: Vec2) -> Option<f32> {
    let stage = snapshot.stages.first()?;
    let mut best: Option<(f32, f32)> = None;
    for p in stage.points().flat_map(|p| p.iter().step_by(1 + p.len() / 200_000)) {
        let Some((place, depth)) = lens.project(*p) else { continue };
        let off = place.distance(at);
        // Of the hair within a hundredth of the picture, the frontmost one.
        if off < 0.01 && best.is_none_or(|(_, d)| depth < d) {
            best = Some((off, depth));
        }
    }
    best.map(|(_, depth)| depth)
}
