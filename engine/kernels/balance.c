/* The equations of the harmonic balance and their slopes: residual, jacobian and wind_slopes of
 * engine/cycles/harmonic_balance.py. Theory section 7.2.
 *
 * A product of the load's gradient g(tau) with a Fourier basis needs only the harmonics of g up to 2 H, since
 * 2 cos a cos b = cos(a - b) + cos(a + b) and so on: blocks of the Jacobian are sums of Toeplitz and Hankel matrices. */
#include "balance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void release_system(System *w)
{
    free(w->place), free(w->active), free(w->waves), free(w->folded), free(w->spectra), free(w->order), free(w->known);
    free(w->matrix), free(w->rows), free(w->sizes), free(w->solution), free(w->slope), free(w->x), free(w->values);
    free(w->loads), free(w->state), free(w->scratch);
}

static void fill_waves(System *w)
{
    for (int s = 0; s < w->samples; s++) {
        const double tau = 2.0 * M_PI * s / w->samples;
        double *waves = w->waves + s * 2 * w->waves_kept, *values = (double *)w->values + s;
        for (int k = 0; k <= 2 * w->harmonics && 2 * s <= w->samples; k++) {
            waves[k] = cos(k * tau) / w->samples;
            waves[w->waves_kept + k] = sin(k * tau) / w->samples;
        }
        values[0] = 1.0;
        for (int k = 1; k <= w->harmonics; k++) {
            values[(2 * k - 1) * w->groups * LANES] = cos(k * tau);
            values[2 * k * w->groups * LANES] = sin(k * tau);
        }
    }
    for (int k = 0; k < w->harmonics; k++)
        ((double *)w->order)[k] = k + 1, ((double *)w->known)[k] = 1.0;
}

int prepare_system(System *w, const Model *model, int harmonics, int besides)
{
    *w = (System){.m = model->m, .stretches = model->stretches, .harmonics = harmonics, .size = 2 * harmonics + 1};
    w->samples = model->samples > 4 * harmonics + 2 ? model->samples : 4 * harmonics + 2;
    w->groups = (w->samples + LANES - 1) / LANES;
    w->waves_kept = (2 * harmonics + LANES) / LANES * LANES;
    w->orders = harmonics + w->waves_kept;
    w->balances = w->m * w->size;
    w->unknowns = w->balances + besides;
    w->stride = w->unknowns + 2 + LANES;
    const size_t m = (size_t)w->m, n = (size_t)w->unknowns, rows = (size_t)row_count(w), width = 2 * (size_t)w->orders;
    const size_t half = (size_t)w->samples / 2 + 1;
    w->place = calloc(n, sizeof *w->place);
    w->active = calloc(2 * m, sizeof *w->active);
    w->waves = calloc(half * 2 * (size_t)w->waves_kept, sizeof *w->waves);
    w->folded = calloc(2 * half, sizeof *w->folded);
    w->spectra = calloc(rows * width + LANES, sizeof *w->spectra);
    w->order = calloc((size_t)harmonics / LANES + 1, sizeof *w->order);
    w->known = calloc((size_t)harmonics / LANES + 1, sizeof *w->known);
    w->matrix = calloc(n * (size_t)w->stride, sizeof *w->matrix);
    w->rows = calloc(n, sizeof *w->rows);
    w->sizes = calloc(n + LANES, sizeof *w->sizes);
    w->solution = calloc(2 * n, sizeof *w->solution);
    w->slope = calloc(m * (size_t)w->size, sizeof *w->slope);
    w->x = calloc(n, sizeof *w->x);
    w->values = calloc((size_t)(w->size * w->groups), sizeof *w->values);
    w->loads = calloc(rows * (size_t)w->groups, sizeof *w->loads);
    w->state = calloc(5 * m + 2 * m * m, sizeof *w->state);
    w->scratch = calloc(load_scratch(model), sizeof *w->scratch);
    if (!(w->place && w->active && w->waves && w->folded && w->spectra && w->order && w->known
          && w->matrix && w->rows && w->sizes && w->solution && w->slope && w->x && w->values
          && w->loads && w->state && w->scratch))
        return 0;
    fill_waves(w);
    return 1;
}

void arrange_system(System *w, const Model *model)
{
    const int m = w->m;
    memset(w->active, 0, 2 * (size_t)m * sizeof *w->active);
    for (int v = 0; v < 2 * m; v++)
        w->active[v] = model->samples > 0;
    for (int row = 0; row < model->points * model->local && !model->samples; row++)
        for (int v = 0; v < 2 * m; v++)
            w->active[v] |= model->forms[(ptrdiff_t)row * 2 * m + v] != 0.0;
    for (int j = 0; j < m; j++)
        w->active[j] |= w->stretches;
    int next = 0;
    for (int active = 0; active < 2; active++)
        for (int j = 0; j < m; j++)
            if ((w->active[j] || w->active[m + j]) == active)
                for (int c = 0; c < w->size; c++)
                    w->place[j * w->size + c] = next++;
    for (; next < w->unknowns; next++)
        w->place[next] = next;
    memset(w->spectra, 0, (size_t)row_count(w) * 2 * (size_t)w->orders * sizeof *w->spectra);
}

