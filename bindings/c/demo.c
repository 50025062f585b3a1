/* Prints the events of a floor as JSON lines, until Ctrl-C.
 *
 *   gcc demo.c $(pkg-config --cflags --libs underfoot) -o demo && ./demo 127.0.0.1:9000 map.ron
 *
 * A third argument names a control: each beginning and end of a hold prints a line with the machine's clock. A fourth
 * is the floor file. SIGTERM ends the floor like Ctrl-C, SIGUSR1 makes this program fail, and SIGUSR2 closes the
 * floor. */
#include <inttypes.h>
#include <poll.h>
#include <setjmp.h>
#include <signal.h>
#include <stdio.h>
#include <time.h>
#include <underfoot.h>

static volatile sig_atomic_t asked;
static jmp_buf failed;

static void note(int signal)
{
    asked = signal;
}

/* Ids come from the layout unchanged: characters that JSON does not allow are escaped. */
static void print_text(const char *text)
{
    putchar('"');
    for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
        if (*c == '"' || *c == '\\') printf("\\%c", *c);
        else if (*c < 0x20) printf("\\u%04x", *c);
        else putchar(*c);
    }
    putchar('"');
}

static void print_event(const uf_event *event)
{
    static const char *const ways[] = { "north", "east", "south", "west" };
    printf("{\"t_s\":%.6f,\"event\":", event->t_s);
    print_text(event->name);
    printf(",\"id\":");
    print_text(event->id);
    printf(",\"value\":");
    switch (event->value_type) {
    case UF_SWITCH: printf(event->value[0] != 0 ? "true" : "false"); break;
    case UF_NUMBER: printf("%.9g", event->value[0]); break;
    case UF_CHOICE: printf("%d", (int)event->value[0]); break;
    case UF_PAIR: printf("[%.9g,%.9g]", event->value[0], event->value[1]); break;
    case UF_DIRECTION: print_text(ways[(int)event->value[0] & 3]); break;
    default: printf("null");
    }
    printf(",\"force_n\":%.9g,\"x_m\":%.9g,\"y_m\":%.9g,\"contact\":", event->force_n, event->x_m, event->y_m);
    if (event->contact < 0) printf("null}\n");
    else printf("%" PRId64 "}\n", event->contact);
}

/* Prints a line when the hold of the control begins or ends; a closed floor has no holds. */
static void look(const uf_session *floor, const char *id)
{
    static int was_held;
    int held = id && uf_held(floor, id);
    if (held != was_held) {
        struct timespec now;
        clock_gettime(CLOCK_MONOTONIC, &now);
        printf("{\"now_s\":%lld.%09ld,\"id\":", (long long)now.tv_sec, now.tv_nsec);
        print_text(id);
        printf(",\"held\":%s}\n", held ? "true" : "false");
    }
    was_held = held;
}

/* Follows the floor until it is over. A program may leave this function by longjmp, as errors of Lua or libpng do: no
 * function of the library is active then. */
static int follow(uf_session *floor, const char *watched)
{
    int status;
    do {
        struct pollfd ready = { .fd = uf_fd(floor), .events = POLLIN };
        poll(&ready, 1, 10);
        if (asked == SIGUSR1) longjmp(failed, 1);
        if (asked == SIGUSR2) return UF_OVER;
        if (asked) uf_stop(floor);
        uf_event event = { .size = sizeof event };
        while ((status = uf_next(floor, &event, 0)) == UF_OK) {
            if (event.kind == UF_CONTROL) print_event(&event);
            if (event.kind == UF_END) fprintf(stderr, "over: %s\n", event.text);
        }
        look(floor, watched);
    } while (status == UF_TIMEOUT);
    if (status != UF_OVER) fprintf(stderr, "%s\n", uf_status_text(status));
    return status;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: %s ADDRESS LAYOUT [ID [FLOOR]]\n", argv[0]);
        return 2;
    }
    const char *watched = argc > 3 ? argv[3] : NULL;
    char error[1024];
    uf_options options = { .size = sizeof options, .every_change = 1, .floor_path = argc > 4 ? argv[4] : NULL };
    uf_session *floor = uf_session_listen(argv[1], argv[2], &options, error, sizeof error);
    if (!floor) {
        fprintf(stderr, "%s\n", error);
        return 1;
    }
    setvbuf(stdout, NULL, _IOLBF, 0);
    printf("{\"listening\":");
    print_text(argv[1]);
    printf("}\n");

    static const int signals[] = { SIGINT, SIGTERM, SIGUSR1, SIGUSR2 };
    for (size_t at = 0; at < sizeof signals / sizeof *signals; at++) signal(signals[at], note);

    volatile int status = UF_PANIC;
    if (!setjmp(failed)) status = follow(floor, watched);
    uf_close(floor);
    look(NULL, watched);
    return status != UF_OVER;
}
