/* The load of the relative wind at every sub-conductor, evaluated as it stands: force and force_gradient of
 * engine/models/unexpanded_load.py, theory sections 13 and 14. LANES states go side by side. */
#include "lanes.h"

#include <string.h>

enum { LIFT, DRAG, MOMENT, COEFFICIENTS };
enum { TURN_OF, RISE, CALM, TURNING, VARIABLES }; /* Theta, V'/U, W'/U and Theta'/U of a section */
#define TURN (2.0 * M_PI)
#define BLOCK 8 /* points */

Unexpanded unexpanded_of(const Unexpanded *stack, int m, ptrdiff_t member)
{
    Unexpanded one = *stack;
    const ptrdiff_t points = one.points, n = one.subconductors;
    one.fields += member * points * 3 * m;
    one.strength += member * points;
    one.factor += member * points;
    one.diameter += member;
    one.positions += member * points * n * 2;
    one.present += member * n;
    one.which += member * points;
    one.rest_angle += member * points;
    one.at_rest += member * m;
    return one;
}

/* The place of angles on a curve: their distances from where their pieces count, and the powers of these pieces. */
typedef struct {
    Lanes distance;
    const double *powers[LANES];
} Places;

/* Find the piece that holds a distance from the curve's origin: guess as if pieces were equally long, then walk. */
static ptrdiff_t piece_at(const Unexpanded *load, ptrdiff_t first, ptrdiff_t last, double reach)
{
    if (!(reach > load->begins[first])) /* before the curve, or NaN where a motion has diverged */
        return first;
    const double share = last > first ? reach / load->begins[last] : 0.0;
    ptrdiff_t piece = first + (ptrdiff_t)((share > 1.0 ? 1.0 : share > 0.0 ? share : 0.0) * (double)(last - first));
    while (piece < last && load->begins[piece + 1] <= reach)
        piece++;
    while (piece > first && load->begins[piece] > reach)
        piece--;
    return piece;
}

/* Find the places of angles on a curve. */
WITHIN Places places_at(const Unexpanded *load, ptrdiff_t curve, Lanes angle)
{
    Lanes reach = angle - load->origin[curve];
    if (load->periodic[curve])
        reach -= TURN * floored(reach * (1.0 / TURN));
    const ptrdiff_t first = load->first[curve], last = load->first[curve + 1] - 1;
    const double density = load->density[curve], length = 1.0 / density;
    Places found;
    if (density > 0.0) { /* equally long pieces, perhaps one more at each end */
        const Lanes zero = {0};
        const double ahead = load->begins[first] < 0.0;
        Lanes piece = ahead + floored(density * reach);
        piece = chosen(piece < (double)(last - first), piece, zero + (double)(last - first));
        piece = chosen(piece > zero, piece, zero); /* NaN where a motion has diverged */
        found.distance = reach - length * chosen(piece > ahead, piece - ahead, zero);
        const Counts which = __builtin_convertvector(piece, Counts);
        for (int lane = 0; lane < LANES; lane++)
            found.powers[lane] = load->powers + 12 * (first + which[lane]);
        return found;
    }
    for (int lane = 0; lane < LANES; lane++) {
        const ptrdiff_t piece = piece_at(load, first, last, reach[lane]);
        found.distance[lane] = reach[lane] + (load->origin[curve] - load->knots[piece]);
        found.powers[lane] = load->powers + 12 * piece;
    }
    return found;
}

/* Turn C_y and C_z of a curve that is fixed to the section, and their slopes, by the angle to C_L and C_D. */
static void turn_to_wind(Lanes angle, Lanes *values, Lanes *slopes)
{
    Lanes c = angle, s = angle;
    for (int lane = 0; lane < LANES; lane++)
        c[lane] = cos(angle[lane]), s[lane] = sin(angle[lane]);
    const Lanes lift = c * values[LIFT] - s * values[DRAG], drag = s * values[LIFT] + c * values[DRAG];
    const Lanes lift_slope = c * slopes[LIFT] - s * slopes[DRAG] - drag;
    slopes[DRAG] = s * slopes[LIFT] + c * slopes[DRAG] + lift;
    slopes[LIFT] = lift_slope, values[LIFT] = lift, values[DRAG] = drag;
}

