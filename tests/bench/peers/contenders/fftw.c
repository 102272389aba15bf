/* The mesh solve made with FFTW in single precision, as a physicist would who wants it fast:
 *
 *     fftw GRID two|one PLANNER WISDOM
 *
 * Both begin with one transform of the real density. "two": the product with influence function and gradient, and two
 * transforms back to the real F_x and F_y; "one": the spectrum of F_x + i F_y, and one complex transform back. All are
 * out of place, which is the faster. PLANNER is measure or patient; the plans are kept in the file WISDOM. */
#include "batches.h"
#include <complex.h>
#include <fftw3.h>
#include <math.h>
#include <stdint.h>

static int grid, half;
static float *density, *force[2], *influence, *gradient;
static fftwf_complex *spectrum, *product[2], *field, *line, *result;
static fftwf_plan forward, back[2];

/* Product with influence and gradient, F = i g S, for the two real transforms back. */
static void multiply(void)
{
    const float *restrict along_y = gradient;
    for (int l = 0; l < grid; l++) {
        const float along_x = gradient[l];
        const float *restrict factor = influence + (size_t)(l > grid / 2 ? grid - l : l) * half;
        const float *restrict value = (const float *)(spectrum + (size_t)l * half);
        float *restrict x = (float *)(product[0] + (size_t)l * half);
        float *restrict y = (float *)(product[1] + (size_t)l * half);
        for (int m = 0; m < half; m++) {
            const float real = factor[m] * value[2 * m], imaginary = factor[m] * value[2 * m + 1];
            x[2 * m] = -along_x * imaginary;
            x[2 * m + 1] = along_x * real;
            y[2 * m] = -along_y[m] * imaginary;
            y[2 * m + 1] = along_y[m] * real;
        }
    }
}

static void solve_with_two(void)
{
    fftwf_execute(forward);
    multiply();
    fftwf_execute(back[0]);
    fftwf_execute(back[1]);
}

/* The same for F_x + i F_y, and for the conjugate half of the spectrum with it: at -k, S is conjugate and g negative.
 * That half is stored backwards, a complex number at a time. */
static void multiply_both(void)
{
    const float *restrict along_y = gradient;
    for (int l = 0; l < grid; l++) {
        const float along_x = gradient[l];
        const float *restrict factor = influence + (size_t)(l > grid / 2 ? grid - l : l) * half;
        const float *restrict value = (const float *)(spectrum + (size_t)l * half);
        float *restrict row = (float *)(field + (size_t)l * grid);
        float *restrict opposite = (float *)line;
        for (int m = 0; m < half; m++) {
            const float real = factor[m] * value[2 * m], imaginary = factor[m] * value[2 * m + 1];
            const float x_real = along_x * real, x_imaginary = along_x * imaginary;
            const float y_real = along_y[m] * real, y_imaginary = along_y[m] * imaginary;
            row[2 * m] = -x_imaginary - y_real;
            row[2 * m + 1] = x_real - y_imaginary;
            opposite[2 * m] = y_real - x_imaginary;
            opposite[2 * m + 1] = -x_real - y_imaginary;
        }
        const uint64_t *restrict from = (const uint64_t *)line;
        uint64_t *restrict to = (uint64_t *)(field + (size_t)(l == 0 ? 0 : grid - l) * grid);
        for (int m = 1; m < half - 1; m++)
            to[grid - m] = from[m];
    }
}

static void solve_with_one(void)
{
    fftwf_execute(forward);
    multiply_both();
    fftwf_execute(back[0]);
}

static size_t checked_node(uint32_t index)
{
    return index * 2654435761u % ((size_t)grid * grid);
}

static void check_two(void)
{
    for (uint32_t i = 0; i < 64; i++)
        printf("%.9g %.9g ", force[0][checked_node(i)], force[1][checked_node(i)]);
    printf("\n");
}

static void check_one(void)
{
    for (uint32_t i = 0; i < 64; i++)
        printf("%.9g %.9g ", crealf(result[checked_node(i)]), cimagf(result[checked_node(i)]));
    printf("\n");
}

/* The paper's influence function and the spectral gradient for Table I's interface, spacing 500/512 R0. */
static void fill_tables(void)
{
    const double pi = acos(-1.0), side = grid * 500.0 / 512.0, spacing = side / grid, kappa = 1.0 / 270.0;
    for (int l = 0; l < half; l++)
        for (int m = 0; m < half; m++) {
            const double x = 2.0 / spacing * sin(pi * l / grid), y = 2.0 / spacing * sin(pi * m / grid);
            influence[(size_t)l * half + m] =
                l + m == 0 ? 0.0f
                           : (float)(2.0 * pi * 0.89 / (x * x + y * y + kappa * kappa) / (side * side) / (1 << 20));
        }
    for (int l = 0; l < grid; l++)
        gradient[l] = l == grid / 2 ? 0.0f : (float)(2.0 * pi * (l > grid / 2 ? l - grid : l) / side);
}

int main(int count, char **arguments)
{
    if (count != 5) {
        fprintf(stderr, "usage: fftw GRID two|one measure|patient WISDOM\n");
        return 2;
    }
    grid = atoi(arguments[1]);
    half = grid / 2 + 1;
    const int two = strcmp(arguments[2], "two") == 0;
    const unsigned flags = strcmp(arguments[3], "patient") == 0 ? FFTW_PATIENT : FFTW_MEASURE;
    const size_t nodes = (size_t)grid * grid, modes = (size_t)grid * half;
    density = fftwf_alloc_real(nodes);
    spectrum = fftwf_alloc_complex(modes);
    influence = fftwf_alloc_real((size_t)half * half);
    gradient = fftwf_alloc_real(grid);
    fftwf_import_wisdom_from_filename(arguments[4]);
    forward = fftwf_plan_dft_r2c_2d(grid, grid, density, spectrum, flags);
    if (two) {
        for (int axis = 0; axis < 2; axis++) {
            force[axis] = fftwf_alloc_real(nodes);
            product[axis] = fftwf_alloc_complex(modes);
            back[axis] = fftwf_plan_dft_c2r_2d(grid, grid, product[axis], force[axis], flags);
        }
    } else {
        field = fftwf_alloc_complex(nodes);
        line = fftwf_alloc_complex(half);
        result = fftwf_alloc_complex(nodes);
        back[0] = fftwf_plan_dft_2d(grid, grid, field, result, FFTW_BACKWARD, flags | FFTW_DESTROY_INPUT);
    }
    fftwf_export_wisdom_to_filename(arguments[4]);
    fill_tables();
    for (size_t i = 0; i < nodes; i++)
        density[i] = (float)((uint32_t)i * 2654435761u >> 12);
    return serve(fftwf_version, two ? solve_with_two : solve_with_one, two ? check_two : check_one);
}
