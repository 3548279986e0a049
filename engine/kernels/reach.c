/* The largest angle of attack and the largest velocity ratio of motions: largest_reach of engine/models/relative_wind.py,
 * theory section 13. LANES samples go side by side. */
#include "lanes.h"

#include <stdlib.h>

enum { TURN, RISE, SWAY, TURNING, LOCAL }; /* Theta, V'/(U phi), W'/(U phi) and Theta'/(U phi) at a node */

/* Gather the states at LANES samples from one on, the last sample again beyond the last one. */
WITHIN void gather(const Reaches *wanted, ptrdiff_t motion, ptrdiff_t sample, Lanes *state)
{
    const ptrdiff_t width = 2 * wanted->m;
    for (int lane = 0; lane < LANES; lane++) {
        const ptrdiff_t at = sample + lane < wanted->samples ? sample + lane : wanted->samples - 1;
        for (ptrdiff_t v = 0; v < width; v++)
            state[v][lane] = wanted->state[(motion * wanted->samples + at) * width + v];
    }
}

WITHIN Lanes larger(Lanes a, Lanes b) { return chosen(a > b, a, b); }

/* Raise the largest size of the angle and the largest square of the velocity by those at a node. */
WITHIN void reach_at_node(const Reaches *wanted, ptrdiff_t member, ptrdiff_t node, const Lanes *state, Lanes *largest)
{
    const ptrdiff_t width = 2 * wanted->m, place = member * wanted->nodes + node;
    const double *forms = wanted->forms + place * LOCAL * width, *arms = wanted->arms + place * wanted->subconductors * 2;
    const double half = 0.5 * wanted->diameter[member];
    Lanes local[LOCAL] = {{0}, {0}, {0}, {0}};
    for (int i = 0; i < LOCAL; i++)
        for (ptrdiff_t v = 0; v < width; v++)
            local[i] += forms[i * width + v] * state[v];
    Lanes angle = local[TURN] - local[RISE] - half * local[TURNING];
    for (ptrdiff_t i = 0; i < wanted->subconductors; i++) {
        const Lanes rise = local[RISE] - arms[2 * i + 1] * local[TURNING];
        const Lanes sway = local[SWAY] + arms[2 * i] * local[TURNING];
        if (!wanted->published)
            angle = local[TURN] - angle_of(rise + half * local[TURNING], 1.0 - sway);
        largest[0] = larger(largest[0], larger(angle, -angle));
        largest[1] = larger(largest[1], rise * rise + sway * sway);
    }
}

WIDE static void reach_of(const Reaches *wanted, ptrdiff_t motion, Lanes *state)
{
    Lanes largest[2] = {{0}, {0}};
    for (ptrdiff_t sample = 0; sample < wanted->samples; sample += LANES) {
        gather(wanted, motion, sample, state);
        for (ptrdiff_t node = 0; node < wanted->nodes; node++)
            reach_at_node(wanted, wanted->member[motion], node, state, largest);
    }
    double most[2] = {0.0, 0.0};
    for (int i = 0; i < 2; i++)
        for (int lane = 0; lane < LANES; lane++)
            most[i] = largest[i][lane] > most[i] ? largest[i][lane] : most[i];
    wanted->reach[motion] = most[0];
    wanted->reach[wanted->motions + motion] = sqrt(most[1]);
}

int find_reaches(const Reaches *wanted)
{
    Lanes *state = calloc(2 * (size_t)wanted->m + 1, sizeof *state);
    for (ptrdiff_t motion = 0; state && motion < wanted->motions; motion++)
        reach_of(wanted, motion, state);
    free(state);
    return state != NULL;
}
