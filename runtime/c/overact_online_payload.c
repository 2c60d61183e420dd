/* Payload of `overact::online`: the nearest physically consistent body, by an interior-point method. */
#include "overact_online.h"

#include <math.h>
#include <stddef.h>

typedef overact_online_number number;

#ifdef OVERACT_ONLINE_SINGLE
#define ROOT(x) sqrtf(x)
#define PIVOT 1e-7f
#else
#define ROOT(x) sqrt(x)
#define PIVOT 1e-15
#endif

#define STEPS 100
#define TEN 10
/* Largest distance from the best half sum of squares. */
#define GAP ((number)0.005)

/* Row and column of each entry of a lower triangle. */
static const int entries[TEN][2]
    = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 2, 0 }, { 2, 1 }, { 2, 2 }, { 3, 0 }, { 3, 1 }, { 3, 2 }, { 3, 3 } };

static int place(int row, int column)
{
    return row * (row + 1) / 2 + column;
}

/* Pseudo-inertia of ten parameters, lengths in units of `length`. */
static void pseudo_inertia(const number *x, number length, number *pseudo)
{
    const number square = length * length;
    pseudo[0] = (number)0.5 * (x[3] + x[5] - x[0]) / square;
    pseudo[1] = -x[1] / square;
    pseudo[2] = (number)0.5 * (x[0] + x[5] - x[3]) / square;
    pseudo[3] = -x[2] / square;
    pseudo[4] = -x[4] / square;
    pseudo[5] = (number)0.5 * (x[0] + x[3] - x[5]) / square;
    pseudo[6] = x[6] / length;
    pseudo[7] = x[7] / length;
    pseudo[8] = x[8] / length;
    pseudo[9] = x[9];
}

/* The ten parameters of a pseudo-inertia. */
static void inertia(const number *pseudo, number length, number *x)
{
    const number square = length * length;
    x[0] = (pseudo[2] + pseudo[5]) * square;
    x[1] = -pseudo[1] * square;
    x[2] = -pseudo[3] * square;
    x[3] = (pseudo[0] + pseudo[5]) * square;
    x[4] = -pseudo[4] * square;
    x[5] = (pseudo[0] + pseudo[2]) * square;
    x[6] = pseudo[6] * length;
    x[7] = pseudo[7] * length;
    x[8] = pseudo[8] * length;
    x[9] = pseudo[9];
}

/* Cholesky factor; 0 unless the matrix is positive definite within rounding. */
static int cholesky(const number *pseudo, number *lower)
{
    for (int row = 0; row < 4; row++) {
        for (int column = 0; column <= row; column++) {
            number rest = pseudo[place(row, column)];
            for (int k = 0; k < column; k++) {
                rest -= lower[place(row, k)] * lower[place(column, k)];
            }
            if (column < row) {
                lower[place(row, column)] = rest / lower[place(column, column)];
            } else if (rest > (PIVOT * pseudo[place(row, row)])) {
                lower[place(row, row)] = ROOT(rest);
            } else {
                return 0;
            }
            if (!isfinite(lower[place(row, column)])) {
                return 0;
            }
        }
    }
    return 1;
}

static void invert(const number *lower, number *inverse)
{
    for (int column = 0; column < 4; column++) {
        for (int row = column; row < 4; row++) {
            number rest = (row == column) ? (number)1.0 : (number)0.0;
            for (int k = column; k < row; k++) {
                rest -= lower[place(row, k)] * inverse[place(k, column)];
            }
            inverse[place(row, column)] = rest / lower[place(row, row)];
        }
    }
}

static number entry_of(const number *lower, int row, int column)
{
    return (row >= column) ? lower[place(row, column)] : (number)0.0;
}

/* N E N^T for an entry; entries off the diagonal times the root of two. */
static void transformed(const number *lower, int entry, number *result)
{
    const int p = entries[entry][0];
    const int q = entries[entry][1];
    for (int i = 0; i < TEN; i++) {
        const int a = entries[i][0];
        const int b = entries[i][1];
        number both = entry_of(lower, a, p) * entry_of(lower, b, q);
        if (p != q) {
            both = both + entry_of(lower, a, q) * entry_of(lower, b, p);
        }
        result[i] = (a == b) ? both : ((number)1.41421356237309504880 * both);
    }
}

/* R x - z of a pseudo-inertia; without z if `side` is null. */
static void residual(
    const overact_online_filter *filter,
    const int *columns,
    number length,
    const number *pseudo,
    const number *side,
    number *result)
{
    const int p = filter->parameters;
    number parameters[TEN];
    inertia(pseudo, length, parameters);
    for (int i = 0; i < p; i++) {
        result[i] = (side != NULL) ? -side[i] : (number)0.0;
        for (int j = 0; j < p; j++) {
            result[i] += filter->factor[i * p + j] * parameters[columns[j]];
        }
    }
}

