/** Time in milliseconds after its last report at which a hold ends. */
export const BELIEVED_FOR: number;

/**
 * Connects to a floor that `underfoot run --web` serves, and again whenever the connection ends: after 0.25 s at
 * most, then after twice that, up to 8 s.
 *
 * @param address Host and port, or a URL. Without it `127.0.0.1:9002`.
 * @throws SyntaxError if the address is no URL of a WebSocket.
 */
export function connect(address?: string): Floor;

/** A floor: its controls, holds and feet as they are now, events, and requests. */
export interface Floor {
  /** The URL of its WebSocket. */
  readonly url: string;
  /** The state of the link. */
  readonly link: LinkState;
  /** Why the floor does not work, as a sentence; empty if it does. */
  readonly why: string;
  /** Title of the layout; empty before the first connection, as the sizes are 0. */
  readonly title: string;
  /** The page that is shown; null without pages. */
  readonly page: string | null;
  /** Size of the floor eastwards, in metres. */
  readonly width_m: number;
  /** Size of the floor northwards, in metres. */
  readonly depth_m: number;
  /** Width of a tile, in metres. */
  readonly tile_m: number;
  /** The controls by their ids, as last reported; they stay after a lost connection. */
  readonly controls: ReadonlyMap<string, Control>;
  /** The feet on the floor; none without a connection. */
  readonly contacts: readonly Contact[];
  /** The ids of the controls that feet hold; none while the last report is older than `BELIEVED_FOR`. */
  readonly held: readonly string[];
  /** Number of messages that no floor sends. */
  readonly unreadable: number;

  /** Whether a foot holds this control. Right at any time, also where a busy page runs timers late. */
  isHeld(id: string): boolean;

  /**
   * Calls `begin` at the beginning of each hold of a control, and the function that it returns at the end of that
   * hold, exactly once, whatever ends it. Returns a function that ends this, and a hold with it.
   */
  whileHeld(id: string, begin: (id: string) => void | ((why: EndOfHold) => void)): () => void;

  /** Calls `call` for each event of a control. Returns a function that ends this. */
  on<E extends keyof ControlEvents>(event: E, id: string, call: (event: ControlEvents[E]) => void): () => void;
  /** Calls `call` for each event, of all controls if it is one of controls. Returns a function that ends this. */
  on<E extends keyof Events>(event: E, call: (event: Events[E]) => void): () => void;

  /**
   * Sends a request: an OSC address of the floor behind its prefix, and the arguments. Returns false without a
   * connection; it is not sent later. The floor reports a refusal as `error`.
   */
  request(path: string, ...args: readonly (number | boolean | string)[]): boolean;
  /** Sets the value of a control; a value beyond its range becomes the nearest end. Returns as `request` does. */
  set(id: string, value: number | boolean | readonly [number, number]): boolean;
  /** Sets least and greatest value of a slider, dial or stepper. Returns as `request` does. */
  setRange(id: string, least: number, greatest: number): boolean;
  /** Sets the text on a control. Returns as `request` does. */
  setLabel(id: string, text: string): boolean;
  /** Sets the lamp of a control. Returns as `request` does. */
  setIndicator(id: string, state: Indicator): boolean;
  /** Switches a control on or off. Returns as `request` does. */
  setEnabled(id: string, enabled: boolean): boolean;
  /** Locks the value of a control, or unlocks it. Returns as `request` does. */
  setLocked(id: string, locked: boolean): boolean;
  /** Shows a page. Returns as `request` does. */
  setPage(page: string): boolean;
  /** Ends all holds; a foot must lift and press again. Returns as `request` does. */
  cancel(): boolean;

  /** Ends holds and connection for good. */
  close(): void;
}

/** `no_connection` and `closed` are this package's; the others are the floor's words for the link to its boards. */
export type LinkState = "no_connection" | "closed" | "waiting" | "live" | "partial" | "lost";

/**
 * Why a hold has ended: the floor reports it no more; no report for `BELIEVED_FOR`; the connection is lost, or closed
 * by this page; the function that `whileHeld` returns was called.
 */
export type EndOfHold = "released" | "silence" | "no_connection" | "closed" | "unwatched";

/** A lamp. */
export type Indicator = "off" | "on" | "busy" | "attention";

/** The value of a control; null for a button. */
export type Value = number | boolean | [number, number] | null;

/** A control: its place on the floor and its state. */
export interface Control extends ControlState {
  /** Its kind in the layout. */
  readonly kind: string;
  /** South-west corner in metres, eastwards. */
  readonly x_m: number;
  /** South-west corner in metres, northwards. */
  readonly y_m: number;
  /** Size in metres, eastwards. */
  readonly width_m: number;
  /** Size in metres, northwards. */
  readonly depth_m: number;
}

