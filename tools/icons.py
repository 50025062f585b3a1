#!/usr/bin/env python3
"""Makes the font of the window's icons anew: those letters of Lucide that the window uses.

    python3 -m venv made && made/bin/pip install fonttools && made/bin/python tools/icons.py

Needed after an icon is added; a test of the window names the icons that the font lacks. The whole font of Lucide has a
megabyte, the part about 10 kB.
"""

import json
import re
import subprocess
from pathlib import Path

from fontTools import subset

WINDOW = Path(__file__).resolve().parent.parent / "crates/underfoot-window"


def lucide() -> Path:
    """Returns the folder of the crate that has the whole font and the letters of the icons."""
    asked = ["cargo", "metadata", "--locked", "--format-version", "1"]
    packages = json.loads(subprocess.run(asked, cwd=WINDOW, check=True, capture_output=True).stdout)["packages"]
    manifest = next(package["manifest_path"] for package in packages if package["name"] == "lucide-icons")
    return Path(manifest).parent


def main() -> None:
    """Writes the font."""
    texts = [file.read_text() for file in sorted((WINDOW / "src").rglob("*.rs"))]
    used = {name for text in texts for name in re.findall(r"\bIcon::([A-Z]\w*)", text)}
    crate = lucide()
    letters = dict(re.findall(r"\bIcon::(\w+) => '\\u\{(\w+)\}'", (crate / "src/icon.rs").read_text()))
    missing = used - letters.keys()
    if missing:
        raise SystemExit(f"Lucide has no icon called {', '.join(sorted(missing))}")
    options = subset.Options(hinting=False, layout_features=[], name_IDs=[], notdef_outline=True, glyph_names=False)
    options.drop_tables += ["GSUB"]
    font = subset.load_font(str(crate / "lucide.ttf"), options)
    chosen = subset.Subsetter(options)
    chosen.populate(unicodes=[int(letters[name], 16) for name in used])
    chosen.subset(font)
    made = WINDOW / "fonts/icons.ttf"
    subset.save_font(font, str(made), options)
    print(f"{made.relative_to(WINDOW.parent.parent)}: {len(used)} icons, {made.stat().st_size} bytes")


if __name__ == "__main__":
    main()
