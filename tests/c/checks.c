/* What a caller can do wrong is answered with a status; what it may do works. Numbers given as arguments are
 * statuses, whose messages are printed instead. */

#include "meniscus.h"

#include <fenv.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures;

static void expect(int line, int true_or_not, const char *what) {
    if (!true_or_not) {
        failures++;
        fprintf(stderr, "line %d: not so: %s\n", line, what);
    }
}

static void expect_status(int line, MeniscusStatus found, MeniscusStatus expected) {
    if (found != expected) {
        failures++;
        fprintf(stderr, "line %d: expected \"%s\", found \"%s\"\n", line,
                meniscus_status_message((int32_t)expected), meniscus_status_message((int32_t)found));
    }
}

#define EXPECT(condition) expect(__LINE__, (condition), #condition)
#define STATUS(expected, call) expect_status(__LINE__, (call), MENISCUS_STATUS_##expected)

enum { GRID = 16, DISCS = 4 };

static const uint32_t X[DISCS] = {0, 0x20000000, 0x40000000, 0xFFFFFFFF};
static const uint32_t Y[DISCS] = {0, 0x20000000, 0, 0x80000000};
static const int32_t STRENGTHS[DISCS] = {MENISCUS_STRENGTH_ONE, -MENISCUS_STRENGTH_ONE, 0, 3};

static MeniscusParameters small_box(void) {
    MeniscusParameters parameters = meniscus_default_parameters();
    parameters.side = 16.0;
    parameters.grid = GRID;
    return parameters;
}

static MeniscusParameters small_split_box(void) {
    MeniscusParameters parameters = small_box();
    parameters.method = MENISCUS_METHOD_P3M;
    parameters.splitting = 0.5;
    parameters.cutoff = 6.0;
    parameters.assignment = MENISCUS_ASSIGNMENT_ORDER7;
    parameters.influence = MENISCUS_INFLUENCE_OPTIMAL;
    return parameters;
}

static MeniscusParameters small_box_with_trap(void) {
    MeniscusParameters parameters = small_box();
    parameters.trap_stiffness = 1.0;
    return parameters;
}

static void *memory_for(uint32_t grid, size_t capacity) {
    /* Not zero: an engine must not rely on it. */
    size_t length = meniscus_size(grid, capacity);
    void *memory = malloc(length);
    if (memory == NULL) {
        abort();
    }
    return memset(memory, 0xA5, length);
}

static MeniscusEngine *engine_for(void *memory) {
    MeniscusEngine *engine = NULL;
    STATUS(OK, meniscus_create(memory, meniscus_size(GRID, DISCS), GRID, DISCS, &engine));
    return engine;
}

static void sizes_and_creation(void) {
    EXPECT(meniscus_size(0, 1) == 0 && meniscus_size(8, 1) == 0 && meniscus_size(100, 1) == 0);
    EXPECT(meniscus_size(8192, 1) == 0 && meniscus_size(0x80000000u, 1) == 0);
    EXPECT(meniscus_size(16, 0) == 0 && meniscus_size(16, 4194305) == 0 && meniscus_size(16, SIZE_MAX) == 0);
    EXPECT(meniscus_size(16, 1) != 0 && meniscus_size(4096, 4194304) != 0);
    EXPECT(meniscus_size_to_hold(16, 0) == 0 && meniscus_size_to_hold(8, 1) == 0);
    EXPECT(meniscus_size_to_hold(GRID, DISCS) == meniscus_size(GRID, DISCS) + 40 * DISCS);
    EXPECT(_Alignof(max_align_t) % meniscus_alignment() == 0);

    size_t length = meniscus_size(GRID, DISCS);
    char *memory = malloc(length + 1);
    MeniscusEngine *engine = (MeniscusEngine *)(void *)memory;
    STATUS(NULL_POINTER, meniscus_create(NULL, length, GRID, DISCS, &engine));
    EXPECT(engine == NULL);
    STATUS(NULL_POINTER, meniscus_create(memory, length, GRID, DISCS, NULL));
    STATUS(MISALIGNED, meniscus_create(memory + 1, length, GRID, DISCS, &engine));
    STATUS(MEMORY_TOO_SHORT, meniscus_create(memory, length - 1, GRID, DISCS, &engine));
    STATUS(GRID, meniscus_create(memory, length, 15, DISCS, &engine));
    STATUS(CAPACITY, meniscus_create(memory, length, GRID, 0, &engine));
    EXPECT(engine == NULL);
    /* The engine touches no byte beyond its length. */
    memory[length] = 0x5A;
    STATUS(OK, meniscus_create(memory, length, GRID, DISCS, &engine));
    MeniscusParameters parameters = small_box();
    STATUS(OK, meniscus_set(engine, &parameters, NULL, NULL, X, Y, NULL, DISCS));
    STATUS(OK, meniscus_step(engine, NULL));
    EXPECT(memory[length] == 0x5A);
    free(memory);
}

