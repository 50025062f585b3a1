// The script of an emulated board: which input has which value from when on.

#ifndef UNDERFOOT_SCRIPT_H
#define UNDERFOOT_SCRIPT_H

#include <stddef.h>

// The pin of a line that marks a time.
#define MARK (-1)

// From this time on, this input has this value.
struct change {
    double ms;
    int pin;
    long value;
};

struct script {
    struct change *changes;
    size_t count;
    size_t next;
};

// Reads the file; returns why it cannot, or NULL.
const char *script_read(struct script *script, const char *path);

// Takes the next change, if it is due; NULL otherwise.
const struct change *script_next(struct script *script, double now_ms);

// Begins with the first change again.
void script_restart(struct script *script);

#endif
