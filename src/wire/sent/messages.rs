//! The table: every message of a floor, apart from the events of its controls.

use super::FieldRange::{Flag, IgnoredReasons, Indicators, Measure, OffReasons, Pages, Text, Words};
use super::{Sent, arguments};
use crate::widget::Value;

/// Makes messages: `Name "address" report "meaning" answer "meaning" { arguments }`, and the list of their addresses.
macro_rules! messages {
    ($($name:ident $path:literal $(report $report:literal)? $(answer $answer:literal)? { $($fields:tt)* })+) => {
        $(
            arguments! {
                $(#[doc = $report])?
                $(#[doc = $answer])?
                $name { $($fields)* }
            }

            impl Sent for $name {
                const PATH: &'static str = $path;
                const REPORT: &'static str = concat!($($report)?);
                const ANSWER: &'static str = concat!($($answer)?);
            }
        )+

        /// The addresses of all messages; an address can occur several times.
        pub(super) const PATHS: &[&str] = &[$($path),+];
    };
}

messages! {
    Contacts "contacts" report "How many contacts follow; 100 times a second at most." {
        count: i32 = Text("0 or more"),
    }
    OneContact "contact" report "One contact, in the bundle of `contacts`." {
        id: i32 = Text("one for as long as it stays down"),
        x: f32 = Measure("m", "eastwards"),
        y: f32 = Measure("m", "northwards"),
        force: f32 = Measure("N", ""),
        x_velocity: f32 = Measure("m/s", ""),
        y_velocity: f32 = Measure("m/s", ""),
    }
    Alive "alive" report "The floor is served; 10 times a second." {
        sequence: i32 = Text("one more each time"),
    }
    Health "health"
    report "How boards and sensors are doing, when that changes; then up to eight sensors in trouble, a string each." {
        state: String = Words(&["waiting", "live", "partial", "lost"]),
        degraded: i32 = Text("sensors"),
        silent: i32 = Text("sensors"),
        faulty: i32 = Text("sensors"),
        uncalibrated: i32 = Text("sensors"),
        ..details: Vec<String>
    }
    Area "area" report "How an area stands, when that changes; told by a gateway." {
        area: String = Text(""),
        state: String = Words(&["waiting", "live", "lost", "disputed"]),
        why: String = Text("empty while it is live"),
        uncertainty: f32 = Measure("s", "of the times of its events"),
    }
    Device "device" report "The device that moves the actuators, when that changes." {
        device: String = Text(""),
        state: String = Words(&["playing", "lost", "faulty", "unfit"]),
        why: String = Text("empty while it plays"),
        channels: i32 = Text(""),
        sample_rate: i32 = Measure("Hz", ""),
        block: i32 = Text("frames"),
        underruns: i32 = Text(""),
        reopened: i32 = Text(""),
        priority: String = Words(&["real-time", "denied", "host"]),
    }
    Crack "crack" report "The ice has cracked; 200 times a second at most." {
        seed: i32 = Text("where cracks come from"),
        energy: f32 = Measure("J", ""),
        x: f32 = Measure("m", "eastwards"),
        y: f32 = Measure("m", "northwards"),
        skipped: i32 = Text("cracks since the last message that were not told"),
    }
    Page "page" report "Another page is shown." answer "The page that is shown." {
        page: String = Pages,
    }
    Mute "mute" report "Something was muted, or no longer." answer "The actuators that are muted." {
        all: bool = Flag,
        tiles: Vec<i32> = Text("column and row of each single tile, 100 at most"),
    }
    Error "error" answer "A request was refused." {
        address: String = Text("as it was asked"),
        why: String = Text(""),
    }

    Held "widget/<id>/held"
    report "Whether a foot holds it; 1 comes 50 times a second: not heard for 100 ms, it is released." {
        held: bool = Flag,
        sequence: i32 = Text("one more each time"),
    }
    Ignored "widget/<id>/ignored"
    report "A foot has left it, and it had ignored the press." {
        reason: String = IgnoredReasons,
        text: String = Text("the reason in a sentence"),
        force: f32 = Measure("N", "the greatest"),
        contact: i32 = Text("the id of the foot"),
    }
    ValueOfControl "widget/<id>/value"
    answer "Its value; sent to all listeners when an app asks for it or changes it." {
        ..value: Value
    }
    State "widget/<id>/state" answer "How it is; told to all likewise." {
        enabled: bool = Flag,
        locked: bool = Flag,
        pressed: bool = Flag,
        armed: bool = Flag,
        indicator: String = Indicators,
        label: String = Text(""),
    }
    Off "widget/<id>/off"
    answer "Why no foot can press it; told to all likewise, and when a `HoldToRun` control goes off or on." {
        reason: String = OffReasons,
        text: String = Text("the reason in a sentence, with the floor file it is about; may be empty"),
    }
    RangeOfNumber "widget/<id>/range" answer "The range of its value." {
        least: f32 = Text(""),
        greatest: f32 = Text(""),
        step: f32 = Text(""),
    }
    RangeOfPair "widget/<id>/range" answer "The range of its value." {
        x_least: f32 = Text(""),
        x_greatest: f32 = Text(""),
        y_least: f32 = Text(""),
        y_greatest: f32 = Text(""),
    }
    RangeOfChoices "widget/<id>/range" answer "The range of its value." {
        choices: Vec<String> = Text("the name of each"),
    }
    PageOfControl "widget/<id>/page" answer "Where it is." {
        page: String = Text("empty if it is on all"),
    }
}
