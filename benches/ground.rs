//! The ground's part of a frame, of a snapshot and of a drawing, on a pond with 2,000 pieces of crack.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::Vec2;
use smallvec::smallvec;
use underfoot::engine::Snapshot;
use underfoot::floor::Geometry;
use underfoot::glam;
use underfoot::ground::Grounds;
use underfoot::schema::{Kinds, builtin_layout, parse_layout};
use underfoot::sense::{Contact, ContactId, ForceFrame, TileLoad};
use underfoot::units::{Instant, Newtons};
use underfoot_scene::scene::{self, Scene, Theme, View};

/// Number of pieces of crack at which the stamping ends.
const PIECES: usize = 2000;

struct Stamper {
    grounds: Grounds,
    geometry: Geometry,
    frame: ForceFrame,
    before: ForceFrame,
    millis: u64,
}

impl Stamper {
    fn step(&mut self) {
        self.millis += 1;
        self.before.at = self.frame.at;
        self.frame.at = Instant::from_millis(self.millis);
        let (step, within) = (self.millis / 200, self.millis % 200);
        let index = (step * 7 % 36) as usize;
        self.frame.forces.fill([0.0; 4]);
        let force = 1000.0 * (within as f32 / 40.0).min(1.0);
        if let Some(tile) = self.frame.forces.get_mut(index) {
            *tile = [0.25 * force; 4];
        }
        let tile = self.geometry.tile_at_index(index);
        let aside = Vec2::new((step % 5) as f32 - 2.0, (step % 3) as f32 - 1.0) * 0.05;
        let place = self.geometry.centre(tile) + aside;
        let load = TileLoad { tile, index, force: Newtons(force), centroid: place };
        let contact = Contact {
            id: ContactId(step as u32),
            centroid: place,
            force: load.force,
            tiles: smallvec![load],
            ..Contact::default()
        };
        black_box(self.grounds.step(&self.frame, &self.before, &[contact], 0));
    }
}

fn ground(criterion: &mut Criterion) {
    let geometry = Geometry::default();
    let text = builtin_layout("pond").unwrap_or_default();
    let Ok(loaded) = parse_layout(text, "pond", &Kinds::builtin(), &geometry) else { return };
    let frame = ForceFrame::empty(&geometry);
    let grounds = Grounds::new(loaded.layout.grounds.iter().map(|ground| ground.spec), &geometry);
    let mut stamper = Stamper { grounds, geometry, before: frame.clone(), frame, millis: 0 };
    let mut snapshot = Snapshot::default();
    let pieces = |snapshot: &Snapshot| snapshot.grounds.first().map_or(0, |state| state.cracks.len());
    // Within the time in which ice heals.
    while pieces(&snapshot) < PIECES && stamper.millis < 80_000 {
        (0..200).for_each(|_| stamper.step());
        stamper.grounds.show(&mut snapshot.grounds);
    }
    snapshot.at = Instant::from_millis(stamper.millis);
    println!("{} pieces of crack after {} s of stamping", pieces(&snapshot), stamper.millis / 1000);
    criterion.bench_function("frame, stamping", |bench| bench.iter(|| stamper.step()));
    criterion.bench_function("snapshot", |bench| {
        bench.iter(|| {
            stamper.step();
            stamper.grounds.show(black_box(&mut snapshot.grounds));
        });
    });
    let mut scene = Scene::new();
    let view = View::new(&geometry, &loaded.layout, &snapshot, &Theme::LIGHT);
    criterion.bench_function("picture", |bench| bench.iter(|| scene::draw(&mut scene, black_box(&view))));
    println!("{} marks", scene.marks().len());
}

criterion_group!(benches, ground);
criterion_main!(benches);
