/* The module engine.kernels._kernels. Arrays come in as buffers; item type and length are checked before use. */
#define PY_SSIZE_T_CLEAN
#include <Python.h>
#include <limits.h>
#include <string.h>

#include "kernels.h"

/* Buffers of one call, released together. */
typedef struct {
    Py_buffer held[40];
    int count;
} Buffers;

static void release_buffers(Buffers *buffers)
{
    while (buffers->count)
        PyBuffer_Release(&buffers->held[--buffers->count]);
}

/* Return the product of sizes, or -1 if one is negative or the product is so large that sums and bytes of it overflow. */
static Py_ssize_t product(const Py_ssize_t *sizes, int count)
{
    Py_ssize_t all = 1;
    for (int i = 0; i < count; i++)
        if (sizes[i] < 0 || __builtin_mul_overflow(all, sizes[i], &all) || all > PY_SSIZE_T_MAX / 16)
            return -1;
    return all;
}

#define SIZE(...) product((const Py_ssize_t[]){__VA_ARGS__}, sizeof((Py_ssize_t[]){__VA_ARGS__}) / sizeof(Py_ssize_t))

/* Return whether a number lies within bounds; set an exception otherwise. */
static int bounded(const char *name, Py_ssize_t number, Py_ssize_t least, Py_ssize_t most)
{
    if (number >= least && number <= most)
        return 1;
    PyErr_Format(PyExc_ValueError, "%s must be %zd to %zd, got %zd", name, least, most, number);
    return 0;
}

/* Bounds far above any use, below which the numbers of monomials of so many variables are ints. */
#define MOST_VARIABLES 1000
#define MOST_HARMONICS (1 << 16)
#define SOME(variables) bounded("variables", variables, 1, MOST_VARIABLES)

/* Return whether a tuple has at least so many items; set an exception otherwise. */
static int has_items(PyObject *parts, Py_ssize_t least)
{
    if (PyTuple_GET_SIZE(parts) >= least)
        return 1;
    PyErr_Format(PyExc_ValueError, "a tuple must hold %zd items, got %zd", least, PyTuple_GET_SIZE(parts));
    return 0;
}

/* Return the items of a contiguous array of `expected` 8-byte numbers of one of these kinds, or NULL with an exception. */
static void *items(Buffers *buffers, PyObject *array, Py_ssize_t expected, const char *kinds, int flags)
{
    Py_buffer *view = &buffers->held[buffers->count];
    if (expected < 0) {
        PyErr_Format(PyExc_ValueError, "array %d would have a negative size, or more numbers than fit", buffers->count + 1);
        return NULL;
    }
    if (buffers->count == sizeof buffers->held / sizeof *buffers->held) {
        PyErr_SetString(PyExc_ValueError, "too many arrays");
        return NULL;
    }
    if (PyObject_GetBuffer(array, view, PyBUF_C_CONTIGUOUS | PyBUF_FORMAT | flags) < 0)
        return NULL;
    buffers->count++;
    if (view->itemsize == 8 && view->format && strlen(view->format) == 1 && strchr(kinds, view->format[0])
        && view->len % 8 == 0 && view->len / 8 == expected)
        return view->buf;
    PyErr_Format(PyExc_ValueError, "array %d must hold %zd numbers of kind %s", buffers->count, expected, kinds);
    return NULL;
}

#define REALS(array, expected) items(&buffers, array, expected, "d", 0)
#define RESULT(array, expected) items(&buffers, array, expected, "d", PyBUF_WRITABLE)
#define INDICES(array, expected) items(&buffers, array, expected, "lq", 0)

/* Return whether every index is below the limit; set an exception otherwise. */
static int within(const Py_ssize_t *index, Py_ssize_t count, Py_ssize_t limit)
{
    for (Py_ssize_t i = 0; i < count; i++)
        if (index[i] < 0 || index[i] >= limit) {
            PyErr_Format(PyExc_IndexError, "model %zd of a stack of %zd", index[i], limit);
            return 0;
        }
    return 1;
}

