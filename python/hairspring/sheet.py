"""A contact sheet of pictures with their names."""

from __future__ import annotations

from pathlib import Path

CELL, LABEL, COLUMNS = 320, 24, 4
"""Size of a picture and of its label [pixels], and pictures in a row."""


def write_sheet(path: Path, pictures: list[tuple[str, Path]]) -> None:
    """Writes a sheet of named pictures. Without the library Pillow, or without pictures, none is written."""
    try:
        from PIL import Image, ImageDraw
    except ImportError:
        import sys

        print("hairspring wedge: no contact sheet; run `pip install pillow` to get one", file=sys.stderr)
        return
    if not pictures:
        return
    columns = min(COLUMNS, len(pictures))
    rows = -(-len(pictures) // columns)
    sheet = Image.new("RGB", (columns * CELL, rows * (CELL + LABEL)), (24, 24, 28))
    draw = ImageDraw.Draw(sheet)
    for k, (name, file) in enumerate(pictures):
        x, y = k % columns * CELL, k // columns * (CELL + LABEL)
        with Image.open(file) as picture:
            picture.thumbnail((CELL, CELL))
            sheet.paste(picture, (x + (CELL - picture.width) // 2, y + (CELL - picture.height) // 2))
        draw.text((x + 6, y + CELL + 6), name[: CELL // 7], fill=(220, 220, 220))
    pending = path.with_name(f".{path.name}")
    sheet.save(pending, format="PNG")
    pending.replace(path)
