#define _GNU_SOURCE
#include "port.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

static volatile sig_atomic_t has_to_end;

static void end(int signal) {
    (void)signal;
    has_to_end = 1;
}

static double seconds(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + now.tv_nsec * 1e-9;
}

static void wait_seconds(double wait) {
    struct timespec span = {(time_t)wait, (long)((wait - (time_t)wait) * 1e9)};
    nanosleep(&span, NULL);
}

const char *port_to_file(struct port *port, const char *path) {
    port->terminal = -1;
    port->file = fopen(path, "wb");
    return port->file ? NULL : "this file cannot be written: ";
}

const char *port_to_terminal(struct port *port) {
    port->terminal = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (port->terminal < 0 || grantpt(port->terminal) != 0 || unlockpt(port->terminal) != 0) {
        return "there is no pseudo terminal";
    }
    // Only a terminal that has been open says later that it is closed.
    const char *path = ptsname(port->terminal);
    int other = path ? open(path, O_RDWR | O_NOCTTY) : -1;
    struct termios settings;
    if (other < 0 || tcgetattr(other, &settings) != 0) return "the pseudo terminal cannot be opened";
    cfmakeraw(&settings);
    tcsetattr(other, TCSANOW, &settings);
    close(other);
    signal(SIGTERM, end);
    signal(SIGINT, end);
    printf("%s\n", path);
    fflush(stdout);
    return NULL;
}

static int is_open(const struct port *port) {
    struct pollfd of = {port->terminal, POLLIN, 0};
    poll(&of, 1, 0);
    return !(of.revents & POLLHUP);
}

int port_await(struct port *port) {
    while (!has_to_end && !is_open(port)) wait_seconds(0.001);
    port->begun = seconds(CLOCK_MONOTONIC);
    return !has_to_end;
}

int port_keep_time(struct port *port, double ms) {
    double early = port->begun + ms / 1000 - seconds(CLOCK_MONOTONIC);
    if (early > 0) wait_seconds(early);
    else if (-early * 1000 > port->late_ms) port->late_ms = -early * 1000;
    return !has_to_end && is_open(port);
}

void port_mark(double ms) {
    printf("mark %.3f %.6f\n", ms, seconds(CLOCK_REALTIME));
    fflush(stdout);
}

void port_send(struct port *port, unsigned char byte) {
    port->sent++;
    if (port->file) {
        if (putc(byte, port->file) == EOF) port->lost++;
    } else if (write(port->terminal, &byte, 1) != 1) {
        port->lost++;
    }
}

int port_take(struct port *port) {
    unsigned char byte;
    if (port->terminal < 0 || read(port->terminal, &byte, 1) != 1) return -1;
    return byte;
}

void port_end(struct port *port) {
    if (port->file && fclose(port->file) != 0) port->lost++;
    printf("sent %lu bytes, of which nobody took %lu; ", port->sent, port->lost);
    printf("late by %.1f ms at most\n", port->late_ms);
}
