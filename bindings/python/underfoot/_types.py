"""The data of a floor: events, controls, feet. Metres, newtons, seconds; x east and y north from the south-west corner.

An event is one of the classes of `AnyEvent`, a union that `match` and `event.kind` narrow:

    match event:
        case ChangedEvent("zoom", float(zoom)): ...
        case ControlEvent("home", "clicked"): ...
        case LinkEvent("lost"): ...
        case EndedEvent(reason, message): ...
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple, TypedDict, Union

Value = Union[bool, float, int, tuple[float, float]]
"""The value of a control: True or False, a number, the number of a choice, or two numbers."""

OffName = Literal[
    "disabled",
    "waiting",
    "boards_swapped",
    "not_calibrated",
    "other_floor",
    "link_lost",
    "sensor_trouble",
    "repeated_readings",
    "coarse_readings",
    "other_held",
    "slow_readings",
]
"""The reason why no foot can press a control."""

IgnoredName = Literal[
    "step",
    "object",
    "stance",
    "outside_region",
    "other_foot",
    "slid_on",
    "not_seen_unloaded",
    "unbelieved",
    "guard",
    "too_light",
    "too_short",
    OffName,
]
"""The reason why a control ignored a press; for a control that is off, the reason for that."""

ControlName = Literal[
    "pressed",
    "released",
    "cancelled",
    "clicked",
    "double_tapped",
    "long_pressed",
    "hard_pressed",
    "hard_released",
    "ticked",
    "armed",
    "disarmed",
    "warned",
    "refused",
]
"""The word for a foot's action on a control, for events without further data."""

LinkName = Literal["waiting", "live", "partial", "lost"]
Lamp = Literal["off", "on", "busy", "attention"]


class Contact(NamedTuple):
    """A foot on the floor."""

    id: int
    x_m: float
    y_m: float
    force_n: float
    x_velocity_m_s: float
    y_velocity_m_s: float


class Off(NamedTuple):
    """The reason why no foot can press a control."""

    reason: OffName
    text: str
    """The reason in a sentence, with the floor file concerned."""


class State(TypedDict):
    """The state of a control."""

    value: Value | None
    label: str
    enabled: bool
    off: Off | None
    locked: bool
    pressed: bool
    armed: bool
    indicator: Lamp
    range: tuple[float, float] | tuple[tuple[float, float], tuple[float, float]] | None
    """Least and greatest of a number, or of both numbers of a pair."""
    step: float | None
    """The step of a number; None if it has none."""
    options: list[str] | None
    """The names of a selector's options."""
    page: str | None
    """The page that it is on; None if it is on all."""


@dataclass(frozen=True)
class Event:
    """The fields of all events. `case Event(id, name, value)` matches each of them."""

    __match_args__: ClassVar[tuple[str, ...]] = ("id", "name", "value")

    t_s: float
    """Time of the event, on the floor's sample clock."""
    kind: Literal[
        "control",
        "ignored",
        "state",
        "page",
        "link",
        "link_cause",
        "health",
        "device",
        "mute",
        "crack",
        "sent",
        "ended",
    ]
    name: str
    """The word for the event, as in JSON lines: of a control "pressed", "released", "changed" and so on."""
    id: str
    """The control or page of the event; empty for an event of the floor."""
    value: Value | str | None
    """The new value of "changed", the direction of "swiped"; None for all others."""
    force_n: float
    x_m: float
    y_m: float
    contact: int | None
    """The number of the foot that caused it; None if no foot did."""
    text: str
    """Of a link "waiting", "live", "partial" or "lost"; of its cause a name, a colon and a sentence, empty when it is
    over; of an ignored press likewise; of the end the reason; empty otherwise."""


@dataclass(frozen=True)
class ChangedEvent(Event):
    """A foot changed the value of a control."""

    __match_args__ = ("id", "value")
    kind: Literal["control"]
    name: Literal["changed"]
    value: Value


@dataclass(frozen=True)
class SwipedEvent(Event):
    """A foot swiped over a control; `value` is the direction."""

    __match_args__ = ("id", "value")
    kind: Literal["control"]
    name: Literal["swiped"]
    value: Literal["north", "east", "south", "west"]


@dataclass(frozen=True)
class ControlEvent(Event):
    """A foot did something else to a control: `name` is the word for it."""

    __match_args__ = ("id", "name")
    kind: Literal["control"]
    name: ControlName
    value: None


