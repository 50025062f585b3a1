"""User interfaces on a force-sensing floor; __init__.pyi and _types.py describe the types."""

import asyncio

from . import _underfoot
from ._types import (
    AnyEvent,
    ChangedEvent,
    Contact,
    ControlEvent,
    CrackEvent,
    EndedEvent,
    Event,
    FloorEvent,
    IgnoredEvent,
    LinkCauseEvent,
    LinkEvent,
    Off,
    PageEvent,
    SentEvent,
    State,
    StateEvent,
    SwipedEvent,
    Value,
    event_of,
)
from ._underfoot import Refused, Session, __version__

__all__ = [
    "AnyEvent",
    "ChangedEvent",
    "Contact",
    "ControlEvent",
    "CrackEvent",
    "EndedEvent",
    "Event",
    "Floor",
    "FloorEvent",
    "IgnoredEvent",
    "LinkCauseEvent",
    "LinkEvent",
    "Off",
    "PageEvent",
    "Refused",
    "SentEvent",
    "State",
    "StateEvent",
    "SwipedEvent",
    "Value",
    "__version__",
    "listen",
    "replay",
    "simulated",
]

# Interval at which `async for` looks for events, in seconds: that of the floor's snapshots.
_LOOK_EVERY = 0.005


class Floor(Session):
    def next_event(self, timeout=None):
        fields = super().next_event(timeout)
        return None if fields is None else event_of(*fields)

    def __iter__(self):
        return self

    def __next__(self):
        event = self.next_event()
        if event is None:
            raise StopIteration
        return event

    def __aiter__(self):
        return self

    async def __anext__(self):
        while not self.over:
            event = self.next_event(0)
            if event is not None:
                return event
            await asyncio.sleep(_LOOK_EVERY)
        raise StopAsyncIteration

    async def __aenter__(self):
        return self

    async def __aexit__(self, *_):
        self.close()

    def contacts(self):
        return [Contact(*foot) for foot in super().contacts()]

    def forces(self):
        return memoryview(super().forces()).cast("f")

    def off(self, id):
        return self.state(id)["off"]

    def state(self, id):
        return _state(super().state(id))

    def controls(self):
        return {id: _state(state) for id, state in super().controls()}


def _state(state):
    if state["off"] is not None:
        state["off"] = Off(*state["off"])
    return state


def listen(address, layout, *, floor=None, every_change=False):
    return Floor(_underfoot.listen(address, layout, floor, every_change))


def replay(recording, *, speed=1.0, every_change=False):
    return Floor(_underfoot.replay(recording, speed, every_change))


def simulated(layout, scenario=None, *, quality="slight", every_change=False):
    return Floor(_underfoot.simulated(layout, scenario, quality, every_change))
