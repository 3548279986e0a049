/* Newton's method on harmonic balances, one cycle after another: newton of engine/numerics/newton.py on the equations of
 * engine/cycles/harmonic_balance.py. Theory section 7.2. */
#include "balance.h"

#include <math.h>
#include <string.h>

#define NEGLIGIBLE 1e-7 /* of their scale: coefficients that a cycle which alternates does not have */

/* Fill the row after the balance with the phase condition. */
static void add_phase(System *w, const double *x, const double *reference, const double *anchor)
{
    double *phase = w->matrix + (ptrdiff_t)w->balances * w->stride;
    for (int v = 0; v < w->balances; v++) {
        const int u = w->kept[v];
        phase[v] = reference[u];
        phase[w->unknowns] += reference[u] * (x[u] - anchor[u]);
    }
}

/* Fill the last row with the condition row . x = target; its second right side is 1, so its solution is the tangent. */
static void add_condition(System *w, const double *x, const double *row, double target)
{
    double *last = w->matrix + (ptrdiff_t)(w->unknowns - 1) * w->stride;
    last[w->unknowns] = -target;
    last[w->unknowns + 1] = 1.0;
    for (int v = 0; v < w->unknowns; v++) {
        last[v] = row[w->kept[v]];
        last[w->unknowns] += row[w->kept[v]] * x[w->kept[v]];
    }
}

/* Return the root mean square of step / scale over all coefficients, w and U. */
static double scaled_size(const System *w, const double *scale)
{
    double sum = 0.0;
    for (int v = 0; v < w->unknowns; v++) {
        const double part = w->solution[v] / scale[w->kept[v]];
        sum += part * part;
    }
    return sqrt(sum / (w->coefficients + w->besides));
}

static int all_finite(int count, const double *x)
{
    for (int u = 0; u < count; u++)
        if (!isfinite(x[u]))
            return 0;
    return 1;
}

/* Copy the residual, from the order of elimination back to that of the coefficients; zero where they are none of the cycle's. */
static void copy_residual(const System *w, double *residual)
{
    memset(residual, 0, (size_t)w->coefficients * sizeof *residual);
    for (int r = 0; r < w->balances; r++)
        residual[w->kept[r]] = w->matrix[(ptrdiff_t)r * w->stride + w->unknowns];
}

/* Compute a step of Newton's method; return 0 if the system is singular. */
static int find_step(System *w, const Model *model, const Balances *wanted, ptrdiff_t cycle)
{
    const int n = w->coefficients + w->besides;
    const double *x = wanted->x + cycle * n;
    assemble_system(w, model, x, wanted->follows ? x[n - 1] : wanted->wind_speed[cycle]);
    add_phase(w, x, wanted->reference + cycle * w->coefficients, wanted->anchor + cycle * n);
    if (!wanted->iterations[cycle])
        copy_residual(w, wanted->residual + cycle * w->coefficients);
    if (wanted->follows)
        add_condition(w, x, wanted->row + cycle * n, wanted->target[cycle]);
    for (int row = 0; row < w->unknowns; row++)
        w->rows[row] = w->matrix + (ptrdiff_t)row * w->stride;
    return eliminate(w->unknowns, w->rows, 1 + wanted->follows, w->sizes, w->solution);
}

static void iterate(System *w, const Model *model, const Balances *wanted, ptrdiff_t cycle, const Options *options)
{
    const int n = w->coefficients + w->besides;
    double *x = wanted->x + cycle * n;
    for (int iteration = 0; iteration < options->iterations && all_finite(n, x); iteration++) {
        if (!find_step(w, model, wanted, cycle))
            return;
        const double size = scaled_size(w, wanted->scale + cycle * n);
        if (!isfinite(size))
            return;
        const double taken = size > options->largest_step ? options->largest_step / size : 1.0;
        for (int v = 0; v < w->unknowns; v++) {
            x[w->kept[v]] -= taken * w->solution[v];
            if (wanted->follows)
                wanted->tangent[cycle * n + w->kept[v]] = w->solution[w->unknowns + v];
        }
        wanted->step[cycle] = size;
        wanted->iterations[cycle] = iteration + 1;
        if (size <= options->tolerance || (!iteration && size > wanted->reach[cycle]))
            return;
    }
}

/* Choose the unknowns of a cycle. Newton's method keeps one that alternates so: the coefficients that it does not have are
 * set to zero, from rounding errors of the start, and left out. */
static void arrange_cycle(System *w, const Model *model, const Balances *wanted, ptrdiff_t cycle)
{
    const int n = w->coefficients + w->besides;
    double *x = wanted->x + cycle * n;
    arrange_system(w, model, alternates(model, w->harmonics, x, NEGLIGIBLE, wanted->scale + cycle * n));
    for (int u = 0; w->alternates && u < w->coefficients; u++) {
        if ((u % w->size + 1) / 2 % 2 == (model->parity[u / w->size] < 0))
            continue;
        x[u] = 0.0;
        if (wanted->follows)
            wanted->tangent[cycle * n + u] = 0.0;
    }
}

int solve_balances(const Model *stack, const Balances *wanted, const Options *options)
{
    System system;
    const int ready = prepare_system(&system, stack, wanted->harmonics, 1 + wanted->follows);
    for (ptrdiff_t cycle = 0; ready && cycle < wanted->cycles; cycle++) {
        const Model model = model_of(stack, wanted->member[cycle]);
        arrange_cycle(&system, &model, wanted, cycle);
        iterate(&system, &model, wanted, cycle, options);
    }
    release_system(&system);
    return ready;
}

/* Copy the residual and its slopes, from the order of elimination back to that of the coefficients. */
static void write_out(const System *w, double *residual, double *slopes)
{
    for (int r = 0; r < w->balances; r++) {
        const double *row = w->matrix + (ptrdiff_t)r * w->stride;
        for (int v = 0; v < w->unknowns; v++)
            slopes[w->kept[r] * w->unknowns + w->kept[v]] = row[v];
    }
    copy_residual(w, residual);
}

int linearize_balances(const Model *stack, const Linearizations *wanted)
{
    System system, *w = &system;
    const int ready = prepare_system(w, stack, wanted->harmonics, 2);
    const ptrdiff_t n = w->coefficients;
    for (ptrdiff_t cycle = 0; ready && cycle < wanted->cycles; cycle++) {
        const Model model = model_of(stack, wanted->member[cycle]);
        arrange_system(w, &model, 0);
        memcpy(w->x, wanted->coefficients + cycle * n, (size_t)n * sizeof *w->x);
        w->x[n] = wanted->angular_frequency[cycle];
        assemble_system(w, &model, w->x, wanted->wind_speed[cycle]);
        write_out(w, wanted->residuals + cycle * n, wanted->slopes + cycle * n * (n + 2));
    }
    release_system(w);
    return ready;
}