/* The wind that a sub-conductor sees: b, c and the angle in its curve, with its place there. */
typedef struct {
    Lanes rise, calm, angle;
    Places place;
} Wind;

/* Find the winds of all sub-conductors at a point. */
WITHIN void find_winds(const Unexpanded *load, int m, ptrdiff_t p, const Lanes *state, Wind *winds)
{
    const double *v = load->fields + p * 3 * m, *w = v + m, *theta = w + m, scale = 1.0 / load->factor[p];
    Lanes turn = {0}, rise = {0}, push = {0}, turning = {0};
    for (int j = 0; j < m; j++) {
        turn += theta[j] * state[j];
        rise += v[j] * state[m + j];
        push += w[j] * state[m + j];
        turning += theta[j] * state[m + j];
    }
    for (ptrdiff_t i = 0; i < load->subconductors; i++) {
        const double *at = load->positions + (p * load->subconductors + i) * 2;
        const Lanes b = scale * (rise + (0.5 * *load->diameter - at[1]) * turning);
        const Lanes c = 1.0 - scale * (push + at[0] * turning), angle = load->rest_angle[p] + turn - angle_of(b, c);
        winds[i] = (Wind){b, c, angle, places_at(load, load->which[p], angle)};
    }
}

/* Evaluate C_L, C_D and C_M and their slopes. */
WITHIN void evaluate(const Unexpanded *load, ptrdiff_t curve, const Wind *wind, Lanes *values, Lanes *slopes)
{
    const Lanes x = wind->place.distance;
    for (int i = 0; i < COEFFICIENTS; i++) {
        Lanes power[4];
        read_columns(wind->place.powers, 4 * i, power);
        values[i] = power[0] + x * (power[1] + x * (power[2] + x * power[3]));
        slopes[i] = power[1] + x * (2.0 * power[2] + 3.0 * x * power[3]);
    }
    if (load->turning[curve])
        turn_to_wind(wind->angle, values, slopes);
}

/* The forces F_y, F_z and the moment on a section, and their slopes by its variables. */
typedef struct {
    Lanes total[3], rows[3][VARIABLES];
} Section;

/* Add one sub-conductor to a section, with its slopes if they are wanted. */
WITHIN void add_subconductor(const Unexpanded *load, ptrdiff_t p, ptrdiff_t i, const Wind *wind, Section *section,
                             int sloped)
{
    const double *at = load->positions + (p * load->subconductors + i) * 2, y = at[0], z = at[1], d = *load->diameter;
    const double scale = 1.0 / load->factor[p], lever = 0.5 * d - z;
    const Lanes b = wind->rise, c = wind->calm, square = b * b + c * c, r = root(square);
    Lanes values[COEFFICIENTS], slopes[COEFFICIENTS];
    evaluate(load, load->which[p], wind, values, slopes);
    const Lanes lift = values[LIFT], drag = values[DRAG], moment = values[MOMENT];
    const Lanes along = lift * c - drag * b, across = lift * b + drag * c, rise = r * along, push = r * across;
    section->total[0] += rise;
    section->total[1] += push;
    section->total[2] += d * square * moment + y * push - z * rise;
    if (!sloped)
        return;
    const Lanes turned_along = slopes[LIFT] * c - slopes[DRAG] * b, turned_across = slopes[LIFT] * b + slopes[DRAG] * c;
    const Lanes inverse = 1.0 / r, rise_share = b * inverse, calm_share = c * inverse, twisted = slopes[MOMENT];
    /* By Theta, b and c: F_y = r along, F_z = r across, F_theta = d r^2 C_M; alpha_b = -c/r^2, alpha_c = b/r^2. */
    Lanes by[3][3] = {
        {r * turned_along, rise_share * along - calm_share * turned_along - r * drag,
         calm_share * along + rise_share * turned_along + r * lift},
        {r * turned_across, rise_share * across - calm_share * turned_across + r * lift,
         calm_share * across + rise_share * turned_across + r * drag},
        {d * square * twisted, d * (2.0 * b * moment - c * twisted), d * (2.0 * c * moment + b * twisted)}};
    for (int v = 0; v < 3; v++)
        by[2][v] += y * by[1][v] - z * by[0][v];
    for (int f = 0; f < 3; f++) {
        section->rows[f][TURN_OF] += by[f][0];
        section->rows[f][RISE] += scale * by[f][1];
        section->rows[f][CALM] -= scale * by[f][2];
        section->rows[f][TURNING] += scale * (lever * by[f][1] - y * by[f][2]);
    }
}