/* Return whether curves begin one after another, each with a piece at least; set an exception otherwise. */
static int rising(const Py_ssize_t *first, Py_ssize_t count)
{
    for (Py_ssize_t i = 0; i < count; i++)
        if (first[i] < 0 || (i && first[i] <= first[i - 1])) {
            PyErr_Format(PyExc_ValueError, "curve %zd begins at piece %zd", i, first[i]);
            return 0;
        }
    return 1;
}

/* Read arrays of reals from a tuple, beginning with one of its items. */
static int read_reals(Buffers *held, PyObject *parts, Py_ssize_t first, int count, const Py_ssize_t *sizes,
                      const double **read)
{
    for (int i = 0; i < count; i++)
        if (!(read[i] = items(held, PyTuple_GET_ITEM(parts, first + i), sizes[i], "d", 0)))
            return 0;
    return 1;
}

/* Read an unexpanded load from the items of a tuple behind the first six: indices which, first, periodic and turning, then
 * the reals in the order of `sizes`. */
static int read_unexpanded(Buffers *held, PyObject *parts, const int *shape, Unexpanded *load, Py_ssize_t members)
{
    const Py_ssize_t m = shape[0], points = shape[1], n = shape[2], sections = SIZE(members, points);
    if (!has_items(parts, 23))
        return 0;
    const Py_ssize_t curves = PyObject_Length(PyTuple_GET_ITEM(parts, 7)) - 1;
    const Py_ssize_t *which, *first, *periodic, *turning;
    if (PyErr_Occurred() || !bounded("curves", curves, 0, PY_SSIZE_T_MAX)
        || !(which = items(held, PyTuple_GET_ITEM(parts, 6), sections, "lq", 0)) || !within(which, sections, curves)
        || !(first = items(held, PyTuple_GET_ITEM(parts, 7), curves + 1, "lq", 0)) || !rising(first, curves + 1)
        || !(periodic = items(held, PyTuple_GET_ITEM(parts, 8), curves, "lq", 0))
        || !(turning = items(held, PyTuple_GET_ITEM(parts, 9), curves, "lq", 0)))
        return 0;
    const Py_ssize_t pieces = first[curves];
    const Py_ssize_t sizes[] = {SIZE(sections, 3, m), sections,         sections, members, SIZE(sections, n, 2),
                                SIZE(members, n),     sections,         SIZE(members, m),  curves,
                                curves,               pieces,           pieces,   SIZE(12, pieces)};
    const double *read[13];
    if (!read_reals(held, parts, 10, 13, sizes, read))
        return 0;
    *load = (Unexpanded){points,  n,       read[0], read[1], read[2],  read[3],  read[4], read[5],  read[6],
                         read[7], read[8], read[9], read[10], read[11], read[12], which,   first,   periodic, turning};
    return 1;
}

/* Read a stack of models from a tuple: mass, damping, stiffness, restoring, restoring_slopes, the last two empty where
 * stretching is neglected, parity, and the load: forms, table, slopes, or an unexpanded one if the shape has samples. */
static int read_model(Buffers *held, PyObject *parts, const int *shape, Model *model, Py_ssize_t members)
{
    const Py_ssize_t m = shape[0], points = shape[1], local = shape[2], stretches = shape[3];
    if (!SOME(shape[0]) || !bounded("points", points, 0, INT_MAX) || !bounded("local", local, 0, MOST_VARIABLES)
        || !bounded("samples", shape[4], 0, MOST_HARMONICS) || !has_items(parts, 9))
        return 0;
    const Py_ssize_t square = SIZE(members, m, m);
    const Py_ssize_t sizes[] = {square, square, square, SIZE(members, stretches, m, monomials_of(shape[0])),
                                SIZE(members, stretches, m, m, lower_of(shape[0]))};
    const double *own[5], *load[3] = {NULL, NULL, NULL};
    const Py_ssize_t *parity;
    if (!read_reals(held, parts, 0, 5, sizes, own)
        || !(parity = items(held, PyTuple_GET_ITEM(parts, 5), SIZE(members, m), "lq", 0)))
        return 0;
    *model = (Model){.m = shape[0], .points = shape[1], .local = shape[2], .stretches = shape[3], .samples = shape[4],
                     .mass = own[0], .damping = own[1], .stiffness = own[2], .restoring = own[3],
                     .restoring_slopes = own[4], .parity = parity};
    if (model->samples)
        return read_unexpanded(held, parts, shape, &model->unexpanded, members);
    const Py_ssize_t of_load[] = {SIZE(members, points, local, 2, m), SIZE(members, points, m, monomials_of(shape[2])),
                                  SIZE(members, points, m, local, lower_of(shape[2]))};
    if (!read_reals(held, parts, 6, 3, of_load, load))
        return 0;
    model->forms = load[0], model->table = load[1], model->slopes = load[2];
    return 1;
}