static void null_pointers(void) {
    void *memory = memory_for(GRID, DISCS);
    MeniscusEngine *engine = engine_for(memory);
    MeniscusParameters parameters = small_box();
    MeniscusClock clock;
    MeniscusDigest digest;
    uint32_t words[DISCS];
    int32_t boxes[DISCS];
    int64_t forces[DISCS];
    char text[65];
    STATUS(NULL_POINTER, meniscus_set(NULL, &parameters, NULL, NULL, X, Y, NULL, DISCS));
    STATUS(NULL_POINTER, meniscus_set(engine, NULL, NULL, NULL, X, Y, NULL, DISCS));
    STATUS(NULL_POINTER, meniscus_set(engine, &parameters, NULL, NULL, NULL, Y, NULL, DISCS));
    STATUS(NULL_POINTER, meniscus_set(engine, &parameters, NULL, NULL, X, NULL, NULL, DISCS));
    STATUS(NULL_POINTER, meniscus_step(NULL, NULL));
    STATUS(NULL_POINTER, meniscus_compute_forces(NULL));
    STATUS(NULL_POINTER, meniscus_clock(NULL, &clock));
    STATUS(NULL_POINTER, meniscus_clock(engine, NULL));
    STATUS(NULL_POINTER, meniscus_positions(NULL, words, words, DISCS));
    STATUS(NULL_POINTER, meniscus_positions(engine, NULL, words, DISCS));
    STATUS(NULL_POINTER, meniscus_crossings(engine, boxes, NULL, DISCS));
    STATUS(NULL_POINTER, meniscus_forces(engine, NULL, forces, DISCS));
    STATUS(NULL_POINTER, meniscus_digest(NULL, &digest));
    STATUS(NULL_POINTER, meniscus_digest(engine, NULL));
    STATUS(NULL_POINTER, meniscus_digest_text(NULL, text));
    STATUS(NULL_POINTER, meniscus_fraction(16.0, 1.0, NULL));
    STATUS(NULL_POINTER, meniscus_hold(NULL, words, words, forces, forces, DISCS));
    STATUS(NULL_POINTER, meniscus_held(NULL, words, words, forces, forces, DISCS));
    EXPECT(meniscus_count(NULL) == 0);
    STATUS(NULL_POINTER, meniscus_set(engine, &parameters, NULL, NULL, X, NULL, STRENGTHS, DISCS));
    STATUS(MISALIGNED, meniscus_set(engine, &parameters, NULL, NULL, X, Y,
                                    (const int32_t *)(const void *)((const char *)STRENGTHS + 1), DISCS - 1));
    STATUS(MISALIGNED, meniscus_set(engine, &parameters, NULL, NULL,
                                    (const uint32_t *)(const void *)((const char *)X + 1), Y, NULL, DISCS - 1));
    free(memory);
}

