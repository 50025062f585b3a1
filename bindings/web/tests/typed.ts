// What the types of the package accept, and what they must not: `tsc --strict`.
import { BELIEVED_FOR, connect, type Contact, type Control, type EndOfHold, type Floor } from "underfoot";

const floor: Floor = connect("127.0.0.1:9002");
const limit: number = BELIEVED_FOR;
const zoom: Control | undefined = floor.controls.get("zoom");
const place: number = (zoom?.x_m ?? 0) + (zoom?.width_m ?? 0) + limit;
const forces: number[] = floor.contacts.map((contact: Contact) => contact.force_n + place);
if (zoom?.off === "link_lost" && floor.link === "partial") console.log(zoom.off_text, forces);

const off: () => void = floor.on("clicked", "home", ({ id, force_n }) => console.log(id, force_n));
floor.on("changed", ({ value }) => console.log(typeof value === "number" ? value.toFixed(1) : value));
floor.on("swiped", "wheel", ({ value }) => { const way: "north" | "east" | "south" | "west" = value; console.log(way); });
floor.on("ignored", ({ reason, why }) => { if (reason !== "too_light") console.log(why); });
floor.on("held", "beam", ({ held, why }) => console.log(held, why));
floor.on("contacts", (contacts) => console.log(contacts.length));
floor.on("line", (line) => console.log(line.event));
floor.whileHeld("beam", () => {});
floor.whileHeld("beam", (id) => (why: EndOfHold) => console.log(id, why));
const sent: boolean = floor.set("zoom", 0.5) && floor.set("pad", [0, 1]) && floor.request("mute/set", 1);
floor.setIndicator("zoom", sent ? "busy" : "off");
off();

// @ts-expect-error: no such event
floor.on("clickt", "home", () => {});
// @ts-expect-error: not an event of one control
floor.on("contacts", "home", () => {});
// @ts-expect-error: a click has no value
floor.on("clicked", ({ value }) => value.toFixed());
// @ts-expect-error: no such lamp
floor.setIndicator("zoom", "green");
// @ts-expect-error: a number or two
floor.set("zoom", [1, 2, 3]);
// @ts-expect-error: the floor says where a control is
floor.controls.get("zoom")!.x_m = 1;
// @ts-expect-error: the link is no such state
if (floor.link === "up") off();
