/* Prints what feet do on a floor as JSON lines, until Ctrl-C.
 *
 *   gcc demo.c $(pkg-config --cflags --libs underfoot) -o demo && ./demo 127.0.0.1:9000 map.ron
 *
 * A third argument names a control: whenever it begins or ends to be held, a line says so with the machine's clock. */
#include <inttypes.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <time.h>
#include <underfoot.h>

static volatile sig_atomic_t is_asked_to_end;

static void ask_to_end(int signal)
{
    (void)signal;
    is_asked_to_end = 1;
}

/* Ids are as their layout's author wrote them: what JSON does not take is escaped. */
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

static void print_held(const char *id, int held)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    printf("{\"now_s\":%lld.%09ld,\"id\":", (long long)now.tv_sec, now.tv_nsec);
    print_text(id);
    printf(",\"held\":%s}\n", held ? "true" : "false");
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: %s ADDRESS LAYOUT [ID]\n", argv[0]);
        return 2;
    }
    const char *watched = argc > 3 ? argv[3] : NULL;
    char error[1024];
    uf_options options = { .size = sizeof options, .every_change = 1 };
    uf_session *floor = uf_session_listen(argv[1], argv[2], &options, error, sizeof error);
    if (!floor) {
        fprintf(stderr, "%s\n", error);
        return 1;
    }
    setvbuf(stdout, NULL, _IOLBF, 0);
    printf("{\"listening\":");
    print_text(argv[1]);
    printf("}\n");

    signal(SIGINT, ask_to_end);
    signal(SIGTERM, ask_to_end);

    int was_held = 0, status;
    do {
        struct pollfd ready = { .fd = uf_fd(floor), .events = POLLIN };
        poll(&ready, 1, 10);
        if (is_asked_to_end) uf_stop(floor);
        uf_event event = { .size = sizeof event };
        while ((status = uf_next(floor, &event, 0)) == UF_OK) {
            if (event.kind == UF_CONTROL) print_event(&event);
            if (event.kind == UF_END) fprintf(stderr, "over: %s\n", event.text);
        }
        int held = watched && uf_held(floor, watched);
        if (held != was_held) print_held(watched, held);
        was_held = held;
    } while (status == UF_TIMEOUT);
    if (status != UF_OVER) fprintf(stderr, "%s\n", uf_status_text(status));
    uf_close(floor);
    return status != UF_OVER;
}