static void before_a_run_is_set(void) {
    void *memory = memory_for(GRID, DISCS);
    MeniscusEngine *engine = engine_for(memory);
    MeniscusDigest digest;
    uint32_t word;
    EXPECT(meniscus_count(engine) == 0);
    STATUS(NOT_INITIALISED, meniscus_step(engine, NULL));
    STATUS(NOT_INITIALISED, meniscus_compute_forces(engine));
    STATUS(NOT_INITIALISED, meniscus_hold(engine, NULL, NULL, NULL, NULL, 0));
    STATUS(NOTHING_HELD, meniscus_held(engine, NULL, NULL, NULL, NULL, 0));
    STATUS(OK, meniscus_digest(engine, &digest));
    EXPECT(digest.length == 32);
    STATUS(OK, meniscus_positions(engine, &word, &word, 0));
    free(memory);
}

static MeniscusStatus set(MeniscusEngine *engine, MeniscusParameters parameters) {
    return meniscus_set(engine, &parameters, NULL, NULL, X, Y, NULL, DISCS);
}

#define REFUSED(expected, field, value) REFUSED_IN(small_box(), expected, field, value)

#define REFUSED_IN(accepted, expected, field, value)    \
    do {                                                \
        MeniscusParameters parameters = (accepted);     \
        STATUS(OK, set(engine, parameters));            \
        parameters.field = (value);                     \
        STATUS(expected, set(engine, parameters));      \
        EXPECT(meniscus_count(engine) == 0);            \
    } while (0)

static void parameters_out_of_range(void) {
    void *memory = memory_for(GRID, DISCS);
    MeniscusEngine *engine = engine_for(memory);
    REFUSED(SIDE, side, (double)NAN);
    REFUSED(SIDE_TOO_LARGE, side, 65537.0);
    REFUSED(SIDE_TOO_SMALL, side, 4.0);
    REFUSED(CAPILLARY_STRENGTH, capillary_strength, -1.0);
    REFUSED(CAPILLARY_LENGTH, capillary_length, 0.0);
    REFUSED(GRID, grid, 17);
    REFUSED(GRID_TOO_COARSE, side, 1000.0);
    REFUSED(GRID_TOO_FINE, grid, 256);
    REFUSED(MAX_STEP, max_step, 2.0);
    REFUSED(MAX_DISPLACEMENT, max_displacement, 1.0);
    REFUSED(MESH_REFRESH, mesh_refresh, -0.1);
    REFUSED(MESH_REFRESH, mesh_refresh, 16.1);
    REFUSED(MESH_REFRESH_TOO_LARGE, mesh_refresh, 4.0);
    REFUSED(NO_ROOM_TO_HOLD, mesh_refresh, 0.1);
    REFUSED(SEED, seed, (uint64_t)1 << 63);
    REFUSED(METHOD, method, 0);
    REFUSED(METHOD, method, 3);
    REFUSED(ASSIGNMENT, assignment, 1);
    REFUSED(ASSIGNMENT, assignment, 8);
    REFUSED(INFLUENCE, influence, 0);
    REFUSED(INFLUENCE, influence, 4);
    REFUSED(GRADIENT, gradient, 3);
    REFUSED(NOISE, noise, 4);
    REFUSED(REPULSION, repulsion, 2);
    REFUSED(FIELDS, uniform_force_x, (double)INFINITY);
    REFUSED(FIELDS, uniform_force_y, -1.1e8);
    REFUSED(FIELDS, trap_stiffness, -1.0);
    REFUSED(FIELDS, trap_stiffness, 1.3e7);
    REFUSED_IN(small_box_with_trap(), FIELDS, trap_center_x, 16.1);
    REFUSED_IN(small_box_with_trap(), FIELDS, trap_center_y, -0.1);
    REFUSED(GRID_MISMATCH, grid, 32);
    free(memory);
}

