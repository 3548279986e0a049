/* Harmonic balance by Newton's method, one cycle after another. engine/harmonic.py, theory section 7.2.
 *
 * A product of the load's gradient g(tau) with a Fourier basis needs only the harmonics of g up to 2 H, since
 * 2 cos a cos b = cos(a - b) + cos(a + b) and so on: blocks of the Jacobian are sums of Toeplitz and Hankel matrices. */
#include "kernels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    int m, harmonics, size, unknowns, stride, samples, groups;
    int *order;          /* position of each co-ordinate: those on which the load does not depend first */
    int *active;         /* whether the load depends on it, (m) */
    int *pivots;         /* (unknowns) */
    double *waves;       /* (samples, 4 H + 2): cos k tau / samples, k = 0 ... 2 H, then sin k tau / samples */
    double *spectra;     /* (rows, 4 H + 2): the same of every row of the load */
    double *matrix;      /* (unknowns, stride) */
    double **rows;       /* (unknowns), into the matrix */
    double *change;      /* (unknowns) */
    double *slope;       /* (m, 2 H + 1), coefficients of dq/dtau */
    Lanes *values;       /* (2 H + 1, groups), the basis at groups of samples, 0 beyond the last */
    Lanes *loads;        /* (rows, groups): f, its gradient, and its derivative by w / U */
    Lanes *state, *scratch;
} Workspace;

enum { FORCE = 0 };
static int gradient_row(const Workspace *w, int i, int v) { return w->m + i * 2 * w->m + v; }
static int frequency_row(const Workspace *w, int i) { return w->m + w->m * 2 * w->m + i; }
static int row_count(const Workspace *w) { return 2 * w->m * (1 + w->m); }

static void release(Workspace *w)
{
    free(w->order), free(w->active), free(w->pivots), free(w->waves), free(w->spectra), free(w->matrix);
    free(w->rows), free(w->change), free(w->slope), free(w->values), free(w->loads), free(w->state), free(w->scratch);
}

static void fill_waves(Workspace *w)
{
    const int orders = 2 * w->harmonics + 1;
    for (int s = 0; s < w->samples; s++) {
        const double tau = 2.0 * M_PI * s / w->samples;
        for (int k = 0; k < orders; k++) {
            w->waves[s * w->samples + k] = cos(k * tau) / w->samples;
            w->waves[s * w->samples + orders + k] = sin(k * tau) / w->samples;
        }
        ((double *)w->values)[s] = 1.0;
        for (int k = 1; k <= w->harmonics; k++) {
            ((double *)(w->values + (2 * k - 1) * w->groups))[s] = cos(k * tau);
            ((double *)(w->values + 2 * k * w->groups))[s] = sin(k * tau);
        }
    }
}

static int prepare(Workspace *w, const Model *model, int harmonics)
{
    *w = (Workspace){.m = model->m, .harmonics = harmonics, .size = 2 * harmonics + 1};
    w->samples = 4 * harmonics + 2;
    w->groups = (w->samples + LANES - 1) / LANES;
    w->unknowns = w->m * w->size + 1;
    w->stride = (w->unknowns + LANES - 1) / LANES * LANES;
    const size_t m = (size_t)w->m, n = (size_t)w->unknowns, rows = (size_t)row_count(w), samples = (size_t)w->samples;
    w->order = calloc(m, sizeof *w->order);
    w->active = calloc(m, sizeof *w->active);
    w->pivots = calloc(n, sizeof *w->pivots);
    w->waves = calloc(samples * samples, sizeof *w->waves);
    w->spectra = calloc(rows * samples, sizeof *w->spectra);
    w->matrix = calloc(n * (size_t)w->stride, sizeof *w->matrix);
    w->rows = calloc(n, sizeof *w->rows);
    w->change = calloc(n, sizeof *w->change);
    w->slope = calloc(m * (size_t)w->size, sizeof *w->slope);
    w->values = calloc((size_t)(w->size * w->groups), sizeof *w->values);
    w->loads = calloc(rows * (size_t)w->groups, sizeof *w->loads);
    w->state = calloc(4 * m + 2 * m * m, sizeof *w->state);
    w->scratch = calloc(load_scratch(model), sizeof *w->scratch);
    if (!(w->order && w->active && w->pivots && w->waves && w->spectra && w->matrix && w->rows && w->change && w->slope
          && w->values && w->loads && w->state && w->scratch))
        return 0;
    fill_waves(w);
    return 1;
}