/** The state of a control. */
export interface ControlState {
  readonly id: string;
  /** The text on it. */
  readonly label: string;
  /** Its page; null if it is on all. */
  readonly page: string | null;
  readonly value: Value;
  /** Least and greatest of a number, or those of both numbers of a pair; null otherwise. */
  readonly range: [number, number] | [[number, number], [number, number]] | null;
  /** Step of a number with steps; null otherwise. */
  readonly step: number | null;
  /** Options of a selector, with the number of one as the value; null otherwise. */
  readonly options: readonly string[] | null;
  /** False while an app or an error of the floor file keeps it off. */
  readonly enabled: boolean;
  /** The reason why no foot can press it, as a word; null if one can. */
  readonly off: OffReason | null;
  /** The same as a sentence. */
  readonly off_text: string | null;
  /** Whether it keeps its value. */
  readonly locked: boolean;
  /** Whether a foot has it pressed. */
  readonly pressed: boolean;
  /** Whether a first press has armed it. */
  readonly armed: boolean;
  readonly indicator: Indicator;
}

/** Why a control is off. */
export type OffReason =
  | "disabled" | "waiting" | "boards_swapped" | "not_calibrated" | "other_floor" | "link_lost" | "sensor_trouble"
  | "repeated_readings" | "coarse_readings" | "other_held" | "slow_readings";

/** An event of a control. */
export interface ControlEvent<V = Value | "north" | "east" | "south" | "west"> {
  /** Seconds on the floor's clock. */
  readonly t_s: number;
  readonly event: keyof ControlEvents;
  readonly id: string;
  /** The new value, or the direction of a swipe; null without one. */
  readonly value: V;
  /** Force of the foot, in newtons. */
  readonly force_n: number;
  /** Place of the foot in metres, eastwards. */
  readonly x_m: number;
  /** Place of the foot in metres, northwards. */
  readonly y_m: number;
  /** Number of the foot; null if no foot caused the event. */
  readonly contact: number | null;
}

/** A foot has left a control that ignored it. */
export interface IgnoredPress {
  readonly t_s: number;
  readonly event: "ignored";
  readonly id: string;
  /** The reason, as a word. */
  readonly reason: IgnoredReason;
  /** The reason, as a sentence. */
  readonly why: string;
  /** Greatest force, in newtons. */
  readonly force_n: number;
  readonly contact: number;
}

/** Why a press was ignored. */
export type IgnoredReason =
  | OffReason | "step" | "object" | "stance" | "outside_region" | "other_foot" | "slid_on" | "not_seen_unloaded"
  | "unbelieved" | "guard" | "too_light" | "too_short";

/** A foot on the floor. */
export interface Contact {
  /** Its number. */
  readonly id: number;
  /** Centre in metres, eastwards. */
  readonly x_m: number;
  /** Centre in metres, northwards. */
  readonly y_m: number;
  /** Force in newtons. */
  readonly force_n: number;
  /** Velocity in metres per second, eastwards. */
  readonly x_velocity_m_s: number;
  /** Velocity in metres per second, northwards. */
  readonly y_velocity_m_s: number;
}

/** The beginning or the end of a hold. */
export interface Hold {
  readonly id: string;
  readonly held: boolean;
  /** Why it has ended; null at its beginning. */
  readonly why: EndOfHold | null;
}

/** Events of one control each. One `released` or `cancelled` follows each `pressed`, also if the connection is lost. */
export interface ControlEvents {
  pressed: ControlEvent<null>;
  released: ControlEvent<null>;
  clicked: ControlEvent<null>;
  cancelled: ControlEvent<null>;
  /** The control has a new value. */
  changed: ControlEvent<Exclude<Value, null>>;
  double_tapped: ControlEvent<null>;
  long_pressed: ControlEvent<null>;
  swiped: ControlEvent<"north" | "east" | "south" | "west">;
  hard_pressed: ControlEvent<null>;
  hard_released: ControlEvent<null>;
  /** The foot passed from one choice to the next. */
  ticked: ControlEvent<null>;
  armed: ControlEvent<null>;
  disarmed: ControlEvent<null>;
  /** A held control will soon stop by itself. */
  warned: ControlEvent<null>;
  /** A foot pressed a locked control. */
  refused: ControlEvent<null>;
  ignored: IgnoredPress;
  held: Hold;
  /** An app has changed the control, or it has gone off or on. */
  state: ControlState;
}

/** All events. */
export interface Events extends ControlEvents {
  /** A connection or another layout: all properties of the floor are new. */
  floor: Floor;
  /** The feet on the floor, 100 times a second. */
  contacts: readonly Contact[];
  /** `link` or `why` of the floor has changed. */
  link: { readonly link: LinkState; readonly why: string };
  /** Another page is shown. */
  page: string | null;
  /** The floor has refused a request. Without a function for it, the console shows it. */
  error: { readonly request: string; readonly why: string };
  /** Each line of the floor as it is, also those of other events. */
  line: { readonly [field: string]: unknown };
}