static void parameters_that_do_not_fit_the_method(void) {
    void *memory = memory_for(GRID, DISCS);
    MeniscusEngine *engine = engine_for(memory);
    REFUSED_IN(small_split_box(), SPLITTING, splitting, 0.0);
    REFUSED_IN(small_split_box(), SPLITTING_TOO_LARGE, splitting, 0.71);
    REFUSED_IN(small_split_box(), CUTOFF, cutoff, 0.5);
    REFUSED_IN(small_split_box(), CUTOFF_TOO_LARGE, cutoff, 8.0);
    REFUSED_IN(small_split_box(), INFLUENCE_OF_METHOD, influence, MENISCUS_INFLUENCE_PAPER);
    REFUSED_IN(small_split_box(), GRADIENT_OF_METHOD, gradient, MENISCUS_GRADIENT_DIFFERENCE2);
    REFUSED_IN(small_box(), INFLUENCE_OF_METHOD, influence, MENISCUS_INFLUENCE_OPTIMAL);
    /* The mesh alone looks at neither splitting nor cut-off. */
    MeniscusParameters parameters = small_box();
    parameters.splitting = parameters.cutoff = (double)NAN;
    STATUS(OK, set(engine, parameters));
    for (uint32_t order = 2; order <= 7; order++) {
        parameters.assignment = order;
        STATUS(OK, set(engine, parameters));
        STATUS(OK, meniscus_step(engine, NULL));
    }
    free(memory);
}

static void strengths(void) {
    void *memory = memory_for(GRID, DISCS);
    MeniscusEngine *engine = engine_for(memory);
    MeniscusParameters parameters = small_split_box();
    MeniscusDigest found, equal;
    int32_t strengths[DISCS] = {MENISCUS_STRENGTH_ONE, MENISCUS_STRENGTH_ONE, MENISCUS_STRENGTH_ONE,
                                MENISCUS_STRENGTH_ONE};
    STATUS(OK, set(engine, parameters));
    STATUS(OK, meniscus_digest(engine, &equal));
    STATUS(OK, meniscus_set(engine, &parameters, NULL, NULL, X, Y, strengths, DISCS));
    STATUS(OK, meniscus_digest(engine, &found));
    EXPECT(found.length == 32 + 8 * DISCS);
    EXPECT(memcmp(equal.sha256, found.sha256, sizeof equal.sha256) == 0);
    STATUS(OK, meniscus_set(engine, &parameters, NULL, NULL, X, Y, STRENGTHS, DISCS));
    STATUS(OK, meniscus_step(engine, NULL));
    STATUS(OK, meniscus_digest(engine, &found));
    EXPECT(found.length == 32 + 12 * DISCS + 12);
    strengths[2] = -1001 * MENISCUS_STRENGTH_ONE;
    STATUS(STRENGTH, meniscus_set(engine, &parameters, NULL, NULL, X, Y, strengths, DISCS));
    EXPECT(meniscus_count(engine) == 0);
    strengths[2] = 10 * MENISCUS_STRENGTH_ONE;
    parameters.capillary_strength = 10.0;
    STATUS(OK, meniscus_set(engine, &parameters, NULL, NULL, X, Y, strengths, DISCS));
    parameters.capillary_strength = 10.1;
    STATUS(STRENGTH, meniscus_set(engine, &parameters, NULL, NULL, X, Y, strengths, DISCS));
    free(memory);
}

static void discs_that_do_not_fit(void) {
    void *memory = memory_for(GRID, DISCS);
    MeniscusEngine *engine = engine_for(memory);
    MeniscusParameters parameters = small_box();
    const uint32_t twice[DISCS] = {0, 1, 1, 2}, beyond[DISCS] = {0, 1, 2, 4};
    const uint32_t many[DISCS + 1] = {0};
    uint32_t words[DISCS];
    STATUS(NO_PARTICLES, meniscus_set(engine, &parameters, NULL, NULL, X, Y, NULL, 0));
    STATUS(TOO_MANY_PARTICLES, meniscus_set(engine, &parameters, NULL, NULL, many, many, NULL, DISCS + 1));
    STATUS(ID, meniscus_set(engine, &parameters, NULL, twice, X, Y, NULL, DISCS));
    STATUS(ID, meniscus_set(engine, &parameters, NULL, beyond, X, Y, NULL, DISCS));
    EXPECT(meniscus_count(engine) == 0);
    STATUS(OK, set(engine, parameters));
    STATUS(ARRAY_TOO_SHORT, meniscus_positions(engine, words, words, DISCS - 1));
    free(memory);
}