/* Put the co-ordinates first on which the load does not depend: their columns are nearly empty. */
static void arrange(Workspace *w, const Model *model)
{
    const int m = w->m;
    int position = 0;
    memset(w->active, 0, (size_t)m * sizeof *w->active);
    for (int l = 0; l < model->points * model->local; l++)
        for (int v = 0; v < 2 * m; v++)
            w->active[v % m] |= model->forms[(ptrdiff_t)l * 2 * m + v] != 0.0;
    for (int active = 0; active < 2; active++)
        for (int j = 0; j < m; j++)
            if (w->active[j] == active)
                w->order[j] = position++;
}

static void differentiate(Workspace *w, const double *coefficients)
{
    for (int j = 0; j < w->m; j++) {
        const double *a = coefficients + j * w->size;
        double *slope = w->slope + j * w->size;
        for (int k = 1; k <= w->harmonics; k++) {
            slope[2 * k - 1] = k * a[2 * k];
            slope[2 * k] = -k * a[2 * k - 1];
        }
    }
}

static inline Lanes series(const Workspace *w, const double *coefficients, int group)
{
    Lanes sum = {0};
    for (int c = 0; c < w->size; c++)
        sum += coefficients[c] * w->values[c * w->groups + group];
    return sum;
}

/* Evaluate the load, its gradient and its derivative by w / U at every sample. */
WIDE static void sample(Workspace *w, const Model *model, const double *coefficients, double rate)
{
    const int m = w->m;
    Lanes *state = w->state, *motion = state + 2 * m, *force = motion + m, *gradient = force + m;
    for (int group = 0; group < w->groups; group++) {
        for (int j = 0; j < m; j++) {
            state[j] = series(w, coefficients + j * w->size, group);
            motion[j] = series(w, w->slope + j * w->size, group);
            state[m + j] = rate * motion[j];
        }
        load_at(model, state, force, gradient, w->scratch);
        for (int i = 0; i < m; i++) {
            Lanes by_rate = {0};
            w->loads[(FORCE + i) * w->groups + group] = force[i];
            for (int v = 0; v < 2 * m; v++)
                w->loads[gradient_row(w, i, v) * w->groups + group] = gradient[i * 2 * m + v];
            for (int j = 0; j < m; j++)
                by_rate += gradient[i * 2 * m + m + j] * motion[j];
            w->loads[frequency_row(w, i) * w->groups + group] = by_rate;
        }
    }
}

/* Transform every row of the load that is not zero for good. */
WIDE static void transform(Workspace *w)
{
    const int count = w->samples, m = w->m;
    for (int row = 0; row < row_count(w); row++) {
        const int v = row - m;
        if (v >= 0 && v < 2 * m * m && !w->active[v % m])
            continue;
        const double *load = (const double *)(w->loads + row * w->groups);
        double *restrict spectrum = w->spectra + row * count;
        memset(spectrum, 0, (size_t)count * sizeof *spectrum);
        for (int s = 0; s < count; s++)
            for (int k = 0; k < count; k++)
                spectrum[k] += load[s] * w->waves[s * count + k];
    }
}

