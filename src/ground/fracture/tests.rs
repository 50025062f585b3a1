//! Cracks under feet of many weights.

use rand::SeedableRng;

use super::*;

const RULES: CrackRules = CrackRules {
    apart_m: 0.25,
    per_j_m: 0.04,
    turn: 0.25,
    branch: 0.15,
    branch_rad: 0.7,
    most: 500,
    refreeze_s: Some(60.0),
};

fn pond() -> Rect {
    Rect::new(Vec2::ZERO, Vec2::splat(1.8))
}

fn at(seconds: f32) -> Instant {
    Instant::from_micros((seconds * 1e6) as u64)
}

#[test]
fn a_first_event_places_a_seed_with_two_cracks_and_later_ones_stay_with_it() {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let mut fracture = Fracture::new(RULES, pond());
    let middle = Vec2::splat(0.9);
    assert!(fracture.grow(middle, 1.0, at(0.0), &mut rng).is_new);
    let cracks: Vec<Crack> = fracture.cracks().copied().collect();
    assert_eq!(cracks.len(), 2, "two fronts are started at once");
    assert!(cracks.iter().all(|crack| crack.from == middle && (crack.length_m() - 0.04).abs() < 1e-5));
    // 24 cm away: the same seed. 26 cm: a new one.
    assert!(!fracture.grow(middle + Vec2::X * 0.24, 1.0, at(0.1), &mut rng).is_new);
    assert!(fracture.grow(middle + Vec2::X * 0.26, 1.0, at(0.2), &mut rng).is_new);
    assert_eq!(fracture.seeds().len(), 2);
}

#[test]
fn cracks_join_end_to_end_stay_on_the_sheet_and_cross_nothing() {
    for seed in 0..20 {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let mut fracture = Fracture::new(RULES, pond());
        for step in 0..400 {
            let place = Vec2::new(rng.random_range(-0.1..1.9), rng.random_range(-0.1..1.9));
            fracture.grow(place, rng.random_range(0.1..2.5), at(step as f32 * 0.01), &mut rng);
        }
        let cracks: Vec<Crack> = fracture.cracks().copied().collect();
        assert!(cracks.len() > 200, "{}", cracks.len());
        for (index, crack) in cracks.iter().enumerate() {
            for end in [crack.from, crack.to] {
                assert!(end == end.clamp(Vec2::ZERO, Vec2::splat(1.8)), "{end} is off the sheet");
            }
            assert!(crack.length_m() >= 0.99 * SHORTEST_M);
            for other in &cracks[..index] {
                // Cut a little off both ends, where cracks may touch.
                let (from, to) = (crack.from.lerp(crack.to, 0.02), crack.from.lerp(crack.to, 0.98));
                assert_eq!(other.met_by(from, to), None, "{crack:?} crosses {other:?}");
            }
        }
        for line in 0..fracture.next_line {
            let pieces: Vec<&Crack> = cracks.iter().filter(|crack| crack.line == line).collect();
            assert!(pieces.windows(2).all(|pair| pair[0].to == pair[1].from), "line {line} has a gap");
        }
        assert!(cracks.iter().any(|crack| crack.rank > 0), "some have branched");
    }
}

#[test]
fn memory_is_bounded_and_what_had_to_make_room_is_counted() {
    let mut rng = Pcg64Mcg::seed_from_u64(9);
    let rules = CrackRules { most: 100, branch: 1.0, ..RULES };
    let mut fracture = Fracture::new(rules, pond());
    let capacity = (fracture.cracks.capacity(), fracture.seeds.capacity());
    for step in 0..20_000 {
        let place = Vec2::new(rng.random_range(0.0..1.8), rng.random_range(0.0..1.8));
        fracture.grow(place, 0.5, at(step as f32 * 1e-3), &mut rng);
    }
    assert_eq!(fracture.cracks().len(), 100);
    assert!(fracture.evicted() > 1000, "{}", fracture.evicted());
    assert_eq!((fracture.cracks.capacity(), fracture.seeds.capacity()), capacity, "no memory was taken");
    let oldest = fracture.cracks().next().unwrap().born;
    assert!(fracture.cracks().all(|crack| crack.born >= oldest), "the oldest have healed first");
}

#[test]
fn a_pond_left_alone_freezes_over() {
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    let mut fracture = Fracture::new(RULES, pond());
    for step in 0..50 {
        fracture.grow(Vec2::splat(0.9), 0.5, at(step as f32), &mut rng);
    }
    fracture.heal(at(60.5));
    let left = fracture.cracks().len();
    assert!(left > 0 && fracture.cracks().all(|crack| crack.born > at(0.4)));
    fracture.heal(at(110.0));
    assert_eq!((fracture.cracks().len(), fracture.seeds().len()), (0, 0));
    // And cracks again from a new seed.
    assert!(fracture.grow(Vec2::splat(0.9), 0.5, at(111.0), &mut rng).is_new);
}

#[test]
fn a_front_that_met_something_takes_energy_as_width() {
    let mut rng = Pcg64Mcg::seed_from_u64(4);
    let rules = CrackRules { branch: 0.0, ..RULES };
    // A sheet the size of a hand: every front soon meets its edge.
    let mut fracture = Fracture::new(rules, Rect::new(Vec2::ZERO, Vec2::splat(0.1)));
    let mut put_in = 0.0;
    for step in 0..300 {
        let growth = fracture.grow(Vec2::splat(0.05), 0.5, at(step as f32 * 0.01), &mut rng);
        put_in += if growth.is_new { 1.0 } else { 0.5 };
    }
    let kept: f32 = fracture.cracks().map(|crack| crack.energy_j).sum();
    assert!(fracture.cracks().any(|crack| crack.energy_j > 2.0), "some gape");
    assert!(kept > 0.9 * put_in, "{kept} of {put_in} J");
}