static void coordinates(void) {
    uint32_t fraction = 1;
    STATUS(OK, meniscus_fraction(16.0, 4.0, &fraction));
    EXPECT(fraction == 0x40000000);
    STATUS(COORDINATE, meniscus_fraction(16.0, 16.0, &fraction));
    STATUS(COORDINATE, meniscus_fraction(16.0, (double)NAN, &fraction));
    STATUS(SIDE, meniscus_fraction(-1.0, 4.0, &fraction));
    STATUS(SIDE_TOO_LARGE, meniscus_fraction(1e6, 4.0, &fraction));
}

static void another_rounding_is_refused(void) {
    void *memory = memory_for(GRID, DISCS);
    MeniscusEngine *engine = engine_for(memory);
    MeniscusParameters parameters = small_box();
    if (fesetround(FE_UPWARD) == 0) {
        MeniscusStatus status = set(engine, parameters);
        fesetround(FE_TONEAREST);
        STATUS(ROUNDING, status);
    }
    free(memory);
}

static void steps_that_are_refused(void) {
    void *memory = memory_for(GRID, DISCS);
    MeniscusEngine *engine = engine_for(memory);
    MeniscusParameters parameters = small_box();
    MeniscusClock late = {UINT64_MAX, 0}, found;
    MeniscusDigest before, after;
    STATUS(OK, meniscus_set(engine, &parameters, &late, NULL, X, Y, NULL, DISCS));
    STATUS(OK, meniscus_digest(engine, &before));
    STATUS(TIME_OVERFLOW, meniscus_step(engine, NULL));
    STATUS(OK, meniscus_digest(engine, &after));
    EXPECT(memcmp(before.sha256, after.sha256, sizeof before.sha256) == 0);
    STATUS(OK, meniscus_clock(engine, &found));
    EXPECT(found.step == UINT64_MAX && found.time == 0);
    free(memory);
}

static void a_restart_goes_on_as_if_nothing_had_happened(void) {
    void *memories[2] = {memory_for(GRID, DISCS), memory_for(GRID, DISCS)};
    MeniscusEngine *whole = engine_for(memories[0]), *parts = engine_for(memories[1]);
    MeniscusParameters parameters = small_box();
    MeniscusClock clock;
    MeniscusDigest expected, found;
    uint32_t x[DISCS], y[DISCS];
    STATUS(OK, set(whole, parameters));
    STATUS(OK, set(parts, parameters));
    for (int step = 0; step < 100; step++) {
        STATUS(OK, meniscus_step(whole, NULL));
        STATUS(OK, meniscus_step(parts, NULL));
        if (step % 10 == 0) {
            STATUS(OK, meniscus_clock(parts, &clock));
            STATUS(OK, meniscus_positions(parts, x, y, DISCS));
            STATUS(OK, meniscus_set(parts, &parameters, &clock, NULL, x, y, NULL, DISCS));
        }
    }
    STATUS(OK, meniscus_digest(whole, &expected));
    STATUS(OK, meniscus_digest(parts, &found));
    EXPECT(expected.length == 32 + 8 * DISCS && expected.length == found.length);
    EXPECT(memcmp(expected.sha256, found.sha256, sizeof expected.sha256) == 0);
    free(memories[0]);
    free(memories[1]);
}

