/* A force-sensing floor in a C program.
 *
 * uf_session_listen starts a thread that receives the floor's packets, and uf_session_simulated one that simulates a
 * floor and the people on it, for trials without hardware; uf_next takes the next event. Any thread may
 * call any function, but no thread may use a session while another one closes it. No function lets a panic out.
 * Metres, newtons, seconds; x east and y north from the floor's south-west corner.
 *
 * A program that moves, lights or pours something while a foot holds a control must call uf_held at least every 20 ms,
 * and stop when it returns 0: silence means released. This is not a safety function.
 */
#ifndef UNDERFOOT_H
#define UNDERFOOT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes of an id, of a word and of a text, with the closing 0. Longer ones are cut at a character. */
#define UF_ID_SIZE 128
#define UF_NAME_SIZE 24
#define UF_TEXT_SIZE 256

/* Results of functions; uf_status_text has the text of each. */
enum {
    UF_OK = 0,
    UF_TIMEOUT = 1,         /* nothing happened in that time */
    UF_OVER = 2,            /* the session has ended and all its events were taken */
    UF_BAD_ARGUMENT = -1,   /* a null pointer, text that is not UTF-8, or a size that no version has */
    UF_UNKNOWN = -2,        /* no such control or page */
    UF_WRONG_TYPE = -3,     /* the control does not hold that type of value */
    UF_NOT_FINITE = -4,     /* NaN or infinite */
    UF_NO_SUCH_CHOICE = -5, /* the selector has fewer options */
    UF_NO_RANGE = -6,       /* the control can't have such a range */
    UF_MOMENTARY = -7,      /* only a foot operates it, for as long as it holds it */
    UF_LOCKED = -8,         /* an app has locked it */
    UF_IN_USE = -9,         /* a foot is on it */
    UF_ENDED = -10,         /* the session is over */
    UF_NO_ANSWER = -11,     /* the floor did not answer within 200 ms */
    UF_REFUSED = -12,       /* for a reason that this header has no number for */
    UF_PANIC = -13          /* a fault of the library, which has been contained */
};

/* The reason why no foot can press a control: uf_off returns it, uf_off_name has the word for it. */
enum {
    UF_ON = 0,                     /* a foot can press it */
    UF_OFF_DISABLED = 1,           /* an app has disabled it */
    UF_OFF_WAITING = 2,            /* the floor has not been sensed yet: no packets, or the tare is being measured */
    UF_OFF_BOARDS_SWAPPED = 3,     /* boards are swapped */
    UF_OFF_NOT_CALIBRATED = 4,     /* the floor file has no calibration of some sensors */
    UF_OFF_OTHER_FLOOR = 5,        /* the floor file is another floor's */
    UF_OFF_LINK_LOST = 6,          /* the boards under it send no usable packets */
    UF_OFF_SENSOR_TROUBLE = 7,     /* sensors under it are wrong or at the end of their range */
    UF_OFF_REPEATED_READINGS = 8,  /* sensors under it repeat their readings bit for bit */
    UF_OFF_COARSE_READINGS = 9,    /* readings under it are too coarse to notice a frozen sensor */
    UF_OFF_OTHER_HELD = 10,        /* another control that acts while it is held is held */
    UF_OFF_SLOW_READINGS = 11,     /* boards under it send fewer than 50 packets a second */
    UF_OFF_OTHER = 100             /* a reason without a number in this header; the text names it */
};

