//! Pictures on the faces of controls.

use crate::widget::Behaviour;
use underfoot_format::Named;

/// A picture on a control's face, distinguishable from standing height.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Icon {
    /// An arrow to the north.
    Up,
    /// An arrow to the south.
    Down,
    /// An arrow to the west.
    Left,
    /// An arrow to the east.
    Right,
    /// A house.
    Home,
    /// An arrow that turns back.
    Back,
    /// A plus.
    Plus,
    /// A minus.
    Minus,
    /// A tick.
    Check,
    /// A cross.
    Cross,
    /// A triangle that points east.
    Play,
    /// Two bars.
    Pause,
    /// A square.
    Stop,
    /// A ring open to the north with a bar in its gap.
    Power,
    /// A light bulb.
    Light,
    /// A closed padlock.
    Lock,
    /// A camera.
    Camera,
    /// A magnifying glass.
    Search,
    /// Three lines.
    Menu,
    /// A bell.
    Bell,
    /// A loudspeaker.
    Sound,
    /// A question mark.
    Help,
}

impl Named for Icon {
    const ALL: &'static [(&'static str, Self)] = &Icon::ALL;
}

impl Icon {
    /// All icons with their names in layouts.
    pub const ALL: [(&'static str, Self); 22] = [
        ("Up", Self::Up),
        ("Down", Self::Down),
        ("Left", Self::Left),
        ("Right", Self::Right),
        ("Home", Self::Home),
        ("Back", Self::Back),
        ("Plus", Self::Plus),
        ("Minus", Self::Minus),
        ("Check", Self::Check),
        ("Cross", Self::Cross),
        ("Play", Self::Play),
        ("Pause", Self::Pause),
        ("Stop", Self::Stop),
        ("Power", Self::Power),
        ("Light", Self::Light),
        ("Lock", Self::Lock),
        ("Camera", Self::Camera),
        ("Search", Self::Search),
        ("Menu", Self::Menu),
        ("Bell", Self::Bell),
        ("Sound", Self::Sound),
        ("Help", Self::Help),
    ];

    /// Whether controls of this behaviour have room for an icon on their faces; the others show their value there.
    #[must_use]
    pub const fn is_shown_on(behaviour: &Behaviour) -> bool {
        matches!(behaviour, Behaviour::Button(_) | Behaviour::Hold(_) | Behaviour::Switch(_))
    }
}