static void differentiate(System *w, const double *coefficients)
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

WITHIN Lanes series(const System *w, const double *coefficients, int group)
{
    Lanes sum = {0};
    for (int c = 0; c < w->size; c++)
        sum += coefficients[c] * w->values[c * w->groups + group];
    return sum;
}

/* Evaluate the load, its gradient and its derivative by w / U at every sample. */
WIDE static void sample(System *w, const Model *model, const double *coefficients, double rate, double speed)
{
    const int m = w->m;
    Lanes *state = w->state, *motion = state + 2 * m, *force = motion + m, *restoring = force + m;
    Lanes *gradient = restoring + m;
    for (int group = 0; group < w->groups; group++) {
        for (int j = 0; j < m; j++) {
            state[j] = series(w, coefficients + j * w->size, group);
            motion[j] = series(w, w->slope + j * w->size, group);
            state[m + j] = rate * motion[j];
        }
        load_at(model, speed, state, force, gradient, restoring, w->scratch);
        for (int i = 0; i < m; i++) {
            Lanes by_rate = {0};
            for (int v = 0; v < 2 * m; v++)
                w->loads[gradient_row(w, i, v) * w->groups + group] = gradient[i * 2 * m + v];
            for (int j = 0; j < m; j++)
                by_rate += gradient[i * 2 * m + m + j] * motion[j];
            w->loads[force_row(i) * w->groups + group] = force[i];
            w->loads[rate_row(w, i) * w->groups + group] = by_rate;
            w->loads[restoring_row(w, i) * w->groups + group] = restoring[i];
        }
    }
}

/* Transform one row of the load for k up to `last`: cos k tau needs only the sums of the samples at tau and -tau, sin k tau
 * only the differences. */
WITHIN void fold_and_sum(System *w, int harmonics, int half, int row, int last)
{
    const double *load = (const double *)(w->loads + row * w->groups);
    const int kept = (2 * harmonics + LANES) / LANES * LANES;
    double *sums = w->folded, *differences = w->folded + half + 1;
    double *even = w->spectra + row * 2 * w->orders + harmonics, *odd = even + w->orders;
    sums[0] = load[0], sums[half] = load[half];
    for (int s = 1; s < half; s++) {
        sums[s] = load[s] + load[2 * half - s];
        differences[s] = load[s] - load[2 * half - s];
    }
    for (int k = 0; k <= last; k += LANES) {
        const double *waves = w->waves + k;
        Lanes by_cosine = {0}, by_sine = {0};
        for (int s = 0; s <= half; s++, waves += 2 * kept) {
            by_cosine += sums[s] * *(const Lanes *)waves;
            by_sine += differences[s] * *(const Lanes *)(waves + kept);
        }
        *(Lanes *)(even + k) = by_cosine;
        *(Lanes *)(odd + k) = by_sine;
    }
    for (int k = 1; k <= harmonics; k++) {
        even[-k] = even[k];
        odd[-k] = -odd[k];
    }
}

WIDE static void transform(System *w, int row, int last)
{
    if (w->harmonics == 5 && w->samples == 22) /* the default: the compiler unrolls loops of known length */
        fold_and_sum(w, 5, 11, row, last);
    else
        fold_and_sum(w, w->harmonics, w->samples / 2, row, last);
}

/* Transform every row of the load that can be nonzero. */
static void transform_all(System *w)
{
    for (int i = 0; i < w->m; i++) {
        transform(w, force_row(i), w->harmonics);
        transform(w, rate_row(w, i), w->harmonics);
        if (w->stretches)
            transform(w, restoring_row(w, i), w->harmonics);
        for (int v = 0; v < 2 * w->m; v++)
            if (w->active[v])
                transform(w, gradient_row(w, i, v), 2 * w->harmonics);
    }
}

/* Return the first entry of the block of equation i and coordinate j. */
static double *block_of(const System *w, int i, int j)
{
    return w->matrix + (ptrdiff_t)w->place[i * w->size] * w->stride + w->place[j * w->size];
}

WITHIN Lanes at(const double *first) { return *(const Lanes *)first; }

/* Subtract x_1, y_1, x_2, y_2, ... from consecutive entries. */
WITHIN void subtract_pairs(double *entries, Lanes x, Lanes y)
{
    for (int lane = 0; lane < LANES; lane++) {
        entries[2 * lane] -= x[lane];
        entries[2 * lane + 1] -= y[lane];
    }
}

/* Subtract U^2 P diag(df/dq) V + U w P diag(df/d(q'/U)) V D from the block of equation i and coordinate j, with V the
 * basis at the samples, P its projection and D its derivative: with E and O the even and the odd spectrum,
 * cos a cos b gives E(b - a) + E(a + b), cos a sin b gives O(a + b) + O(b - a), and so on. */