static number cost(const overact_online_filter *filter, const int *columns, number length, const number *pseudo)
{
    number rest[TEN];
    number sum = (number)0.0;
    residual(filter, columns, length, pseudo, filter->side, rest);
    for (int i = 0; i < filter->parameters; i++) {
        sum += rest[i] * rest[i];
    }
    return (number)0.5 * sum;
}

/* Newton step for a barrier; its decrement, or a negative number without step. */
static number newton(
    const overact_online_filter *filter,
    const int *columns,
    number length,
    const number *weights,
    const number *pseudo,
    number barrier,
    number *step)
{
    const int p = filter->parameters;
    const number root = ROOT(barrier);
    number memory[OVERACT_ONLINE_MEMORY(TEN)];
    number lower[TEN];
    number inverse[TEN];
    number changes[TEN][TEN];
    number effects[TEN][TEN];
    number units[TEN][TEN];
    number rest[TEN];
    number present[TEN];
    number row[TEN];
    number square = (number)0.0;
    overact_online_filter system;
    (void)overact_online_init(&system, TEN, memory);
    if (cholesky(pseudo, lower) == 0) {
        return (number)-1.0;
    }
    invert(lower, inverse);
    for (int entry = 0; entry < TEN; entry++) {
        number unit[TEN] = { (number)0.0 };
        unit[entry] = (number)1.0;
        residual(filter, columns, length, unit, NULL, effects[entry]);
        inertia(unit, length, units[entry]);
        transformed(inverse, entry, changes[entry]);
    }
    residual(filter, columns, length, pseudo, filter->side, rest);
    inertia(pseudo, length, present);
    for (int line = 0; line < p; line++) {
        for (int entry = 0; entry < TEN; entry++) {
            row[entry] = effects[entry][line];
        }
        if (overact_online_update(&system, row, -rest[line], (number)1.0, NULL) != OVERACT_ONLINE_OK) {
            return (number)-1.0;
        }
    }
    for (int i = 0; i < TEN; i++) {
        if (weights[i] > (number)0.0) {
            for (int entry = 0; entry < TEN; entry++) {
                row[entry] = weights[i] * units[entry][i];
            }
            if (overact_online_update(&system, row, -weights[i] * present[i], (number)1.0, NULL)
                != OVERACT_ONLINE_OK) {
                return (number)-1.0;
            }
        }
    }
    for (int line = 0; line < TEN; line++) {
        const number y = (entries[line][0] == entries[line][1]) ? root : (number)0.0;
        for (int entry = 0; entry < TEN; entry++) {
            row[entry] = root * changes[entry][line];
        }
        if (overact_online_update(&system, row, y, (number)1.0, NULL) != OVERACT_ONLINE_OK) {
            return (number)-1.0;
        }
    }
    system.is_regular = 1;
    if (overact_online_estimate(&system, step) != OVERACT_ONLINE_OK) {
        return (number)-1.0;
    }
    for (int i = 0; i < TEN; i++) {
        square += system.side[i] * system.side[i];
    }
    square = ROOT(square / barrier);
    return isfinite(square) ? square : (number)-1.0;
}

/* Standard deviation of the prior of a parameter. */
static number deviation(int parameter, number mass, number length)
{
    number result = mass;
    if (parameter < 6) {
        result = mass * length * length;
    } else if (parameter < 9) {
        result = mass * length;
    } else {
        result = mass;
    }
    return result;
}

/* Improves a positive definite pseudo-inertia. */
static void improve(
    const overact_online_filter *filter, const int *columns, number length, const number *weights, number *pseudo)
{
    const number last = (number)0.25 * GAP;
    number barrier = (number)0.25 * cost(filter, columns, length, pseudo);
    int is_done = 0;
    barrier = (barrier > last) ? barrier : last;
    for (int count = 0; (count < STEPS) && (is_done == 0); count++) {
        number step[TEN];
        number next[TEN];
        number lower[TEN];
        const number decrement = newton(filter, columns, length, weights, pseudo, barrier, step);
        const number damping
            = (decrement > (number)0.25) ? ((number)1.0 / ((number)1.0 + decrement)) : (number)1.0;
        is_done = (decrement < (number)0.0) ? 1 : 0;
        for (int i = 0; (i < TEN) && (is_done == 0); i++) {
            next[i] = pseudo[i] + damping * step[i];
        }
        if ((is_done == 0) && (cholesky(next, lower) == 0)) {
            is_done = 1;
        }
        if (is_done == 0) {
            for (int i = 0; i < TEN; i++) {
                pseudo[i] = next[i];
            }
            if (decrement < (number)0.5) {
                is_done = (barrier <= last) ? 1 : 0;
                barrier = ((number)0.1 * barrier > last) ? ((number)0.1 * barrier) : last;
            }
        }
    }
}

