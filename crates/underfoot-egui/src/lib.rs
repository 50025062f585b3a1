//! Feet on a force-sensing floor drive the widgets of an egui app.
//!
//! | an app | with |
//! |---|---|
//! | has its own buttons, sliders and maps pressed by feet | [`FootInput`], fed in `eframe::App::raw_input_hook` |
//! | has several sliders dragged by several feet at once | [`FootSlider`] |
//! | shows floor, feet and controls | [`FloorView`]; [`Projector`] for a projector above the floor |
//! | is tried without a floor | `SmallFloor` (feature `sim`), on which the mouse acts as a foot |
//!
//! Actions that must not happen by accident do not belong here: egui has no guards, supports one pointer and cannot
//! undo the beginning of a press. Such actions are controls of the floor's layout (`Confirm`, `HoldToRun`), and a
//! contact on one of those never reaches egui: only floor without controls is mapped.
//!
//! ```no_run
//! use underfoot::floor::Rect;
//! use underfoot::glam::Vec2;
//! use underfoot::runtime::Session;
//! use underfoot_egui::FootInput;
//!
//! struct App { floor: Session, feet: FootInput }
//!
//! impl App {
//!     fn new(floor: Session, context: &egui::Context) -> Self {
//!         FootInput::tune(context);
//!         // The floor from 0.9 m north on is the window.
//!         Self { floor, feet: FootInput::new(Rect::from_min_size(Vec2::new(0.0, 0.9), Vec2::new(1.8, 0.9))) }
//!     }
//!
//!     // What `eframe::App::raw_input_hook` calls.
//!     fn raw_input_hook(&mut self, context: &egui::Context, raw: &mut egui::RawInput) {
//!         self.feet.follow(context, &self.floor, raw);
//!     }
//! }
//! ```

mod input;
mod projector;
mod slider;
#[cfg(feature = "sim")]
mod small_floor;
mod touch;
mod view;

pub use input::FootInput;
pub use projector::Projector;
pub use slider::FootSlider;
#[cfg(feature = "sim")]
pub use small_floor::SmallFloor;
pub use view::FloorView;
