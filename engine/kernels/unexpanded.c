/* The load of the relative wind at every sub-conductor, evaluated as it stands: force and force_gradient of
 * engine/models/unexpanded_load.py, theory sections 13 and 14. */
#include "kernels.h"

#include <math.h>
#include <string.h>

enum { LIFT, DRAG, MOMENT, COEFFICIENTS };
#define TURN (2.0 * M_PI)

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

/* Find the piece that holds a distance from the curve's origin: guess as if pieces were equally long, then walk. */
WITHIN ptrdiff_t piece_at(const Unexpanded *load, ptrdiff_t curve, double reach)
{
    const ptrdiff_t first = load->first[curve], last = load->first[curve + 1] - 1;
    if (!(reach > load->begins[first])) /* before the curve, or NaN where a motion has diverged */
        return first;
    const double width = load->begins[last];
    const double share = width > 0.0 ? reach / width : 0.0;
    ptrdiff_t piece = first + (ptrdiff_t)((share > 1.0 ? 1.0 : share) * (double)(last - first));
    while (piece < last && load->begins[piece + 1] <= reach)
        piece++;
    while (piece > first && load->begins[piece] > reach)
        piece--;
    return piece;
}

/* Evaluate C_L, C_D and C_M and their slopes at an angle. */
WITHIN void evaluate(const Unexpanded *load, ptrdiff_t curve, double angle, double *values, double *slopes)
{
    double reach = angle - load->origin[curve];
    if (load->periodic[curve])
        reach -= TURN * floor(reach / TURN);
    const ptrdiff_t piece = piece_at(load, curve, reach);
    const double x = reach + load->origin[curve] - load->knots[piece], *powers = load->powers + 12 * piece;
    for (int i = 0; i < COEFFICIENTS; i++, powers += 4) {
        values[i] = powers[0] + x * (powers[1] + x * (powers[2] + x * powers[3]));
        slopes[i] = powers[1] + x * (2.0 * powers[2] + 3.0 * x * powers[3]);
    }
    if (!load->turning[curve])
        return;
    const double c = cos(angle), s = sin(angle);
    const double lift = c * values[0] - s * values[1], drag = s * values[0] + c * values[1];
    const double lift_slope = c * slopes[0] - s * slopes[1] - drag, drag_slope = s * slopes[0] + c * slopes[1] + lift;
    values[LIFT] = lift, values[DRAG] = drag, slopes[LIFT] = lift_slope, slopes[DRAG] = drag_slope;
}

/* Add F_y, F_z and the moment of one sub-conductor to `total` (3) and, if there are `rows` (3, 4), their slopes by Theta,
 * V'/U, W'/U and Theta'/U of the section to them. */
WITHIN void add_subconductor(const Unexpanded *load, ptrdiff_t point, ptrdiff_t i, const double *motion, double *total,
                             double (*rows)[4])
{
    const double y = load->positions[(point * load->subconductors + i) * 2];
    const double z = load->positions[(point * load->subconductors + i) * 2 + 1];
    const double d = *load->diameter, phi = load->factor[point], lever = 0.5 * d - z;
    const double b = (motion[1] + lever * motion[3]) / phi, c = 1.0 - (motion[2] + y * motion[3]) / phi;
    const double square = b * b + c * c, r = sqrt(square);
    double values[COEFFICIENTS], slopes[COEFFICIENTS];
    const double wind = c > 0.0 ? atan(b / c) : atan2(b, c); /* atan is twice as fast, and c hardly ever changes its sign */
    evaluate(load, load->which[point], load->rest_angle[point] + motion[0] - wind, values, slopes);
    const double lift = values[LIFT], drag = values[DRAG], moment = values[MOMENT];
    const double along = lift * c - drag * b, across = lift * b + drag * c;
    const double forces[3] = {r * along, r * across, d * square * moment};
    total[0] += forces[0];
    total[1] += forces[1];
    total[2] += forces[2] + y * forces[1] - z * forces[0];
    if (!rows)
        return;
    const double turned_along = slopes[LIFT] * c - slopes[DRAG] * b, turned_across = slopes[LIFT] * b + slopes[DRAG] * c;
    /* By Theta, b and c: F_y = r along, F_z = r across, F_theta = d r^2 C_M; alpha_b = -c/r^2, alpha_c = b/r^2. */
    const double by[3][3] = {
        {r * turned_along, (b * along - c * turned_along) / r - r * drag, (c * along + b * turned_along) / r + r * lift},
        {r * turned_across, (b * across - c * turned_across) / r + r * lift,
         (c * across + b * turned_across) / r + r * drag},
        {d * square * slopes[MOMENT], d * (2.0 * b * moment - c * slopes[MOMENT]),
         d * (2.0 * c * moment + b * slopes[MOMENT])}};
    for (int f = 0; f < 3; f++) {
        double own[3] = {by[f][0], by[f][1], by[f][2]};
        for (int v = 0; v < 3 && f == 2; v++)
            own[v] += y * by[1][v] - z * by[0][v];
        rows[f][0] += own[0];
        rows[f][1] += own[1] / phi;
        rows[f][2] -= own[2] / phi;
        rows[f][3] += (lever * own[1] - y * own[2]) / phi;
    }
}

WIDE void unexpanded_force(const Unexpanded *load, int m, const double *state, double *force, double *gradient)
{
    for (int j = 0; j < m; j++)
        force[j] = -load->at_rest[j];
    if (gradient)
        memset(gradient, 0, (size_t)m * 2 * (size_t)m * sizeof *gradient);
    for (ptrdiff_t p = 0; p < load->points; p++) {
        const double *v = load->fields + p * 3 * m, *w = v + m, *theta = w + m, strength = load->strength[p];
        double motion[4] = {0.0}, total[3] = {0.0}, rows[3][4] = {{0.0}};
        if (strength == 0.0) /* padding */
            continue;
        for (int j = 0; j < m; j++) {
            motion[0] += theta[j] * state[j];
            motion[1] += v[j] * state[m + j];
            motion[2] += w[j] * state[m + j];
            motion[3] += theta[j] * state[m + j];
        }
        for (ptrdiff_t i = 0; i < load->subconductors; i++)
            if (load->present[i] != 0.0)
                add_subconductor(load, p, i, motion, total, gradient ? rows : NULL);
        for (int j = 0; j < m; j++) {
            const double own[3] = {strength * v[j], strength * w[j], strength * theta[j]};
            if (own[0] == 0.0 && own[1] == 0.0 && own[2] == 0.0)
                continue;
            double mixed[4] = {0.0};
            for (int f = 0; f < 3; f++) {
                force[j] += own[f] * total[f];
                for (int k = 0; k < 4; k++)
                    mixed[k] += own[f] * rows[f][k];
            }
            for (int k = 0; k < m && gradient; k++) {
                gradient[j * 2 * m + k] += mixed[0] * theta[k];
                gradient[j * 2 * m + m + k] += mixed[1] * v[k] + mixed[2] * w[k] + mixed[3] * theta[k];
            }
        }
    }
}

void unexpanded_at(const Unexpanded *load, int m, const Lanes *state, Lanes *force, Lanes *gradient)
{
    double x[2 * m], own[m], slopes[m * 2 * m];
    for (int lane = 0; lane < LANES; lane++) {
        for (int v = 0; v < 2 * m; v++)
            x[v] = state[v][lane];
        unexpanded_force(load, m, x, own, slopes);
        for (int j = 0; j < m; j++)
            force[j][lane] = own[j];
        for (int v = 0; v < m * 2 * m; v++)
            gradient[v][lane] = slopes[v];
    }
}
