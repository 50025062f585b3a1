// The serial port of an emulated board: a pseudo terminal in real time, or a file.

#ifndef UNDERFOOT_PORT_H
#define UNDERFOOT_PORT_H

#include <stdio.h>

struct port {
    FILE *file;
    int terminal;
    unsigned long sent, lost;
    // Seconds of the clock that does not jump, at the board's last reset.
    double begun;
    double late_ms;
};

// Opens it; returns why it cannot, or NULL.
const char *port_to_file(struct port *port, const char *path);
const char *port_to_terminal(struct port *port);

// Waits until a program opens the terminal; zero if this program has to end.
int port_await(struct port *port);

// Waits for the time `ms` after the reset; zero if the terminal has been closed, or this program has to end.
int port_keep_time(struct port *port, double ms);

// Says when the script has come to this time.
void port_mark(double ms);

// Sends a byte of the board; counts it as lost if nobody takes it.
void port_send(struct port *port, unsigned char byte);

// Takes a byte for the board; negative if there is none.
int port_take(struct port *port);

// Says how it went.
void port_end(struct port *port);

#endif