WIDE static void subtract_load_block(System *w, int i, int j, double speed, double omega)
{
    const double *even = spectrum(w, gradient_row(w, i, j)), *odd = even + w->orders;
    const double *rate_even = spectrum(w, gradient_row(w, i, w->m + j)), *rate_odd = rate_even + w->orders;
    double *block = block_of(w, i, j);
    for (int a = 0; a <= w->harmonics; a++) {
        const double weight = a ? 1.0 : 0.5, f = weight * speed * speed, g = weight * speed * omega;
        double *cosine = block + (a ? 2 * a - 1 : 0) * w->stride, *sine = cosine + w->stride;
        cosine[0] -= 2.0 * f * even[a];
        if (a)
            sine[0] -= 2.0 * f * odd[a];
        for (int b = 1; b <= w->harmonics; b += LANES) {
            const Lanes by_q = f * w->known[b / LANES], by_rate = g * w->order[b / LANES];
            const Lanes e = at(even + b - a), e_sum = at(even + a + b), o = at(odd + b - a), o_sum = at(odd + a + b);
            const Lanes r = at(rate_even + b - a), r_sum = at(rate_even + a + b);
            const Lanes t = at(rate_odd + b - a), t_sum = at(rate_odd + a + b);
            subtract_pairs(cosine + 2 * b - 1, by_q * (e + e_sum) - by_rate * (t_sum + t),
                           by_q * (o_sum + o) + by_rate * (r + r_sum));
            if (a)
                subtract_pairs(sine + 2 * b - 1, by_q * (o_sum - o) - by_rate * (r - r_sum),
                               by_q * (e - e_sum) + by_rate * (t_sum - t));
        }
    }
}

/* Add K - a^2 w^2 M and a w C to the block of equation i and coordinate j. */
static void add_linear_block(System *w, const Model *model, int i, int j, double omega)
{
    const int at = i * w->m + j;
    double *block = block_of(w, i, j);
    block[0] += model->stiffness[at];
    for (int a = 1; a <= w->harmonics; a++) {
        const double elastic = model->stiffness[at] - a * a * omega * omega * model->mass[at];
        const double viscous = a * omega * model->damping[at];
        double *cosine = block + (2 * a - 1) * w->stride + 2 * a - 1, *sine = cosine + w->stride;
        cosine[0] += elastic;
        cosine[1] += viscous;
        sine[0] -= viscous;
        sine[1] += elastic;
    }
}

/* Add the linear terms of coordinate j to the residual of equation i and to its slope by w. */
static void add_motion(System *w, const Model *model, int i, int j, const double *x)
{
    const int at = i * w->m + j;
    const double mass = model->mass[at], damping = model->damping[at], omega = x[w->balances];
    double *row = w->matrix + (ptrdiff_t)w->place[i * w->size] * w->stride;
    for (int c = 0; c < w->size; c++, row += w->stride) {
        const double a = x[j * w->size + c], slope = w->slope[j * w->size + c];
        const double bend = -((c + 1) / 2) * ((c + 1) / 2) * a;
        row[w->balances] += 2.0 * omega * mass * bend + damping * slope;
        row[w->unknowns] += omega * (omega * mass * bend + damping * slope) + model->stiffness[at] * a;
    }
}

/* Subtract the load's harmonics from the residual of equation i and from its slopes by w and U: with f(q, w q'/U) and
 * g(q), d(U^2 P (f - g/U^2))/dU = 2 U P f - w P df/d(w/U). */
static void subtract_load(System *w, int i, double omega, double speed)
{
    const double *forces = spectrum(w, force_row(i)), *by_rate = spectrum(w, rate_row(w, i));
    const double *restoring = spectrum(w, restoring_row(w, i));
    double *row = w->matrix + (ptrdiff_t)w->place[i * w->size] * w->stride;
    for (int c = 0; c < w->size; c++, row += w->stride) {
        const int at = (c + 1) / 2 + (c % 2 == 0 && c ? w->orders : 0);
        const double weight = c ? 2.0 : 1.0;
        row[w->balances] -= weight * speed * by_rate[at];
        if (w->unknowns > w->balances + 1)
            row[w->balances + 1] -= weight * (2.0 * speed * (forces[at] + restoring[at]) - omega * by_rate[at]);
        row[w->unknowns] -= weight * speed * speed * forces[at];
    }
}

void assemble_system(System *w, const Model *model, const double *x, double speed)
{
    const int m = w->m;
    const double omega = x[w->balances];
    memset(w->matrix, 0, (size_t)w->unknowns * (size_t)w->stride * sizeof *w->matrix);
    differentiate(w, x);
    sample(w, model, x, omega / speed, speed);
    transform_all(w);
    for (int i = 0; i < m; i++) {
        subtract_load(w, i, omega, speed);
        for (int j = 0; j < m; j++) {
            add_motion(w, model, i, j, x);
            add_linear_block(w, model, i, j, omega);
            if (w->active[j] || w->active[m + j])
                subtract_load_block(w, i, j, speed, omega);
        }
    }
}
