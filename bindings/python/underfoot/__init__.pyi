"""User interfaces on a force-sensing floor.

Metres, newtons, seconds; x east and y north from the floor's south-west corner.

    with underfoot.listen("127.0.0.1:9000", "map.ron") as floor:
        for event in floor:
            print(event)
"""

from os import PathLike
from types import TracebackType
from typing import Literal, NamedTuple, final

Value = bool | float | int | tuple[float, float]

class Refused(Exception):
    """The floor does not do what was asked: locked, in use by a foot, only for feet, out of range, or over."""

@final
class Event:
    """One thing that happened. `match event: case Event("zoom", "changed", value)` works."""

    __match_args__ = ("id", "name", "value")
    t_s: float
    """When, on the floor's sample clock."""
    kind: Literal[
        "control", "state", "page", "link", "link_cause", "health", "device", "mute", "crack", "ended"
    ]
    name: str
    """The word for what happened, as in JSON lines: of a control "pressed", "released", "changed" and so on."""
    id: str
    """The control or page it is about; empty where it is about the floor."""
    value: Value | str | None
    """The new value of "changed", the direction of "swiped"; None of all others."""
    force_n: float
    x_m: float
    y_m: float
    contact: int | None
    """Which foot did it; None if none did."""
    text: str
    """Of a link "waiting", "live", "partial" or "lost"; of its cause a name, a colon and a sentence, empty when it is
    over; of the end why; empty otherwise."""

class Contact(NamedTuple):
    """A foot on the floor."""

    id: int
    x_m: float
    y_m: float
    force_n: float
    x_velocity_m_s: float
    y_velocity_m_s: float

class Floor:
    """A floor at work on a thread of its own. Ends with `with`, with `close`, and when nobody has it any more."""

    def __init__(
        self,
        address: str,
        layout: str | PathLike[str],
        *,
        floor: str | PathLike[str] | None = None,
        every_change: bool = False,
    ) -> None: ...
    def __enter__(self) -> Floor: ...
    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None: ...
    async def __aenter__(self) -> Floor: ...
    async def __aexit__(self, *_: object) -> None: ...
    def __iter__(self) -> Floor: ...
    def __next__(self) -> Event: ...
    def __aiter__(self) -> Floor: ...
    async def __anext__(self) -> Event: ...
    def next_event(self, timeout: float | None = None) -> Event | None:
        """The next event within `timeout` seconds, 0 for now, None for ever; None if there is none.

        Other threads run meanwhile, and Ctrl-C ends it."""
    @property
    def over(self) -> bool:
        """Whether the last event, "ended", was taken, or the floor is closed."""
    def stop(self) -> None:
        """Ends the floor: what is held is cancelled and "ended" follows. Does not wait."""
    def close(self) -> None:
        """Ends the floor and waits for it."""
    def held(self, id: str) -> bool:
        """Whether a foot holds the control now, and the floor has said so within the last 100 ms.

        To be asked at least every 20 ms while something acts: silence means released. Not a safety function."""
    @property
    def dropped(self) -> int:
        """Events that were dropped because nobody took them."""
    @property
    def page(self) -> str | None: ...
    @property
    def link(self) -> Literal["waiting", "live", "partial", "lost"]: ...
    @property
    def link_cause(self) -> tuple[str, str] | None:
        """Why boards that send give no usable frame, or why no load was ever seen: a name that never changes, such as
        "rate_low", and a sentence. None if all is well or nothing is sent."""
    def __getitem__(self, id: str) -> Value | None:
        """What the control holds; None for a button. KeyError for an unknown one."""
    def __setitem__(self, id: str, value: Value) -> None:
        """KeyError, TypeError or Refused say why it stays as it was."""
    def __contains__(self, id: str) -> bool: ...
    def ids(self) -> list[str]: ...
    def state(self, id: str) -> dict[str, object]:
        """value, label, enabled, locked, pressed, armed, indicator."""
    def set_range(self, id: str, least: float, greatest: float) -> None: ...
    def set_label(self, id: str, label: str) -> None: ...
    def set_indicator(self, id: str, lamp: Literal["off", "on", "busy", "attention"]) -> None: ...
    def set_enabled(self, id: str, enabled: bool) -> None: ...
    def set_locked(self, id: str, locked: bool) -> None: ...
    def set_page(self, page: str) -> None: ...
    def contacts(self) -> list[Contact]: ...
    def forces(self) -> list[float]:
        """Newtons on each tile, row by row from the south-west; numpy.array(...) takes it as it is."""

def listen(
    address: str,
    layout: str | PathLike[str],
    *,
    floor: str | PathLike[str] | None = None,
    every_change: bool = False,
) -> Floor:
    """A floor whose boards send to `address`, with the page of controls in the file `layout`.

    `floor` is the floor file; without it, the paper's floor of 6 x 6 tiles. With `every_change` no value of a control
    is left out when the program is slow. ValueError says what is wrong with a file, OSError with the address."""
