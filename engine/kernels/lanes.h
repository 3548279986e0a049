/* Functions of numbers side by side that the compiler has no vector form of. */
#ifndef GALLOPING_LANES_H
#define GALLOPING_LANES_H

#include "kernels.h"

#include <math.h>

#define EIGHTH 0.41421356237309503 /* tan(pi/8) */

typedef int Counts __attribute__((vector_size(LANES * sizeof(int))));
typedef long long Masks __attribute__((vector_size(LANES * sizeof(double)), aligned(8), may_alias));

#ifdef __clang__
#define SHUFFLED(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
#define SHUFFLED(a, b, ...) __builtin_shuffle(a, b, (Masks){__VA_ARGS__})
#endif

/* Take a where the mask, a comparison, holds, and b elsewhere. */
WITHIN Lanes chosen(Masks mask, Lanes a, Lanes b) { return (Lanes)(((Masks)a & mask) | ((Masks)b & ~mask)); }

/* Return whether a mask holds in all lanes. */
WITHIN int all_hold(Masks mask)
{
    long long all = mask[0];
    for (int lane = 1; lane < LANES; lane++)
        all &= mask[lane];
    return all != 0;
}

WITHIN Lanes root(Lanes x)
{
    double values[LANES];
    for (int lane = 0; lane < LANES; lane++)
        values[lane] = sqrt(x[lane]);
    return *(Lanes *)values;
}

/* Round down, for |x| < 2^51: adding 1.5 * 2^52 leaves no digits behind the point. */
WITHIN Lanes floored(Lanes x)
{
    const Lanes nearest = x + 0x1.8p52 - 0x1.8p52;
    return nearest - chosen(nearest > x, (Lanes){0} + 1.0, (Lanes){0});
}

/* Read four numbers of each of four rows, from a place on, and return them as columns. */
WITHIN void read_columns(const double *const *rows, int from, Lanes *columns)
{
    const Lanes a = *(const Lanes *)(rows[0] + from), b = *(const Lanes *)(rows[1] + from);
    const Lanes c = *(const Lanes *)(rows[2] + from), d = *(const Lanes *)(rows[3] + from);
    const Lanes even = SHUFFLED(a, b, 0, 4, 2, 6), odd = SHUFFLED(a, b, 1, 5, 3, 7);
    const Lanes even_below = SHUFFLED(c, d, 0, 4, 2, 6), odd_below = SHUFFLED(c, d, 1, 5, 3, 7);
    columns[0] = SHUFFLED(even, even_below, 0, 1, 4, 5);
    columns[1] = SHUFFLED(odd, odd_below, 0, 1, 4, 5);
    columns[2] = SHUFFLED(even, even_below, 2, 3, 6, 7);
    columns[3] = SHUFFLED(odd, odd_below, 2, 3, 6, 7);
}

/* Return atan(t) for |t| <= tan(pi/8), to 5e-18 t: t + t z P(z) with z = t^2 and P through Chebyshev's points. */
WITHIN Lanes small_angle(Lanes t)
{
    const Lanes z = t * t, z2 = z * z, z4 = z2 * z2;
    const Lanes low = (-0.3333333333333333 + z * 0.1999999999999552) + z2 * (-0.14285714284666542 + z * 0.11111111015256361);
    const Lanes middle = (-0.09090904578123903 + z * 0.07692183190826087) + z2 * (-0.06664511447381948 + z * 0.0585814891280221);
    const Lanes high = (-0.0508544973794026 + z * 0.03923165829558719) - z2 * 0.01917688711906226;
    return t + t * z * (low + z4 * (middle + z4 * high));
}

/* Return the angle of (x, y), as atan2(y, x). Where it is not small, it comes from that of the smaller coordinate over the
 * larger one, less an eighth of a turn if that is nearer. */
WITHIN Lanes angle_of(Lanes y, Lanes x)
{
    const Lanes zero = {0}, rise = chosen(y < zero, -y, y);
    if (all_hold(rise <= EIGHTH * x))
        return small_angle(y / x);
    const Lanes run = chosen(x < zero, -x, x);
    const Masks steep = rise > run;
    const Lanes less = chosen(steep, run, rise), more = chosen(steep, rise, run);
    const Masks far = less > EIGHTH * more;
    Lanes angle = small_angle(chosen(far, less - more, less) / chosen(far, less + more, more));
    angle += chosen(far, zero + 0.25 * M_PI, zero);
    angle = chosen(steep, 0.5 * M_PI - angle, angle);
    angle = chosen(x < zero, M_PI - angle, angle);
    return chosen(y < zero, -angle, angle);
}

#endif