/* Add factor P diag(g) V, or its product with the derivative, to the block of equation i and co-ordinate j. */
WIDE static void add_product(Workspace *w, int i, int j, const double *spectrum, double factor, int derived)
{
    const int harmonics = w->harmonics;
    const double *even = spectrum, *odd = spectrum + 2 * harmonics + 1;
    double *block = w->matrix + (ptrdiff_t)w->order[i] * w->size * w->stride + w->order[j] * w->size;
    for (int a = 0; a <= harmonics; a++) {
        const double weight = a ? factor : 0.5 * factor;
        double *cosine = block + (a ? 2 * a - 1 : 0) * w->stride, *sine = block + 2 * a * w->stride;
        for (int b = derived; b <= harmonics; b++) {
            const double scale = derived ? weight * b : weight;
            const double difference = a < b ? -odd[b - a] : odd[a - b];
            const double cc = scale * (even[abs(a - b)] + even[a + b]), ss = scale * (even[abs(a - b)] - even[a + b]);
            const double cs = scale * (odd[a + b] - difference), sc = scale * (odd[a + b] + difference);
            const int c = b ? 2 * b - 1 : 0, s = 2 * b;
            cosine[c] += derived ? -cs : cc;
            if (b)
                cosine[s] += derived ? cc : cs;
            if (a)
                sine[c] += derived ? -ss : sc;
            if (a && b)
                sine[s] += derived ? sc : ss;
        }
    }
}

/* Add (K - a^2 w^2 M) and a w C of one block. */
static void add_linear(Workspace *w, const Model *model, int i, int j, double omega)
{
    const int at = i * w->m + j;
    double *block = w->matrix + (ptrdiff_t)w->order[i] * w->size * w->stride + w->order[j] * w->size;
    block[0] += model->stiffness[at];
    for (int a = 1; a <= w->harmonics; a++) {
        const double elastic = model->stiffness[at] - a * a * omega * omega * model->mass[at];
        const double viscous = a * omega * model->damping[at];
        double *cosine = block + (2 * a - 1) * w->stride + 2 * a - 1, *sine = block + 2 * a * w->stride + 2 * a - 1;
        cosine[0] += elastic;
        cosine[1] += viscous;
        sine[0] -= viscous;
        sine[1] += elastic;
    }
}

/* Coefficient c of equation i's linear part and of its derivative by w; e is the sum over the co-ordinates. */
static void add_motion(Workspace *w, const Model *model, int i, const double *coefficients, double omega)
{
    double *residual = w->change + w->order[i] * w->size;
    double *by_omega = w->matrix + (ptrdiff_t)w->order[i] * w->size * w->stride + w->unknowns - 1;
    for (int j = 0; j < w->m; j++) {
        const int at = i * w->m + j;
        const double mass = model->mass[at], damping = model->damping[at], stiffness = model->stiffness[at];
        for (int c = 0; c < w->size; c++) {
            const double a = coefficients[j * w->size + c], slope = w->slope[j * w->size + c];
            const double bend = -((c + 1) / 2) * ((c + 1) / 2) * a;
            residual[c] += omega * omega * mass * bend + omega * damping * slope + stiffness * a;
            by_omega[c * w->stride] += 2.0 * omega * mass * bend + damping * slope;
        }
    }
}

/* Subtract the load's harmonics from equation i and from its derivative by w. */
static void subtract_load(Workspace *w, int i, double speed)
{
    const int orders = 2 * w->harmonics + 1;
    const double *force = w->spectra + (FORCE + i) * w->samples, *by_rate = w->spectra + frequency_row(w, i) * w->samples;
    double *residual = w->change + w->order[i] * w->size;
    double *by_omega = w->matrix + (ptrdiff_t)w->order[i] * w->size * w->stride + w->unknowns - 1;
    for (int c = 0; c < w->size; c++) {
        const int at = (c + 1) / 2 + (c && c % 2 == 0 ? orders : 0);
        const double weight = c ? 2.0 : 1.0;
        residual[c] -= weight * speed * speed * force[at];
        by_omega[c * w->stride] -= weight * speed * by_rate[at];
    }
}

