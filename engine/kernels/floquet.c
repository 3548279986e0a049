/* Monodromy matrices by the fourth-order Magnus method with two Gauss points per step: state_matrix, step_maps and
 * _product_over_period of engine/cycles/floquet.py. Theory section 7.3.
 *
 * Each lane integrates a different part of the period, so LANES matrix products run in parallel. */
#include "kernels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST, SECOND, EXPONENT, SQUARE, CUBE, FOURTH, HIGH, PRODUCT, MATRICES };

typedef struct {
    int m, n, size;        /* n = 2 m; size = 2 H + 1 */
    ptrdiff_t stretch;     /* steps of each lane */
    ptrdiff_t count;       /* n n */
    Lanes *matrices;       /* (MATRICES, n, n) */
    Lanes *blocks;         /* (2, n, m): rows of -M^-1 K(tau) / w^2 and -M^-1 C(tau) / w at the two Gauss points */
    Lanes *state, *force, *restoring, *gradient, *scratch;
} Workspace;

static void release(Workspace *w)
{
    free(w->matrices), free(w->blocks), free(w->state), free(w->force), free(w->restoring), free(w->gradient);
    free(w->scratch);
}

static int prepare(Workspace *w, const Model *model, int harmonics)
{
    *w = (Workspace){.m = model->m, .n = 2 * model->m, .size = 2 * harmonics + 1};
    w->count = (ptrdiff_t)w->n * w->n;
    const size_t m = (size_t)w->m;
    w->matrices = calloc(MATRICES * (size_t)w->count, sizeof(Lanes));
    w->blocks = calloc(4 * m * m, sizeof(Lanes));
    w->state = calloc(2 * m, sizeof(Lanes));
    w->force = calloc(m, sizeof(Lanes));
    w->restoring = calloc(m, sizeof(Lanes));
    w->gradient = calloc(4 * m * m, sizeof(Lanes));
    w->scratch = calloc(load_scratch(model), sizeof(Lanes));
    return w->matrices && w->blocks && w->state && w->force && w->restoring && w->gradient && w->scratch;
}

static inline Lanes *matrix_of(const Workspace *w, int which) { return w->matrices + which * w->count; }

WITHIN void product_of(int n, const Lanes *restrict left, const Lanes *restrict right, Lanes *restrict product)
{
    for (int i = 0; i < n; i++) {
        Lanes row[n]; /* stays in registers where n is known: no sum waits for the one before */
        for (int j = 0; j < n; j++)
            row[j] = left[i * n] * right[j];
        for (int k = 1; k < n; k++)
            for (int j = 0; j < n; j++)
                row[j] += left[i * n + k] * right[k * n + j];
        for (int j = 0; j < n; j++)
            product[i * n + j] = row[j];
    }
}

WIDE static void multiply(int n, const Lanes *restrict left, const Lanes *restrict right, Lanes *restrict product)
{
    if (n == 6) /* the hybrid model: the compiler unrolls loops of known length */
        product_of(6, left, right, product);
    else if (n == 8) /* with a relief coordinate */
        product_of(8, left, right, product);
    else if (n == 12) /* finite elements with two numbers of loops */
        product_of(12, left, right, product);
    else
        product_of(n, left, right, product);
}

/* Set the lower half (m, 2 m) of A(tau) of y' = A y, y = (q, dq/dtau), at one Gauss point of the lanes' steps. */
WIDE static void generate(Workspace *w, const Model *model, const Monodromies *wanted, ptrdiff_t cycle, int point,
                          ptrdiff_t step)
{
    const int m = w->m, n = w->n;
    const ptrdiff_t steps = wanted->steps[cycle];
    const double omega = wanted->angular_frequency[cycle], speed = wanted->wind_speed[cycle];
    const double *coefficients = wanted->coefficients + cycle * m * w->size;
    const double *inverse = wanted->inverse_mass + wanted->member[cycle] * m * m;
    Lanes *block = w->blocks + point * m * n;
    const double *values[LANES], *slopes[LANES];
    for (int lane = 0; lane < LANES; lane++) {
        const ptrdiff_t at = (wanted->first[cycle] + point * steps + lane * w->stretch + step) * w->size;
        values[lane] = wanted->values + at, slopes[lane] = wanted->slopes + at;
    }
    memset(w->state, 0, (size_t)n * sizeof *w->state);
    for (int c = 0; c < w->size; c++) {
        const Lanes value = {values[0][c], values[1][c], values[2][c], values[3][c]};
        const Lanes slope = omega / speed * (Lanes){slopes[0][c], slopes[1][c], slopes[2][c], slopes[3][c]};
        for (int j = 0; j < m; j++) {
            w->state[j] += coefficients[j * w->size + c] * value;
            w->state[m + j] += coefficients[j * w->size + c] * slope;
        }
    }
    load_at(model, speed, w->state, w->force, w->gradient, w->restoring, w->scratch);
    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++) {
            Lanes elastic = {0}, viscous = {0};
            for (int k = 0; k < m; k++) {
                elastic += inverse[i * m + k] * (speed * speed * w->gradient[k * n + j] - model->stiffness[k * m + j]);
                viscous += inverse[i * m + k] * (speed * w->gradient[k * n + m + j] - model->damping[k * m + j]);
            }
            block[i * n + j] = elastic * (1.0 / (omega * omega));
            block[i * n + m + j] = viscous * (1.0 / omega);
        }
}

