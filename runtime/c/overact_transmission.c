/* Transmissions between motors and joints, as `overact::transmission`. */
#include "overact_transmission.h"

#include <math.h>

typedef overact_transmission_number number;
typedef overact_transmission_error error_code;
typedef overact_transmission_interval interval;

/* Smallest scale of a column relative to the longest; largest condition number; least pivot of the gains. */
#ifdef OVERACT_TRANSMISSION_SINGLE
#define SMALLEST_SCALE 1e-5f
#define LARGEST_CONDITION 1e5f
#define LEAST_PIVOT 1e-5f
#define ROOT(x) sqrtf(x)
#define MAGNITUDE(x) fabsf(x)
#else
#define SMALLEST_SCALE 1e-5
#define LARGEST_CONDITION 1e9
#define LEAST_PIVOT 1e-9
#define ROOT(x) sqrt(x)
#define MAGNITUDE(x) fabs(x)
#endif

#define ZERO ((number)0.0)
#define ONE ((number)1.0)

static int is_finite(const number *x, int count)
{
    for (int i = 0; i < count; i++) {
        if (!isfinite(x[i])) {
            return 0;
        }
    }
    return 1;
}

/* The error of a result. */
static error_code checked(const number *x, int count)
{
    return is_finite(x, count) ? OVERACT_TRANSMISSION_OK : OVERACT_TRANSMISSION_OVERFLOW;
}