/* The subject of an event. */
enum {
    UF_CONTROL = 1, /* a foot did something to the control `id`: `name` is "pressed", "released", "changed" ... */
    UF_STATE = 2,   /* the state of the control `id`: an app changed it or asked for it, or it is one that acts while
                       it is held and went off or on (uf_off) */
    UF_PAGE = 3,    /* the page `id` is shown */
    UF_LINK = 4,    /* `text` is "waiting", "live", "partial" or "lost"; "lost" has cancelled all holds */
    UF_HEALTH = 5,  /* the state of the sensors has changed */
    UF_DEVICE = 6,  /* the state of the device that moves the actuators has changed */
    UF_MUTE = 7,    /* the muted set has changed */
    UF_CRACK = 8,   /* a ground cracked at `x_m`, `y_m` */
    UF_END = 9,     /* the last event: `text` is "stopped", "source_ended", or "failed: ..." or "panicked: ..." */
    UF_LINK_CAUSE = 10, /* the reason why boards that send give no usable frame: `text` is a stable name, a colon and
                         * a sentence, such as "rate_low: board 0 sends ..."; "" when it is over */
    UF_IGNORED = 11, /* the control `id` ignored the foot `contact`, which has left it: `force_n` is the greatest force,
                      * `text` a stable name, a colon and a sentence, such as "too_light: too light" or
                      * "not_calibrated: the floor is not calibrated" */
    UF_SENT = 12,   /* the control or region `id` gives a message to another program, which the session does not send:
                     * `text` is the name of its target, a colon and its content, such as "viewer: key Right" */
    UF_OTHER = 100  /* a subject without a number in this header; `name` has the word */
};

/* The content of `value`. */
enum {
    UF_NOTHING = 0,
    UF_SWITCH = 1,   /* value[0] is 0 or 1 */
    UF_NUMBER = 2,   /* value[0] */
    UF_CHOICE = 3,   /* value[0] is the number of the option, from 0 */
    UF_PAIR = 4,     /* eastwards, northwards */
    UF_DIRECTION = 5 /* of a swipe: value[0] is 0 north, 1 east, 2 south, 3 west */
};

typedef struct uf_session uf_session;

/* Later versions may add fields at the ends of these. `size` shows the version for which the program was compiled: the
 * library writes and reads no further. Set it before the call, as in `uf_event event = { .size = sizeof event };`. */

typedef struct uf_options {
    uint32_t size;
    uint32_t every_change;  /* 1: keep every value; 0: keep the latest untaken one of each control */
    const char *floor_path; /* floor file; NULL: the paper's floor of 6 x 6 tiles */
} uf_options;

typedef struct uf_event {
    uint32_t size;
    uint32_t kind;           /* UF_CONTROL ... */
    double t_s;              /* on the floor's sample clock */
    char id[UF_ID_SIZE];     /* of the control or page; "" if it is about the floor */
    char name[UF_NAME_SIZE]; /* the word for the event, as in JSON lines */
    char text[UF_TEXT_SIZE]; /* of a link, of its cause, of an ignored press and of the end; "" otherwise */
    uint32_t value_type;     /* UF_NOTHING ... */
    float value[2];
    float force_n;
    float x_m;
    float y_m;
    int64_t contact;         /* the number of the foot; -1 if no foot did it */
} uf_event;

typedef struct uf_value {
    uint32_t size;
    uint32_t type; /* UF_SWITCH ... */
    float value[2];
} uf_value;

typedef struct uf_contact {
    uint32_t size;
    uint32_t id;
    float x_m;
    float y_m;
    float force_n;
    float x_velocity_m_s;
    float y_velocity_m_s;
} uf_contact;

/* Starts a floor with boards that send to `address`, such as "127.0.0.1:9000", and the page of controls in the file
 * `layout`. `options` may be NULL. NULL on failure: `error` then has the reason, cut to `error_size` bytes with the
 * closing 0; it may be NULL. */
uf_session *uf_session_listen(const char *address, const char *layout, const uf_options *options, char *error,
                              size_t error_size);

/* Replays a recorded floor, with its layout: the same events, at `speed` times the original speed, or with 0 as fast as
 * possible. It ends with the recording. Of the options only `every_change` counts. NULL as above. */
uf_session *uf_session_replay(const char *recording, double speed, const uf_options *options, char *error,
                              size_t error_size);

/* Starts a simulated floor of 6 x 6 tiles, new and well built (of the quality `slight`), with the page of controls in
 * the file `layout` and the people and faults of the file `scenario`; with NULL the built-in scenario, which fits the
 * shipped layout map.ron. It runs in real time and ends with the scenario. Of the options only `every_change` counts. NULL as above. */
uf_session *uf_session_simulated(const char *layout, const char *scenario, const uf_options *options, char *error,
                                 size_t error_size);

/* Writes the address for boards, such as "127.0.0.1:9000", with the port that the system chose for port 0, cut to
 * `address_size` bytes with the closing 0. Returns the length of the whole text: 0 for a recording and for a simulated
 * floor, negative on failure. */
