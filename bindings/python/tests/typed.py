"""The types of events for type checkers: `mypy --strict` passes this file, and needs each of its comments that
silence an error. It is checked and never run."""

from typing import Literal, assert_never, assert_type

import underfoot
from underfoot import AnyEvent, Off, State, Value


def by_class(event: AnyEvent) -> str:
    match event:
        case underfoot.ChangedEvent(id, float(number)):
            assert_type(number, float)
            return f"{id} is at {number:.2f}"
        case underfoot.ChangedEvent(id, value):
            return f"{id} is {value}"
        case underfoot.SwipedEvent(id, way):
            assert_type(way, Literal["north", "east", "south", "west"])
            return f"{id} to the {way}"
        case underfoot.ControlEvent(id, "pressed" | "released" as name):
            return f"{id} {name}"
        case underfoot.ControlEvent(value=nothing):
            assert_type(nothing, None)
            return event.name
        case underfoot.IgnoredEvent(id, "too_light" | "disabled" as why):
            return f"{id} {why}"
        case underfoot.IgnoredEvent(message=message):
            return message
        case underfoot.StateEvent(id) | underfoot.PageEvent(id):
            return id
        case underfoot.LinkEvent(state):
            assert_type(state, Literal["waiting", "live", "partial", "lost"])
            return state
        case underfoot.LinkCauseEvent(cause, message):
            return f"{cause or 'over'} {message}"
        case underfoot.FloorEvent(name):
            assert_type(name, Literal["health", "device", "mute"])
            return name
        case underfoot.CrackEvent(x_m, y_m, energy_j):
            return f"{x_m + y_m} {energy_j}"
        case underfoot.SentEvent(id, target, message):
            return f"{id} {target} {message}"
        case underfoot.EndedEvent(reason, message):
            assert_type(reason, Literal["stopped", "source_ended", "failed", "panicked"])
            return reason + message
        case _:
            # No case is left.
            assert_never(event)


def by_tag(event: AnyEvent) -> str:
    if event.kind == "ended" or event.kind == "ignored":
        return event.reason
    if event.kind == "crack":
        return f"{event.energy_j}"
    if event.name == "changed":
        assert_type(event.value, Value)
        return event.id
    if event.name == "swiped":
        return event.value.upper()
    # A pressed control has no value, and the events that are left have no reason.
    if event.name == "pressed":
        event.value.upper()  # type: ignore[attr-defined]
    event.reason  # type: ignore[union-attr]
    return event.text


def by_the_words_of_all(event: AnyEvent) -> None:
    match event:
        case underfoot.Event("zoom", "changed", value):
            print(value)


def follow(floor: underfoot.Floor) -> None:
    for event in floor:
        assert_type(event, AnyEvent)
        print(by_class(event), by_tag(event))
    assert_type(floor.next_event(0.01), AnyEvent | None)
    assert_type(floor.state("zoom"), State)
    assert_type(floor.state("zoom")["off"], Off | None)
    off = floor.off("zoom")
    if off is not None and off.reason == "not_calibrated":
        print(off.text)
    if off is not None and off.reason == "not_calibratd":  # type: ignore[comparison-overlap]
        print(off.text)
    total: float = sum(floor.forces())
    print(total, floor.shape[0], floor.address, underfoot.__version__)


async def follow_async() -> None:
    async with underfoot.replay("visit.mcap", speed=None) as floor:
        async for event in floor:
            print(by_class(event))


with underfoot.listen("127.0.0.1:9000", "map.ron") as floor:
    follow(floor)
with underfoot.simulated("map.ron", "visit.ron", every_change=True) as floor:
    follow(floor)
