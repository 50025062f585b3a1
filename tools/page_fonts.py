#!/usr/bin/env python3
"""Makes the fonts of the page in a browser anew: the common letters of the fonts of egui.

    python3 -m venv made && made/bin/pip install fonttools && made/bin/python tools/page_fonts.py

Needed after a new version of egui, and after the window uses a letter that they lack, which a test of the drawings
names. A browser draws all other letters itself. The whole fonts have 670 kB, these 115; egui fits letters to pixels with
its own rules where a font has none, so these fonts have none.
"""

import json
import subprocess
from pathlib import Path

from fontTools import subset
from fontTools.ttLib import TTFont

MADE = Path(__file__).resolve().parent.parent / "crates/underfoot-scene/fonts"

# Punctuation, small numbers, currencies, arrows, mathematics, and shapes.
SIGNS = (
    "2000-206F,2070-209F,20AC,2116,2122,2126,2190-21AF,21BA-21BB,21D0-21D5,21E6-21EA,2202-2248,2260-2267,22C5,"
    "25A0-25CF,25E6"
)

# Latin of Western and Central Europe, Greek and Cyrillic.
TEXT = "0020-007E,00A0-017F,0192,0218-021B,02C6-02DD,0370-03FF,0400-045F,0490-0491,1E9E,FB00-FB06," + SIGNS

# Code is Latin; a comment in other letters has those of the text.
CODE = "0020-007E,00A0-00FF," + SIGNS

FONTS = {"Ubuntu-Light": ("Ubuntu-Light derivative underfoot", TEXT), "Hack-Regular": ("Hack underfoot", CODE)}


def whole_fonts() -> Path:
    """Returns the folder of the crate that has the whole fonts."""
    asked = ["cargo", "metadata", "--locked", "--format-version", "1"]
    packages = json.loads(subprocess.run(asked, cwd=MADE.parent, check=True, capture_output=True).stdout)["packages"]
    manifest = next(package["manifest_path"] for package in packages if package["name"] == "epaint_default_fonts")
    return Path(manifest).parent / "fonts"


def rename(font: TTFont, name: str) -> None:
    """Gives the font another name, as the licences of the fonts ask of a part of them."""
    table = font["name"]
    for record in list(table.names):
        if record.nameID in (1, 4, 6):
            kept = name.replace(" ", "-") if record.nameID == 6 else name
            table.setName(kept, record.nameID, record.platformID, record.platEncID, record.langID)


def main() -> None:
    """Writes the fonts."""
    MADE.mkdir(exist_ok=True)
    for file, (name, letters) in FONTS.items():
        options = subset.Options(hinting=False, notdef_outline=True, glyph_names=False)
        options.layout_features = ["kern", "mark", "mkmk", "ccmp", "locl"]
        options.name_IDs = [0, 1, 2, 4, 6]
        options.drop_tables += ["TTFA", "VDMX", "hdmx"]
        font = subset.load_font(str(whole_fonts() / f"{file}.ttf"), options)
        chosen = subset.Subsetter(options)
        chosen.populate(unicodes=subset.parse_unicodes(letters))
        chosen.subset(font)
        rename(font, name)
        made = MADE / f"{file}-part.ttf"
        subset.save_font(font, str(made), options)
        print(f"{made.name}: {len(font.getBestCmap())} letters, {made.stat().st_size} bytes")


if __name__ == "__main__":
    main()
