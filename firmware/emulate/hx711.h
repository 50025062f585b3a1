// HX711 load-cell amplifiers at the pins A0 to A3, with one clock for all.

#ifndef UNDERFOOT_HX711_H
#define UNDERFOOT_HX711_H

#include <simavr/sim_avr.h>

#define AMPLIFIERS 4

struct amplifiers {
    avr_t *avr;
    avr_irq_t *data[AMPLIFIERS];
    // Values at their inputs, as the script has it, and those of the last conversion.
    long values[AMPLIFIERS];
    long converted[AMPLIFIERS];
    // Pulses since the last conversion; 0 while a sample waits.
    int pulses;
    int is_ready;
    // Cycles between two conversions, and the cycle of the last pulse.
    avr_cycle_count_t interval, clocked;
};

// Connects them; `clock` is a pin of 0 to 7.
void amplifiers_connect(struct amplifiers *amplifiers, avr_t *avr, int clock, long clock_hz);

// Begins anew with the board.
void amplifiers_restart(struct amplifiers *amplifiers);

// Sets the value at an input.
void amplifiers_set(struct amplifiers *amplifiers, int pin, long value);

#endif
