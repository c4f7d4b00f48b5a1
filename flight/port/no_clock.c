/* QOCO's timer on a board without a clock: every time is zero. */
#include "timer.h"

void start_timer(QOCOTimer *timer) { (void)timer; }
void stop_timer(QOCOTimer *timer) { (void)timer; }
QOCOFloat get_elapsed_time_sec(QOCOTimer *timer) { (void)timer; return 0.0; }
