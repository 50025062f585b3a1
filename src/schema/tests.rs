//! Reading and writing of floor files.

mod geometry_and_boards {
    use crate::floor::{Actuator, Calibration, Corner, Floor, Geometry, SensorId, TileId};
    use crate::schema::{parse_floor, write_floor};
    use crate::units::Newtons;

    fn read(text: &str) -> Floor {
        parse_floor(text, "floor.ron").unwrap_or_else(|problems| panic!("{problems}"))
    }

    #[test]
    fn an_empty_description_is_the_papers_floor() {
        assert_eq!(read("Floor()"), Floor::default());
        assert_eq!(read("()"), Floor::default());
        assert_eq!(read(&write_floor(&Floor::default())), Floor::default());
    }

    #[test]
    fn a_grid_of_another_size_is_wired_row_by_row() {
        let floor = read("Floor(columns: 10, rows: 2, tile_m: 0.5)");
        assert_eq!(floor, Floor::of(Geometry::new(10, 2, 0.5, 0.5, 0.02).unwrap()));
    }

    #[test]
    fn what_is_listed_replaces_what_would_be_assumed() {
        let floor = read(
            "Floor(columns: 2, rows: 1,
                allow: [\"10.0.0.5\", \"192.168.1.0/24\"],
                boards: [
                    (tiles: [(1, 0)]),
                    (address: \"/lab/west\", channels: [(0, 0, Ne), None, (0, 0, Sw)]),
                ],
                sensors: [(tile: (0, 0), corner: Ne, a_n: 0.7, tare_n: 12.5)],
                actuators: [(tile: (1, 0), channel: 7, full_scale_n: 55)],
            )",
        );
        let sensor = |column, corner| Some(SensorId { tile: TileId::new(column, 0), corner });
        assert_eq!(floor.boards[0].address, "/underfoot/board/0");
        assert_eq!(floor.boards[0].channels, Corner::ALL.map(|corner| sensor(1, corner)));
        assert_eq!(floor.boards[1].address, "/lab/west");
        assert_eq!(
            floor.boards[1].channels,
            [sensor(0, Corner::NorthEast), None, sensor(0, Corner::SouthWest)]
        );
        let part = Calibration::exponential(0.7, 1.34);
        assert_eq!(floor.calibration[0][Corner::NorthEast.index()], part);
        assert_eq!(floor.calibration[0][0], Calibration::NOMINAL);
        assert_eq!(floor.tare[0][Corner::NorthEast.index()], Newtons(12.5));
        assert_eq!(floor.actuators, [None, Some(Actuator { channel: 7, full_scale: Newtons(55.0) })]);
        assert_eq!(floor.allow, ["10.0.0.5", "192.168.1.0/24"].map(|text| text.parse().unwrap()));
        assert_eq!(read(&write_floor(&floor)), floor);
    }

    #[test]
    fn a_written_floor_can_be_edited_by_people() {
        let mut floor = Floor::of(Geometry::of_paper_tiles(2, 1).unwrap());
        floor.boards[0].channels.truncate(4);
        floor.calibration[1][2] = Calibration::exponential(0.52, 1.34);
        floor.actuators[0] = None;
        insta::assert_snapshot!(write_floor(&floor), @r#"
        // A floor: where its tiles are and what is wired to them.
        // Tiles are (column, row) from the south-west, lengths in metres, forces in newtons.
        Floor(
            version: 1,
            columns: 2,
            rows: 1,
            tile_m: 0.304,
            pitch_m: 0.304,
            sensor_inset_m: 0.02,

            // Which tiles, or which sensors, are on the channels of each board.
            boards: [
                (tiles: [(0, 0)]),
            ],
            // f = a exp(b v) with v in volts, then the tare is taken off. Sensors that are not listed are nominal.
            sensors: [
                (tile: (1, 0), corner: Nw, a_n: 0.52, b_per_volt: 1.34, tare_n: 0),
            ],
            // Output channels; tiles that are not listed have no actuator.
            actuators: [
                (tile: (1, 0), channel: 1, full_scale_n: 40),
            ],
        )
        "#);
    }
}

mod sensors {
    use crate::floor::{Calibration, Divider, Floor, Geometry, Linear, Power};
    use crate::schema::{parse_floor, write_floor};

    fn complaints(sensor: &str) -> String {
        let text = format!("Floor(columns: 1, rows: 1, sensors: [(tile: (0, 0), corner: Sw, {sensor})])");
        parse_floor(&text, "floor.ron").unwrap_err().to_string()
    }

    #[test]
    fn each_law_is_written_by_name_and_read_back() {
        let mut floor = Floor::of(Geometry::of_paper_tiles(1, 1).unwrap());
        floor.calibration[0] = [
            Calibration::exponential(4.4e-6, 3.7),
            Calibration::Power(Power { a_n: 2.2, exponent: 3.1 }),
            Calibration::Divider(Divider { a_n: 35.0, supply_v: 5.0 }),
            Calibration::Linear(Linear { a_n_per_volt: 82.0, zero_v: -0.4 }),
        ];
        let text = write_floor(&floor);
        let sensors = text.lines().skip_while(|line| !line.contains("// f = a exp")).take(9);
        insta::assert_snapshot!(sensors.collect::<Vec<_>>().join("\n"), @r#"
        // f = a exp(b v) with v in volts, then the tare is taken off. Sensors that are not listed are nominal.
        // Power: f = a_n v^exponent.
        // Divider: f = a_n v / (supply_v - v).
        // Linear: f = a_n_per_volt (v - zero_v).
        sensors: [
            (tile: (0, 0), corner: Sw, a_n: 4.4e-6, b_per_volt: 3.7, tare_n: 0),
            (tile: (0, 0), corner: Se, law: Power, a_n: 2.2, exponent: 3.1, tare_n: 0),
            (tile: (0, 0), corner: Nw, law: Divider, a_n: 35, supply_v: 5, tare_n: 0),
            (tile: (0, 0), corner: Ne, law: Linear, a_n_per_volt: 82, zero_v: -0.4, tare_n: 0),
        "#);
        assert_eq!(parse_floor(&text, "floor.ron").unwrap_or_else(|told| panic!("{told}")), floor);
    }

    #[test]
    fn an_unknown_law_is_told_with_the_nearest_name_and_nothing_else() {
        let told = complaints("law: Powr, a_n: 2.2, exponent: 3.1");
        assert!(
            told.contains("there is no `law` called Powr") && told.contains("did you mean Power?"),
            "{told}"
        );
        assert!(told.contains("1 error"), "{told}");
        let told = complaints("law: Logarithm, a_n: 2.2, b_per_volt: 3.1");
        assert!(told.contains("expected Exponential, Power, Divider or Linear"), "{told}");
    }

    #[test]
    fn numbers_of_another_law_and_numbers_that_no_part_has_are_told() {
        let told = complaints("law: Power, a_n: 2.2, b_per_volt: 3.1");
        assert!(told.contains("unknown field `b_per_volt`") && told.contains("lacks `exponent`"), "{told}");
        let told = complaints("law: Linear, a_n_per_volt: -3, zero_v: 0");
        assert!(told.contains("`a_n_per_volt` is out of range"), "{told}");
        let told = complaints("law: Divider, supply_v: 5");
        assert!(told.contains("lacks `a_n`"), "{told}");
    }
}

mod what_moves_and_sounds {
    use glam::Vec2;

    use crate::floor::{Drive, Floor, Loudspeaker, Response};
    use crate::schema::{parse_floor, write_floor};

    fn read(text: &str) -> Floor {
        parse_floor(text, "floor.ron").unwrap_or_else(|problems| panic!("{problems}"))
    }

    #[test]
    fn what_moves_and_sounds_is_read_and_written_again() {
        let floor = read(
            "Floor(columns: 2, rows: 1,
                drive: (full_scale_v: 28, long_term_w: 60),
                response_n: [(50, 20), (200, 80)],
                actuators: [
                    (tile: (0, 0), channel: 1),
                    (tile: (1, 0), channel: 0, full_scale_n: 20, response_db: [(40, -3), (800, 3)]),
                ],
                loudspeakers: [(at_m: (-0.5, 1), channel: 2), (at_m: (1.1, 1), channel: 5, gain_db: -6)],
            )",
        );
        assert_eq!(floor.drive, Drive { full_scale_v: 28.0, load_ohm: 4.0, long_term_w: 60.0 });
        let common = floor.responses[0].as_ref().unwrap();
        assert!((common.gain_db(50.0) + 6.02).abs() < 0.01, "20 N of 40 N are -6 dB");
        assert_eq!(floor.responses[1], Response::of(vec![(40.0, -3.0), (800.0, 3.0)]));
        let second = Loudspeaker { at: Vec2::new(1.1, 1.0), channel: 5, gain_db: -6.0 };
        assert_eq!((floor.loudspeakers.len(), floor.loudspeakers[1]), (2, second));
        assert_eq!(floor.channel_count(), 6);
        assert_eq!(read(&write_floor(&floor)), floor);
    }

    #[test]
    fn one_response_for_all_is_written_once() {
        let floor = read("Floor(response_db: [(50, -6), (100, 0), (750, -9.5)])");
        let text = write_floor(&floor);
        assert_eq!(text.matches("response_db").count(), 1, "{text}");
        assert_eq!(read(&text), floor);
    }

    #[test]
    fn what_makes_no_sense_is_named() {
        let told = parse_floor(
            "Floor(columns: 2, rows: 1,
                drive: (load_ohm: 0),
                response_db: [(50, 0)],
                actuators: [
                    (tile: (0, 0), channel: 0, response_db: [(50, 0), (40, 0)]),
                    (tile: (1, 0), channel: 3, response_db: [(50, 0), (60, 1)], response_n: [(50, 1), (60, 1)]),
                ],
                loudspeakers: [
                    (at_m: (0, 0), channel: 7), (at_m: (0, 0), channel: 7), (channel: 8),
                ],
            )",
            "floor.ron",
        )
        .unwrap_err()
        .to_string();
        for said in [
            "`load_ohm` is out of range",
            "`response_db` has too few points",
            "the hertz of a response must rise",
            "`response_db` or `response_n`, not both",
            "channel 7 comes twice",
            "`at_m`",
        ] {
            assert!(told.contains(said), "{said}: {told}");
        }
        let taken =
            parse_floor("Floor(loudspeakers: [(at_m: (0, 0), channel: 4)])", "floor.ron").unwrap_err();
        assert!(taken.to_string().contains("channel 4 moves tile (4, 0) already"), "{taken}");
    }
}

mod maps {
    use crate::floor::PositionMap;
    use crate::schema::parse_floor;

    fn complaints(fields: &str) -> String {
        let text = format!("Floor(columns: 2, rows: 1,\n{fields}\n)");
        parse_floor(&text, "floor.ron").unwrap_err().to_string()
    }

    #[test]
    fn maps_belong_to_the_tiles_that_are_listed() {
        let zeros = "0, 0, 0, 0, 0, 0, 0, 0, 0, 0";
        let text = format!(
            "Floor(columns: 2, rows: 1, tared: \"2026-11-20\", maps: [
                (tile: (1, 0), bends: [[0.1, {}], [{zeros}]], mapped: \"2026-11-19\", residual_m: 0.004),
            ])",
            &zeros[3..]
        );
        let floor = parse_floor(&text, "floor.ron").unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(floor.position_maps[0], None);
        let map = floor.position_maps[1].unwrap();
        assert_eq!((map.bends[0][0], map.trims), (0.1, PositionMap::NONE.trims));
        assert_eq!(floor.map_records[1].unwrap().residual_m, 0.004);
        assert_eq!(floor.tared.unwrap().to_string(), "2026-11-20");
    }

    #[test]
    fn wrong_maps_and_days_are_all_named() {
        let told = complaints(
            "tared: \"20.11.2026\",
            sensors: [(tile: (0, 0), corner: Sw, calibrated: \"2026-11-20\")],
            maps: [
                (tile: (0, 0), trims: [[0, 0], [0], [0]], bends: [[7]]),
                (tile: (1, 0), residual_m: 0.1),
                (tile: (1, 0)),
            ],",
        );
        for said in [
            "`tared` is no day",
            "`calibrated` needs `residual` beside it",
            "expected 4",
            "expected 21",
            "`bends` is out of range",
            "`residual_m` needs `mapped` beside it",
            "the map of tile (1, 0) comes twice",
        ] {
            assert!(told.contains(said), "{said}: {told}");
        }
    }
}

mod plates {
    use glam::Vec2;

    use crate::floor::{Calibration, Corner, Floor, SensorId, TileId};
    use crate::schema::{Kinds, parse_floor, parse_layout, write_floor};

    fn read(text: &str) -> Floor {
        parse_floor(text, "floor.ron").unwrap_or_else(|problems| panic!("{problems}"))
    }

    fn complaints(fields: &str) -> String {
        parse_floor(&format!("Floor(version: 3, columns: 3, rows: 3,\n{fields}\n)"), "floor.ron")
            .map(|_| String::new())
            .unwrap_or_else(|problems| problems.to_string())
    }

    const EDGES: &str = "sensors_m: [(0, -0.13), (0.13, 0), (-0.13, 0), (0, 0.13)],";

    #[test]
    fn rectangles_holes_places_and_plates_are_read_and_written_again() {
        let floor = read(
            "Floor(version: 3, columns: 3, rows: 2, tile_m: (0.4, 0.3), pitch_m: (0.42, 0.3),
                sensors_m: [(0, -0.13), (0.18, 0), (-0.18, 0), (0, 0.13)],
                missing: [(at: (1, 0), size: (2, 1))],
                plates: [(tile: (0, 1), size_m: (0.3, 0.3), sensors_m: [(-0.1, -0.1), (0.1, -0.1), (0, 0.1)])],
                boards: [(tiles: [(0, 0), (0, 1)]), (channels: [(1, 1, 3), None, (1, 1, 0)])],
                sensors: [(tile: (0, 1), corner: 2, a_n: 0.7)],
            )",
        );
        let geometry = &floor.geometry;
        let tiles: Vec<_> = geometry.tiles().filter(|tile| geometry.has(*tile)).collect();
        assert_eq!(tiles, [(0, 0), (0, 1), (1, 1), (2, 1)].map(|(column, row)| TileId::new(column, row)));
        assert_eq!((geometry.tile_m(), geometry.pitch_m()), (Vec2::new(0.4, 0.3), Vec2::new(0.42, 0.3)));
        assert_eq!([0, 1].map(|row| geometry.sensors(TileId::new(0, row)).len()), [4, 3]);
        assert_eq!([0, 1].map(|board: usize| floor.boards[board].channels.len()), [7, 3]);
        let last = SensorId { tile: TileId::new(1, 1), corner: Corner::NorthEast };
        assert_eq!(floor.boards[1].channels[0], Some(last));
        assert_eq!(floor.calibration[3][2], Calibration::exponential(0.7, 1.34));
        assert_eq!(floor.actuators.iter().filter(|actuator| actuator.is_some()).count(), 4);
        assert_eq!(read(&write_floor(&floor)), floor);
    }

    #[test]
    fn squares_with_sensors_in_the_corners_are_written_as_before() {
        let text = write_floor(&Floor::default());
        assert!(text.contains("version: 1,") && text.contains("tile_m: 0.304,"), "{text}");
        assert!(!text.contains("sensors_m") && !text.contains("missing"), "{text}");
        let written = write_floor(&read("Floor(version: 3, columns: 1, rows: 1, tile_m: (0.5, 0.3))"));
        assert!(written.contains("version: 3,") && written.contains("tile_m: (0.5, 0.3),"), "{written}");
    }

    #[test]
    fn a_floor_that_cannot_be_is_refused_with_its_place_and_what_to_do() {
        for (fields, said) in [
            ("sensors_m: [(-0.1, 0), (0, 0.001), (0.1, 0)],", "lie on one line"),
            ("sensors_m: [(-0.1, 0), (0.1, 0)],", "a plate has three or four sensors"),
            ("sensors_m: [(-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1)],", "neighbours, not opposite"),
            ("sensors_m: [(-0.1, -0.1), (0.2, -0.1), (0, 0.1)],", "sensor 1 lies beyond the edge of a plate"),
            ("sensor_inset_m: 0.02, sensors_m: [(-0.1, -0.1), (0.1, -0.1), (0, 0.1)],", "not both"),
            ("tile_m: 0.3, pitch_m: (0.3, 0.25),", "pitch_m must be at least tile_m"),
            ("missing: [(at: (2, 2), size: (2, 1))],", "reaches beyond the floor"),
            ("missing: [(at: (0, 0), size: (3, 3))],", "every tile of this floor is missing"),
            ("plates: [(tile: (1, 1), size_m: (0.4, 0.2))],", "the plate of tile (1, 1) must be"),
            ("plates: [(tile: (1, 1)), (tile: (1, 1))],", "the plate of tile (1, 1) comes twice"),
            ("missing: [(at: (1, 1))], boards: [(tiles: [(1, 1)])],", "tile (1, 1) is missing on this floor"),
            ("missing: [(at: (1, 1))], actuators: [(tile: (1, 1), channel: 0)],", "tile (1, 1) is missing"),
            ("boards: [(tiles: [(0, 0)]), (channels: [(0, 0, Ne)])],", "tile (0, 0) ne comes twice"),
        ] {
            let told = complaints(fields);
            assert!(told.contains(said) && told.contains("floor.ron:2:"), "{fields}: {told}");
        }
        let legs = "sensors_m: [(-0.1, -0.1), (0.1, -0.1), (0, 0.1)],";
        let told = complaints(&format!("{legs} boards: [(channels: [(0, 0, 3)])],"));
        assert!(told.contains("tile (0, 0) has no sensor 3"), "{told}");
        // Numbers where sensors have numbers, names where they have names.
        assert!(complaints(&format!("{EDGES} boards: [(channels: [(0, 0, Ne)])],")).contains("`corner`"));
        assert!(complaints("boards: [(channels: [(0, 0, 3)])],").contains("`corner`"));
        assert_eq!(complaints(&format!("{EDGES} boards: [(channels: [(0, 0, 3)])],")), "");
    }

    #[test]
    fn an_older_version_says_what_it_cannot_hold() {
        for (fields, said) in [
            (EDGES, "sensors at given places need version 3"),
            ("missing: [(at: (0, 0))],", "missing tiles need version 3"),
            ("tile_m: (0.3, 0.4),", "rectangular tiles need version 3"),
        ] {
            let told = parse_floor(&format!("Floor(version: 1, {fields})"), "floor.ron").unwrap_err();
            assert!(told.to_string().contains(said), "{told}");
        }
    }

    #[test]
    fn no_control_lies_over_a_hole_and_tiles_are_as_wide_as_they_are() {
        let floor =
            read("Floor(version: 3, columns: 3, rows: 3, tile_m: (0.4, 0.3), missing: [(at: (1, 1))])");
        let page = |at: &str, units: &str| {
            let text = format!(
                "Layout(version: 1, title: \"ring\", units: {units}, regions: [(id: \"all\", at: (0, 0), size: (1.2, 0.9))],
                    widgets: [(id: \"it\", kind: \"button\", at: {at}, size: (0.3, 0.2), label: \"It\")])"
            );
            parse_layout(&text, "page.ron", &Kinds::builtin(), &floor.geometry)
        };
        let told = page("(0.5, 0.35)", "Metres").err().unwrap().to_string();
        assert!(
            told.contains("\"it\" lies over the missing tile (1, 1)") && told.contains("page.ron:2:"),
            "{told}"
        );
        let beside = page("(0.05, 0.35)", "Metres").unwrap().layout;
        assert_eq!(beside.widgets[0].area.min, Vec2::new(0.05, 0.35));
        let tiles = page("(0.5, 0.5)", "Tiles").unwrap().layout;
        assert!(tiles.widgets[0].area.min.distance(Vec2::new(0.2, 0.15)) < 1e-6);
        assert!(tiles.widgets[0].area.size().distance(Vec2::new(0.12, 0.06)) < 1e-6);
    }
}
