/* Prints what the feet on a simulated floor do, and stops with it. */
#include <stdio.h>
#include <string.h>
#include <underfoot.h>

int main(void)
{
    char error[1024];
    uf_session *floor = uf_session_simulated("map.ron", NULL, NULL, error, sizeof error);
    if (!floor) {
        fprintf(stderr, "%s\n", error);
        return 1;
    }
    uf_event event = { .size = sizeof event };
    while (uf_next(floor, &event, -1) == UF_OK) {
        if (event.kind == UF_CONTROL) printf("%s %s %g\n", event.id, event.name, event.value[0]);
        if (strcmp(event.name, "clicked") == 0 && strcmp(event.id, "home") == 0)
            uf_set_number(floor, "zoom", 0);
    }
    uf_close(floor);
    return 0;
}
