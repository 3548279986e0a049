/* Direct integration of starts, LANES at a time, by Lawson's form of the fourth-order Runge-Kutta method.
 * The numpy form is lawson_step and _block in engine/checks/settled_motion.py. */
#include "monomials.h"

#include <stdlib.h>
#include <string.h>

/* The equations of LANES starts, and the memory that a step needs. */
typedef struct {
    int m, points, rows, local, terms, stretches;
    int *first, *end; /* (local), the components that each linear form depends on: from first to before end */
    Unexpanded unexpanded[LANES];
    Lanes *gain, *linear, *wind_speed;
    Lanes *half_step, *nonlinear, *outward, *forms, *restoring, *angle, *step, *state, *square, *largest;
    Lanes *x, *forces, *monomials, *shifted, *here, *middle, *k[4];
} Group;

/* The number of monomials of degree 2 and 3. */
static int terms_of(int variables) { return monomials_of(variables) - variables; }

/* Copy one column of numbers per start into its lane; lanes beyond the last start repeat it. */
static void gather(const double *from, ptrdiff_t rows, ptrdiff_t starts, ptrdiff_t first, Lanes *to)
{
    for (ptrdiff_t row = 0; row < rows; row++)
        for (ptrdiff_t lane = 0; lane < LANES; lane++)
            to[row][lane] = from[row * starts + (first + lane < starts ? first + lane : starts - 1)];
}

/* Copy each lane back to the column of its start. */
static void scatter(const Lanes *from, ptrdiff_t rows, ptrdiff_t starts, ptrdiff_t first, double *to)
{
    for (ptrdiff_t row = 0; row < rows; row++)
        for (ptrdiff_t lane = 0; lane < LANES && first + lane < starts; lane++)
            to[row * starts + first + lane] = from[row][lane];
}

/* Find the components that each linear form depends on, at any point and in any lane. */
static void find_reach(const Group *group)
{
    const int components = 2 * group->m;
    for (int l = 0; l < group->local; l++) {
        group->first[l] = components, group->end[l] = 0;
        for (int p = 0; p < group->points; p++)
            for (int k = 0; k < components; k++) {
                const Lanes form = group->forms[((ptrdiff_t)p * group->local + l) * components + k];
                if (form[0] == 0.0 && form[1] == 0.0 && form[2] == 0.0 && form[3] == 0.0)
                    continue;
                group->first[l] = k < group->first[l] ? k : group->first[l];
                group->end[l] = k + 1 > group->end[l] ? k + 1 : group->end[l];
            }
    }
}

/* Evaluate the unexpanded loads at (q, q'/U): all lanes at once where they have the same one. */
WITHIN void unexpanded_forces(const Group *group, const Lanes *state, Lanes *force)
{
    const int m = group->m;
    unexpanded_force(group->unexpanded, m, state, force);
    for (int lane = 1; lane < LANES; lane++) {
        Lanes own[m];
        if (group->unexpanded[lane].fields == group->unexpanded->fields)
            continue;
        unexpanded_force(group->unexpanded + lane, m, state, own);
        for (int i = 0; i < m; i++)
            force[i][lane] = own[i][lane];
    }
}

/* Add the part of an unexpanded load, less its linear part, to q'' (m) at a state (2 m). */
static void add_unexpanded(const Group *group, const Lanes *state, Lanes *result)
{
    const int m = group->m;
    Lanes x[2 * m], force[m];
    for (int i = 0; i < m; i++) {
        x[i] = state[i];
        x[m + i] = state[m + i] / *group->wind_speed;
    }
    unexpanded_forces(group, x, force);
    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++)
            result[i] += group->gain[i * m + j] * force[j];
    for (int i = 0; i < m; i++)
        for (int j = 0; j < 2 * m; j++)
            result[i] -= group->linear[i * 2 * m + j] * state[j];
}

/* Add the products of m rows of coefficients (m, terms) with the monomials to q'' (m), three rows at a time: the sum of
 * one row waits for every addition. */
WITHIN void add_rows(int m, int terms, const Lanes *coefficient, const Lanes *products, Lanes *result)
{
    int i = 0;
    for (; i + 2 < m; i += 3, coefficient += 3 * terms) {
        Lanes first = result[i], second = result[i + 1], third = result[i + 2];
        for (int t = 0; t < terms; t++) {
            first += coefficient[t] * products[t];
            second += coefficient[terms + t] * products[t];
            third += coefficient[2 * terms + t] * products[t];
        }
        result[i] = first, result[i + 1] = second, result[i + 2] = third;
    }
    for (; i < m; i++, coefficient += terms) {
        Lanes even = result[i], odd = {0};
        for (int t = 0; t + 1 < terms; t += 2) {
            even += coefficient[t] * products[t];
            odd += coefficient[t + 1] * products[t + 1];
        }
        if (terms % 2)
            even += coefficient[terms - 1] * products[terms - 1];
        result[i] = even + odd;
    }
}