@dataclass(frozen=True)
class IgnoredEvent(Event):
    """The control `id` ignored the foot `contact`, which has left it; `force_n` is the greatest force."""

    __match_args__ = ("id", "reason")
    kind: Literal["ignored"]
    name: Literal["ignored"]
    value: None
    reason: IgnoredName
    message: str
    """The reason in a sentence."""


@dataclass(frozen=True)
class StateEvent(Event):
    """The state of the control `id`: an app changed or asked for it, or a guarded control went off or on."""

    __match_args__ = ("id",)
    kind: Literal["state"]
    name: Literal["state"]
    value: None


@dataclass(frozen=True)
class PageEvent(Event):
    """The page `id` is shown."""

    __match_args__ = ("id",)
    kind: Literal["page"]
    name: Literal["page"]
    value: None


@dataclass(frozen=True)
class LinkEvent(Event):
    """Whether packets arrive; "lost" has cancelled all holds."""

    __match_args__ = ("text",)
    kind: Literal["link"]
    name: Literal["link"]
    value: None
    text: LinkName


@dataclass(frozen=True)
class LinkCauseEvent(Event):
    """The reason why boards that send give no usable frame, or why no load was ever seen; or its end."""

    __match_args__ = ("cause", "message")
    kind: Literal["link_cause"]
    name: Literal["link_cause"]
    value: None
    cause: str | None
    """A stable name, such as "rate_low"; None when it is over."""
    message: str
    """The cause in a sentence; empty when it is over."""


@dataclass(frozen=True)
class FloorEvent(Event):
    """The state of the sensors, of the device that moves the actuators, or of the muted set has changed."""

    __match_args__ = ("name",)
    kind: Literal["health", "device", "mute"]
    name: Literal["health", "device", "mute"]
    value: None


@dataclass(frozen=True)
class CrackEvent(Event):
    """A ground cracked at `x_m`, `y_m`."""

    __match_args__ = ("x_m", "y_m", "energy_j")
    kind: Literal["crack"]
    name: Literal["crack"]
    value: None
    seed: int
    energy_j: float


@dataclass(frozen=True)
class SentEvent(Event):
    """The control or region `id` gives a message to another program, which the session does not send."""

    __match_args__ = ("id", "target", "message")
    kind: Literal["sent"]
    name: Literal["sent"]
    value: None
    target: str
    """The name of the target in the layout."""
    message: str
    """The content, such as "key Right"."""


@dataclass(frozen=True)
class EndedEvent(Event):
    """The last event: nothing is held any more, and no event follows."""

    __match_args__ = ("reason", "message")
    kind: Literal["ended"]
    name: Literal["ended"]
    value: None
    reason: Literal["stopped", "source_ended", "failed", "panicked"]
    message: str
    """The message of the failure; empty otherwise."""


AnyEvent = Union[
    ChangedEvent,
    SwipedEvent,
    ControlEvent,
    IgnoredEvent,
    StateEvent,
    PageEvent,
    LinkEvent,
    LinkCauseEvent,
    FloorEvent,
    CrackEvent,
    SentEvent,
    EndedEvent,
]


def event_of(kind, name, id, value, text, message, when_and_where):  # type: ignore[no-untyped-def]
    """The event with these fields, which come from the library."""
    t_s, force_n, x_m, y_m, contact = when_and_where
    seen = dict(t_s=t_s, name=name, id=id, force_n=force_n, x_m=x_m, y_m=y_m, contact=contact)
    if kind == "control":
        made = {"changed": ChangedEvent, "swiped": SwipedEvent}.get(name, ControlEvent)
        return made(kind=kind, value=value, text="", **seen)
    if kind == "crack":
        seed, energy_j = value
        return CrackEvent(kind=kind, value=None, text="", seed=seed, energy_j=energy_j, **seen)
    if kind == "link_cause":
        cause, _, sentence = message.partition(": ")
        return LinkCauseEvent(
            kind=kind, value=None, text=message, cause=cause or None, message=sentence, **seen
        )
    if kind == "ignored":
        said = "%s: %s" % (text, message)
        return IgnoredEvent(kind=kind, value=None, text=said, reason=text, message=message, **seen)
    if kind == "sent":
        target, _, content = message.partition(": ")
        return SentEvent(kind=kind, value=None, text=message, target=target, message=content, **seen)
    if kind == "ended":
        said = "%s: %s" % (text, message) if message else text
        return EndedEvent(kind=kind, value=None, text=said, reason=text, message=message, **seen)
    made = {"state": StateEvent, "page": PageEvent, "link": LinkEvent}.get(kind, FloorEvent)
    return made(kind=kind, value=None, text=text, **seen)