/* Release the buffers; return None, or NULL with an exception. */
static PyObject *finished(Buffers *buffers, int enough_memory)
{
    release_buffers(buffers);
    if (PyErr_Occurred())
        return NULL;
    if (!enough_memory)
        return PyErr_NoMemory();
    Py_RETURN_NONE;
}

static PyObject *newton(PyObject *Py_UNUSED(self), PyObject *arguments)
{
    Buffers buffers = {.count = 0};
    PyObject *parts, *member, *speed, *reference, *anchor, *scale, *row, *target, *reach, *x, *step, *iterations;
    PyObject *residual, *tangent;
    int shape[5], harmonics, follows, done = 1;
    Py_ssize_t members, cycles;
    Options options;
    if (!PyArg_ParseTuple(arguments, "O!(niiipi)(nip)(OOOOOOOO)(ddi)(OOOOO)", &PyTuple_Type, &parts, &members, shape,
                          shape + 1, shape + 2, shape + 3, shape + 4, &cycles, &harmonics, &follows, &member, &speed, &reference, &anchor,
                          &scale, &row, &target, &reach, &options.tolerance, &options.largest_step, &options.iterations, &x,
                          &step, &iterations, &residual, &tangent))
        return NULL;
    const Py_ssize_t balances = SIZE(shape[0], 2 * (Py_ssize_t)harmonics + 1), unknowns = balances + 1 + follows;
    const Py_ssize_t all = SIZE(cycles, unknowns);
    Model model;
    Balances wanted = {.cycles = cycles, .harmonics = harmonics, .follows = follows};
    if (bounded("harmonics", harmonics, 0, MOST_HARMONICS) && read_model(&buffers, parts, shape, &model, members)
        && (wanted.member = INDICES(member, cycles)) && within(wanted.member, cycles, members)
        && (wanted.wind_speed = REALS(speed, follows ? 0 : cycles))
        && (wanted.reference = REALS(reference, SIZE(cycles, balances))) && (wanted.anchor = REALS(anchor, all))
        && (wanted.scale = REALS(scale, all)) && (wanted.row = REALS(row, follows ? all : 0))
        && (wanted.target = REALS(target, follows ? cycles : 0)) && (wanted.reach = REALS(reach, cycles))
        && (wanted.x = RESULT(x, all))
        && (wanted.step = RESULT(step, cycles))
        && (wanted.iterations = items(&buffers, iterations, cycles, "lq", PyBUF_WRITABLE))
        && (wanted.residual = RESULT(residual, SIZE(cycles, balances)))
        && (wanted.tangent = RESULT(tangent, follows ? all : 0))) {
        Py_BEGIN_ALLOW_THREADS
        done = solve_balances(&model, &wanted, &options);
        Py_END_ALLOW_THREADS
    }
    return finished(&buffers, done);
}

