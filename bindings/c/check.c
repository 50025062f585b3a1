/* Checks the library for C: ./check RECORDING LAYOUT SCENARIO. Prints each failure, and then ends with 1. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <underfoot.h>

static int wrong;

#define CHECK(so) ((so) ? (void)0 : (void)(wrong = 1, fprintf(stderr, "line %d: not so: %s\n", __LINE__, #so)))

static char error[1024];

/* One call replays a recording, with the same events, to its end. */
static void replays(const char *recording)
{
    uf_options options = { .size = sizeof options, .every_change = 1, .floor_path = NULL };
    uf_session *floor = uf_session_replay(recording, 0, &options, error, sizeof error);
    CHECK(floor);
    uf_event event = { .size = sizeof event };
    int clicked = 0, changed = 0, status;
    while ((status = uf_next(floor, &event, -1)) == UF_OK) {
        clicked += event.kind == UF_CONTROL && !strcmp(event.id, "home") && !strcmp(event.name, "clicked");
        changed += event.kind == UF_CONTROL && !strcmp(event.id, "zoom") && event.value_type == UF_NUMBER;
    }
    CHECK(status == UF_OVER);
    CHECK(event.kind == UF_END && !strcmp(event.text, "source_ended"));
    CHECK(clicked == 1 && changed > 3);
    CHECK(uf_address(floor, error, sizeof error) == 0);
    uf_close(floor);

    CHECK(!uf_session_replay("no such file.mcap", 1, NULL, error, sizeof error));
    CHECK(strstr(error, "no such file.mcap"));
    CHECK(!uf_session_replay(recording, NAN, NULL, error, sizeof error));
    CHECK(!uf_session_replay(recording, -1, NULL, error, sizeof error));
    CHECK(!uf_session_replay(NULL, 1, NULL, error, sizeof error));
}

/* One call simulates a person who clicks home. */
static void simulates(const char *layout, const char *scenario)
{
    uf_session *floor = uf_session_simulated(layout, scenario, NULL, error, sizeof error);
    CHECK(floor);
    CHECK(uf_address(floor, error, sizeof error) == 0);
    uf_event event = { .size = sizeof event };
    int clicked = 0, status;
    while ((status = uf_next(floor, &event, -1)) == UF_OK) {
        if (event.kind != UF_CONTROL || strcmp(event.id, "home") || strcmp(event.name, "clicked")) continue;
        clicked++;
        uf_stop(floor);
    }
    CHECK(status == UF_OVER && clicked == 1);
    CHECK(event.kind == UF_END && !strcmp(event.text, "stopped"));
    uf_close(floor);

    CHECK(!uf_session_simulated("no such layout.ron", scenario, NULL, error, sizeof error));
    CHECK(strstr(error, "no such layout.ron") && !strncmp(uf_last_error(), error, strlen(error)));
    CHECK(!uf_session_simulated(layout, "no such scenario.ron", NULL, error, sizeof error));
    CHECK(strstr(error, "no such scenario.ron"));
    /* A layout is no scenario. */
    CHECK(!uf_session_simulated(layout, layout, NULL, error, sizeof error) && strstr(error, layout));
    CHECK(!uf_session_simulated(NULL, scenario, NULL, error, sizeof error));
    CHECK(!uf_session_simulated(layout, "\xff", NULL, error, sizeof error));
    CHECK(!strcmp(error, "the path of the scenario is not UTF-8"));
}

/* A press on a control that an app has switched off is ignored, for that reason. */
static void ignores(const char *layout, const char *scenario)
{
    uf_session *floor = uf_session_simulated(layout, scenario, NULL, error, sizeof error);
    CHECK(floor);
    CHECK(uf_set_enabled(floor, "home", 0) == UF_OK);
    uf_event event = { .size = sizeof event };
    int ignored = 0;
    while (uf_next(floor, &event, -1) == UF_OK) {
        CHECK(event.kind != UF_CONTROL || strcmp(event.id, "home"));
        if (event.kind != UF_IGNORED || strcmp(event.id, "home") || ignored++) continue;
        CHECK(!strcmp(event.name, "ignored") && !strcmp(event.text, "disabled: an app has switched it off"));
        CHECK(event.force_n > 100 && event.contact >= 0 && event.value_type == UF_NOTHING);
        uf_stop(floor);
    }
    CHECK(ignored == 1);
    uf_close(floor);
}

static float number(const uf_session *floor, const char *id)
{
    uf_value value = { .size = sizeof value };
    CHECK(uf_get(floor, id, &value) == UF_OK);
    CHECK(value.type == UF_NUMBER);
    return value.value[0];
}