/* Set the exponent h/2 (A_1 + A_2) + sqrt(3)/12 h^2 (A_2 A_1 - A_1 A_2); the upper half of each A is (0, 1). */
WIDE static void exponent(Workspace *w, double width)
{
    const int m = w->m, n = w->n;
    const Lanes *first = w->blocks, *second = w->blocks + m * n;
    Lanes *result = matrix_of(w, EXPONENT);
    const double half = 0.5 * width, bracket = sqrt(3.0) / 12.0 * width * width;
    for (int i = 0; i < m; i++)
        for (int j = 0; j < n; j++) {
            Lanes lower = {0};
            if (j >= m)
                lower += second[i * n + j - m] - first[i * n + j - m];
            for (int k = 0; k < m; k++)
                lower += second[i * n + m + k] * first[k * n + j] - first[i * n + m + k] * second[k * n + j];
            result[i * n + j] = bracket * (first[i * n + j] - second[i * n + j]) + (j == m + i ? width : 0.0);
            result[(m + i) * n + j] = half * (first[i * n + j] + second[i * n + j]) + bracket * lower;
        }
}

/* Sum the Taylor series of the exponential to degree 8 with four products; the steps keep its argument small. */
WIDE static void exponentiate(Workspace *w, Lanes *result)
{
    const int n = w->n;
    Lanes *a = matrix_of(w, EXPONENT), *square = matrix_of(w, SQUARE), *cube = matrix_of(w, CUBE);
    Lanes *fourth = matrix_of(w, FOURTH), *high = matrix_of(w, HIGH);
    multiply(n, a, a, square);
    multiply(n, square, a, cube);
    multiply(n, square, square, fourth);
    for (ptrdiff_t e = 0; e < w->count; e++)
        high[e] = a[e] * (1.0 / 120.0) + square[e] * (1.0 / 720.0) + cube[e] * (1.0 / 5040.0)
                  + fourth[e] * (1.0 / 40320.0) + (e % (n + 1) ? 0.0 : 1.0 / 24.0);
    multiply(n, fourth, high, result);
    for (ptrdiff_t e = 0; e < w->count; e++)
        result[e] += a[e] + square[e] * 0.5 + cube[e] * (1.0 / 6.0) + (e % (n + 1) ? 0.0 : 1.0);
}

/* Multiply the matrices of all lanes, later ones on the left. */
static void collect(const Workspace *w, const Lanes *lanes, double *result)
{
    const int n = w->n;
    double *product = (double *)matrix_of(w, HIGH);
    for (ptrdiff_t e = 0; e < w->count; e++)
        result[e] = lanes[e][0];
    for (int lane = 1; lane < LANES; lane++) {
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) {
                double sum = 0.0;
                for (int k = 0; k < n; k++)
                    sum += lanes[i * n + k][lane] * result[k * n + j];
                product[i * n + j] = sum;
            }
        memcpy(result, product, (size_t)w->count * sizeof *result);
    }
}

/* Turn the map over half a period into that over the whole one: the second half is the mirror image of the first. */
static void mirror(const Workspace *w, const Model *model, double *matrix)
{
    const int n = w->n;
    double *half = (double *)matrix_of(w, HIGH);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            half[i * n + j] = (model->parity[i % w->m] < 0 ? -1.0 : 1.0) * matrix[i * n + j];
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double sum = 0.0;
            for (int k = 0; k < n; k++)
                sum += half[i * n + k] * half[k * n + j];
            matrix[i * n + j] = sum;
        }
}

static void integrate(Workspace *w, const Model *model, const Monodromies *wanted, ptrdiff_t cycle)
{
    const ptrdiff_t steps = wanted->steps[cycle];
    const double *coefficients = wanted->coefficients + cycle * w->m * w->size;
    const int halves = steps % (2 * LANES) == 0 && alternates(model, wanted->harmonics, coefficients, 0.0, NULL);
    w->stretch = steps / LANES / (1 + halves);
    Lanes *sofar = matrix_of(w, FIRST), *next = matrix_of(w, SECOND), *factor = matrix_of(w, PRODUCT);
    for (ptrdiff_t step = 0; step < w->stretch; step++) {
        for (int point = 0; point < 2; point++)
            generate(w, model, wanted, cycle, point, step);
        exponent(w, 2.0 * M_PI / (double)steps);
        exponentiate(w, step ? factor : next);
        if (step)
            multiply(w->n, factor, sofar, next);
        Lanes *swapped = sofar;
        sofar = next;
        next = swapped;
    }
    collect(w, sofar, wanted->matrices + cycle * w->count);
    if (halves)
        mirror(w, model, wanted->matrices + cycle * w->count);
}

int integrate_monodromies(const Model *stack, const Monodromies *wanted)
{
    Workspace workspace;
    const int ready = prepare(&workspace, stack, wanted->harmonics);
    for (ptrdiff_t cycle = 0; ready && cycle < wanted->cycles; cycle++) {
        const Model model = model_of(stack, wanted->member[cycle]);
        if (wanted->steps[cycle])
            integrate(&workspace, &model, wanted, cycle);
        else
            for (ptrdiff_t e = 0; e < workspace.count; e++)
                wanted->matrices[cycle * workspace.count + e] = NAN;
    }
    release(&workspace);
    return ready;
}
