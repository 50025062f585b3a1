//! The ergonomic rules: limits, reasons and sources.

use serde::Serialize;

/// One ergonomic rule: a limit with its reason and its source.
#[derive(Debug, PartialEq, Serialize)]
pub struct Rule {
    /// Stable code, for searching and for programs.
    pub code: &'static str,
    /// Short name of the problem.
    pub title: &'static str,
    /// The limits of an error and of a warning.
    pub limits: &'static str,
    /// Reason and source of the limits.
    pub source: &'static str,
    /// Suggested remedy.
    pub remedy: &'static str,
}

/// All rules, by code: 1xx for space, 2xx for force, 3xx for sight.
pub const RULES: &[Rule] = &[
    Rule {
        code: "U101",
        title: "too small for a shoe",
        limits: "error: a side below 5 cm; warning: below 10 cm",
        source: "Feet miss targets below 5 cm (Saunders and Vogel 2015, tap-kick-click). The 95th percentile of \
                 foot breadth is 11 cm, a shoe adds 1 cm: 10 to 12 cm and more work well.",
        remedy: "make it 12 cm or larger: 0.4 tiles of 30 cm",
    },
    Rule {
        code: "U102",
        title: "too close to its neighbour",
        limits: "`HoldToRun`: error below 5.5 cm, warning below 10 cm; `Confirm`: warning below 5.5 cm; \
                 others: warning below 5 cm",
        source: "Gaps between pedals for one foot in sequence are 5 cm at least, in any order 10 cm \
                 (MIL-STD-1472). Half a foot's width, 5.5 cm, is this project's rule against the wrong pedal: \
                 a shoe whose middle is on one control then reaches no other with its weight.",
        remedy: "move them apart, or make one of them smaller",
    },
    Rule {
        code: "U103",
        title: "out of reach from where people stand",
        limits: "warning: its middle is more than 0.8 m from the nearest place for a standing foot; \
                 error: more than 1.2 m",
        source: "A step is about 0.7 m long; a foot that reaches further takes the body along. \
                 Tried only where the layout has stance zones.",
        remedy: "move it nearer, or add a stance zone beside it",
    },
    Rule {
        code: "U104",
        title: "too near to where people stand",
        limits: "warning: it shares a tile with a stance zone, or lies on the tile beside one",
        source: "One foot covers up to four tiles. Two feet on the same or on neighbouring tiles share sensors \
                 and are told apart only by when they landed (`underfoot experiment feet`).",
        remedy: "keep a free row of tiles between the stance zone and the controls",
    },
    Rule {
        code: "U105",
        title: "the floor finds the foot less exactly than the control is small",
        limits: "error: 95 in 100 feet that aim at its middle are found within more than half of its smaller side; \
                 warning: more than half of that",
        source: "Measured on simulated floors by force and by distance from a tile's edge: \
                 `underfoot experiment place --quality paper`. A floor file with position maps counts.",
        remedy: "make it larger, press it harder, or calibrate position maps (`underfoot calibrate map`)",
    },
    Rule {
        code: "U106",
        title: "steps finer than a foot can hold",
        limits: "warning: less than 1 cm from one value to the next",
        source: "The place of a pressing foot is found within 0.5 cm at best (95 in 100, with position maps, \
                 200 N): two values must lie twice that apart.",
        remedy: "make it longer, or its steps coarser",
    },
    Rule {
        code: "U107",
        title: "a standing foot is the cursor",
        limits: "warning: a stance zone overlaps a region with `cursor: Largest`, or is less than half a shoe (13 cm) \
                 from it",
        source: "The heaviest foot in such a region is its cursor. People stand up to half a shoe beside their zone: \
                 then that foot, not the one on a control, is the cursor, and 88 of 100 presses were missed. \
                 `underfoot experiment controls` measures both rules.",
        remedy: "let the foot on a control be the cursor: `cursor: Working`, or move the zone away",
    },
    Rule {
        code: "U201",
        title: "too heavy for a light person",
        limits: "warning: the press takes more than half of the weight of 45 kg (221 N); error: more than all of it (441 N)",
        source: "A person who stands on one foot and presses with the other shifts weight: half of it without stepping on \
                 the control, all of it only by standing on it. 45 kg is this project's lightest person.",
        remedy: "lower `press_n`, or give it as a part of the weight",
    },
    Rule {
        code: "U202",
        title: "lighter than a foot at rest",
        limits: "warning: the press takes less than 35 N",
        source: "A foot that rests beside its work bears some of the leg's weight; 35 N is this project's least \
                 engage force for standing users.",
        remedy: "raise `press_n` to 35 or more",
    },
    Rule {
        code: "U203",
        title: "within a stance zone, or pressed by who stands beside it",
        limits: "error: it overlaps a stance zone; warning: it is less than 10 cm from one and \
                 takes less than a standing foot bears (350 N)",
        source: "A foot in a stance zone is a standing foot and presses nothing there. Beside the zone a person of \
                 70 kg bears 350 N on each foot, more than most presses take.",
        remedy: "keep controls at least 10 cm, better a tile, away from stance zones",
    },
    Rule {
        code: "U301",
        title: "hard to read",
        limits: "error: contrast of label and face, at rest or lit, below 3; warning: below 4.5",
        source: "Web Content Accessibility Guidelines 2.2, 1.4.3: 4.5 for text, 3 for large text.",
        remedy: "make `ink` darker or `face` and `lit` lighter",
    },
    Rule {
        code: "U302",
        title: "the label does not fit",
        limits: "warning: its end is left out at the smallest letters (2.4 cm)",
        source: "Letters below 2.4 cm are not read from standing height (1.6 m) at the 5 arc minutes of an eye of \
                 20/60; set as the window sets it.",
        remedy: "shorten the label, or make the control wider",
    },
    Rule {
        code: "U303",
        title: "nothing to tell it by",
        limits: "warning: neither label nor icon",
        source: "Feet have no habit of the place of a control that they use seldom: people look.",
        remedy: "add a label, or an icon: look: (icon: Home)",
    },
    Rule {
        code: "U304",
        title: "letters that no font has",
        limits: "warning: a text of the layout holds a letter that neither the program's own fonts have, which are \
                 Latin, Greek, Cyrillic, arrows and emoji, nor those of the computer that checks it",
        source: "A box is drawn in place of such a letter. Fonts differ from computer to computer: check on the one \
                 that shows the layout.",
        remedy: "install a font that has them where the layout is shown (Debian: fonts-noto-core, fonts-noto-cjk)",
    },
];

/// Returns the rule of this code, ignoring case; `None` if no rule has it.
#[must_use]
pub fn rule(code: &str) -> Option<&'static Rule> {
    RULES.iter().find(|rule| rule.code.eq_ignore_ascii_case(code))
}
