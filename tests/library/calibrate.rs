//! Calibrating a floor from load-cell tables, pressed points and real packets over loopback.

use std::time::Duration;

use crate::sender::{ANY_PORT, Sender, simulated, small_floor, standing};
use underfoot::floor::{Calibration, Corner, Day, Floor, Geometry, LawKind, SensorId, TileId};
use underfoot::glam::Vec2;
use underfoot::sense::{Assembler, Fit, LoadPoint, LoadTable, PressTable, SensorLoads, Verdict};
use underfoot::serve::{ForceWatch, TareFailure, take_tare};
use underfoot::source::{FloorInput, UdpSource};
use underfoot::units::Newtons;
use underfoot_sim::{self as sim, Load, PartConfig, Print, SensorFault, SimConfig, SimFloor};

#[test]
fn simulated_parts_come_back_within_one_percent_through_two_percent_of_noise() {
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};
    let floor = small_floor();
    let exact = PartConfig { a_spread: 0.25, b_spread: 0.05, ..PartConfig::exact() };
    let config = SimConfig { sensing: sim::SimulatedSensors::Counts(exact), ..SimConfig::default() };
    let sim = SimFloor::new(&floor, config, 7);
    let table = LoadTable::read(sim::load_table(&sim, 3).as_bytes(), &floor.geometry).unwrap();
    assert_eq!(table.sensors.len(), 24);
    let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(5);
    let noise = Normal::new(1.0, 0.02).unwrap();
    for clean in &table.sensors {
        let truth = clean.judge().fit.unwrap().calibration.numbers();
        // Eight seconds of a slow press at 1 kHz: each load 200 times, with an error of the load cell of 2 % each
        // time.
        let points = clean.points.iter().flat_map(|point| std::iter::repeat_n(*point, 200));
        let points: Vec<_> =
            points.map(|point| LoadPoint::new(point.volts, point.force * noise.sample(&mut rng))).collect();
        let judgement = SensorLoads { points, ..clean.clone() }.judge();
        let found = judgement.fit.unwrap().calibration.numbers();
        assert_eq!(judgement.laws.chosen, Some(LawKind::Exponential), "{}", clean.sensor);
        let (a, b) = (found[0] / truth[0], found[1] / truth[1]);
        assert!((a - 1.0).abs() < 0.01 && (b - 1.0).abs() < 0.01, "{}: a {a}, b {b}", clean.sensor);
        assert_eq!(judgement.verdict, Verdict::Good);
    }
}

#[test]
fn tables_of_a_simulated_floor_calibrate_and_map_it() {
    let nominal = small_floor();
    let sim = simulated(&nominal);
    // The tare was measured with slightly different curves; it follows the new ones.
    let mut floor = sim::calibrated(&nominal, &sim, 2).unwrap();
    let table = LoadTable::read(sim::load_table(&sim, 1).as_bytes(), &floor.geometry).unwrap();
    for loads in &table.sensors {
        let judgement = loads.judge();
        assert_eq!(judgement.verdict, Verdict::Good, "{}", loads.sensor);
        floor.recalibrate(loads.sensor, judgement.fit.unwrap().calibration, None);
    }
    let table = PressTable::read(sim::press_table(&floor, &sim, 1).as_bytes(), &floor).unwrap();
    assert_eq!(table.tiles.len(), 6);
    for points in &table.tiles {
        let fit = points.fit(&floor).unwrap();
        assert!(fit.before.p95_m > 2.0 * fit.after.p95_m, "{}: {:?}", points.tile, fit.before);
        assert!(fit.after.p95_m < 0.01 && fit.after.median_m < 0.004, "{}: {:?}", points.tile, fit.after);
    }
}

#[test]
fn places_alone_teach_the_part_of_the_distortion_that_no_force_changes() {
    // A plate that bends: all estimates lie a tenth too far inside, and a little to the east.
    let floor = small_floor();
    let mut text = String::from("true_x_m,true_y_m,est_x_m,est_y_m\n");
    let centre = floor.geometry.centre(TileId::new(1, 1));
    for step in 0..49_u8 {
        let at = Vec2::new(f32::from(step % 7) - 3.0, f32::from(step / 7) - 3.0) * 0.046;
        let seen = centre + at * 0.9 + Vec2::new(0.004, 0.0);
        text += &format!("{},{},{},{}\n", centre.x + at.x, centre.y + at.y, seen.x, seen.y);
    }
    let table = PressTable::read(text.as_bytes(), &floor).unwrap();
    let fit = table.tiles[0].fit(&floor).unwrap();
    assert_eq!((table.tiles[0].tile, fit.points), (TileId::new(1, 1), 49));
    assert!(fit.before.worst_m > 0.014 && fit.after.worst_m < 0.002, "{fit:?}");
}

