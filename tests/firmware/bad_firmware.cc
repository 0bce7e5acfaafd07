// SPDX-License-Identifier: Apache-2.0
// Three mistakes that simavr tolerates and a real board does not; the simulated board must detect them. Compiled with
// one of SLEEPS, FLOODS and FORGETS, for an ATmega328P.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

extern "C" __attribute__((noinline, used, externally_visible)) void logger_idle() { __asm__ __volatile__(""); }

ISR(ADC_vect) {}

#if defined(SLEEPS)
ISR(TIMER1_COMPB_vect) { OCR1B += 2000; }
#endif

int main() {
  TCCR1A = 0;
  TCCR1B = _BV(CS11);
  OCR1B = 2000;
  ADCSRB = _BV(ADTS2) | _BV(ADTS0);
  ADCSRA = _BV(ADEN) | _BV(ADATE) | _BV(ADIE) | 7;
  UCSR0A = _BV(U2X0);
  UBRR0 = 16;
  UCSR0B = _BV(TXEN0);
#if defined(SLEEPS)
  TIMSK1 = _BV(OCIE1B);
#endif
  sei();
  for (;;) {
#if defined(SLEEPS)
    sleep_mode();
#elif defined(FLOODS)
    UDR0 = 'x';  // without waiting for UDRE0
#elif defined(FORGETS)
    OCR1B = TCNT1 + 100;  // OCF1B is never cleared
#endif
    logger_idle();
  }
}
