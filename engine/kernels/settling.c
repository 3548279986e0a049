/* Direct integration of starts side by side, LANES at a time: Lawson's form of the Runge-Kutta method of fourth order.
 * engine/checks/settled_motion.py. */
#include "monomials.h"

#include <stdlib.h>
#include <string.h>

/* The equations of LANES starts, and room for what a step computes. */
typedef struct {
    int m, points, local, terms;
    Lanes *half, *bend, *forms, *angle, *step, *state, *square, *largest;
    Lanes *x, *monomials, *kicked, *here, *middle, *k[4];
} Group;

static int terms_of(int variables)
{
    return variables * (variables + 1) / 2 + variables * (variables + 1) * (variables + 2) / 6;
}

/* Copy a row of numbers a start; places beyond the last start repeat it. */
static void gathered(const double *from, ptrdiff_t rows, ptrdiff_t starts, ptrdiff_t first, Lanes *to)
{
    for (ptrdiff_t row = 0; row < rows; row++)
        for (ptrdiff_t lane = 0; lane < LANES; lane++)
            to[row][lane] = from[row * starts + (first + lane < starts ? first + lane : starts - 1)];
}

static void scattered(const Lanes *from, ptrdiff_t rows, ptrdiff_t starts, ptrdiff_t first, double *to)
{
    for (ptrdiff_t row = 0; row < rows; row++)
        for (ptrdiff_t lane = 0; lane < LANES && first + lane < starts; lane++)
            to[row * starts + first + lane] = from[row][lane];
}

/* Evaluate the quadratic and cubic part of q'' (m) at a state (2 m). */
WITHIN void bend_at(const Group *group, const Lanes *state, Lanes *result)
{
    const int m = group->m, local = group->local, terms = group->terms;
    const Lanes *form = group->forms, *coefficient = group->bend;
    memset(result, 0, (size_t)m * sizeof *result);
    for (int p = 0; p < group->points; p++) {
        for (int l = 0; l < local; l++) {
            Lanes sum = {0};
            for (int k = 0; k < 2 * m; k++)
                sum += *form++ * state[k];
            group->x[l] = sum;
        }
        powers(local, group->x, group->monomials);
        const Lanes *bent = group->monomials + 1 + local;
        for (int i = 0; i < m; i++) {
            Lanes sum = result[i];
            for (int t = 0; t < terms; t++)
                sum += *coefficient++ * bent[t];
            result[i] = sum;
        }
    }
}

/* Let the linear part act for half a step. */
WITHIN void turned(const Group *group, const Lanes *state, Lanes *result)
{
    const Lanes *half = group->half;
    for (int i = 0; i < 2 * group->m; i++) {
        Lanes sum = {0};
        for (int j = 0; j < 2 * group->m; j++)
            sum += *half++ * state[j];
        result[i] = sum;
    }
}

/* Add a share of a step of accelerations to the velocities of a state. */
WITHIN void kicked(const Group *group, const Lanes *state, double share, const Lanes *by, Lanes *result)
{
    const int m = group->m;
    for (int i = 0; i < m; i++) {
        result[i] = state[i];
        result[m + i] = state[m + i] + share * group->step[0] * by[i];
    }
}

WITHIN void advanced(const Group *group)
{
    Lanes *const *k = group->k;
    bend_at(group, group->state, k[0]);
    turned(group, group->state, group->here);
    kicked(group, group->state, 0.5, k[0], group->kicked);
    turned(group, group->kicked, group->middle);
    bend_at(group, group->middle, k[1]);
    kicked(group, group->here, 0.5, k[1], group->kicked);
    bend_at(group, group->kicked, k[2]);
    kicked(group, group->here, 1.0, k[2], group->kicked);
    turned(group, group->kicked, group->middle);
    bend_at(group, group->middle, k[3]);
    kicked(group, group->state, 1.0 / 6.0, k[0], group->kicked);
    turned(group, group->kicked, group->middle);
    for (int i = 0; i < group->m; i++)
        k[1][i] += k[2][i];
    kicked(group, group->middle, 1.0 / 3.0, k[1], group->kicked);
    turned(group, group->kicked, group->middle);
    kicked(group, group->middle, 1.0 / 6.0, k[3], group->state);
}

WIDE static void integrated(const Group *group, ptrdiff_t steps, const double *window)
{
    memset(group->square, 0, 2 * (size_t)group->m * sizeof *group->square);
    *group->largest = (Lanes){0};
    for (ptrdiff_t step = 0; step < steps; step++) {
        Lanes angle = {0};
        advanced(group);
        for (int i = 0; i < 2 * group->m; i++) {
            const Lanes part = group->angle[i] * group->state[i];
            angle += part * part;
            group->square[i] += window[step] * group->state[i] * group->state[i];
        }
        for (int lane = 0; lane < LANES; lane++)
            if (!(angle[lane] <= (*group->largest)[lane])) /* what is no number counts as larger */
                (*group->largest)[lane] = angle[lane];
    }
}

/* Cut the parts of a group from one piece of memory; without it, only count the Lanes that they take. */
static size_t laid_out(Group *group, Lanes *memory)
{
    const size_t m = (size_t)group->m, points = (size_t)group->points, local = (size_t)group->local;
    const size_t terms = (size_t)group->terms;
    struct {
        Lanes **part;
        size_t size;
    } parts[] = {{&group->half, 4 * m * m}, {&group->bend, points * m * terms}, {&group->forms, points * local * 2 * m},
                 {&group->angle, 2 * m}, {&group->step, 1}, {&group->state, 2 * m}, {&group->square, 2 * m},
                 {&group->largest, 1}, {&group->x, local}, {&group->monomials, 1 + local + terms},
                 {&group->kicked, 2 * m}, {&group->here, 2 * m}, {&group->middle, 2 * m}, {group->k, m},
                 {group->k + 1, m}, {group->k + 2, m}, {group->k + 3, m}};
    size_t used = 0;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        if (memory)
            *parts[i].part = memory + used;
        used += parts[i].size;
    }
    return used;
}

int integrate_flows(const Flows *flows)
{
    const ptrdiff_t m = flows->m, points = flows->points, local = flows->local, starts = flows->starts;
    Group group = {.m = flows->m, .points = flows->points, .local = flows->local, .terms = terms_of(flows->local)};
    Lanes *memory = malloc(laid_out(&group, NULL) * sizeof *memory);
    if (!memory)
        return 0;
    laid_out(&group, memory);
    for (ptrdiff_t first = 0; first < starts; first += LANES) {
        gathered(flows->half, 4 * m * m, starts, first, group.half);
        gathered(flows->bend, points * m * group.terms, starts, first, group.bend);
        gathered(flows->forms, points * local * 2 * m, starts, first, group.forms);
        gathered(flows->angle, 2 * m, starts, first, group.angle);
        gathered(flows->step, 1, starts, first, group.step);
        gathered(flows->state, 2 * m, starts, first, group.state);
        integrated(&group, flows->steps, flows->window);
        scattered(group.state, 2 * m, starts, first, flows->state);
        scattered(group.square, 2 * m, starts, first, flows->square);
        scattered(group.largest, 1, starts, first, flows->largest);
    }
    free(memory);
    return 1;
}