/* Evaluate the quadratic and cubic part of q'' (m) at a state (2 m). */
WITHIN void nonlinear_terms(const Group *group, int m, int local, int rows, const Lanes *state, Lanes *result)
{
    const int terms = monomials_of(local) - local;
    const Lanes *coefficient = group->nonlinear, *outward = group->outward, *form = group->forms;
    memset(result, 0, (size_t)m * sizeof *result);
    for (int p = 0; p < group->points; p++, coefficient += rows * terms, outward += m * rows) {
        for (int l = 0; l < local; l++, form += 2 * m) {
            Lanes sum = {0};
            for (int k = group->first[l]; k < group->end[l]; k++)
                sum += form[k] * state[k];
            group->x[l] = sum;
        }
        powers(local, group->x, group->monomials);
        memset(group->forces, 0, (size_t)rows * sizeof *group->forces);
        add_rows(rows, terms, coefficient, group->monomials + 1 + local, group->forces);
        for (int i = 0; i < m; i++)
            for (int r = 0; r < rows; r++)
                result[i] += outward[i * rows + r] * group->forces[r];
    }
    if (group->gain)
        add_unexpanded(group, state, result);
    if (!group->stretches)
        return;
    powers(m, state, group->monomials);
    add_rows(m, monomials_of(m) - m, group->restoring, group->monomials + 1 + m, result);
}

WIDE static void nonlinear_acceleration(const Group *group, const Lanes *state, Lanes *result)
{
    if (group->m == 3 && group->local == 4 && group->rows == 3) /* the hybrid model: loops of known length are unrolled */
        nonlinear_terms(group, 3, 4, 3, state, result);
    else if (group->m == 4 && group->local == 4 && group->rows == 3)
        nonlinear_terms(group, 4, 4, 3, state, result);
    else
        nonlinear_terms(group, group->m, group->local, group->rows, state, result);
}

/* Advance the linear part by half a step: multiply by its matrix exponential. */
WITHIN void propagate(const Group *group, const Lanes *state, Lanes *result)
{
    const Lanes *half_step = group->half_step;
    for (int i = 0; i < 2 * group->m; i++) {
        Lanes sum = {0};
        for (int j = 0; j < 2 * group->m; j++)
            sum += *half_step++ * state[j];
        result[i] = sum;
    }
}

/* Add share * step * acceleration to the velocities of a state. */
WITHIN void add_acceleration(const Group *group, const Lanes *state, double share, const Lanes *by, Lanes *result)
{
    const int m = group->m;
    for (int i = 0; i < m; i++) {
        result[i] = state[i];
        result[m + i] = state[m + i] + share * group->step[0] * by[i];
    }
}

/* Advance the states by one step, as lawson_step of engine/checks/settled_motion.py does. */
WITHIN void lawson_step(const Group *group)
{
    Lanes *const *k = group->k;
    nonlinear_acceleration(group, group->state, k[0]);
    propagate(group, group->state, group->here);
    add_acceleration(group, group->state, 0.5, k[0], group->shifted);
    propagate(group, group->shifted, group->middle);
    nonlinear_acceleration(group, group->middle, k[1]);
    add_acceleration(group, group->here, 0.5, k[1], group->shifted);
    nonlinear_acceleration(group, group->shifted, k[2]);
    add_acceleration(group, group->here, 1.0, k[2], group->shifted);
    propagate(group, group->shifted, group->middle);
    nonlinear_acceleration(group, group->middle, k[3]);
    add_acceleration(group, group->state, 1.0 / 6.0, k[0], group->shifted);
    propagate(group, group->shifted, group->middle);
    for (int i = 0; i < group->m; i++)
        k[1][i] += k[2][i];
    add_acceleration(group, group->middle, 1.0 / 3.0, k[1], group->shifted);
    propagate(group, group->shifted, group->middle);
    add_acceleration(group, group->middle, 1.0 / 6.0, k[3], group->state);
}