/* Add what one force of a section, with its slopes (VARIABLES), does on coordinate j. */
WITHIN void add_gradient(int m, const double *fields, double share, const Lanes *row, Lanes *gradient)
{
    const double *v = fields, *w = v + m, *theta = w + m;
    for (int k = 0; k < m; k++) {
        if (theta[k] != 0.0) {
            gradient[k] += share * theta[k] * row[TURN_OF];
            gradient[m + k] += share * theta[k] * row[TURNING];
        }
        if (v[k] != 0.0)
            gradient[m + k] += share * v[k] * row[RISE];
        if (w[k] != 0.0)
            gradient[m + k] += share * w[k] * row[CALM];
    }
}

WITHIN void add_section(const Unexpanded *load, int m, ptrdiff_t p, const Section *section, Lanes *force,
                        Lanes *gradient, int sloped)
{
    const double *fields = load->fields + p * 3 * m;
    for (int f = 0; f < 3; f++)
        for (int j = 0; j < m; j++) {
            const double share = load->strength[p] * fields[f * m + j];
            if (share == 0.0)
                continue;
            force[j] += share * section->total[f];
            if (sloped)
                add_gradient(m, fields, share, section->rows[f], gradient + j * 2 * m);
        }
}

/* Points go in blocks, first all winds, then all forces: a chain from states to forces is long, and the processor only
 * looks so far ahead for another one. */
WITHIN void add_points(const Unexpanded *load, int m, const Lanes *state, Lanes *force, Lanes *gradient, int sloped)
{
    const ptrdiff_t n = load->subconductors;
    const Section none = {.rows = {{{0}}}};
    Wind winds[BLOCK * n];
    for (int j = 0; j < m; j++)
        force[j] = (Lanes){0} - load->at_rest[j];
    if (sloped)
        memset(gradient, 0, (size_t)m * 2 * (size_t)m * sizeof *gradient);
    for (ptrdiff_t first = 0; first < load->points; first += BLOCK) {
        const ptrdiff_t end = first + BLOCK < load->points ? first + BLOCK : load->points;
        for (ptrdiff_t p = first; p < end; p++)
            if (load->strength[p] != 0.0) /* no padding */
                find_winds(load, m, p, state, winds + (p - first) * n);
        for (ptrdiff_t p = first; p < end; p++) {
            Section section = none;
            if (load->strength[p] == 0.0)
                continue;
            for (ptrdiff_t i = 0; i < n; i++)
                if (load->present[i] != 0.0)
                    add_subconductor(load, p, i, winds + (p - first) * n + i, &section, sloped);
            add_section(load, m, p, &section, force, gradient, sloped);
        }
    }
}

WIDE void unexpanded_force(const Unexpanded *load, int m, const Lanes *state, Lanes *force)
{
    add_points(load, m, state, force, NULL, 0);
}

WIDE void unexpanded_at(const Unexpanded *load, int m, const Lanes *state, Lanes *force, Lanes *gradient)
{
    if (m == 3) /* the hybrid model: the compiler unrolls loops of known length */
        add_points(load, 3, state, force, gradient, 1);
    else if (m == 4)
        add_points(load, 4, state, force, gradient, 1);
    else
        add_points(load, m, state, force, gradient, 1);
}