static PyObject *linearization(PyObject *Py_UNUSED(self), PyObject *arguments)
{
    Buffers buffers = {.count = 0};
    PyObject *parts, *member, *coefficients, *frequency, *speed, *residuals, *slopes;
    int shape[5], harmonics;
    Py_ssize_t members, cycles;
    if (!PyArg_ParseTuple(arguments, "O!(niiipi)(ni)(OOOO)(OO)", &PyTuple_Type, &parts, &members, shape, shape + 1,
                          shape + 2, shape + 3, shape + 4, &cycles, &harmonics, &member, &coefficients, &frequency, &speed, &residuals, &slopes))
        return NULL;
    const Py_ssize_t n = SIZE(shape[0], 2 * (Py_ssize_t)harmonics + 1);
    Model model;
    Linearizations wanted = {.cycles = cycles, .harmonics = harmonics};
    int done = 1;
    if (bounded("harmonics", harmonics, 0, MOST_HARMONICS) && read_model(&buffers, parts, shape, &model, members)
        && (wanted.member = INDICES(member, cycles)) && within(wanted.member, cycles, members)
        && (wanted.coefficients = REALS(coefficients, SIZE(cycles, n)))
        && (wanted.angular_frequency = REALS(frequency, cycles)) && (wanted.wind_speed = REALS(speed, cycles))
        && (wanted.residuals = RESULT(residuals, SIZE(cycles, n)))
        && (wanted.slopes = RESULT(slopes, SIZE(cycles, n, n + 2)))) {
        Py_BEGIN_ALLOW_THREADS
        done = linearize_balances(&model, &wanted);
        Py_END_ALLOW_THREADS
    }
    return finished(&buffers, done);
}

/* Return whether steps are multiples of LANES and their rows exist; set an exception otherwise. */
static int whole_steps(const Monodromies *wanted, Py_ssize_t rows)
{
    for (Py_ssize_t i = 0; i < wanted->cycles; i++)
        if (wanted->steps[i] < 0 || wanted->steps[i] % LANES || wanted->first[i] < 0
            || wanted->steps[i] > rows / 2 || wanted->first[i] > rows - 2 * wanted->steps[i]) {
            PyErr_Format(PyExc_ValueError, "%zd steps from row %zd of %zd", wanted->steps[i], wanted->first[i], rows);
            return 0;
        }
    return 1;
}

static PyObject *monodromies(PyObject *Py_UNUSED(self), PyObject *arguments)
{
    Buffers buffers = {.count = 0};
    PyObject *parts, *member, *inverse, *coefficients, *frequency, *speed, *values, *slopes, *steps, *first, *matrices;
    int shape[5], harmonics;
    Py_ssize_t members, cycles, rows;
    if (!PyArg_ParseTuple(arguments, "O!(niiipi)(nni)(OOOOOOOOO)O", &PyTuple_Type, &parts, &members, shape, shape + 1,
                          shape + 2, shape + 3, shape + 4, &cycles, &rows, &harmonics, &member, &inverse, &coefficients, &frequency, &speed,
                          &values, &slopes, &steps, &first, &matrices))
        return NULL;
    const Py_ssize_t m = shape[0], size = 2 * (Py_ssize_t)harmonics + 1;
    Model model;
    Monodromies wanted = {.cycles = cycles, .harmonics = harmonics};
    int done = 1;
    if (bounded("harmonics", harmonics, 0, MOST_HARMONICS) && read_model(&buffers, parts, shape, &model, members)
        && (wanted.member = INDICES(member, cycles)) && within(wanted.member, cycles, members)
        && (wanted.inverse_mass = REALS(inverse, SIZE(members, m, m)))
        && (wanted.coefficients = REALS(coefficients, SIZE(cycles, m, size)))
        && (wanted.angular_frequency = REALS(frequency, cycles)) && (wanted.wind_speed = REALS(speed, cycles))
        && (wanted.values = REALS(values, SIZE(rows, size))) && (wanted.slopes = REALS(slopes, SIZE(rows, size)))
        && (wanted.steps = INDICES(steps, cycles)) && (wanted.first = INDICES(first, cycles))
        && whole_steps(&wanted, rows) && (wanted.matrices = RESULT(matrices, SIZE(cycles, 4, m, m)))) {
        Py_BEGIN_ALLOW_THREADS
        done = integrate_monodromies(&model, &wanted);
        Py_END_ALLOW_THREADS
    }
    return finished(&buffers, done);
}