/* Take one step for each entry of the window and accumulate the weighted squares and the largest angle of attack. */
WIDE static void integrate_block(const Group *group, ptrdiff_t steps, const double *window)
{
    memset(group->square, 0, 2 * (size_t)group->m * sizeof *group->square);
    *group->largest = (Lanes){0};
    for (ptrdiff_t step = 0; step < steps; step++) {
        Lanes angle = {0};
        lawson_step(group);
        for (int i = 0; i < 2 * group->m; i++) {
            const Lanes part = group->angle[i] * group->state[i];
            angle += part * part;
            group->square[i] += window[step] * group->state[i] * group->state[i];
        }
        for (int lane = 0; lane < LANES; lane++)
            if (!(angle[lane] <= (*group->largest)[lane])) /* NaN counts as larger */
                (*group->largest)[lane] = angle[lane];
    }
}

/* Divide one block of memory among the arrays of a group; if it is NULL, only count the Lanes that they need. */
static size_t lay_out(Group *group, Lanes *memory)
{
    const size_t m = (size_t)group->m, points = (size_t)group->points, local = (size_t)group->local;
    const size_t rows = (size_t)group->rows, terms = (size_t)group->terms;
    const size_t own = group->stretches ? (size_t)terms_of(group->m) : 0;
    const size_t unexpanded = group->gain ? 1 : 0;
    const size_t monomials = 1 + (local + terms > m + own ? local + terms : m + own);
    struct {
        Lanes **part;
        size_t size;
    } parts[] = {{&group->half_step, 4 * m * m}, {&group->nonlinear, points * rows * terms},
                 {&group->outward, points * m * rows}, {&group->forces, rows},
                 {&group->forms, points * local * 2 * m}, {&group->restoring, m * own}, {&group->angle, 2 * m},
                 {&group->step, 1}, {&group->gain, unexpanded * m * m}, {&group->linear, unexpanded * 2 * m * m},
                 {&group->wind_speed, unexpanded},
                 {&group->state, 2 * m}, {&group->square, 2 * m}, {&group->largest, 1}, {&group->x, local},
                 {&group->monomials, monomials}, {&group->shifted, 2 * m}, {&group->here, 2 * m},
                 {&group->middle, 2 * m}, {group->k, m}, {group->k + 1, m}, {group->k + 2, m}, {group->k + 3, m}};
    size_t used = 0;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        if (memory && parts[i].size)
            *parts[i].part = memory + used;
        used += parts[i].size;
    }
    return used;
}

int integrate_flows(const Flows *flows)
{
    const ptrdiff_t m = flows->m, points = flows->points, local = flows->local, starts = flows->starts;
    Group group = {.m = flows->m, .points = flows->points, .rows = flows->rows, .local = flows->local,
                   .terms = terms_of(flows->local), .stretches = flows->stretches};
    Lanes unused;
    int reach[2 * (local ? local : 1)];
    group.first = reach, group.end = reach + local;
    if (flows->gain)
        group.gain = &unused; /* until it is laid out */
    Lanes *memory = malloc(lay_out(&group, NULL) * sizeof *memory);
    if (!memory)
        return 0;
    lay_out(&group, memory);
    for (ptrdiff_t first = 0; first < starts; first += LANES) {
        gather(flows->half_step, 4 * m * m, starts, first, group.half_step);
        gather(flows->nonlinear, points * group.rows * group.terms, starts, first, group.nonlinear);
        gather(flows->outward, points * m * group.rows, starts, first, group.outward);
        gather(flows->forms, points * local * 2 * m, starts, first, group.forms);
        find_reach(&group);
        gather(flows->angle, 2 * m, starts, first, group.angle);
        gather(flows->restoring, group.stretches ? m * terms_of(group.m) : 0, starts, first, group.restoring);
        gather(flows->step, 1, starts, first, group.step);
        for (int lane = 0; lane < LANES && flows->gain; lane++)
            group.unexpanded[lane] = unexpanded_of(
                &flows->unexpanded, flows->m, flows->member[first + lane < starts ? first + lane : starts - 1]);
        if (flows->gain) {
            gather(flows->gain, m * m, starts, first, group.gain);
            gather(flows->linear, 2 * m * m, starts, first, group.linear);
            gather(flows->wind_speed, 1, starts, first, group.wind_speed);
        }
        gather(flows->state, 2 * m, starts, first, group.state);
        integrate_block(&group, flows->steps, flows->window);
        scatter(group.state, 2 * m, starts, first, flows->state);
        scatter(group.square, 2 * m, starts, first, flows->square);
        scatter(group.largest, 1, starts, first, flows->largest);
    }
    free(memory);
    return 1;
}