/* Fill the matrix of the balance and of the phase condition, and the right side, both in the order of elimination. */
static void assemble(Workspace *w, const Model *model, const Balances *balances, ptrdiff_t cycle, const double *given)
{
    const int m = w->m, last = w->unknowns - 1;
    const double *x = balances->x + cycle * w->unknowns, *reference = balances->reference + cycle * last;
    const double omega = x[last], speed = balances->wind_speed[cycle];
    memset(w->matrix, 0, (size_t)w->unknowns * (size_t)w->stride * sizeof *w->matrix);
    memset(w->change, 0, (size_t)w->unknowns * sizeof *w->change);
    differentiate(w, x);
    sample(w, model, x, omega / speed);
    transform(w);
    for (int i = 0; i < m; i++) {
        add_motion(w, model, i, x, omega);
        subtract_load(w, i, speed);
        for (int j = 0; j < m; j++) {
            add_linear(w, model, i, j, omega);
            if (w->active[j]) {
                add_product(w, i, j, w->spectra + gradient_row(w, i, j) * w->samples, -speed * speed, 0);
                add_product(w, i, j, w->spectra + gradient_row(w, i, m + j) * w->samples, -speed * omega, 1);
            }
        }
    }
    double *phase = w->matrix + (ptrdiff_t)last * w->stride;
    for (int j = 0; j < m; j++)
        for (int c = 0; c < w->size; c++) {
            const int from = j * w->size + c;
            phase[w->order[j] * w->size + c] = reference[from];
            w->change[last] += reference[from] * (x[from] - given[from]);
        }
    for (int i = 0; i < w->unknowns; i++)
        w->rows[i] = w->matrix + (ptrdiff_t)i * w->stride;
}

static inline int position(const Workspace *w, int unknown)
{
    return unknown == w->unknowns - 1 ? unknown : w->order[unknown / w->size] * w->size + unknown % w->size;
}

/* Return the root mean square of change / scale. */
static double scaled_size(const Workspace *w, const double *scale)
{
    double sum = 0.0;
    for (int u = 0; u < w->unknowns; u++) {
        const double part = w->change[position(w, u)] / scale[u];
        sum += part * part;
    }
    return sqrt(sum / w->unknowns);
}

static void iterate(Workspace *w, const Model *model, const Balances *balances, ptrdiff_t cycle, const Options *options,
                    double *given)
{
    double *x = balances->x + cycle * w->unknowns;
    const double *scale = balances->scale + cycle * w->unknowns;
    memcpy(given, x, (size_t)w->unknowns * sizeof *given);
    for (int u = 0; u < w->unknowns; u++)
        if (!isfinite(x[u]))
            return;
    for (int iteration = 0; iteration < options->iterations; iteration++) {
        assemble(w, model, balances, cycle, given);
        if (!factorize(w->unknowns, w->rows, w->pivots))
            return;
        substitute(w->unknowns, w->rows, w->pivots, w->change);
        const double size = scaled_size(w, scale);
        if (!isfinite(size))
            return;
        const double taken = size > options->largest_step ? options->largest_step / size : 1.0;
        for (int u = 0; u < w->unknowns; u++)
            x[u] -= taken * w->change[position(w, u)];
        balances->step[cycle] = size;
        balances->iterations[cycle] = iteration + 1;
        if (size <= options->tolerance)
            return;
    }
}

int solve_balances(const Model *stack, const Balances *balances, const Options *options)
{
    Workspace workspace;
    double *given = calloc((size_t)(stack->m * (2 * balances->harmonics + 1) + 1), sizeof *given);
    const int ready = prepare(&workspace, stack, balances->harmonics) && given;
    for (ptrdiff_t cycle = 0; ready && cycle < balances->cycles; cycle++) {
        const Model model = model_of(stack, balances->member[cycle]);
        arrange(&workspace, &model);
        iterate(&workspace, &model, balances, cycle, options, given);
    }
    release(&workspace);
    free(given);
    return ready;
}
