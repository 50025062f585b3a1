//! Units and examples of fields, found by their names alone.

/// The unit of a field, by the end of its name, with a space before it; empty if it has none.
pub fn unit(field: &str) -> &'static str {
    const UNITS: [(&str, &str); 22] = [
        ("_px_s", " pixels per second"),
        ("_n_s_m", " N s/m"),
        ("_n_m", " N/m"),
        ("_kg", " kg"),
        ("_m_per_j", " m/J"),
        ("_per_j_s", " per joule second"),
        ("_per_j", " per joule"),
        ("_j", " J"),
        ("_m_s", " m/s"),
        ("_n_per_volt", " N per volt"),
        ("_per_volt", " per volt"),
        ("_ms", " ms"),
        ("_n", " N"),
        ("hz", " Hz"),
        ("_m", " m"),
        ("_deg", " degrees"),
        ("_per_s", " per second"),
        ("_s", " s"),
        ("_db", " dB"),
        ("_v", " V"),
        ("_ohm", " ohms"),
        ("_w", " W"),
    ];
    UNITS.iter().find(|(end, _)| field.ends_with(end)).map_or("", |(_, unit)| unit)
}

/// An example of a field, for a file that lacks it.
pub fn example(field: &str) -> Option<&'static str> {
    Some(match field {
        "version" => "version: 1",
        "to" => "to: Keyboard, or to: Osc(\"127.0.0.1:53000\")",
        "title" => "title: \"Map navigation\"",
        "id" => "id: \"home\"",
        "kind" => "kind: \"button\"",
        "at" => "at: (2.5, 3.0), its south-west corner",
        "size" => "size: (0.6, 0.6), its width and depth",
        "regions" => "regions: [(id: \"map\", at: (0, 2), size: (6, 4))]",
        "widgets" => "widgets: [(id: \"home\", kind: \"button\", at: (2, 3), size: (0.6, 0.6))]",
        "name" => "name: \"my_button\"",
        "columns" => "columns: 3",
        "behaviour" => "behaviour: Button, or make it from another kind: from: \"button\"",
        "press_n" => "press_n: 60",
        "release_n" => "release_n: 40",
        "min" => "min: 0",
        "max" => "max: 1",
        "options" => "options: [\"Low\", \"High\"]",
        "full_n" => "full_n: 250",
        "max_s" => "max_s: 60, the longest that it acts",
        "full_per_s" => "full_per_s: 0.5, the change per second at full deflection",
        "level_n" => "level_n: 12",
        "modes" => "modes: [(hz: 180, decay_ms: 18, amplitude: 1.0)]",
        "hz" => "hz: 180",
        "decay_ms" => "decay_ms: 18",
        "length_ms" => "length_ms: 300",
        "resonances" => "resonances: [(hz: 180, decay_ms: 12)]",
        "spacing_m" => "spacing_m: 0.003",
        "grip" => "grip: 0.9",
        "glide" => "glide: 0.5",
        "stretch_m" => "stretch_m: 0.002",
        "exponent" => "exponent: 2.5",
        "supply_v" => "supply_v: 5",
        "a_n_per_volt" => "a_n_per_volt: 80",
        "zero_v" => "zero_v: 0",
        "parts" => "parts: [(at_ms: 0, plays: \"crisp_click\"), (at_ms: 90, plays: \"soft_click\")]",
        "at_ms" => "at_ms: 0",
        "plays" => "plays: Click(level_n: 12, modes: [(hz: 180, decay_ms: 18)])",
        "level" => "level: 0.5",
        "low_hz" => "low_hz: 80",
        "high_hz" => "high_hz: 320",
        "tile" => "tile: (0, 0), column and row",
        "corner" => "corner: Sw",
        "address" => "address: \"/underfoot/board/0\"",
        "channel" => "channel: 0",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_end_in_their_unit() {
        assert_eq!(unit("press_n"), " N");
        assert_eq!(unit("dwell_ms"), " ms");
        assert_eq!(unit("full_speed_m_s"), " m/s");
        assert_eq!(unit("low_hz"), " Hz");
        assert_eq!(unit("tile_m"), " m");
        assert_eq!(unit("max_s"), " s");
        assert_eq!(unit("full_per_s"), " per second");
        assert_eq!(unit("angle_deg"), " degrees");
        assert_eq!(unit("amplitude"), "");
    }
}
