#include "hx711.h"

#include <simavr/avr_ioport.h>

// Samples a second of an amplifier with RATE high.
#define RATE 80

// Pulses that read a sample and choose the next one's gain.
#define PULSES 25

static void all_data(struct amplifiers *amplifiers, int level) {
    for (int i = 0; i < AMPLIFIERS; i++) avr_raise_irq(amplifiers->data[i], level);
}

static avr_cycle_count_t convert(avr_t *avr, avr_cycle_count_t when, void *parameter) {
    struct amplifiers *amplifiers = parameter;
    // A sample that is read meanwhile stays; pulses that end in the middle of one do not keep it.
    if (amplifiers->pulses == 0 || avr->cycle - amplifiers->clocked > amplifiers->interval / 4) {
        amplifiers->pulses = 0;
        for (int i = 0; i < AMPLIFIERS; i++) amplifiers->converted[i] = amplifiers->values[i];
        amplifiers->is_ready = 1;
        all_data(amplifiers, 0);
    }
    return when + amplifiers->interval;
}

// The clock of the sketch: each rising edge brings the next bit, the highest first.
static void clocked(struct avr_irq_t *irq, uint32_t level, void *parameter) {
    (void)irq;
    struct amplifiers *amplifiers = parameter;
    if (!level || !amplifiers->is_ready) return;
    amplifiers->pulses++;
    amplifiers->clocked = amplifiers->avr->cycle;
    if (amplifiers->pulses == PULSES) {
        amplifiers->pulses = 0;
        amplifiers->is_ready = 0;
        return all_data(amplifiers, 1);
    }
    for (int i = 0; i < AMPLIFIERS; i++) {
        avr_raise_irq(amplifiers->data[i], amplifiers->converted[i] >> (PULSES - 1 - amplifiers->pulses) & 1);
    }
}

void amplifiers_connect(struct amplifiers *amplifiers, avr_t *avr, int clock, long clock_hz) {
    amplifiers->avr = avr;
    amplifiers->interval = clock_hz / RATE;
    for (int i = 0; i < AMPLIFIERS; i++) {
        amplifiers->data[i] = avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('C'), IOPORT_IRQ_PIN0 + i);
    }
    avr_irq_t *pulses = avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('D'), IOPORT_IRQ_PIN0 + clock);
    avr_irq_register_notify(pulses, clocked, amplifiers);
}

void amplifiers_restart(struct amplifiers *amplifiers) {
    amplifiers->pulses = 0;
    amplifiers->is_ready = 0;
    // simavr passes on changes alone, and the reset has cleared the pins.
    all_data(amplifiers, 0);
    all_data(amplifiers, 1);
    avr_cycle_timer_register(amplifiers->avr, amplifiers->interval, convert, amplifiers);
}

void amplifiers_set(struct amplifiers *amplifiers, int pin, long value) {
    if (pin < AMPLIFIERS) amplifiers->values[pin] = value;
}
