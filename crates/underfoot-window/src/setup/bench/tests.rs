//! The steps with a simulated floor, without a window.

use underfoot::floor::{Floor, Geometry, TileId};
use underfoot::serve::{StandNews, StandTask, WiringTask};

use crate::setup::site::Site;
use crate::setup::{
    FloorShape, GridShape, SetupAnswer, SetupBench, SetupOrder, SetupRequest, SetupStep, SetupView,
    StepState, WorkView,
};

/// A floor of `columns` x `rows` tiles, with a board for each row.
fn floor(columns: u16, rows: u16) -> Floor {
    Floor::of(Geometry::of_paper_tiles(columns, rows).unwrap())
}

fn grid(columns: u16, rows: u16) -> SetupOrder {
    SetupOrder::WriteFloor(FloorShape::Grid(GridShape::of_paper(columns, rows)))
}

/// A site whose floor file is written.
fn written(columns: u16, rows: u16) -> Site {
    let mut site = Site::new(floor(columns, rows));
    site.order(&SetupOrder::Go(SetupStep::Boards));
    site.hold(50, None);
    site.order(&grid(columns, rows));
    site
}

fn words(view: &SetupView, step: SetupStep) -> String {
    view.step(step).words.join(" ")
}

#[test]
fn no_step_on_the_floor_begins_before_there_is_a_floor_file() {
    let mut site = Site::new(floor(1, 1));
    for step in SetupStep::ALL.into_iter().filter(|step| step.needs_floor()) {
        site.order(&SetupOrder::Go(step));
        let view = site.bench.view();
        assert_eq!(view.step(step).state, StepState::Trouble);
        assert!(words(&view, step).contains("choose the floor's shape first"), "{view:?}");
    }
    site.order(&SetupOrder::Stand { weight_kg: 70.0, tiles: Vec::new() });
    site.order(&SetupOrder::OpenLayout);
    assert!(site.saved.is_empty() && site.opened == 0);
}

#[test]
fn a_shape_with_more_sensors_than_channels_is_written_and_the_lack_is_said() {
    let mut site = Site::new(floor(2, 1));
    site.order(&SetupOrder::Go(SetupStep::Boards));
    site.hold(50, None);
    site.order(&grid(2, 2));
    let view = site.bench.view();
    assert_eq!(view.step(SetupStep::Shape).state, StepState::Trouble);
    assert!(words(&view, SetupStep::Shape).contains("8 sensors have no channel"), "{view:?}");
    site.order(&grid(0, 2));
    assert!(words(&site.bench.view(), SetupStep::Shape).contains("1 to 256 columns"));
    site.order(&grid(2, 1));
    let view = site.bench.view();
    assert_eq!(view.step(SetupStep::Shape).state, StepState::Done);
    assert_eq!(site.saved.len(), 2);
    assert_eq!(site.saved[1].boards, site.wired.boards);
}

#[test]
fn a_file_that_cannot_be_written_leaves_the_floor_as_it_was() {
    let mut bench = SetupBench::new(None);
    bench.order(&grid(2, 2));
    let Some(SetupRequest::Save(_)) = bench.next_request() else { panic!() };
    bench.answer(SetupAnswer::Saved(Err("error: the disk is full".into())));
    let view = bench.view();
    assert!(view.floor.is_none());
    assert_eq!(words(&view, SetupStep::Shape), "error: the disk is full");
}

#[test]
fn a_foot_on_the_wrong_tile_twice_gives_no_wiring_and_the_walk_can_begin_anew() {
    let mut site = written(1, 2);
    site.order(&SetupOrder::Go(SetupStep::Wiring));
    site.hold(500, None);
    for _ in 0..2 {
        site.hold(300, Some(site.middle(TileId::new(0, 0))));
        site.hold(100, None);
    }
    let view = site.bench.view();
    assert!(words(&view, SetupStep::Wiring).contains("Walk again"), "{view:?}");
    assert_eq!((view.step(SetupStep::Wiring).state, site.saved.len()), (StepState::Trouble, 1));
    site.order(&SetupOrder::Go(SetupStep::Wiring));
    let view = site.bench.view();
    assert!(
        matches!(&view.work, WorkView::Wiring(walk) if walk.task == WiringTask::KeepOff && walk.steps.is_empty())
    );
    assert_eq!(view.step(SetupStep::Wiring).state, StepState::Open);
}

#[test]
fn a_person_who_stands_elsewhere_is_told_and_a_walk_without_stands_gives_no_laws() {
    let mut site = written(2, 1);
    site.order(&SetupOrder::Stand { weight_kg: 5000.0, tiles: Vec::new() });
    assert!(words(&site.bench.view(), SetupStep::Standing).contains("15 to 300 kg"));
    site.order(&SetupOrder::Stand { weight_kg: 50.0, tiles: vec![TileId::new(1, 0)] });
    site.hold(1800, None);
    let view = site.bench.view();
    let WorkView::Standing(walk) = &view.work else { panic!("{view:?}") };
    assert!(walk.marks.len() == 5 && walk.marks.iter().all(|mark| mark.tile == TileId::new(1, 0)));
    assert!(matches!(walk.task, StandTask::Go(_)), "{walk:?}");
    site.hold(4000, Some(site.middle(TileId::new(0, 0))));
    let view = site.bench.view();
    let WorkView::Standing(walk) = &view.work else { panic!("{view:?}") };
    assert!(
        matches!(walk.news, Some(StandNews::Elsewhere { felt, .. }) if felt == TileId::new(0, 0)),
        "{walk:?}"
    );
    site.is_on = false;
    site.hold(300, None);
    let view = site.bench.view();
    let WorkView::Standing(walk) = &view.work else { panic!("{view:?}") };
    assert_eq!(walk.trouble.as_deref(), Some("Nothing comes from /underfoot/board/0."));
    site.order(&SetupOrder::EndStanding);
    assert!(words(&site.bench.view(), SetupStep::Standing).contains("No stand was measured"));
    assert_eq!(site.saved.len(), 1, "only the shape");
}

#[test]
fn a_floor_on_which_somebody_walks_is_not_measured_as_empty_and_the_reason_is_said() {
    let mut site = written(1, 1);
    site.order(&SetupOrder::Stand { weight_kg: 50.0, tiles: Vec::new() });
    for _ in 0..20 {
        site.hold(200, Some(site.middle(TileId::new(0, 0))));
        site.hold(200, None);
    }
    let view = site.bench.view();
    let WorkView::Standing(walk) = &view.work else { panic!("{view:?}") };
    assert_eq!(walk.task, StandTask::KeepOff);
    assert!(walk.trouble.as_ref().is_some_and(|reason| reason.contains("something moves")), "{walk:?}");
    assert!(!view.is_rested);
    // The block of a second and a half in which the last foot leaves, and a quiet one.
    site.hold(4000, None);
    let view = site.bench.view();
    assert!(
        matches!(&view.work, WorkView::Standing(walk) if walk.trouble.is_none()) && view.is_rested,
        "{view:?}"
    );
}

#[test]
fn the_boards_are_left_to_the_layout_while_it_is_open() {
    let mut site = written(1, 1);
    site.order(&SetupOrder::OpenLayout);
    assert_eq!(site.opened, 1);
    assert!(matches!(site.bench.view().work, WorkView::Open));
    site.bench.answer(SetupAnswer::Closed(Err("The layout did not stay open.".into())));
    let view = site.bench.view();
    assert!(matches!(view.work, WorkView::Nothing));
    assert_eq!(view.step(SetupStep::Layout).state, StepState::Trouble);
}
