/* Newton's method on harmonic balances, one cycle after another. engine/harmonic.py, theory section 7.2. */
#include "balance.h"

#include <math.h>
#include <string.h>

/* Fill the last row with the phase condition. */
static void add_phase(System *w, const double *x, const double *reference)
{
    const int n = w->unknowns;
    double *phase = w->matrix + (ptrdiff_t)(n - 1) * w->stride;
    for (int u = 0; u < n - 1; u++) {
        phase[w->place[u]] = reference[u];
        phase[n] += reference[u] * (x[u] - w->given[u]);
    }
}

/* Return the root mean square of change / scale. */
static double scaled_size(const System *w, const double *scale)
{
    double sum = 0.0;
    for (int u = 0; u < w->unknowns; u++) {
        const double part = w->rows[w->place[u]][w->unknowns] / scale[u];
        sum += part * part;
    }
    return sqrt(sum / w->unknowns);
}

static int all_finite(int count, const double *x)
{
    for (int u = 0; u < count; u++)
        if (!isfinite(x[u]))
            return 0;
    return 1;
}

static void iterate(System *w, const Model *model, const Balances *balances, ptrdiff_t cycle, const Options *options)
{
    const int n = w->unknowns;
    double *x = balances->x + cycle * n;
    memcpy(w->given, x, (size_t)n * sizeof *x);
    for (int iteration = 0; iteration < options->iterations && all_finite(n, x); iteration++) {
        assemble_system(w, model, x, balances->wind_speed[cycle]);
        add_phase(w, x, balances->reference + cycle * (n - 1));
        for (int row = 0; row < n; row++)
            w->rows[row] = w->matrix + (ptrdiff_t)row * w->stride;
        if (!eliminate(n, w->rows))
            return;
        const double size = scaled_size(w, balances->scale + cycle * n);
        if (!isfinite(size))
            return;
        const double taken = size > options->largest_step ? options->largest_step / size : 1.0;
        for (int u = 0; u < n; u++)
            x[u] -= taken * w->rows[w->place[u]][n];
        balances->step[cycle] = size;
        balances->iterations[cycle] = iteration + 1;
        if (size <= options->tolerance)
            return;
    }
}

int solve_balances(const Model *stack, const Balances *balances, const Options *options)
{
    System system;
    const int ready = prepare_system(&system, stack, balances->harmonics);
    for (ptrdiff_t cycle = 0; ready && cycle < balances->cycles; cycle++) {
        const Model model = model_of(stack, balances->member[cycle]);
        arrange_system(&system, &model);
        iterate(&system, &model, balances, cycle, options);
    }
    release_system(&system);
    return ready;
}

/* Copy the balance out of the order of elimination, with its slopes by the wind speed U: from f(q, w q'/U) follows
 * dr/dU = -2 U P f + w P df/d(w/U). */
static void write_out(const System *w, double omega, double speed, double *residual, double *slopes)
{
    const int n = w->unknowns - 1;
    for (int u = 0; u < n; u++) {
        const double *row = w->matrix + (ptrdiff_t)w->place[u] * w->stride;
        const int i = u / w->size, c = u % w->size, at = (c + 1) / 2 + (c % 2 == 0 && c ? w->orders : 0);
        const double force = spectrum(w, force_row(i))[at], by_rate = spectrum(w, rate_row(w, i))[at];
        for (int v = 0; v < n; v++)
            slopes[v] = row[w->place[v]];
        slopes[n] = row[n];
        slopes[n + 1] = (c ? 2.0 : 1.0) * (omega * by_rate - 2.0 * speed * force);
        slopes += n + 2;
        residual[u] = row[n + 1];
    }
}

int linearize_balances(const Model *stack, const Linearizations *wanted)
{
    System system, *w = &system;
    const int ready = prepare_system(w, stack, wanted->harmonics);
    const ptrdiff_t n = w->unknowns - 1;
    for (ptrdiff_t cycle = 0; ready && cycle < wanted->cycles; cycle++) {
        const Model model = model_of(stack, wanted->member[cycle]);
        const double omega = wanted->angular_frequency[cycle], speed = wanted->wind_speed[cycle];
        arrange_system(w, &model);
        memcpy(w->given, wanted->coefficients + cycle * n, (size_t)n * sizeof *w->given);
        w->given[n] = omega;
        assemble_system(w, &model, w->given, speed);
        write_out(w, omega, speed, wanted->residuals + cycle * n, wanted->slopes + cycle * n * (n + 2));
    }
    release_system(w);
    return ready;
}