static PyObject *eigenvalues(PyObject *Py_UNUSED(self), PyObject *arguments)
{
    Buffers buffers = {.count = 0};
    PyObject *matrices, *values;
    Eigenproblems wanted;
    int done = 1;
    if (!PyArg_ParseTuple(arguments, "(ni)OO", &wanted.count, &wanted.n, &matrices, &values) || !SOME(wanted.n))
        return NULL;
    if ((wanted.matrices = REALS(matrices, SIZE(wanted.count, wanted.n, wanted.n)))
        && (wanted.values = RESULT(values, SIZE(wanted.count, wanted.n, 2)))) {
        Py_BEGIN_ALLOW_THREADS
        done = find_eigenvalues(&wanted);
        Py_END_ALLOW_THREADS
    }
    return finished(&buffers, done);
}

static PyObject *even_parts(PyObject *Py_UNUSED(self), PyObject *arguments)
{
    Buffers buffers = {.count = 0};
    PyObject *polynomials, *statics, *member, *angle, *even, *square;
    Py_ssize_t members, count;
    if (!PyArg_ParseTuple(arguments, "(nn)(OOOO)(OO)", &members, &count, &polynomials, &statics, &member, &angle, &even,
                          &square))
        return NULL;
    EvenParts wanted = {.count = count};
    if ((wanted.polynomials = REALS(polynomials, SIZE(members, 28))) && (wanted.statics = REALS(statics, SIZE(members, 3)))
        && (wanted.member = INDICES(member, count)) && within(wanted.member, count, members)
        && (wanted.angle = REALS(angle, count)) && (wanted.even = RESULT(even, SIZE(2, count)))
        && (wanted.square = RESULT(square, SIZE(2, count))))
        evaluate_even_parts(&wanted);
    return finished(&buffers, 1);
}

static PyObject *reaches(PyObject *Py_UNUSED(self), PyObject *arguments)
{
    Buffers buffers = {.count = 0};
    PyObject *forms, *arms, *diameter, *member, *state, *reach;
    Py_ssize_t members;
    Reaches wanted = {.m = 0};
    int done = 1;
    if (!PyArg_ParseTuple(arguments, "(nnnninp)(OOOOO)O", &members, &wanted.motions, &wanted.samples, &wanted.nodes,
                          &wanted.m, &wanted.subconductors, &wanted.published, &forms, &arms, &diameter, &member, &state,
                          &reach))
        return NULL;
    const Py_ssize_t motions = wanted.motions, nodes = wanted.nodes, width = 2 * (Py_ssize_t)wanted.m;
    if (SOME(wanted.m) && bounded("sub-conductors", wanted.subconductors, 0, MOST_VARIABLES)
        && (wanted.forms = REALS(forms, SIZE(members, nodes, 4, width)))
        && (wanted.arms = REALS(arms, SIZE(members, nodes, wanted.subconductors, 2)))
        && (wanted.diameter = REALS(diameter, members)) && (wanted.member = INDICES(member, motions))
        && within(wanted.member, motions, members)
        && (wanted.state = REALS(state, SIZE(motions, width, wanted.samples)))
        && (wanted.reach = RESULT(reach, SIZE(2, motions)))) {
        Py_BEGIN_ALLOW_THREADS
        done = find_reaches(&wanted);
        Py_END_ALLOW_THREADS
    }
    return finished(&buffers, done);
}

/* Read the unexpanded load of starts: gain, linear, wind_speed and member, then the load as in read_unexpanded. */
static int read_unexpanded_starts(Buffers *held, PyObject *extra, PyObject *parts, Flows *flows)
{
    const Py_ssize_t starts = flows->starts, m = flows->m;
    if (!has_items(extra, 6) || !has_items(parts, 23))
        return 0;
    const Py_ssize_t members = PyObject_Length(PyTuple_GET_ITEM(parts, 0));
    const Py_ssize_t points = PyLong_AsSsize_t(PyTuple_GET_ITEM(extra, 4));
    const Py_ssize_t n = PyLong_AsSsize_t(PyTuple_GET_ITEM(extra, 5));
    if (PyErr_Occurred() || !bounded("points", points, 0, INT_MAX) || !bounded("sub-conductors", n, 0, MOST_VARIABLES))
        return 0;
    const int shape[] = {flows->m, (int)points, (int)n};
    const Py_ssize_t sizes[] = {SIZE(m, m, starts), SIZE(2, m, m, starts), starts};
    const double *read[3];
    if (!read_reals(held, extra, 0, 3, sizes, read)
        || !(flows->member = items(held, PyTuple_GET_ITEM(extra, 3), starts, "lq", 0))
        || !within(flows->member, starts, members))
        return 0;
    flows->gain = read[0], flows->linear = read[1], flows->wind_speed = read[2];
    return read_unexpanded(held, parts, shape, &flows->unexpanded, members);
}