static void controls(uf_session *floor)
{
    char id[UF_ID_SIZE];
    int count = uf_control_count(floor), has_zoom = 0;
    for (int index = 0; index < count; index++) {
        CHECK(uf_control_id(floor, index, id, sizeof id) == UF_OK);
        CHECK(uf_has(floor, id) == UF_OK);
        has_zoom |= !strcmp(id, "zoom");
    }
    CHECK(count > 3 && has_zoom);
    CHECK(uf_control_id(floor, count, id, sizeof id) == UF_UNKNOWN);
    CHECK(uf_control_id(floor, -1, id, sizeof id) == UF_UNKNOWN);
}

/* A misspelt name is refused, with the nearest one; uf_held returns 0 for it, which is safe. */
static void names(uf_session *floor)
{
    static const char expected[] = "there is no control \"zom\"; did you mean \"zoom\"?";
    uf_value value = { .size = sizeof value };
    CHECK(uf_has(floor, "zom") == UF_UNKNOWN && !strcmp(uf_last_error(), expected));
    CHECK(uf_set_label(floor, "zom", "Zoom") == UF_UNKNOWN && !strcmp(uf_last_error(), expected));
    CHECK(uf_get(floor, "zom", &value) == UF_UNKNOWN && !strcmp(uf_last_error(), expected));
    CHECK(uf_off(floor, "zom", NULL, 0) == UF_UNKNOWN);
    CHECK(uf_set_page(floor, "more") == UF_UNKNOWN);
    CHECK(!strcmp(uf_last_error(), "there is no page \"more\": the layout has no pages"));
    CHECK(uf_held(floor, "zom") == 0 && !strcmp(uf_last_error(), expected));
    CHECK(uf_held(floor, "home") == 0);
}

/* A number beyond the range becomes the nearest end of it; NaN is refused. */
static void values(uf_session *floor)
{
    CHECK(uf_set_number(floor, "zoom", 7) == UF_OK && number(floor, "zoom") == 1);
    CHECK(uf_set_number(floor, "zoom", -7) == UF_OK && number(floor, "zoom") == 0);
    CHECK(uf_set_number(floor, "zoom", NAN) == UF_NOT_FINITE);
    CHECK(!strcmp(uf_last_error(), "zoom: the value is not a finite number"));
}

/* A control that is off has a reason. */
static void reasons(uf_session *floor)
{
    char text[UF_TEXT_SIZE];
    CHECK(uf_off(floor, "home", text, sizeof text) == UF_OFF_WAITING);
    CHECK(strstr(text, "no packets have come") && !strcmp(uf_off_name(UF_OFF_WAITING), "waiting"));
    CHECK(uf_set_enabled(floor, "home", 0) == UF_OK);
    CHECK(uf_off(floor, "home", text, sizeof text) == UF_OFF_DISABLED);
    CHECK(!strcmp(text, "an app has switched it off"));
    CHECK(uf_off(floor, "home", text, 5) == UF_OFF_DISABLED && !strcmp(text, "an a"));
    CHECK(uf_off(floor, "home", NULL, 0) == UF_OFF_DISABLED);
    CHECK(!strcmp(uf_off_name(UF_ON), "") && !strcmp(uf_off_name(UF_OFF_OTHER_HELD), "other_held"));
}

int main(int argc, char **argv)
{
    if (argc < 4) {
        fprintf(stderr, "usage: %s RECORDING LAYOUT SCENARIO\n", argv[0]);
        return 2;
    }
    CHECK(!strcmp(uf_last_error(), ""));
    replays(argv[1]);
    simulates(argv[2], argv[3]);
    ignores(argv[2], argv[3]);
    uf_session *floor = uf_session_listen("127.0.0.1:0", argv[2], NULL, error, sizeof error);
    if (!floor) {
        fprintf(stderr, "%s\n", error);
        return 1;
    }
    char address[64];
    CHECK(uf_address(floor, address, sizeof address) == (int)strlen(address));
    CHECK(!strncmp(address, "127.0.0.1:", 10) && strcmp(address, "127.0.0.1:0"));
    /* The address is in use; the message names no option of a program. */
    CHECK(!uf_session_listen(address, argv[2], NULL, error, sizeof error) && !strstr(error, "--"));
    controls(floor);
    names(floor);
    values(floor);
    reasons(floor);
    uf_close(floor);
    CHECK(uf_held(NULL, "home") == 0 && uf_control_count(NULL) == UF_BAD_ARGUMENT);
    printf("C: %s\n", wrong ? "not as its header says" : "as its header says");
    return wrong;
}
