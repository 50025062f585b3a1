//! One area's computer finds the same feet in it as one for the whole floor.

use glam::Vec2;
use underfoot::floor::{Area, Floor, Geometry, TileBlock, TileId};
use underfoot::sense::{ForceFrame, Method, Sensing};
use underfoot::units::Instant;
use underfoot_sim::{Performance, Person, Script, SimConfig, SimFloor};

/// One computer: its area, and the part of the floor that it senses.
struct Computer {
    area: Area,
    floor: Floor,
    frame: ForceFrame,
    sensing: Sensing,
}

impl Computer {
    fn new(whole: &Floor, area: &Area) -> Self {
        let floor = whole.part(area).unwrap();
        let sensing = Sensing::new(floor.geometry, Method::Tracker);
        Self { area: area.clone(), frame: ForceFrame::empty(&floor.geometry), floor, sensing }
    }
}

#[test]
fn feet_that_cross_a_border_are_where_the_whole_floor_s_computer_finds_them() {
    let tiles = |column, columns| TileBlock { first: TileId::new(column, 0), columns, rows: 6 };
    let areas = [("west", tiles(0, 6)), ("east", tiles(6, 6))].map(|(id, tiles)| Area::new(id, tiles));
    let whole = Floor::of(Geometry::of_paper_tiles(12, 6).unwrap()).with_areas(areas.clone().into());
    let mut computers = areas.map(|area| Computer::new(&whole, &area));
    let mut sensing = Sensing::new(whole.geometry, Method::Tracker);
    let mut frame = ForceFrame::empty(&whole.geometry);

    // Two people meet at the border: one crosses eastwards, the other westwards.
    let size = whole.geometry.bounds().max;
    let walker = |mass_kg, seed, from: Vec2, to: Vec2| {
        let mut walker = Performance::new(Person { mass_kg, ..Person::default() }, seed);
        walker.appear(from, 0.0).unwrap();
        walker.walk(&[to, from]).unwrap();
        walker
    };
    let people = vec![
        walker(62.0, 1, Vec2::new(0.4, 0.5), Vec2::new(size.x - 0.4, 0.6)),
        walker(85.0, 2, Vec2::new(size.x - 0.4, 1.3), Vec2::new(0.4, 1.2)),
    ];
    let script = Script::new(people, whole.geometry.bounds());
    let mut sim = SimFloor::new(&whole, SimConfig::ideal(), 1);
    sim.step(&[]);
    let forces = |sim: &SimFloor, index| {
        sim.support_forces(index).unwrap_or_default().map(|force: underfoot::units::Newtons| force.0)
    };
    let empty: Vec<[f32; 4]> = (0..whole.geometry.tile_count()).map(|index| forces(&sim, index)).collect();
    let (mut feet, mut compared, mut astray) = (Vec::new(), 0, 0);
    for ms in 0..script.duration().as_millis() as u64 {
        let now = Instant::from_millis(ms);
        feet.clear();
        script.feet_at(now, &mut feet);
        sim.step(&feet);
        for (index, empty) in empty.iter().enumerate() {
            let now = forces(&sim, index);
            frame.forces[index] = std::array::from_fn(|corner| now[corner] - empty[corner]);
        }
        frame.at = now;
        let found: Vec<_> = sensing.update(&frame).to_vec();
        for computer in &mut computers {
            for (own, tile) in computer.floor.geometry.tiles().enumerate() {
                computer.frame.forces[own] = frame.forces[whole.geometry.index(tile).unwrap()];
            }
            computer.frame.at = now;
            let contacts = computer.sensing.update(&computer.frame);
            let is_own = |at: Vec2| computer.area.holds(&whole.geometry, at);
            for contact in found.iter().filter(|contact| contact.force.0 > 100.0 && is_own(contact.centroid))
            {
                let nearest = contacts.iter().map(|other| other.centroid.distance(contact.centroid));
                compared += 1;
                astray += usize::from(nearest.fold(f32::MAX, f32::min) > 0.001);
            }
        }
    }
    // Before a foot enters the sensed part of a computer, that computer knows less about its person.
    assert!(compared > 10_000, "{compared}");
    assert!(astray * 200 <= compared, "{astray} of {compared}");
}
