// Force sensors under a floor, as lines of text over USB: one line a sample, one number a sensor, with spaces between.
// `pad.ron`, one folder up, reads them; docs/build-a-floor.md shows how to build the pad.
//
// Wiring of four force-sensing resistors to an Uno or Nano. Each has a resistor of 1 kilohm from its pin to GND:
//
//     5V ---[ sensor ]---+---[ 1 kilohm ]--- GND
//                        |
//                       pin
//
//     column  pin  corner of the tile, seen from above with north up
//     1       A0   south-west
//     2       A1   south-east
//     3       A2   north-west
//     4       A3   north-east
//
// More tiles take the next four pins each, in the same order. An Uno has 6 inputs, a Nano 8, a Mega 16.
//
// Wiring of HX711 load-cell amplifiers, with AMPLIFIERS = true: DT of each to its pin of INPUTS, SCK of all to CLOCK,
// VCC to 5V, GND to GND, and RATE to VCC, for 80 samples a second instead of 10.

// ---- Change these to fit the floor. ----

// The pins of the sensors, in the order of the columns: 4 to 16.
const uint8_t INPUTS[] = {A0, A1, A2, A3};

// Whether an HX711 stands behind each input.
const bool AMPLIFIERS = false;

// The pin that clocks all amplifiers.
const uint8_t CLOCK = 4;

// The byte that asks for a line, as 'v'; 0 for a board that sends by itself.
const char REQUEST = 0;

// Bits a second, as `baud` in the floor file. A board with 16 MHz makes 500000 without an error.
const unsigned long BAUD = 500000;

// ---- The rest fits itself. ----

const uint8_t COUNT = sizeof(INPUTS) / sizeof(INPUTS[0]);

// Microseconds between two lines: 1000 lines a second with 4 inputs, 500 with 8, 250 with 16. An Uno takes up to 215
// microseconds for each input: 112 to convert it, the rest to write and send its number.
const unsigned long PERIOD_US = 250UL * COUNT;

// Numbers of one line: 0 to 1023 of the converter, 0 to 16777215 of amplifiers.
unsigned long samples[COUNT];

// Microseconds at which the next line is due.
unsigned long due_us;

void setup() {
  Serial.begin(BAUD);
  if (AMPLIFIERS) {
    pinMode(CLOCK, OUTPUT);
    digitalWrite(CLOCK, LOW);
    for (uint8_t i = 0; i < COUNT; i++) pinMode(INPUTS[i], INPUT_PULLUP);
  }
  due_us = micros();
}

void loop() {
  if (REQUEST != 0 && Serial.read() != REQUEST) return;
  if (AMPLIFIERS) {
    readAmplifiers();
  } else {
    if (REQUEST == 0) waitUntilDue();
    for (uint8_t i = 0; i < COUNT; i++) samples[i] = analogRead(INPUTS[i]);
  }
  sendLine();
}

// Waits for the next line's time. A board that cannot keep up sends fewer lines; it repeats none.
void waitUntilDue() {
  while ((long)(micros() - due_us) < 0) {
  }
  due_us += PERIOD_US;
  if ((long)(micros() - due_us) >= 0) due_us = micros();
}

// Reads all amplifiers at once, as soon as the last of them has a sample. One that is missing never has one, so that
// no line is sent and the link is lost: better than a number that nobody measured.
void readAmplifiers() {
  for (uint8_t i = 0; i < COUNT; i++) {
    while (digitalRead(INPUTS[i]) == HIGH) delayMicroseconds(20);
    samples[i] = 0;
  }
  // 24 bits, and a 25th pulse, which chooses input A with gain 128 for the next sample.
  for (uint8_t bit = 0; bit < 25; bit++) {
    // A clock that stays high for 60 microseconds switches the amplifiers off.
    noInterrupts();
    digitalWrite(CLOCK, HIGH);
    delayMicroseconds(1);
    digitalWrite(CLOCK, LOW);
    interrupts();
    if (bit == 24) break;
    for (uint8_t i = 0; i < COUNT; i++) {
      samples[i] = samples[i] << 1 | (digitalRead(INPUTS[i]) == HIGH);
    }
  }
  // From two's complement to numbers from 0, with no load near the middle.
  for (uint8_t i = 0; i < COUNT; i++) samples[i] ^= 0x800000UL;
}

void sendLine() {
  char line[COUNT * 9 + 1];
  char *end = line;
  for (uint8_t i = 0; i < COUNT; i++) {
    if (i > 0) *end++ = ' ';
    // The conversion of short numbers is faster.
    if (samples[i] <= 0xFFFF) utoa(samples[i], end, 10);
    else ultoa(samples[i], end, 10);
    end += strlen(end);
  }
  *end++ = '\n';
  Serial.write(line, end - line);
}