#[test]
fn a_part_beyond_repair_is_named() {
    let floor = small_floor();
    let text = sim::load_table(&simulated(&floor), 1);
    // Its wires are swapped: volts fall with increasing load.
    let broken: Vec<String> = text
        .lines()
        .map(|line| match line.strip_prefix("1,1,nw,").and_then(|rest| rest.split_once(',')) {
            Some((volts, newtons)) => format!("1,1,nw,{:.5},{newtons}", 5.0 - volts.parse::<f32>().unwrap()),
            None => line.to_owned(),
        })
        .collect();
    let table = LoadTable::read(broken.join("\n").as_bytes(), &floor.geometry).unwrap();
    let beyond = table.sensors.iter().filter(|loads| loads.judge().verdict == Verdict::Replace);
    let named: Vec<_> = beyond.map(|loads| loads.sensor).collect();
    assert_eq!(named, [SensorId { tile: TileId::new(1, 1), corner: Corner::NorthWest }]);
}

#[test]
fn an_empty_floor_is_tared_over_real_packets() {
    let floor = small_floor();
    let sim = simulated(&floor);
    let expected = sim::calibrated(&floor, &sim, 1).unwrap();
    let calibrated = Floor { tare: vec![[Newtons::ZERO; 4]; 6], ..expected.clone() };
    let source = UdpSource::bind(ANY_PORT, &calibrated).unwrap();
    let _sender = Sender::start(&floor, sim, source.local_addr().unwrap(), |sim, _| {
        sim.step(&[]);
    });
    let tare =
        take_tare(&mut FloorInput::from(source).source, &calibrated, Duration::from_secs(10), false).unwrap();
    for (found, expected) in tare.iter().flatten().zip(expected.tare.iter().flatten()) {
        assert!((*found - *expected).abs() < Newtons(0.1), "{found:?} for {expected:?}");
    }
}

#[test]
fn somebody_on_the_floor_is_named_by_the_sensor_and_nothing_is_taken() {
    let floor = small_floor();
    let sim = simulated(&floor);
    let calibrated = sim::calibrated(&floor, &sim, 1).unwrap();
    let source = UdpSource::bind(ANY_PORT, &calibrated).unwrap();
    let place = floor.geometry.centre(TileId::new(2, 1));
    let _sender = Sender::start(&floor, sim, source.local_addr().unwrap(), move |sim, _| {
        sim.step(&[standing(place)]);
    });
    let refused = take_tare(&mut FloorInput::from(source).source, &calibrated, Duration::from_secs(1), true)
        .unwrap_err();
    let TareFailure::NotQuiet { sensor, mean, .. } = &refused else { panic!("{refused}") };
    assert_eq!(sensor.tile, TileId::new(2, 1));
    assert!(mean.0 > 60.0, "{mean:?}");
    assert!(refused.to_string().contains("tile (2, 1)"), "{refused}");
}

#[test]
fn something_light_that_was_not_there_at_the_last_tare_is_noticed() {
    let floor = small_floor();
    let sim = simulated(&floor);
    let mut calibrated = sim::calibrated(&floor, &sim, 1).unwrap();
    calibrated.tared = Some(Day::of_unix_seconds(0));
    // A bag of 4 kg, still and spread over a tile: no sensor carries much.
    let at = floor.geometry.centre(TileId::new(1, 0));
    let bag = Load { print: Print::Point, position: at, heading: 0.0, force: Newtons(40.0) };
    let tare = |accept_change| {
        let source = UdpSource::bind(ANY_PORT, &calibrated).unwrap();
        let to = source.local_addr().unwrap();
        let _sender = Sender::start(&floor, sim.clone(), to, move |sim, _| {
            sim.step_under([bag]);
        });
        take_tare(&mut FloorInput::from(source).source, &calibrated, Duration::from_secs(10), accept_change)
    };
    let refused = tare(false).unwrap_err();
    let TareFailure::Changed { tile, change } = refused else { panic!("{refused}") };
    assert_eq!(tile, TileId::new(1, 0));
    assert!((change.0 - 40.0).abs() < 8.0, "{change:?}");
    assert!(tare(true).is_ok());
}

