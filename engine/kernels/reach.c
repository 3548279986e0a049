/* The largest angle of attack and the largest velocity ratio of motions: largest_reach of engine/models/relative_wind.py,
 * theory section 13. LANES samples go side by side. */
#include "lanes.h"

#include <stdlib.h>

enum { TURN, RISE, SWAY, TURNING, LOCAL }; /* Theta, V'/(U phi), W'/(U phi) and Theta'/(U phi) at a node */

/* Gather the states at LANES samples from one on, the last sample again beyond the last one. */
WITHIN void gather(const Reaches *wanted, ptrdiff_t motion, ptrdiff_t sample, Lanes *state)
{
    const ptrdiff_t width = 2 * wanted->m, last = wanted->samples - 1;
    for (ptrdiff_t v = 0; v < width; v++) {
        const double *course = wanted->state + (motion * width + v) * wanted->samples;
        for (ptrdiff_t lane = 0; lane < LANES; lane++)
            state[v][lane] = course[sample + lane < last ? sample + lane : last];
    }
}

WITHIN Lanes larger(Lanes a, Lanes b) { return chosen(a > b, a, b); }

WITHIN Lanes size_of(Lanes a) { return larger(a, -a); }

/* Return the product of a linear form with m numbers. */
WITHIN Lanes sum_of(const double *form, const Lanes *numbers, ptrdiff_t m)
{
    Lanes sum = {0};
    for (ptrdiff_t v = 0; v < m; v++)
        sum += form[v] * numbers[v];
    return sum;
}

/* Return the largest number in all lanes. */
WITHIN Lanes largest_of(Lanes a)
{
    double most = a[0];
    for (int lane = 1; lane < LANES; lane++)
        most = a[lane] > most ? a[lane] : most;
    return (Lanes){0} + most;
}

/* Return the largest distance of a sub-conductor of a model from the reference curve. */
WITHIN double longest_arm(const Reaches *wanted, ptrdiff_t member)
{
    const ptrdiff_t count = wanted->nodes * wanted->subconductors;
    const double *arms = wanted->arms + member * count * 2;
    double square = 0.0;
    for (ptrdiff_t i = 0; i < count; i++) {
        const double own = arms[2 * i] * arms[2 * i] + arms[2 * i + 1] * arms[2 * i + 1];
        square = own > square ? own : square;
    }
    return sqrt(square);
}

/* Raise the largest size of the angle and the largest square of the velocity by those at a node. The angle is at most
 * |turn| + across/along: where the longest arm cannot make it or the velocity larger than they are, no arm is looked at. */
WITHIN void reach_at_node(const Reaches *wanted, ptrdiff_t member, ptrdiff_t node, ptrdiff_t m, double longest,
                          const Lanes *state, Lanes *largest)
{
    const ptrdiff_t place = member * wanted->nodes + node, count = wanted->subconductors;
    const double *forms = wanted->forms + place * LOCAL * 2 * m, *arms = wanted->arms + place * count * 2;
    const double half = 0.5 * wanted->diameter[member];
    const Lanes turn = sum_of(forms, state, m);
    Lanes rates[LOCAL];
    for (int i = RISE; i < LOCAL; i++)
        rates[i] = sum_of(forms + (2 * i + 1) * m, state + m, m);
    if (wanted->published)
        largest[0] = larger(largest[0], size_of(turn - rates[RISE] - half * rates[TURNING]));

    const Lanes spin = size_of(rates[TURNING]), room = largest[0] - size_of(turn);
    const Lanes rise = size_of(rates[RISE]) + longest * spin, sway = size_of(rates[SWAY]) + longest * spin;
    const Masks level = (room >= 0.0) & (sway < 1.0) & (rise + half * spin <= room * (1.0 - sway));
    if (all_hold(rise * rise + sway * sway <= largest[1]) && (wanted->published || all_hold(level)))
        return;

    for (ptrdiff_t i = 0; i < count; i++) {
        if (i > 0 && arms[2 * i] == arms[0] && arms[2 * i + 1] == arms[1])
            break; /* the first one again: there are no more */
        const Lanes v = rates[RISE] - arms[2 * i + 1] * rates[TURNING], w = rates[SWAY] + arms[2 * i] * rates[TURNING];
        largest[1] = larger(largest[1], v * v + w * w);
        if (!wanted->published)
            largest[0] = larger(largest[0], size_of(turn - angle_of(v + half * rates[TURNING], 1.0 - w)));
    }
    for (int i = 0; i < 2; i++)
        largest[i] = largest_of(largest[i]);
}

WITHIN void reach_with(const Reaches *wanted, ptrdiff_t motion, ptrdiff_t m, Lanes *state)
{
    const ptrdiff_t member = wanted->member[motion];
    const double longest = longest_arm(wanted, member);
    Lanes largest[2] = {{0}, {0}};
    for (ptrdiff_t sample = 0; sample < wanted->samples; sample += LANES) {
        gather(wanted, motion, sample, state);
        for (ptrdiff_t node = 0; node < wanted->nodes; node++)
            reach_at_node(wanted, member, node, m, longest, state, largest);
    }
    wanted->reach[motion] = largest_of(largest[0])[0];
    wanted->reach[wanted->motions + motion] = sqrt(largest_of(largest[1])[0]);
}

WIDE static void reach_of(const Reaches *wanted, ptrdiff_t motion, Lanes *state)
{
    if (wanted->m == 3) /* the hybrid model: the compiler unrolls loops of known length */
        reach_with(wanted, motion, 3, state);
    else if (wanted->m == 4) /* with a relief coordinate */
        reach_with(wanted, motion, 4, state);
    else
        reach_with(wanted, motion, wanted->m, state);
}

int find_reaches(const Reaches *wanted)
{
    Lanes *state = calloc(2 * (size_t)wanted->m + 1, sizeof *state);
    for (ptrdiff_t motion = 0; state && motion < wanted->motions; motion++)
        reach_of(wanted, motion, state);
    free(state);
    return state != NULL;
}
