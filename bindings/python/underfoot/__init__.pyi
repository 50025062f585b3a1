"""User interfaces on a force-sensing floor.

Metres, newtons, seconds; x east and y north from the floor's south-west corner.

    with underfoot.simulated("map.ron") as floor:
        for event in floor:
            print(event)
"""

from os import PathLike
from types import TracebackType
from typing import Literal

from ._types import AnyEvent as AnyEvent
from ._types import ChangedEvent as ChangedEvent
from ._types import Contact as Contact
from ._types import ControlEvent as ControlEvent
from ._types import CrackEvent as CrackEvent
from ._types import EndedEvent as EndedEvent
from ._types import Event as Event
from ._types import FloorEvent as FloorEvent
from ._types import IgnoredEvent as IgnoredEvent
from ._types import Lamp, LinkName
from ._types import LinkCauseEvent as LinkCauseEvent
from ._types import LinkEvent as LinkEvent
from ._types import Off as Off
from ._types import PageEvent as PageEvent
from ._types import SentEvent as SentEvent
from ._types import State as State
from ._types import StateEvent as StateEvent
from ._types import SwipedEvent as SwipedEvent
from ._types import Value as Value

__version__: str

class Refused(Exception):
    """The floor refuses: the control is locked, in use or for feet only, the value is NaN, or the floor ended."""

class Floor:
    """A floor that runs on a thread of its own. It ends with `with`, with `close`, and when it is garbage-collected.

    KeyError names a control that the layout lacks, with the nearest name; or a page, with the names of all."""

    def __init__(self, started: object) -> None:
        """Use `listen`, `replay` and `simulated`."""
    def __enter__(self) -> Floor: ...
    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None: ...
    async def __aenter__(self) -> Floor: ...
    async def __aexit__(self, *_: object) -> None: ...
    def __iter__(self) -> Floor: ...
    def __next__(self) -> AnyEvent: ...
    def __aiter__(self) -> Floor: ...
    async def __anext__(self) -> AnyEvent: ...
    def next_event(self, timeout: float | None = None) -> AnyEvent | None:
        """The next event within `timeout` seconds, 0 for now, None for ever; None if there is none.

        Other threads run meanwhile, and Ctrl-C ends it."""
    @property
    def over(self) -> bool:
        """Whether the program has taken the last event, "ended", or the floor is closed."""
    def stop(self) -> None:
        """Ends the floor: cancels all holds, and "ended" follows. Does not wait."""
    def close(self) -> None:
        """Ends the floor and waits for it."""
    def held(self, id: str) -> bool:
        """Whether a foot holds the control now, and the floor has reported that within the last 100 ms.

        Call it at least every 20 ms while something acts: silence means released. Not a safety function. False on a
        closed floor; KeyError for a control that the layout lacks, which would never be held."""
    @property
    def address(self) -> str | None:
        """The address for boards, with the port that the system chose for port 0; None for a recording and for a
        simulated floor."""
    @property
    def dropped(self) -> int:
        """Number of events that were dropped because the program did not take them."""
    @property
    def page(self) -> str | None: ...
    @property
    def link(self) -> LinkName: ...
    @property
    def link_cause(self) -> tuple[str, str] | None:
        """The reason why boards that send give no usable frame, or why no load was ever seen: a stable name, such as
        "rate_low", and a sentence. None if all is well or no board sends."""
    def __getitem__(self, id: str) -> Value | None:
        """The value of the control; None for a button."""
    def __setitem__(self, id: str, value: Value) -> None:
        """Sets the value. A number beyond the control's range becomes the nearest end of the range, and one between two
        steps the nearer step. KeyError, TypeError or Refused give the reason why it stays unchanged; NaN is refused,
        and so is a choice that a selector lacks."""
    def __contains__(self, id: str) -> bool: ...
    def ids(self) -> list[str]: ...
    def controls(self) -> dict[str, State]:
        """The state of each control, in the order of the layout."""
    def state(self, id: str) -> State: ...
    def off(self, id: str) -> Off | None:
        """The reason why no foot can press the control; None if one can."""
    def set_range(self, id: str, least: float, greatest: float) -> None: ...
    def set_label(self, id: str, label: str) -> None: ...
    def set_indicator(self, id: str, lamp: Lamp) -> None: ...
    def set_enabled(self, id: str, enabled: bool) -> None: ...
    def set_locked(self, id: str, locked: bool) -> None: ...
    def set_page(self, page: str) -> None: ...
    def contacts(self) -> list[Contact]: ...
    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of tiles."""
    def forces(self) -> memoryview[float]:
        """Newtons on each tile, row by row from the south-west, as single-precision numbers in one buffer:
        `numpy.asarray(floor.forces()).reshape(floor.shape)` copies nothing. It does not change afterwards."""

def listen(
    address: str,
    layout: str | PathLike[str],
    *,
    floor: str | PathLike[str] | None = None,
    every_change: bool = False,
) -> Floor:
    """Starts a floor with boards that send to `address`, and the page of controls in the file `layout`.

    `floor` is the floor file; without it, the paper's floor of 6 x 6 tiles. With `every_change` no value of a control
    is left out when the program is slow. ValueError describes an error in a file, OSError one of the address."""

def replay(
    recording: str | PathLike[str], *, speed: float | None = 1.0, every_change: bool = False
) -> Floor:
    """Replays a recorded floor, with its layout: the same events, at `speed` times the original speed, or with None as
    fast as possible. It ends with the recording. OSError gives the reason why the recording cannot be read."""

def simulated(
    layout: str | PathLike[str],
    scenario: str | PathLike[str] | None = None,
    *,
    quality: Literal["ideal", "paper", "slight", "moderate", "severe"] = "slight",
    every_change: bool = False,
) -> Floor:
    """Starts a simulated floor of 6 x 6 tiles, with the page of controls in the file `layout` and the people and faults
    of the file `scenario`; without it, the built-in scenario, which fits the shipped layout map.ron. `quality` is that
    of its plates and sensors.

    It runs in real time and ends with the scenario. ValueError describes an error in a file."""