static PyObject *flows(PyObject *Py_UNUSED(self), PyObject *arguments)
{
    Buffers buffers = {.count = 0};
    PyObject *half_step, *nonlinear, *outward, *forms, *restoring, *step, *angle, *window, *state, *square, *largest;
    PyObject *extra = NULL, *parts = NULL;
    Flows wanted = {.gain = NULL};
    int done = 1;
    if (!PyArg_ParseTuple(arguments, "(nniiiip)(OOOOOOOO)(OOO)|O!O!", &wanted.starts, &wanted.steps, &wanted.m,
                          &wanted.points, &wanted.rows, &wanted.local, &wanted.stretches, &half_step, &nonlinear,
                          &outward, &forms, &restoring, &step, &angle, &window, &state, &square, &largest, &PyTuple_Type, &extra, &PyTuple_Type,
                          &parts))
        return NULL;
    const Py_ssize_t starts = wanted.starts, m = wanted.m, points = wanted.points, local = wanted.local;
    if (!SOME(wanted.m) || !bounded("local", local, 0, MOST_VARIABLES))
        return NULL;
    if (extra && !parts) {
        PyErr_SetString(PyExc_ValueError, "the terms of an unexpanded load come with the load");
        return NULL;
    }
    const Py_ssize_t rows = wanted.rows, terms = monomials_of(wanted.local) - local;
    const Py_ssize_t own = wanted.stretches ? monomials_of(wanted.m) - m : 0, both = SIZE(2, m, starts);
    if ((wanted.half_step = REALS(half_step, SIZE(4, m, m, starts)))
        && (wanted.nonlinear = REALS(nonlinear, SIZE(points, rows, terms, starts)))
        && (wanted.outward = REALS(outward, SIZE(points, m, rows, starts)))
        && (wanted.forms = REALS(forms, SIZE(points, local, 2, m, starts)))
        && (wanted.restoring = REALS(restoring, SIZE(m, own, starts))) && (wanted.step = REALS(step, starts))
        && (wanted.angle = REALS(angle, both)) && (wanted.window = REALS(window, wanted.steps))
        && (wanted.state = RESULT(state, both)) && (wanted.square = RESULT(square, both))
        && (wanted.largest = RESULT(largest, starts))
        && (!extra || read_unexpanded_starts(&buffers, extra, parts, &wanted))) {
        Py_BEGIN_ALLOW_THREADS
        done = integrate_flows(&wanted);
        Py_END_ALLOW_THREADS
    }
    return finished(&buffers, done);
}

static PyMethodDef methods[] = {
    {"newton", newton, METH_VARARGS, "Solve the harmonic balance of a stack of cycles by Newton's method."},
    {"linearization", linearization, METH_VARARGS, "Evaluate the harmonic balance of a stack of cycles with its slopes."},
    {"monodromies", monodromies, METH_VARARGS, "Integrate the linearized equations of a stack of cycles over one period."},
    {"eigenvalues", eigenvalues, METH_VARARGS, "Find the eigenvalues of a stack of small matrices."},
    {"even_parts", even_parts, METH_VARARGS, "Evaluate the scalar equation of the explicit first harmonic."},
    {"reaches", reaches, METH_VARARGS, "Find the largest angle of attack and velocity ratio of a stack of motions."},
    {"flows", flows, METH_VARARGS, "Integrate the equations of motion of a stack of starts directly."},
    {NULL, NULL, 0, NULL},
};

static struct PyModuleDef definition = {PyModuleDef_HEAD_INIT, "_kernels", "The engine's innermost loops.", 0, methods,
                                        NULL, NULL, NULL, NULL};

PyMODINIT_FUNC PyInit__kernels(void) { return PyModuleDef_Init(&definition); }
