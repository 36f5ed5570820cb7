//! Promise: every example of the library runs.

#[path = "../../examples/custom_collider.rs"]
mod custom_collider;
#[path = "../../examples/custom_force.rs"]
mod custom_force;
#[path = "../../examples/debug_lines.rs"]
mod debug_lines;
#[path = "../../examples/engine_loop.rs"]
mod engine_loop;
#[path = "../../examples/follow_hairs.rs"]
mod follow_hairs;
#[path = "../../examples/many_characters.rs"]
mod many_characters;
#[path = "../../examples/sdf_from_array.rs"]
mod sdf_from_array;
#[path = "../../examples/snapshot_and_rollback.rs"]
mod snapshot_and_rollback;

#[test]
fn examples_run() {
    let examples: [(&str, fn()); 8] = [
        ("custom_collider", custom_collider::main),
        ("custom_force", custom_force::main),
        ("debug_lines", debug_lines::main),
        ("engine_loop", engine_loop::main),
        ("follow_hairs", follow_hairs::main),
        ("many_characters", many_characters::main),
        ("sdf_from_array", sdf_from_array::main),
        ("snapshot_and_rollback", snapshot_and_rollback::main),
    ];
    let listed = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/examples")).unwrap().count();
    assert_eq!(listed, examples.len(), "an example is missing in this list");
    for (name, run) in examples {
        println!("{name}:");
        run();
    }
}
