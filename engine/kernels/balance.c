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
    for (int kind = 0; kind < KINDS; kind++)
        free(w->kinds[kind].waves), free(w->kinds[kind].order), free(w->kinds[kind].known);
    free(w->kind), free(w->first), free(w->kept), free(w->active), free(w->folded), free(w->spectra), free(w->matrix);
    free(w->rows), free(w->sizes), free(w->solution), free(w->slope), free(w->x), free(w->values), free(w->loads);
    free(w->state), free(w->scratch);
}

/* Allocate and fill the harmonics of one kind, read from so many of the samples; return 0 if memory is short. */
static int prepare_orders(Orders *kind, int step, int lowest, int harmonics, int samples, int read)
{
    const int doubled = (2 * harmonics - lowest + step) / step;
    *kind = (Orders){.step = step, .lowest = lowest, .count = (harmonics - lowest + step) / step, .samples = read};
    kind->kept = (doubled + LANES - 1) / LANES * LANES;
    kind->waves = calloc(((size_t)read / 2 + 1) * 2 * (size_t)kind->kept, sizeof *kind->waves);
    kind->order = calloc((size_t)kind->count / LANES + 1, sizeof *kind->order);
    kind->known = calloc((size_t)kind->count / LANES + 1, sizeof *kind->known);
    if (!(kind->waves && kind->order && kind->known))
        return 0;
    for (int s = 0; 2 * s <= read; s++)
        for (int n = 0; n < doubled; n++) {
            const double angle = 2.0 * M_PI * s / samples * (step * n + lowest);
            kind->waves[s * 2 * kind->kept + n] = cos(angle) / read;
            kind->waves[(s * 2 + 1) * kind->kept + n] = sin(angle) / read;
        }
    for (int n = !lowest; n < kind->count; n++)
        ((double *)kind->order)[n - !lowest] = step * n + lowest, ((double *)kind->known)[n - !lowest] = 1.0;
    return 1;
}

static void fill_values(System *w)
{
    for (int s = 0; s < w->samples; s++) {
        double *values = (double *)w->values + s;
        values[0] = 1.0;
        for (int k = 1; k <= w->harmonics; k++) {
            values[(2 * k - 1) * w->value_groups * LANES] = cos(2.0 * M_PI * s / w->samples * k);
            values[2 * k * w->value_groups * LANES] = sin(2.0 * M_PI * s / w->samples * k);
        }
    }
}

int prepare_system(System *w, const Model *model, int harmonics, int besides)
{
    *w = (System){.m = model->m, .stretches = model->stretches, .harmonics = harmonics, .size = 2 * harmonics + 1};
    w->samples = model->samples > 4 * harmonics + 2 ? model->samples : 4 * harmonics + 2;
    w->value_groups = (w->samples + LANES - 1) / LANES;
    w->coefficients = w->m * w->size;
    w->besides = besides;
    w->orders = harmonics + (2 * harmonics + LANES) / LANES * LANES;
    const size_t m = (size_t)w->m, n = (size_t)(w->coefficients + besides), half = (size_t)w->samples / 2 + 1;
    const size_t rows = (size_t)row_count(w);
    int ready = 1;
    for (int kind = 0; kind < KINDS; kind++) {
        const int whole = kind == EVERY;
        ready &= prepare_orders(&w->kinds[kind], 2 - whole, kind == ODD, harmonics, w->samples, w->samples / (2 - whole));
    }
    w->kind = calloc(m, sizeof *w->kind);
    w->first = calloc(m, sizeof *w->first);
    w->kept = calloc(n, sizeof *w->kept);
    w->active = calloc(2 * m, sizeof *w->active);
    w->folded = calloc(2 * half, sizeof *w->folded);
    w->spectra = calloc(rows * 2 * (size_t)w->orders + LANES, sizeof *w->spectra);
    w->matrix = calloc(n * (n + 2 + LANES), sizeof *w->matrix);
    w->rows = calloc(n, sizeof *w->rows);
    w->sizes = calloc(n + LANES, sizeof *w->sizes);
    w->solution = calloc(2 * n + LANES, sizeof *w->solution);
    w->slope = calloc((size_t)w->coefficients, sizeof *w->slope);
    w->x = calloc((size_t)w->coefficients + 2, sizeof *w->x);
    w->values = calloc((size_t)(w->size * w->value_groups), sizeof *w->values);
    w->loads = calloc(rows * (size_t)w->value_groups, sizeof *w->loads);
    w->state = calloc(5 * m + 2 * m * m, sizeof *w->state);
    w->scratch = calloc(load_scratch(model), sizeof *w->scratch);
    if (!(ready && w->kind && w->first && w->kept && w->active && w->folded && w->spectra && w->matrix && w->rows
          && w->sizes && w->solution && w->slope && w->x && w->values && w->loads && w->state && w->scratch))
        return 0;
    fill_values(w);
    return 1;
}

