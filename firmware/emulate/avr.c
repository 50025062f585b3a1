// Runs a sketch for the ATmega328P of an Arduino Uno, with scripted voltages at its inputs.
//
//     avr SKETCH.elf SCRIPT [--out FILE] [--until MS] [--hx711 CLOCK]
//
// Each line of the script is `ms pin millivolts`, in order of time: from then on, analogue input A<pin> has this
// voltage; pin -1 is a mark, which prints `mark MS SECONDS`, by the clock of the system. With `--hx711 CLOCK`, the
// numbers are those of load-cell amplifiers behind the pins A0 to A3 instead.
//
// Without --out, the sketch runs in real time with its serial port at a pseudo terminal. Its path is the first line
// printed. Each opening of the terminal resets the board, as the port of an Uno does, and starts the script anew. With
// --out, the bytes of the port go to a file as fast as the machine runs the sketch, up to --until, and a line says when
// the sketch first reads an input.
//
// At the end, the last line says how many bytes nobody took, and by how much the emulator was late at most.

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <simavr/avr_adc.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>

#include "hx711.h"
#include "port.h"
#include "script.h"

#define CLOCK_HZ 16000000
#define CYCLES_PER_MS (CLOCK_HZ / 1000)

static void die(const char *why, const char *which) {
    fprintf(stderr, "avr: %s%s\n", why, which);
    exit(1);
}

// The board, and everything at its pins.
struct board {
    avr_t *avr;
    struct script script;
    struct amplifiers amplifiers;
    int has_amplifiers;
    struct port port;
    // Time of the first conversion; negative before it.
    double first_ms;
};

// The library says other things than this program on the same output.
static void say_nothing(avr_t *avr, const int level, const char *format, va_list parts) {
    (void)avr;
    if (level <= LOG_ERROR) vfprintf(stderr, format, parts);
}

static avr_t *make_avr(const char *path) {
    elf_firmware_t firmware;
    memset(&firmware, 0, sizeof firmware);
    avr_global_logger_set(say_nothing);
    if (elf_read_firmware(path, &firmware) != 0) die("this is no program for an AVR: ", path);
    avr_t *avr = avr_make_mcu_by_name("atmega328p");
    if (!avr) die("simavr has no atmega328p", "");
    avr->log = LOG_ERROR;
    avr_init(avr);
    firmware.frequency = CLOCK_HZ;
    avr_load_firmware(avr, &firmware);
    avr->frequency = CLOCK_HZ;
    avr->vcc = avr->avcc = avr->aref = 5000;
    // Otherwise it prints lines of its own, and sleeps while the sketch polls.
    uint32_t flags = 0;
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    return avr;
}

static void sent(struct avr_irq_t *irq, uint32_t byte, void *port) {
    (void)irq;
    port_send(port, (unsigned char)byte);
}

static void converts(struct avr_irq_t *irq, uint32_t input, void *parameter) {
    (void)irq, (void)input;
    struct board *board = parameter;
    if (board->first_ms < 0) board->first_ms = (double)board->avr->cycle / CYCLES_PER_MS;
}

// Changes the inputs that the script changes now, and gives the sketch the bytes that came for it.
static avr_cycle_count_t each_turn(avr_t *avr, avr_cycle_count_t when, void *parameter) {
    struct board *board = parameter;
    const struct change *change;
    double now_ms = (double)avr->cycle / CYCLES_PER_MS;
    while ((change = script_next(&board->script, now_ms))) {
        if (change->pin == MARK) {
            port_mark(change->ms);
        } else if (board->has_amplifiers) {
            amplifiers_set(&board->amplifiers, change->pin, change->value);
        } else {
            avr_irq_t *input = avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0 + change->pin);
            avr_raise_irq(input, (uint32_t)change->value);
        }
    }
    int byte = port_take(&board->port);
    if (byte >= 0) avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT), (uint32_t)byte);
    return when + CYCLES_PER_MS / 10;
}

static void reset(struct board *board) {
    avr_reset(board->avr);
    board->avr->cycle = 0;
    board->first_ms = -1;
    script_restart(&board->script);
    if (board->has_amplifiers) amplifiers_restart(&board->amplifiers);
    avr_cycle_timer_register(board->avr, 1, each_turn, board);
}

// Runs the sketch up to this time.
static void run_until(struct board *board, double ms) {
    avr_cycle_count_t end = (avr_cycle_count_t)(ms * CYCLES_PER_MS);
    while (board->avr->cycle < end) {
        int state = avr_run(board->avr);
        if (state == cpu_Done || state == cpu_Crashed) die("the sketch has crashed", "");
    }
}

int main(int arguments, char **argument) {
    struct board board;
    memset(&board, 0, sizeof board);
    const char *out = NULL;
    double until_ms = 0;
    int clock_pin = -1;
    if (arguments < 3 || arguments % 2 == 0) {
        die("usage: avr SKETCH.elf SCRIPT [--out FILE] [--until MS] [--hx711 CLOCK]", "");
    }
    for (int i = 3; i < arguments; i += 2) {
        if (!strcmp(argument[i], "--out")) out = argument[i + 1];
        else if (!strcmp(argument[i], "--until")) until_ms = atof(argument[i + 1]);
        else if (!strcmp(argument[i], "--hx711")) clock_pin = atoi(argument[i + 1]);
        else die("there is no option ", argument[i]);
    }
    const char *wrong = script_read(&board.script, argument[2]);
    if (wrong) die(wrong, argument[2]);
    board.avr = make_avr(argument[1]);
    board.has_amplifiers = clock_pin >= 0;
    if (board.has_amplifiers) amplifiers_connect(&board.amplifiers, board.avr, clock_pin, CLOCK_HZ);
    wrong = out ? port_to_file(&board.port, out) : port_to_terminal(&board.port);
    if (wrong) die(wrong, out ? out : "");
    avr_irq_register_notify(avr_io_getirq(board.avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), sent, &board.port);
    avr_irq_register_notify(avr_io_getirq(board.avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER), converts, &board);
    reset(&board);
    if (out) {
        run_until(&board, until_ms);
        printf("first conversion at %.3f ms\n", board.first_ms);
    } else {
        while (port_await(&board.port)) {
            reset(&board);
            for (double ms = 1; port_keep_time(&board.port, ms); ms++) run_until(&board, ms);
        }
    }
    port_end(&board.port);
    return 0;
}