/* A body with the estimated mass and centre as far as they are possible. */
static void start(const number *raw, number mass, number length, number *pseudo)
{
    const number least = (number)0.01 * mass;
    const number own = (raw[9] > least) ? raw[9] : least;
    number centre[4];
    centre[3] = (number)1.0;
    for (int i = 0; i < 3; i++) {
        const number ratio = raw[6 + i] / (own * length);
        const number above = (ratio > (number)-0.5) ? ratio : (number)-0.5;
        centre[i] = (above < (number)0.5) ? above : (number)0.5;
    }
    for (int i = 0; i < TEN; i++) {
        const int a = entries[i][0];
        const int b = entries[i][1];
        const number round = ((a == b) && (a < 3)) ? (number)0.25 : (number)0.0;
        pseudo[i] = (centre[a] * centre[b] + round) * own;
    }
}

static overact_online_error described(const number *x, int is_projected, overact_online_payload *payload)
{
    overact_online_payload found;
    const number m = x[9];
    const number a = x[6] / m;
    const number b = x[7] / m;
    const number c = x[8] / m;
    found.mass = m;
    found.centre[0] = a;
    found.centre[1] = b;
    found.centre[2] = c;
    found.inertia[0][0] = x[0] - m * (b * b + c * c);
    found.inertia[0][1] = x[1] + m * a * b;
    found.inertia[0][2] = x[2] + m * a * c;
    found.inertia[1][1] = x[3] - m * (a * a + c * c);
    found.inertia[1][2] = x[4] + m * b * c;
    found.inertia[2][2] = x[5] - m * (a * a + b * b);
    found.inertia[1][0] = found.inertia[0][1];
    found.inertia[2][0] = found.inertia[0][2];
    found.inertia[2][1] = found.inertia[1][2];
    found.is_projected = is_projected;
    for (int i = 0; i < TEN; i++) {
        found.parameters[i] = x[i];
        if (!isfinite(x[i])) {
            return OVERACT_ONLINE_OVERFLOW;
        }
    }
    for (int i = 0; i < 9; i++) {
        if (!isfinite(found.inertia[i / 3][i % 3]) || !isfinite(found.centre[i % 3])) {
            return OVERACT_ONLINE_OVERFLOW;
        }
    }
    *payload = found;
    return OVERACT_ONLINE_OK;
}

static int are_valid(int parameters, const int *columns, number mass, number length)
{
    if ((parameters < 1) || (parameters > TEN)) {
        return 0;
    }
    for (int i = 0; i < parameters; i++) {
        if ((columns[i] < 0) || (columns[i] >= TEN)) {
            return 0;
        }
        for (int j = 0; j < i; j++) {
            if (columns[i] == columns[j]) {
                return 0;
            }
        }
    }
    return ((mass > (number)0.0) && (length > (number)0.0) && isfinite(mass) && isfinite(length)) ? 1 : 0;
}

overact_online_error overact_online_payload_init(
    overact_online_filter *filter,
    int parameters,
    const int *columns,
    overact_online_number mass,
    overact_online_number length,
    overact_online_number *memory)
{
    number prior[TEN] = { (number)0.0 };
    number square_root[TEN * TEN] = { (number)0.0 };
    if (are_valid(parameters, columns, mass, length) == 0) {
        return OVERACT_ONLINE_SETTING;
    }
    for (int i = 0; i < parameters; i++) {
        square_root[i * parameters + i] = (number)1.0 / deviation(columns[i], mass, length);
    }
    (void)overact_online_init(filter, parameters, memory);
    return overact_online_set_prior(filter, prior, square_root);
}

overact_online_error overact_online_payload_estimate(
    const overact_online_filter *filter,
    const int *columns,
    overact_online_number mass,
    overact_online_number length,
    overact_online_payload *payload)
{
    number estimate[TEN];
    number raw[TEN] = { (number)0.0 };
    number weights[TEN];
    number pseudo[TEN];
    number lower[TEN];
    overact_online_error error;
    int is_projected;
    if (are_valid(filter->parameters, columns, mass, length) == 0) {
        return OVERACT_ONLINE_SETTING;
    }
    error = overact_online_estimate(filter, estimate);
    if (error != OVERACT_ONLINE_OK) {
        return error;
    }
    for (int i = 0; i < TEN; i++) {
        weights[i] = (number)0.1 / deviation(i, mass, length);
    }
    for (int i = 0; i < filter->parameters; i++) {
        raw[columns[i]] = estimate[i];
        weights[columns[i]] = (number)0.0;
    }
    pseudo_inertia(raw, length, pseudo);
    if ((filter->parameters == TEN) && (cholesky(pseudo, lower) != 0)) {
        return described(raw, 0, payload);
    }
    start(raw, mass, length, pseudo);
    improve(filter, columns, length, weights, pseudo);
    is_projected = (filter->parameters == TEN) ? 1 : 0;
    if (cost(filter, columns, length, pseudo) > ((number)10.0 * GAP)) {
        is_projected = 1;
    }
    inertia(pseudo, length, raw);
    return described(raw, is_projected, payload);
}