#[test]
fn boards_that_send_nothing_and_broken_sensors_are_named() {
    let floor = small_floor();
    let sim = simulated(&floor);
    let calibrated = sim::calibrated(&floor, &sim, 1).unwrap();
    let source = UdpSource::bind(ANY_PORT, &calibrated).unwrap();
    // Only the southern row's board is connected.
    let southern = Floor { boards: floor.boards[..1].to_vec(), ..floor.clone() };
    let half = SimFloor::new(&southern, SimConfig::default(), 7);
    let sender = Sender::start(&southern, half, source.local_addr().unwrap(), |sim, _| {
        sim.step(&[]);
    });
    let refused =
        take_tare(&mut FloorInput::from(source).source, &calibrated, Duration::from_millis(700), false)
            .unwrap_err();
    drop(sender);
    let TareFailure::Silent { boards } = refused else { panic!("{refused}") };
    assert_eq!(boards, ["/underfoot/board/1"]);

    let source = UdpSource::bind(ANY_PORT, &calibrated).unwrap();
    let mut broken = sim;
    let sensor = SensorId { tile: TileId::new(0, 1), corner: Corner::SouthEast };
    broken.set_fault(sensor, Some(SensorFault::Short));
    let _sender = Sender::start(&floor, broken, source.local_addr().unwrap(), |sim, _| {
        sim.step(&[]);
    });
    let refused = take_tare(&mut FloorInput::from(source).source, &calibrated, Duration::from_secs(1), false)
        .unwrap_err();
    assert!(matches!(refused, TareFailure::NotQuiet { sensor: named, .. } if named == sensor), "{refused}");
}

#[test]
fn a_press_is_measured_over_real_packets() {
    let floor = small_floor();
    let sim = simulated(&floor);
    let calibrated = sim::calibrated(&floor, &sim, 1).unwrap();
    let mut source = UdpSource::bind(ANY_PORT, &calibrated).unwrap();
    let at = floor.geometry.centre(TileId::new(1, 1));
    // Half a second empty, then 200 N in the middle of a tile until the end.
    let _sender = Sender::start(&floor, sim, source.local_addr().unwrap(), move |sim, millis| {
        let press = Load { print: Print::Point, position: at, heading: 0.0, force: Newtons(200.0) };
        sim.step_under((millis >= 500).then_some(press));
    });
    let mut assembler = Assembler::new(&calibrated);
    let mut watch = ForceWatch::new(&calibrated);
    while watch.frames() < 2000 {
        match source.next(Duration::from_millis(5)).unwrap() {
            Some(packet) => assembler.take(&packet),
            None => assembler.poll(source.now()),
        }
        while let Some(frame) = assembler.ready() {
            watch.take(frame);
        }
    }
    let ranges: Vec<_> = watch.ranges().collect();
    let pressed = &ranges[floor.geometry.index(TileId::new(1, 1)).unwrap()];
    assert!(pressed.force.least_n.abs() < 1.0, "{pressed:?}");
    assert!((150.0..250.0).contains(&pressed.force.median_n), "{pressed:?}");
    assert!(pressed.force.greatest_n < 260.0, "{pressed:?}");
    assert!(pressed.sensors.iter().all(|sensor| (20.0..90.0).contains(&sensor.greatest_n)), "{pressed:?}");
    assert!(ranges[0].force.greatest_n < 1.0, "{:?}", ranges[0]);
    assert_eq!(watch.heaviest().unwrap().0, TileId::new(1, 1));
}

#[test]
fn a_sensor_at_its_end_is_left_out_of_the_fit() {
    let points = |most: u16| -> String {
        (1..=40_u16)
            .map(|step| {
                let counts = most / 40 * step;
                format!("0,0,sw,{counts},{}\n", Calibration::NOMINAL.force(counts).0)
            })
            .collect()
    };
    let text =
        format!("col,row,corner,counts,newtons\n{}0,0,sw,65535,900\n0,0,sw,65535,1500\n", points(60_000));
    let table = LoadTable::read(text.as_bytes(), &Geometry::default()).unwrap();
    assert_eq!((table.sensors[0].points.len(), table.sensors[0].saturated), (40, 2));
    let Fit { calibration, residual } = table.sensors[0].judge().fit.unwrap();
    assert!((calibration.numbers()[0] - 0.5).abs() < 1e-3 && residual < 1e-3, "{calibration:?}");
}
