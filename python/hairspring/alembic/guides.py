"""The guides of strands in Alembic archives."""

from __future__ import annotations

import numpy as np

SAME = 1e-5
"""Distance within which two roots are the same [m]."""


def strands_of_ids(objects: list[dict]) -> dict[int, list[tuple[int, np.ndarray]]]:
    """The number and the root of the strands of each `groom_id`. In some files, ids begin again in each object."""
    known: dict[int, list[tuple[int, np.ndarray]]] = {}
    number = 0
    for r in objects:
        for s, points in enumerate(r["strands"]):
            if r["ids"] is not None:
                known.setdefault(int(r["ids"][s]), []).append((number, points[0]))
            number += 1
    return known


def repeats(guides: dict, known: dict[int, list[tuple[int, np.ndarray]]]) -> list[int] | None:
    """The numbers of the strands that an object of guides repeats: those with the same ids and roots. `None` if any of its
    guides is not such a strand."""
    if guides["ids"] is None:
        return None
    found: list[int] = []
    for i, points in zip(guides["ids"], guides["strands"]):
        same = [number for number, root in known.get(int(i), []) if np.abs(root - points[0]).max() < SAME]
        if not same:
            return None
        found += same
    return found


def guides_of(drawn: list[dict], notes: list[str]) -> tuple[np.ndarray | None, np.ndarray | None]:
    """The guides of each strand and their weights. `groom_closest_guides` names strands by `groom_id`: those of the objects of
    guides, or else those of its own object. A guide follows itself."""
    with_guides = [r["closest"] is not None and r["weights"] is not None for r in drawn]
    if not any(with_guides):
        return None, None
    first = np.cumsum([0] + [len(r["strands"]) for r in drawn])
    are_guides = [r["guide"] is not None and bool(r["guide"].all()) for r in drawn]

    def by_id(k: int) -> dict[int, int]:
        r = drawn[k]
        ids = np.arange(len(r["strands"])) if r["ids"] is None else r["ids"]
        return {int(i): int(first[k]) + s for s, i in enumerate(ids)}

    of_guides: dict[int, int] = {}
    for k, guides in enumerate(are_guides):
        of_guides |= by_id(k) if guides else {}
    closest, weights = [], []
    for k, r in enumerate(drawn):
        own = np.arange(first[k], first[k + 1])
        if with_guides[k]:
            known = of_guides or by_id(k)
            rows = np.array([[known.get(int(i), -1) for i in row] for row in r["closest"]])
            shares = r["weights"].astype(np.float64)
        elif are_guides[k]:
            rows, shares = np.repeat(own[:, None], 3, axis=1), np.tile([1.0, 0.0, 0.0], (len(own), 1))
        else:
            notes.append(f"{r['name']} has no groom_closest_guides, so the guides of all objects are left out")
            return None, None
        closest.append(rows)
        weights.append(shares)
    found, total = np.concatenate(closest), np.concatenate(weights)
    # A guide without weight does not matter.
    found = np.where((found < 0) & (total == 0), found.max(axis=1, keepdims=True), found)
    if found.min() < 0:
        notes.append("groom_closest_guides names strands that do not exist; left out")
        return None, None
    if not np.isfinite(total).all() or total.min() < 0 or total.sum(axis=1).min() <= 0:
        notes.append("groom_guide_weights are not finite, below 0 or all 0; left out, with the guides")
        return None, None
    return found.astype(np.uint32), (total / total.sum(axis=1, keepdims=True)).astype(np.float32)
