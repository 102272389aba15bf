/* A collapse of 36 discs in a static buffer; prints the state's digest, the clock and every disc. */

#include "meniscus.h"

#include <inttypes.h>
#include <stdio.h>

enum { GRID = 32, DISCS = 36, ROW = 6, STEPS = 300 };

/* meniscus_size(GRID, DISCS) bytes are needed; the union aligns them. */
static union {
    uint64_t alignment;
    unsigned char bytes[32 * 1024];
} memory;

static const double SIDE = 32.0;

/* Where a row or column of the lattice lies, R0. */
static double coordinate(uint32_t place) {
    double along = 24.75 + 2.5 * place;
    return along < SIDE ? along : along - SIDE;
}

static int fail(const char *what, MeniscusStatus status) {
    fprintf(stderr, "%s: %s\n", what, meniscus_status_message((int32_t)status));
    return 1;
}

int main(void) {
    MeniscusEngine *engine;
    MeniscusStatus status = meniscus_create(&memory, sizeof memory, GRID, DISCS, &engine);
    if (status != MENISCUS_STATUS_OK) {
        return fail("create", status);
    }

    MeniscusParameters parameters = meniscus_default_parameters();
    parameters.side = SIDE;
    parameters.grid = GRID;
    parameters.capillary_strength = 20.0;
    parameters.capillary_length = 16.0;
    parameters.noise = MENISCUS_NOISE_GAUSSIAN;
    parameters.seed = 7;

    /* A square lattice across the borders, the last disc first. */
    uint32_t ids[DISCS], x[DISCS], y[DISCS];
    for (uint32_t place = 0; place < DISCS; place++) {
        uint32_t id = DISCS - 1 - place;
        ids[place] = id;
        status = meniscus_fraction(parameters.side, coordinate(id % ROW), &x[place]);
        if (status == MENISCUS_STATUS_OK) {
            status = meniscus_fraction(parameters.side, coordinate(id / ROW), &y[place]);
        }
        if (status != MENISCUS_STATUS_OK) {
            return fail("fraction", status);
        }
    }
    status = meniscus_set(engine, &parameters, NULL, ids, x, y, NULL, DISCS);
    if (status != MENISCUS_STATUS_OK) {
        return fail("set", status);
    }

    MeniscusStep step = {0};
    for (int done = 0; done < STEPS; done++) {
        status = meniscus_step(engine, &step);
        if (status != MENISCUS_STATUS_OK) {
            return fail("step", status);
        }
    }

    MeniscusDigest digest;
    MeniscusClock clock;
    char text[65];
    int32_t crossings_x[DISCS], crossings_y[DISCS];
    int64_t force_x[DISCS], force_y[DISCS];
    if ((status = meniscus_digest(engine, &digest)) != MENISCUS_STATUS_OK ||
        (status = meniscus_digest_text(&digest, text)) != MENISCUS_STATUS_OK ||
        (status = meniscus_clock(engine, &clock)) != MENISCUS_STATUS_OK ||
        (status = meniscus_compute_forces(engine)) != MENISCUS_STATUS_OK ||
        (status = meniscus_positions(engine, x, y, DISCS)) != MENISCUS_STATUS_OK ||
        (status = meniscus_crossings(engine, crossings_x, crossings_y, DISCS)) != MENISCUS_STATUS_OK ||
        (status = meniscus_forces(engine, force_x, force_y, DISCS)) != MENISCUS_STATUS_OK) {
        return fail("read", status);
    }
    printf("%" PRIu64 " %s\n", digest.length, text);
    printf("%" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 "\n", clock.step, clock.time, step.length,
           step.largest_force);
    for (size_t id = 0; id < meniscus_count(engine); id++) {
        printf("%" PRIu32 " %" PRIu32 " %" PRId32 " %" PRId32 " %" PRId64 " %" PRId64 "\n", x[id], y[id],
               crossings_x[id], crossings_y[id], force_x[id], force_y[id]);
    }
    return 0;
}
