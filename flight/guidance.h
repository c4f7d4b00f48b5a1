/* The three-phase guidance law (Algorithm 1), as smallsat.studies.rendezvous.guidance has it. States
 * are relative positions, m, and velocities, m/s, in the target's Hill frame; times are in s. */
#ifndef GUIDANCE_H
#define GUIDANCE_H

#include <stdbool.h>

#include "law.h"
#include "program.h"

enum phase { RENDEZVOUS, APPROACH, DOCKING };

void write_program(const struct law *law, enum phase phase, const double state[STATES], double time,
                   struct program *program, double start[STATES]);
bool phase_ended(const struct law *law, enum phase phase, const double state[STATES], double time);

#endif