int uf_address(const uf_session *session, char *address, size_t address_size);

/* The controls of the layout: their number, and the id of each, from 0 (UF_OK or UF_UNKNOWN). An id of
 * UF_ID_SIZE bytes is never cut. */
int uf_control_count(const uf_session *session);
int uf_control_id(const uf_session *session, int index, char *id, size_t id_size);

/* UF_OK if the layout has a control of this name, otherwise UF_UNKNOWN. Call it once for each id before uf_held: a
 * misspelt one is never held. */
int uf_has(const uf_session *session, const char *id);

/* The reason why no foot can press a control: UF_ON if one can, UF_OFF_..., or a negative failure. `text` gets it as a
 * sentence, with the name of the floor file where that matters, cut to `text_size` bytes with the closing 0; it may be
 * NULL. */
int uf_off(const uf_session *session, const char *id, char *text, size_t text_size);

/* The word for a reason, as in JSON lines, such as "not_calibrated"; "" for UF_ON. It stays valid for ever. */
const char *uf_off_name(int reason);

/* Takes the next event: UF_OK, UF_TIMEOUT or UF_OVER. Waits for at most `timeout_ms`; 0 does not wait, a negative
 * number waits for ever. The last event is always UF_END. */
int uf_next(uf_session *session, uf_event *event, int timeout_ms);

/* 1 if a foot holds the control now and the floor has reported that within the last 100 ms; otherwise 0, also for NULL
 * and for a control that the layout lacks (see uf_has). */
int uf_held(const uf_session *session, const char *id);

/* A descriptor for poll and select, readable when there may be events: then call uf_next with a timeout of 0 until it
 * returns UF_TIMEOUT or UF_OVER. It belongs to the session: do not read or close it. Negative without one (on
 * Windows). */
int uf_fd(const uf_session *session);

/* Reads the value of a control: UF_OK or UF_UNKNOWN; its type is UF_NOTHING for a button. */
int uf_get(const uf_session *session, const char *id, uf_value *value);

/* Writes up to `capacity` feet on the floor into `contacts`, as elements of `element_size` bytes, which is
 * sizeof(uf_contact), and returns the number of all feet; negative on failure. */
int uf_contacts(const uf_session *session, uf_contact *contacts, size_t capacity, size_t element_size);

/* Writes the reason why boards that send give no usable frame, or why no load was ever seen, like the text of
 * UF_LINK_CAUSE, cut to `size` bytes with the closing 0; "" if all is well or no board sends. Returns UF_OK or
 * UF_BAD_ARGUMENT. */
int uf_link_cause(const uf_session *session, char *text, size_t size);

/* Number of events that were dropped because the program did not take them. */
uint64_t uf_dropped(const uf_session *session);

/* These return UF_OK, or the reason why the control stays unchanged. A number beyond the control's range becomes the
 * nearest end of the range, and one between two steps the nearer step; NaN and infinities are refused. For a switch a
 * number other than 0 means on; for a selector it is the number of an option, from 0, and one without an option is
 * refused. */
int uf_set_number(uf_session *session, const char *id, float value);
int uf_set_pair(uf_session *session, const char *id, float east, float north);
int uf_set_range(uf_session *session, const char *id, float least, float greatest);
int uf_set_label(uf_session *session, const char *id, const char *label);
int uf_set_indicator(uf_session *session, const char *id, const char *lamp); /* "off", "on", "busy", "attention" */
int uf_set_enabled(uf_session *session, const char *id, int enabled);
int uf_set_locked(uf_session *session, const char *id, int locked);
int uf_set_page(uf_session *session, const char *page);

/* Ends the floor: cancels all holds, and UF_END follows. Does not wait. */
void uf_stop(uf_session *session);

/* Ends the floor, waits until its thread has ended, and frees the session; NULL is allowed. */
void uf_close(uf_session *session);

/* The text of `status`; it stays valid for ever. */
const char *uf_status_text(int status);

/* The reason of the last failed call on this thread, with the name in question and the nearest existing one, such as
 * `there is no control "zom"; did you mean "zoom"?`; "" if none has failed. It stays valid until the next failure. */
const char *uf_last_error(void);

#ifdef __cplusplus
}
#endif

#endif