/* Note on which components of (q, q'/U) the load depends. */
static void find_active(System *w, const Model *model)
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
}

static const Orders *orders_of(const System *w, int j) { return &w->kinds[w->kind[j]]; }

/* Return the number of coefficients with these orders. */
static int terms_of(const Orders *kind) { return 2 * kind->count - !kind->lowest; }

/* Return where the term-th coefficient with these orders stands among mean, cos 1, sin 1, .... */
static int place_of(const Orders *kind, int term)
{
    const int c = term + kind->lowest, order = kind->step * ((c + 1) / 2 - kind->lowest) + kind->lowest;
    return c ? 2 * order - c % 2 : 0;
}

void arrange_system(System *w, const Model *model, int alternates)
{
    find_active(w, model);
    w->alternates = alternates;
    int next = 0;
    for (int active = 0; active < 2; active++)
        for (int j = 0; j < w->m; j++)
            if ((w->active[j] || w->active[w->m + j]) == active) {
                w->kind[j] = !alternates ? EVERY : model->parity[j] < 0 ? ODD : EVEN;
                w->first[j] = next;
                for (int term = 0; term < terms_of(orders_of(w, j)); term++)
                    w->kept[next++] = j * w->size + place_of(orders_of(w, j), term);
            }
    w->balances = next;
    w->unknowns = next + w->besides;
    for (int i = 0; i < w->besides; i++)
        w->kept[next + i] = w->coefficients + i;
    w->stride = w->unknowns + 2 + LANES;
    w->groups = (w->kinds[alternates ? ODD : EVERY].samples + LANES - 1) / LANES;
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

/* Sum the harmonics of a coordinate at a group of samples. */
WITHIN Lanes series(const System *w, int j, const double *coefficients, int group)
{
    const Orders *kind = orders_of(w, j);
    const Lanes *values = w->values + group;
    Lanes sum = {0};
    if (!kind->lowest)
        sum += coefficients[j * w->size] * values[0];
    for (int k = kind->lowest ? 1 : kind->step; k <= w->harmonics; k += kind->step) {
        sum += coefficients[j * w->size + 2 * k - 1] * values[(2 * k - 1) * w->value_groups];
        sum += coefficients[j * w->size + 2 * k] * values[2 * k * w->value_groups];
    }
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
            state[j] = series(w, j, coefficients, group);
            motion[j] = series(w, j, w->slope, group);
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

/* Transform one row of the load for its first orders: cos k tau needs only the sums of the samples at tau and -tau, sin k tau
 * only the differences. Half a period later a row of odd orders has the other sign, so -tau is half a period less tau. */
WITHIN void fold_and_sum(System *w, int samples, int kept, const Orders *kind, int row, int count)
{
    const double *load = (const double *)(w->loads + row * w->groups);
    const double sign = kind->step == 2 && kind->lowest ? -1.0 : 1.0;
    const int half = samples / 2;
    double *sums = w->folded, *differences = w->folded + half + 1;
    double *even = w->spectra + row * 2 * w->orders + w->harmonics, *odd = even + w->orders;
    sums[0] = load[0], differences[0] = 0.0;
    for (int s = 1; 2 * s < samples; s++) {
        sums[s] = load[s] + sign * load[samples - s];
        differences[s] = load[s] - sign * load[samples - s];
    }
    if (samples % 2 == 0)
        sums[half] = differences[half] = load[half];
    for (int n = 0; n < count; n += LANES) {
        const double *waves = kind->waves + n;
        Lanes by_cosine = {0}, by_sine = {0};
        for (int s = 0; s <= half; s++, waves += 2 * kept) {
            by_cosine += sums[s] * *(const Lanes *)waves;
            by_sine += differences[s] * *(const Lanes *)(waves + kept);
        }
        *(Lanes *)(even + n) = by_cosine;
        *(Lanes *)(odd + n) = by_sine;
    }
    for (int n = 1; n < kind->count + kind->lowest; n++) {
        even[-n] = even[n - kind->lowest];
        odd[-n] = -odd[n - kind->lowest];
    }
}

/* Transform a row whose orders are of this kind, up to so many. */
WIDE static void transform(System *w, const Orders *kind, int row, int highest)
{
    const int count = (highest - kind->lowest + kind->step) / kind->step;
    if (kind->samples == 22 && kind->kept == 12) /* the default: the compiler unrolls loops of known length */
        fold_and_sum(w, 22, 12, kind, row, count);
    else if (kind->samples == 11 && kind->kept == 8) /* and half of it */
        fold_and_sum(w, 11, 8, kind, row, count);
    else
        fold_and_sum(w, kind->samples, kind->kept, kind, row, count);
}

/* Return the orders of the load's gradient on coordinate i by coordinate j. */
static const Orders *orders_between(const System *w, int i, int j)
{
    return !w->alternates ? &w->kinds[EVERY] : w->kind[i] == w->kind[j] ? &w->kinds[EVEN] : &w->kinds[ODD];
}

/* Transform every row of the load that can be nonzero. */
static void transform_all(System *w)
{
    for (int i = 0; i < w->m; i++) {
        transform(w, orders_of(w, i), force_row(i), w->harmonics);
        transform(w, orders_of(w, i), rate_row(w, i), w->harmonics);
        if (w->stretches)
            transform(w, orders_of(w, i), restoring_row(w, i), w->harmonics);
        for (int v = 0; v < 2 * w->m; v++)
            if (w->active[v])
                transform(w, orders_between(w, i, v % w->m), gradient_row(w, i, v), 2 * w->harmonics);
    }
}

/* Return the first entry of the block of equation i and coordinate j. */
static double *block_of(const System *w, int i, int j)
{
    return w->matrix + (ptrdiff_t)w->first[i] * w->stride + w->first[j];
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
 * cos a cos b gives E(b - a) + E(a + b), cos a sin b gives O(a + b) + O(b - a), and so on. The orders a and b are those of
 * i and j; below, `from` and `to` are where b - a and a + b stand in a spectrum. */
WIDE static void subtract_load_block(System *w, int i, int j, double speed, double omega)
{
    const Orders *of_a = orders_of(w, i), *of_b = orders_of(w, j), *between = orders_between(w, i, j);
    const double *even = spectrum(w, gradient_row(w, i, j)), *odd = even + w->orders;
    const double *rate_even = spectrum(w, gradient_row(w, i, w->m + j)), *rate_odd = rate_even + w->orders;
    const int less = (of_b->lowest - of_a->lowest - between->lowest) / 2;
    const int more = (of_a->lowest + of_b->lowest - between->lowest) / 2;
    const int mean = !of_b->lowest, waves = of_b->count - mean;
    for (int n = 0; n < of_a->count; n++) {
        const int a = of_a->step * n + of_a->lowest;
        const double weight = a ? 1.0 : 0.5, f = weight * speed * speed, g = weight * speed * omega;
        double *cosine = block_of(w, i, j) + (a ? 2 * n - !of_a->lowest : 0) * w->stride, *sine = cosine + w->stride;
        if (mean)
            cosine[0] -= 2.0 * f * even[n];
        if (mean && a)
            sine[0] -= 2.0 * f * odd[n];
        for (int p = 0; p < waves; p += LANES) {
            const Lanes by_q = f * of_b->known[p / LANES], by_rate = g * of_b->order[p / LANES];
            const int from = p + mean - n + less, to = p + mean + n + more;
            const Lanes e = at(even + from), e_sum = at(even + to), o = at(odd + from), o_sum = at(odd + to);
            const Lanes r = at(rate_even + from), r_sum = at(rate_even + to);
            const Lanes t = at(rate_odd + from), t_sum = at(rate_odd + to);
            subtract_pairs(cosine + mean + 2 * p, by_q * (e + e_sum) - by_rate * (t_sum + t),
                           by_q * (o_sum + o) + by_rate * (r + r_sum));
            if (a)
                subtract_pairs(sine + mean + 2 * p, by_q * (o_sum - o) - by_rate * (r - r_sum),
                               by_q * (e - e_sum) + by_rate * (t_sum - t));
        }
    }
}

/* Add K - a^2 w^2 M and a w C to the block of equation i and coordinate j, whose orders are equal. */
static void add_linear_block(System *w, const Model *model, int i, int j, double omega)
{
    const int at = i * w->m + j;
    const Orders *kind = orders_of(w, i);
    double *entry = block_of(w, i, j);
    if (!kind->lowest) {
        *entry += model->stiffness[at];
        entry += w->stride + 1;
    }
    for (int n = !kind->lowest; n < kind->count; n++, entry += 2 * (w->stride + 1)) {
        const int a = kind->step * n + kind->lowest;
        const double elastic = model->stiffness[at] - a * a * omega * omega * model->mass[at];
        const double viscous = a * omega * model->damping[at];
        entry[0] += elastic;
        entry[1] += viscous;
        entry[w->stride] -= viscous;
        entry[w->stride + 1] += elastic;
    }
}

/* Add the linear terms of coordinate j to the residual of equation i, of equal orders, and to its slope by w. */
static void add_motion(System *w, const Model *model, int i, int j, const double *x)
{
    const int at = i * w->m + j, terms = terms_of(orders_of(w, i));
    const double mass = model->mass[at], damping = model->damping[at], omega = x[w->coefficients];
    double *row = w->matrix + (ptrdiff_t)w->first[i] * w->stride;
    for (int term = 0; term < terms; term++, row += w->stride) {
        const int here = w->kept[w->first[j] + term], order = (here - j * w->size + 1) / 2;
        const double a = x[here], slope = w->slope[here], bend = -order * order * a;
        row[w->balances] += 2.0 * omega * mass * bend + damping * slope;
        row[w->unknowns] += omega * (omega * mass * bend + damping * slope) + model->stiffness[at] * a;
    }
}

/* Subtract the load's harmonics from the residual of equation i and from its slopes by w and U: with f(q, w q'/U) and
 * g(q), d(U^2 P (f - g/U^2))/dU = 2 U P f - w P df/d(w/U). */
static void subtract_load(System *w, int i, double omega, double speed)
{
    const Orders *kind = orders_of(w, i);
    const double *forces = spectrum(w, force_row(i)), *by_rate = spectrum(w, rate_row(w, i));
    const double *restoring = spectrum(w, restoring_row(w, i));
    double *row = w->matrix + (ptrdiff_t)w->first[i] * w->stride;
    for (int term = 0; term < terms_of(kind); term++, row += w->stride) {
        const int c = term + kind->lowest, at = (c + 1) / 2 - kind->lowest + (c % 2 == 0 && c ? w->orders : 0);
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
    const double omega = x[w->coefficients];
    memset(w->matrix, 0, (size_t)w->unknowns * (size_t)w->stride * sizeof *w->matrix);
    differentiate(w, x);
    sample(w, model, x, omega / speed, speed);
    transform_all(w);
    for (int i = 0; i < m; i++) {
        subtract_load(w, i, omega, speed);
        for (int j = 0; j < m; j++) {
            if (w->kind[i] == w->kind[j]) {
                add_motion(w, model, i, j, x);
                add_linear_block(w, model, i, j, omega);
            }
            if (w->active[j] || w->active[m + j])
                subtract_load_block(w, i, j, speed, omega);
        }
    }
}
