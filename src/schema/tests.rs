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
