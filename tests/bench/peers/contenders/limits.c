/* What this machine can do at most, for comparison with what the engines do:
 *
 *     limits adds|mixed sse2|avx2|avx512    sums of numbers in registers; mixed: as many products besides
 *     limits copy|triad KILOBYTES           y = x, or z = x + 3 y, over arrays that take so much together
 *
 * The description is what one repetition does: so many operations, or so many bytes read and written. */
#include "batches.h"

enum { LOOPS = 1 << 20, CHAINS = 12 };

/* Twelve chains hide the latency. The compiler may not reorder sums of floats, so it has to do them all. */
#define KERNEL(NAME, BYTES, TARGET, VALUE)                                                                             \
    __attribute__((target(TARGET))) static void NAME(void)                                                             \
    {                                                                                                                  \
        typedef float lanes __attribute__((vector_size(BYTES)));                                                       \
        lanes values[CHAINS], one = (lanes){0} + 1.0f;                                                                 \
        __asm__ volatile("" : "+x"(one));                                                                              \
        for (int j = 0; j < CHAINS; j++)                                                                               \
            values[j] = one;                                                                                           \
        for (int i = 0; i < LOOPS; i++) {                                                                              \
            _Pragma("GCC unroll 12") for (int j = 0; j < CHAINS; j++) values[j] = VALUE;                               \
        }                                                                                                              \
        for (int j = 0; j < CHAINS; j++)                                                                               \
            __asm__ volatile("" ::"x"(values[j]));                                                                     \
    }
#define KERNELS(NAME, BYTES, TARGET)                                                                                   \
    KERNEL(NAME##_adds, BYTES, TARGET, values[j] + one)                                                                \
    KERNEL(NAME##_mixed, BYTES, TARGET, j % 2 == 0 ? values[j] + one : values[j] * one)

KERNELS(sse2, 16, "sse2")
KERNELS(avx2, 32, "avx2")
KERNELS(avx512, 64, "avx512f")

static float *x, *y, *z;
static size_t elements;
static int passes;

static void copy(void)
{
    for (int pass = 0; pass < passes; pass++) {
        for (size_t i = 0; i < elements; i++)
            y[i] = x[i];
        __asm__ volatile("" ::"r"(y) : "memory");
    }
}

static void triad(void)
{
    for (int pass = 0; pass < passes; pass++) {
        for (size_t i = 0; i < elements; i++)
            z[i] = x[i] + 3.0f * y[i];
        __asm__ volatile("" ::"r"(z) : "memory");
    }
}

static void nothing(void)
{
}

static float *array(void)
{
    float *new = aligned_alloc(4096, (elements * sizeof(float) + 4095) / 4096 * 4096);
    for (size_t i = 0; i < elements; i++)
        new[i] = 1.0f;
    return new;
}

static int serve_arithmetic(const char *what, const char *level)
{
    static const struct {
        const char *name;
        int lanes;
        void (*adds)(void), (*mixed)(void);
    } levels[] = {
        {"sse2", 4, sse2_adds, sse2_mixed}, {"avx2", 8, avx2_adds, avx2_mixed}, {"avx512", 16, avx512_adds, avx512_mixed}};
    for (size_t i = 0; i < sizeof levels / sizeof *levels; i++)
        if (strcmp(level, levels[i].name) == 0) {
            char work[32];
            snprintf(work, sizeof work, "%.0f", (double)LOOPS * CHAINS * levels[i].lanes);
            return serve(work, strcmp(what, "adds") == 0 ? levels[i].adds : levels[i].mixed, nothing);
        }
    return 2;
}

static int serve_memory(const char *what, const char *kilobytes)
{
    const int is_copy = strcmp(what, "copy") == 0, arrays = is_copy ? 2 : 3;
    const size_t bytes = strtoul(kilobytes, NULL, 10) * 1024;
    elements = bytes / sizeof(float) / arrays;
    passes = bytes < 1 << 26 ? (int)((1 << 26) / bytes) : 1;
    x = array();
    y = array();
    z = array();
    char work[32];
    snprintf(work, sizeof work, "%.0f", (double)elements * sizeof(float) * arrays * passes);
    return serve(work, is_copy ? copy : triad, nothing);
}

int main(int count, char **arguments)
{
    if (count == 3 && (strcmp(arguments[1], "adds") == 0 || strcmp(arguments[1], "mixed") == 0))
        return serve_arithmetic(arguments[1], arguments[2]);
    if (count == 3 && (strcmp(arguments[1], "copy") == 0 || strcmp(arguments[1], "triad") == 0))
        return serve_memory(arguments[1], arguments[2]);
    fprintf(stderr, "usage: limits adds|mixed sse2|avx2|avx512, or limits copy|triad KILOBYTES\n");
    return 2;
}