static number dot(const number *a, const number *b, int count)
{
    number sum = ZERO;
    for (int i = 0; i < count; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* y = A x, with A rows x columns */
static void times(const number *a, int rows, int columns, const number *x, number *y)
{
    for (int i = 0; i < rows; i++) {
        y[i] = dot(&a[i * columns], x, columns);
    }
}

/* y = A^T x */
static void transposed_times(const number *a, int rows, int columns, const number *x, number *y)
{
    for (int j = 0; j < columns; j++) {
        y[j] = ZERO;
    }
    for (int i = 0; i < rows; i++) {
        for (int j = 0; j < columns; j++) {
            y[j] += a[i * columns + j] * x[i];
        }
    }
}

/* B = A^T diag(d) A */
static void congruence(const number *a, int rows, int columns, const number *d, number *b)
{
    for (int i = 0; i < (columns * columns); i++) {
        b[i] = ZERO;
    }
    for (int k = 0; k < rows; k++) {
        for (int i = 0; i < columns; i++) {
            const number scaled = a[k * columns + i] * d[k];
            for (int j = 0; j < columns; j++) {
                b[i * columns + j] += scaled * a[k * columns + j];
            }
        }
    }
}

/* B = A^T S A; `product` has rows x columns numbers. */
static void transformed(const number *a, int rows, int columns, const number *s, number *product, number *b)
{
    for (int k = 0; k < rows; k++) {
        transposed_times(a, rows, columns, &s[k * rows], &product[k * columns]);
    }
    for (int i = 0; i < (columns * columns); i++) {
        b[i] = ZERO;
    }
    for (int k = 0; k < rows; k++) {
        for (int i = 0; i < columns; i++) {
            for (int j = 0; j < columns; j++) {
                b[i * columns + j] += a[k * columns + i] * product[k * columns + j];
            }
        }
    }
}

static error_code set_scales(overact_transmission *t)
{
    const int n = t->motors;
    const int r = t->joints;
    number longest = ZERO;
    for (int i = 0; i < r; i++) {
        number squares = ZERO;
        for (int a = 0; a < n; a++) {
            squares += t->jacobian[a * r + i] * t->jacobian[a * r + i];
        }
        t->scales[i] = ROOT(squares);
        longest = (t->scales[i] > longest) ? t->scales[i] : longest;
    }
    for (int i = 0; i < r; i++) {
        const number least = longest * SMALLEST_SCALE;
        t->scales[i] = (t->scales[i] > least) ? t->scales[i] : least;
        if (t->scales[i] <= ZERO) {
            return OVERACT_TRANSMISSION_SINGULAR;
        }
        if (!isfinite(t->scales[i])) {
            return OVERACT_TRANSMISSION_OVERFLOW;
        }
    }
    return OVERACT_TRANSMISSION_OK;
}

/* Makes the columns of the scaled Jacobian, which are the rows of `inverse`, orthonormal. */
static error_code orthonormalise(overact_transmission *t)
{
    const int n = t->motors;
    const int r = t->joints;
    for (int i = 0; i < (r * r); i++) {
        t->upper[i] = ZERO;
    }
    for (int k = 0; k < r; k++) {
        number *const own = &t->inverse[k * n];
        number length;
        for (int pass = 0; pass < 2; pass++) {
            for (int i = 0; i < k; i++) {
                const number *const direction = &t->inverse[i * n];
                const number along = dot(direction, own, n);
                t->upper[i * r + k] += along;
                for (int a = 0; a < n; a++) {
                    own[a] -= along * direction[a];
                }
            }
        }
        length = ROOT(dot(own, own, n));
        if (length <= ZERO) {
            return OVERACT_TRANSMISSION_SINGULAR;
        }
        t->upper[k * r + k] = length;
        for (int a = 0; a < n; a++) {
            own[a] /= length;
        }
    }
    return OVERACT_TRANSMISSION_OK;
}

error_code overact_transmission_init(
    overact_transmission *t, int motors, int joints, const number *jacobian, number *memory)
{
    const int n = motors;
    const int r = joints;
    number norm;
    error_code error;
    if ((n < 1) || (r < 1)) {
        return OVERACT_TRANSMISSION_SETTING;
    }
    t->motors = n;
    t->joints = r;
    t->jacobian = memory;
    t->inverse = &memory[n * r];
    t->upper = &memory[2 * n * r];
    t->scales = &memory[2 * n * r + r * r];
    t->condition = ZERO;
    if (!is_finite(jacobian, n * r)) {
        return OVERACT_TRANSMISSION_NOT_FINITE;
    }
    for (int i = 0; i < (n * r); i++) {
        t->jacobian[i] = jacobian[i];
    }
    error = set_scales(t);
    if ((n < r) || (error == OVERACT_TRANSMISSION_SINGULAR)) {
        return OVERACT_TRANSMISSION_SINGULAR;
    }
    if (error != OVERACT_TRANSMISSION_OK) {
        return error;
    }
    for (int i = 0; i < r; i++) {
        for (int a = 0; a < n; a++) {
            t->inverse[i * n + a] = jacobian[a * r + i] / t->scales[i];
        }
    }
    norm = ROOT(dot(t->inverse, t->inverse, n * r));
    error = orthonormalise(t);
    if (error != OVERACT_TRANSMISSION_OK) {
        return error;
    }
    for (int i = r - 1; i >= 0; i--) {
        number *const own = &t->inverse[i * n];
        for (int k = i + 1; k < r; k++) {
            for (int a = 0; a < n; a++) {
                own[a] -= t->upper[i * r + k] * t->inverse[k * n + a];
            }
        }
        for (int a = 0; a < n; a++) {
            own[a] /= t->upper[i * r + i];
        }
    }
    t->condition = norm * ROOT(dot(t->inverse, t->inverse, n * r)) / (number)r;
    if (!(t->condition < LARGEST_CONDITION)) {
        return OVERACT_TRANSMISSION_SINGULAR;
    }
    for (int i = 0; i < r; i++) {
        for (int a = 0; a < n; a++) {
            t->inverse[i * n + a] /= t->scales[i];
        }
    }
    return checked(t->inverse, n * r);
}

error_code overact_transmission_in_mode_of(
    const overact_transmission *t, const overact_transmission *home, number *work)
{
    const int r = t->joints;
    int is_positive = 1;
    for (int i = 0; i < r; i++) {
        transposed_times(t->jacobian, t->motors, r, &home->inverse[i * t->motors], &work[i * r]);
    }
    for (int k = 0; k < r; k++) {
        int pivot = k;
        for (int row = k + 1; row < r; row++) {
            if (MAGNITUDE(work[row * r + k]) > MAGNITUDE(work[pivot * r + k])) {
                pivot = row;
            }
        }
        if (pivot != k) {
            for (int j = 0; j < r; j++) {
                const number held = work[k * r + j];
                work[k * r + j] = work[pivot * r + j];
                work[pivot * r + j] = held;
            }
            is_positive = 1 - is_positive;
        }
        if (work[k * r + k] < ZERO) {
            is_positive = 1 - is_positive;
        } else if (!(work[k * r + k] > ZERO)) {
            return OVERACT_TRANSMISSION_ANOTHER_MODE;
        }
        for (int row = k + 1; row < r; row++) {
            const number factor = work[row * r + k] / work[k * r + k];
            for (int j = k + 1; j < r; j++) {
                work[row * r + j] -= factor * work[k * r + j];
            }
        }
    }
    return (is_positive != 0) ? OVERACT_TRANSMISSION_OK : OVERACT_TRANSMISSION_ANOTHER_MODE;
}

error_code overact_transmission_motor_velocities(const overact_transmission *t, const number *x, number *y)
{
    if (!is_finite(x, t->joints)) {
        return OVERACT_TRANSMISSION_NOT_FINITE;
    }
    times(t->jacobian, t->motors, t->joints, x, y);
    return checked(y, t->motors);
}

error_code overact_transmission_joint_velocities(const overact_transmission *t, const number *x, number *y)
{
    if (!is_finite(x, t->motors)) {
        return OVERACT_TRANSMISSION_NOT_FINITE;
    }
    times(t->inverse, t->joints, t->motors, x, y);
    return checked(y, t->joints);
}

error_code overact_transmission_motor_accelerations(
    const overact_transmission *t, const number *x, const number *bias, number *y)
{
    if (!is_finite(x, t->joints) || !is_finite(bias, t->motors)) {
        return OVERACT_TRANSMISSION_NOT_FINITE;
    }
    times(t->jacobian, t->motors, t->joints, x, y);
    for (int a = 0; a < t->motors; a++) {
        y[a] += bias[a];
    }
    return checked(y, t->motors);
}

error_code overact_transmission_joint_accelerations(
    const overact_transmission *t, const number *x, const number *bias, number *work, number *y)
{
    if (!is_finite(x, t->motors) || !is_finite(bias, t->motors)) {
        return OVERACT_TRANSMISSION_NOT_FINITE;
    }
    for (int a = 0; a < t->motors; a++) {
        work[a] = x[a] - bias[a];
    }
    times(t->inverse, t->joints, t->motors, work, y);
    return checked(y, t->joints);
}

error_code overact_transmission_joint_torques(const overact_transmission *t, const number *x, number *y)
{
    if (!is_finite(x, t->motors)) {
        return OVERACT_TRANSMISSION_NOT_FINITE;
    }
    transposed_times(t->jacobian, t->motors, t->joints, x, y);
    return checked(y, t->joints);
}

error_code overact_transmission_motor_torques(const overact_transmission *t, const number *x, number *y)
{
    if (!is_finite(x, t->joints)) {
        return OVERACT_TRANSMISSION_NOT_FINITE;
    }
    transposed_times(t->inverse, t->joints, t->motors, x, y);
    return checked(y, t->motors);
}

error_code overact_transmission_reflected_inertia(const overact_transmission *t, const number *x, number *y)
{
    return overact_transmission_joint_gains(t, x, y);
}

error_code overact_transmission_joint_gains(const overact_transmission *t, const number *x, number *y)
{
    if (!is_finite(x, t->motors)) {
        return OVERACT_TRANSMISSION_NOT_FINITE;
    }
    congruence(t->jacobian, t->motors, t->joints, x, y);
    return checked(y, t->joints * t->joints);
}

/* Adds `sign` times the sum of torques times curvatures. */
static error_code add(
    const overact_transmission *t, const number *torques, const number *curvature, number sign, number *gains)
{
    const int size = t->joints * t->joints;
    if (!is_finite(torques, t->motors) || !is_finite(curvature, t->motors * size)) {
        return OVERACT_TRANSMISSION_NOT_FINITE;
    }
    for (int a = 0; a < t->motors; a++) {
        const number factor = sign * torques[a];
        for (int i = 0; i < size; i++) {
            gains[i] += factor * curvature[a * size + i];
        }
    }
    return OVERACT_TRANSMISSION_OK;
}

error_code overact_transmission_joint_stiffness(
    const overact_transmission *t, const number *gains, const number *torques, const number *curvature, number *y)
{
    error_code error = overact_transmission_joint_gains(t, gains, y);
    if (error == OVERACT_TRANSMISSION_OK) {
        error = add(t, torques, curvature, -ONE, y);
    }
    return (error == OVERACT_TRANSMISSION_OK) ? checked(y, t->joints * t->joints) : error;
}

error_code overact_transmission_motor_gains(const overact_transmission *t, const number *x, number *work, number *y)
{
    if (!is_finite(x, t->joints * t->joints)) {
        return OVERACT_TRANSMISSION_NOT_FINITE;
    }
    transformed(t->inverse, t->joints, t->motors, x, work, y);
    return checked(y, t->motors * t->motors);
}

error_code overact_transmission_motor_stiffness(
    const overact_transmission *t,
    const number *stiffness,
    const number *torques,
    const number *curvature,
    number *work,
    number *y)
{
    const int size = t->joints * t->joints;
    error_code error;
    if (!is_finite(stiffness, size)) {
        return OVERACT_TRANSMISSION_NOT_FINITE;
    }
    for (int i = 0; i < size; i++) {
        work[i] = stiffness[i];
    }
    error = add(t, torques, curvature, ONE, work);
    if (error != OVERACT_TRANSMISSION_OK) {
        return error;
    }
    transformed(t->inverse, t->joints, t->motors, work, &work[size], y);
    return checked(y, t->motors * t->motors);
}

/* Solves S x = b of a positive semidefinite S (n x n) with a diagonal of ones, in place; 0 if S is singular. */
static int solve_definite(int n, number *s, number *b)
{
    for (int k = 0; k < n; k++) {
        number *const own = &s[k * n];
        number pivot;
        for (int j = 0; j < k; j++) {
            own[j] = (own[j] - dot(own, &s[j * n], j)) / s[j * n + j];
        }
        pivot = own[k] - dot(own, own, k);
        if (!(pivot > LEAST_PIVOT)) {
            return 0;
        }
        own[k] = ROOT(pivot);
        b[k] = (b[k] - dot(own, b, k)) / own[k];
    }
    for (int k = n - 1; k >= 0; k--) {
        number rest = b[k];
        for (int row = k + 1; row < n; row++) {
            rest -= s[row * n + k] * b[row];
        }
        b[k] = rest / s[k * n + k];
    }
    return 1;
}

error_code overact_transmission_diagonal_motor_gains(
    const overact_transmission *t, const number *gains, number *work, number *y)
{
    const int n = t->motors;
    const int r = t->joints;
    number *const scaled = work;               /* n x r */
    number *const wanted = &work[n * r];       /* r x r */
    number *const products = &wanted[r * r];   /* n x n */
    number *const squares = &products[n * n];  /* n */
    if (!is_finite(gains, r * r)) {
        return OVERACT_TRANSMISSION_NOT_FINITE;
    }
    for (int a = 0; a < n; a++) {
        for (int i = 0; i < r; i++) {
            scaled[a * r + i] = t->jacobian[a * r + i] / t->scales[i];
        }
        squares[a] = dot(&scaled[a * r], &scaled[a * r], r);
        if (squares[a] <= ZERO) {
            return OVERACT_TRANSMISSION_AMBIGUOUS;
        }
    }
    for (int i = 0; i < r; i++) {
        for (int j = 0; j < r; j++) {
            wanted[i * r + j] = gains[i * r + j] / (t->scales[i] * t->scales[j]);
        }
    }
    for (int a = 0; a < n; a++) {
        const number *const own = &scaled[a * r];
        number sum = ZERO;
        for (int b = 0; b < n; b++) {
            const number product = dot(own, &scaled[b * r], r);
            products[a * n + b] = product * product / (squares[a] * squares[b]);
        }
        for (int i = 0; i < r; i++) {
            sum += own[i] * dot(&wanted[i * r], own, r);
        }
        y[a] = sum / squares[a];
    }
    if (solve_definite(n, products, y) == 0) {
        return OVERACT_TRANSMISSION_AMBIGUOUS;
    }
    for (int a = 0; a < n; a++) {
        y[a] = y[a] / squares[a];
    }
    return checked(y, n);
}

/* Narrows an interval to the factors by which a number is within a limit. */
static void narrow(interval *all, number x, interval limit)
{
    number least;
    number most;
    if (x > ZERO) {
        least = limit.least / x;
        most = limit.most / x;
    } else if (x < ZERO) {
        least = limit.most / x;
        most = limit.least / x;
    } else {
        return;
    }
    all->least = (least > all->least) ? least : all->least;
    all->most = (most < all->most) ? most : all->most;
}

static error_code check_limits(const interval *limits, int count)
{
    for (int i = 0; i < count; i++) {
        if (!((limits[i].least <= ZERO) && (limits[i].most >= ZERO))) {
            return OVERACT_TRANSMISSION_SETTING;
        }
    }
    return OVERACT_TRANSMISSION_OK;
}

static error_code check_direction(const number *direction, int count)
{
    if (!is_finite(direction, count)) {
        return OVERACT_TRANSMISSION_NOT_FINITE;
    }
    for (int i = 0; i < count; i++) {
        if (MAGNITUDE(direction[i]) > ZERO) {
            return OVERACT_TRANSMISSION_OK;
        }
    }
    return OVERACT_TRANSMISSION_SETTING;
}

static const interval everything = { -(number)HUGE_VAL, (number)HUGE_VAL };

error_code overact_transmission_speed_intervals(const overact_transmission *t, const interval *limits, interval *joints)
{
    if (check_limits(limits, t->motors) != OVERACT_TRANSMISSION_OK) {
        return OVERACT_TRANSMISSION_SETTING;
    }
    for (int i = 0; i < t->joints; i++) {
        joints[i] = everything;
        for (int a = 0; a < t->motors; a++) {
            narrow(&joints[i], t->jacobian[a * t->joints + i], limits[a]);
        }
    }
    return OVERACT_TRANSMISSION_OK;
}

error_code overact_transmission_torque_intervals(
    const overact_transmission *t, const interval *limits, interval *joints)
{
    if (check_limits(limits, t->motors) != OVERACT_TRANSMISSION_OK) {
        return OVERACT_TRANSMISSION_SETTING;
    }
    for (int i = 0; i < t->joints; i++) {
        joints[i] = everything;
        for (int a = 0; a < t->motors; a++) {
            narrow(&joints[i], t->inverse[i * t->motors + a], limits[a]);
        }
    }
    return OVERACT_TRANSMISSION_OK;
}

error_code overact_transmission_speed_factor(
    const overact_transmission *t, const number *direction, const interval *limits, number *factor)
{
    interval all = everything;
    error_code error = check_limits(limits, t->motors);
    if (error == OVERACT_TRANSMISSION_OK) {
        error = check_direction(direction, t->joints);
    }
    if (error != OVERACT_TRANSMISSION_OK) {
        return error;
    }
    for (int a = 0; a < t->motors; a++) {
        narrow(&all, dot(&t->jacobian[a * t->joints], direction, t->joints), limits[a]);
    }
    *factor = all.most;
    return OVERACT_TRANSMISSION_OK;
}

error_code overact_transmission_torque_factor(
    const overact_transmission *t, const number *direction, const interval *limits, number *factor)
{
    interval all = everything;
    error_code error = check_limits(limits, t->motors);
    if (error == OVERACT_TRANSMISSION_OK) {
        error = check_direction(direction, t->joints);
    }
    if (error != OVERACT_TRANSMISSION_OK) {
        return error;
    }
    for (int a = 0; a < t->motors; a++) {
        number torque = ZERO;
        for (int i = 0; i < t->joints; i++) {
            torque += t->inverse[i * t->motors + a] * direction[i];
        }
        narrow(&all, torque, limits[a]);
    }
    *factor = all.most;
    return OVERACT_TRANSMISSION_OK;
}

int overact_transmission_curvature(
    int motors, int joints, overact_transmission_bias bias, void *context, number *work, number *curvature)
{
    const int size = joints * joints;
    number *const twist = work;
    number *const found = &work[joints];
    for (int i = 0; i < joints; i++) {
        int error;
        for (int k = 0; k < joints; k++) {
            twist[k] = (k == i) ? ONE : ZERO;
        }
        error = bias(context, twist, found);
        if (error != 0) {
            return error;
        }
        for (int a = 0; a < motors; a++) {
            curvature[a * size + i * joints + i] = found[a];
        }
    }
    for (int i = 0; i < joints; i++) {
        for (int j = 0; j < i; j++) {
            int error;
            for (int k = 0; k < joints; k++) {
                twist[k] = ((k == i) || (k == j)) ? ONE : ZERO;
            }
            error = bias(context, twist, found);
            if (error != 0) {
                return error;
            }
            for (int a = 0; a < motors; a++) {
                number *const second = &curvature[a * size];
                const number mixed =
                    (number)0.5 * (found[a] - second[i * joints + i] - second[j * joints + j]);
                second[i * joints + j] = mixed;
                second[j * joints + i] = mixed;
            }
        }
    }
    return 0;
}
