#include "script.h"

#include <stdio.h>
#include <stdlib.h>

// Inputs A0 to A7.
#define PINS 8

const char *script_read(struct script *script, const char *path) {
    FILE *file = fopen(path, "r");
    if (!file) return "this script cannot be read: ";
    const char *wrong = NULL;
    size_t room = 0;
    struct change change;
    double last_ms = 0;
    int found;
    while (!wrong && (found = fscanf(file, "%lf %d %ld", &change.ms, &change.pin, &change.value)) != EOF) {
        if (found != 3) wrong = "a line is not `ms pin value`: ";
        else if (change.pin < MARK || change.pin >= PINS) wrong = "pins are 0 to 7, or -1: ";
        else if (change.ms < last_ms) wrong = "a line is earlier than the one before: ";
        if (script->count == room) {
            room = room ? 2 * room : 1024;
            struct change *larger = realloc(script->changes, room * sizeof *larger);
            if (!larger) wrong = "there is no memory for this script: ";
            else script->changes = larger;
        }
        if (!wrong) script->changes[script->count++] = change;
        last_ms = change.ms;
    }
    fclose(file);
    return wrong;
}

const struct change *script_next(struct script *script, double now_ms) {
    if (script->next == script->count || script->changes[script->next].ms > now_ms) return NULL;
    return &script->changes[script->next++];
}

void script_restart(struct script *script) {
    script->next = 0;
}
