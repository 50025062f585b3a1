"""User interfaces on a force-sensing floor; the types and what they do stand in __init__.pyi."""

import asyncio
from typing import NamedTuple

from ._underfoot import Event, Refused, Session

__all__ = ["Contact", "Event", "Floor", "Refused", "listen"]

# How often `async for` looks for events, in seconds: as often as the floor renews what it shows.
_LOOK_EVERY = 0.005


class Contact(NamedTuple):
    id: int
    x_m: float
    y_m: float
    force_n: float
    x_velocity_m_s: float
    y_velocity_m_s: float


class Floor(Session):
    def contacts(self):
        return [Contact(*foot) for foot in super().contacts()]

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


def listen(address, layout, *, floor=None, every_change=False):
    return Floor(address, layout, floor=floor, every_change=every_change)
