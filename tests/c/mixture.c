/* Discs that raise the interface and discs that sink it, held by a trap: the split force, its mesh part held over several
 * steps, unequal strengths and external fields. Prints the state's digest, the clock and the last step, and in how many
 * steps the force of the mesh was computed. */

#include "meniscus.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { GRID = 32, DISCS = 25, ROW = 5, STEPS = 200 };

static const double SIDE = 40.0;

static void require(const char *what, MeniscusStatus status) {
    if (status != MENISCUS_STATUS_OK) {
        fprintf(stderr, "%s: %s\n", what, meniscus_status_message((int32_t)status));
        exit(1);
    }
}

int main(void) {
    size_t length = meniscus_size_to_hold(GRID, DISCS);
    void *memory = malloc(length);
    MeniscusEngine *engine;
    require("create", meniscus_create(memory, length, GRID, DISCS, &engine));

    MeniscusParameters parameters = meniscus_default_parameters();
    parameters.side = SIDE;
    parameters.grid = GRID;
    parameters.capillary_strength = 20.0;
    parameters.capillary_length = INFINITY;
    parameters.method = MENISCUS_METHOD_P3M;
    parameters.splitting = 0.4;
    parameters.cutoff = 7.5;
    parameters.mesh_refresh = 0.25;
    parameters.assignment = MENISCUS_ASSIGNMENT_ORDER5;
    parameters.influence = MENISCUS_INFLUENCE_OPTIMAL;
    parameters.gradient = MENISCUS_GRADIENT_SPECTRAL;
    parameters.uniform_force_x = -3.0;
    parameters.uniform_force_y = 0.5;
    parameters.trap_stiffness = 0.25;
    parameters.trap_center_x = 0.0;
    parameters.trap_center_y = 30.0;
    parameters.noise = MENISCUS_NOISE_GAUSSIAN;
    parameters.seed = 11;

    /* A square lattice of spacing 3 R0 from the left lower corner on; every third disc sinks the interface. */
    uint32_t x[DISCS], y[DISCS];
    int32_t strengths[DISCS];
    for (uint32_t id = 0; id < DISCS; id++) {
        require("fraction", meniscus_fraction(SIDE, 3.0 * (id % ROW), &x[id]));
        require("fraction", meniscus_fraction(SIDE, 3.0 * (id / ROW), &y[id]));
        strengths[id] = id % 3 == 0 ? -MENISCUS_STRENGTH_ONE : MENISCUS_STRENGTH_ONE / 2;
    }
    require("set", meniscus_set(engine, &parameters, NULL, NULL, x, y, strengths, DISCS));

    MeniscusStep step = {0};
    uint32_t refreshed = 0;
    for (int done = 0; done < STEPS; done++) {
        require("step", meniscus_step(engine, &step));
        refreshed += step.refreshed;
    }

    MeniscusDigest digest;
    char text[65];
    require("digest", meniscus_digest(engine, &digest));
    require("text", meniscus_digest_text(&digest, text));
    printf("%" PRIu64 " %s\n", digest.length, text);
    printf("%" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 "\n", step.clock.step, step.clock.time, step.length,
           step.largest_force);
    printf("%" PRIu32 "\n", refreshed);
    free(memory);
    return 0;
}