static void held_forces_go_on_after_a_restart(void) {
    size_t length = meniscus_size_to_hold(GRID, DISCS);
    MeniscusEngine *whole, *parts;
    char *memories[2] = {malloc(length + 1), malloc(length + 1)};
    memories[0][length] = memories[1][length] = 0x5A;
    STATUS(OK, meniscus_create(memories[0], length, GRID, DISCS, &whole));
    STATUS(OK, meniscus_create(memories[1], length, GRID, DISCS, &parts));
    MeniscusParameters parameters = small_split_box();
    parameters.mesh_refresh = 0.2;
    MeniscusClock clock;
    MeniscusStep step;
    MeniscusDigest expected, found;
    uint32_t x[DISCS], y[DISCS], reference_x[DISCS], reference_y[DISCS];
    int64_t force_x[DISCS], force_y[DISCS];
    int refreshed = 0;
    STATUS(OK, set(whole, parameters));
    STATUS(OK, set(parts, parameters));
    STATUS(NOTHING_HELD, meniscus_held(whole, reference_x, reference_y, force_x, force_y, DISCS));
    for (int number = 0; number < 100; number++) {
        STATUS(OK, meniscus_step(whole, &step));
        refreshed += step.refreshed != 0;
        STATUS(OK, meniscus_step(parts, NULL));
        STATUS(OK, meniscus_digest(whole, &expected));
        STATUS(OK, meniscus_digest(parts, &found));
        EXPECT(expected.length == 32 + 8 * DISCS + 12 + 24 * DISCS && expected.length == found.length);
        EXPECT(memcmp(expected.sha256, found.sha256, sizeof expected.sha256) == 0);
        STATUS(OK, meniscus_clock(parts, &clock));
        STATUS(OK, meniscus_positions(parts, x, y, DISCS));
        STATUS(OK, meniscus_held(parts, reference_x, reference_y, force_x, force_y, DISCS));
        STATUS(OK, meniscus_set(parts, &parameters, &clock, NULL, x, y, NULL, DISCS));
        STATUS(OK, meniscus_hold(parts, reference_x, reference_y, force_x, force_y, DISCS));
    }
    EXPECT(refreshed > 1 && refreshed < 100);
    STATUS(NULL_POINTER, meniscus_held(parts, reference_x, NULL, force_x, force_y, DISCS));
    STATUS(NULL_POINTER, meniscus_held(parts, reference_x, reference_y, NULL, force_y, DISCS));
    STATUS(ARRAY_TOO_SHORT, meniscus_held(parts, reference_x, reference_y, force_x, force_y, DISCS - 1));
    STATUS(ARRAY_TOO_SHORT, meniscus_hold(parts, reference_x, reference_y, force_x, force_y, DISCS - 1));
    STATUS(TOO_MANY_PARTICLES, meniscus_hold(parts, reference_x, reference_y, force_x, force_y, DISCS + 1));
    STATUS(NULL_POINTER, meniscus_hold(parts, reference_x, reference_y, force_x, NULL, DISCS));
    force_y[1] = INT64_MIN;
    STATUS(HELD_FORCE, meniscus_hold(parts, reference_x, reference_y, force_x, force_y, DISCS));
    STATUS(NOTHING_HELD, meniscus_held(parts, reference_x, reference_y, force_x, force_y, DISCS));
    /* A run that holds none ignores what it is given. */
    parameters.mesh_refresh = 0.0;
    STATUS(OK, set(parts, parameters));
    STATUS(OK, meniscus_hold(parts, reference_x, reference_y, force_x, force_y, DISCS));
    STATUS(OK, meniscus_step(parts, &step));
    EXPECT(step.refreshed == 1);
    EXPECT(memories[0][length] == 0x5A && memories[1][length] == 0x5A);
    free(memories[0]);
    free(memories[1]);
}

int main(int count, char **arguments) {
    if (count > 1) {
        for (int place = 1; place < count; place++) {
            puts(meniscus_status_message((int32_t)strtol(arguments[place], NULL, 10)));
        }
        return 0;
    }
    sizes_and_creation();
    null_pointers();
    before_a_run_is_set();
    parameters_out_of_range();
    parameters_that_do_not_fit_the_method();
    strengths();
    discs_that_do_not_fit();
    coordinates();
    another_rounding_is_refused();
    steps_that_are_refused();
    a_restart_goes_on_as_if_nothing_had_happened();
    held_forces_go_on_after_a_restart();
    return failures != 0;
}
