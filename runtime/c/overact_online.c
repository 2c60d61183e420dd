/* Square-root information filter, change test and whitening of `overact::online`. */
#include "overact_online.h"

#include <math.h>
#include <stddef.h>

typedef overact_online_number number;

/* Largest weighted number; smallest one that a rotation eliminates; least diagonal of a regular R relative to its
 * column; least one that forgetting leaves, relative to its column, and absolute. */
#ifdef OVERACT_ONLINE_SINGLE
#define LARGEST 1e9f
#define SMALLEST 2e-19f
#define REGULAR 8e-6f
#define REMEMBERED 3.5e-4f
#define FAINTEST 1e-12f
#define ROOT(x) sqrtf(x)
#define MAGNITUDE(x) fabsf(x)
#else
#define LARGEST 1e100
#define SMALLEST 1e-150
#define REGULAR 1.5e-14
#define REMEMBERED 1.5e-8
#define FAINTEST 1e-60
#define ROOT(x) sqrt(x)
#define MAGNITUDE(x) fabs(x)
#endif

static number larger(number a, number b)
{
    return (a > b) ? a : b;
}

/* Whether numbers divided by a standard deviation are finite and in range. */
static overact_online_error check(const number *numbers, int count, number weight)
{
    overact_online_error error = OVERACT_ONLINE_OK;
    for (int i = 0; i < count; i++) {
        if (!isfinite(numbers[i])) {
            return OVERACT_ONLINE_NOT_FINITE;
        }
        if (!(MAGNITUDE(numbers[i] * weight) <= LARGEST)) {
            error = OVERACT_ONLINE_OUT_OF_RANGE;
        }
    }
    return error;
}

/* 1/sigma; 0 if sigma is not positive and finite. */
static number weight_of(number sigma)
{
    const number weight = (number)1.0 / sigma;
    return ((sigma > (number)0.0) && (weight > (number)0.0) && isfinite(weight)) ? weight : (number)0.0;
}

/* A product; zero if its square would not be a normal number. */
static number scaled(number x, number by)
{
    const number product = x * by;
    return (MAGNITUDE(product) < SMALLEST) ? (number)0.0 : product;
}

static int is_factor(number factor)
{
    return ((factor > (number)0.0) && (factor <= (number)1.0)) ? 1 : 0;
}

/* Rotates a row and its right side into R and z, from column `first` on: the remaining right side, and the product of
 * the cosines. */
static number rotate_in(overact_online_filter *filter, number *row, number y, int first, number *cosines)
{
    const int p = filter->parameters;
    *cosines = (number)1.0;
    for (int i = first; i < p; i++) {
        number *const pivots = &filter->factor[i * p];
        const number a = pivots[i];
        const number b = row[i];
        if (!(MAGNITUDE(b) < SMALLEST)) {
            const number root = ROOT(a * a + b * b);
            const number cosine = a / root;
            const number sine = b / root;
            const number z = filter->side[i];
            pivots[i] = root;
            for (int j = i + 1; j < p; j++) {
                const number u = pivots[j];
                const number l = row[j];
                pivots[j] = cosine * u + sine * l;
                row[j] = cosine * l - sine * u;
            }
            filter->side[i] = cosine * z + sine * y;
            y = cosine * y - sine * z;
            *cosines *= cosine;
        }
    }
    return y;
}

/* Rotates rows `upper` and `upper` + 1 of R and z, from column `upper` on. */
static void rotate_rows(overact_online_filter *filter, int upper, number cosine, number sine)
{
    const int p = filter->parameters;
    number *const above = &filter->factor[upper * p];
    number *const below = &filter->factor[(upper + 1) * p];
    const number a = filter->side[upper];
    const number b = filter->side[upper + 1];
    for (int j = upper; j < p; j++) {
        const number u = above[j];
        const number l = below[j];
        above[j] = cosine * u + sine * l;
        below[j] = cosine * l - sine * u;
    }
    filter->side[upper] = cosine * a + sine * b;
    filter->side[upper + 1] = cosine * b - sine * a;
}

static void make_diagonal_nonnegative(overact_online_filter *filter)
{
    const int p = filter->parameters;
    for (int i = 0; i < p; i++) {
        if (filter->factor[i * p + i] < (number)0.0) {
            for (int j = 0; j < p; j++) {
                filter->factor[i * p + j] = -filter->factor[i * p + j];
            }
            filter->side[i] = -filter->side[i];
        }
    }
}

/* Multiplies the information along a row by lambda: rotations turn u = R w into the first unit vector, the first row
 * is scaled, and rotations make R triangular again. */
static void forget_along(overact_online_filter *filter, const number *row, number root_of_lambda)
{
    const int p = filter->parameters;
    number *const direction = filter->work;
    number largest = (number)0.0;
    number longest = (number)0.0;
    for (int j = 0; j < p; j++) {
        largest = larger(largest, MAGNITUDE(row[j]));
    }
    if (largest < SMALLEST) {
        return;
    }
    for (int i = 0; i < p; i++) {
        direction[i] = (number)0.0;
        for (int j = i; j < p; j++) {
            direction[i] += filter->factor[i * p + j] * (row[j] / largest);
        }
    }
    for (int i = 0; i < p; i++) {
        longest = larger(longest, MAGNITUDE(direction[i]));
    }
    if (!((longest >= SMALLEST) && isfinite(longest))) {
        return;
    }
    for (int i = 0; i < p; i++) {
        direction[i] /= longest;
    }
    for (int upper = p - 2; upper >= 0; upper--) {
        const number a = direction[upper];
        const number b = direction[upper + 1];
        if (!(MAGNITUDE(b) < SMALLEST)) {
            const number root = ROOT(a * a + b * b);
            direction[upper] = root;
            filter->factor[(upper + 1) * p + upper] = (number)0.0;
            rotate_rows(filter, upper, a / root, b / root);
        }
    }
    for (int j = 0; j < p; j++) {
        filter->factor[j] = scaled(filter->factor[j], root_of_lambda);
    }
    filter->side[0] = scaled(filter->side[0], root_of_lambda);
    for (int upper = 0; upper < (p - 1); upper++) {
        const number a = filter->factor[upper * p + upper];
        const number b = filter->factor[(upper + 1) * p + upper];
        if (MAGNITUDE(b) >= SMALLEST) {
            const number root = ROOT(a * a + b * b);
            rotate_rows(filter, upper, a / root, b / root);
        }
        filter->factor[(upper + 1) * p + upper] = (number)0.0;
    }
    make_diagonal_nonnegative(filter);
}

/* Length of a column of R. */
static number column_length(const overact_online_filter *filter, int column)
{
    number squares = (number)0.0;
    for (int i = 0; i <= column; i++) {
        const number entry = filter->factor[i * filter->parameters + column];
        squares += entry * entry;
    }
    return ROOT(squares);
}

/* Whether each diagonal entry of R is nonzero within rounding of its column. */
static int is_regular(const overact_online_filter *filter)
{
    int regular = 1;
    for (int i = 0; (i < filter->parameters) && (regular != 0); i++) {
        const number diagonal = filter->factor[i * filter->parameters + i];
        regular = ((diagonal >= SMALLEST) && (diagonal > (REGULAR * column_length(filter, i)))) ? 1 : 0;
    }
    return regular;
}

/* Solves R x = z; 1 if all numbers are finite. */
static int solve(const overact_online_filter *filter, number *solution)
{
    const int p = filter->parameters;
    int finite = 1;
    for (int i = p - 1; i >= 0; i--) {
        number rest = filter->side[i];
        for (int j = i + 1; j < p; j++) {
            rest -= filter->factor[i * p + j] * solution[j];
        }
        solution[i] = rest / filter->factor[i * p + i];
        finite = (isfinite(solution[i]) && (finite != 0)) ? 1 : 0;
    }
    return finite;
}

/* Raises diagonal entries of a regular R that forgetting made too small, without a change of the estimate. */
static void keep_regular(overact_online_filter *filter)
{
    const int p = filter->parameters;
    int has_estimate = 0;
    for (int i = 0; (i < p) && (filter->is_regular != 0); i++) {
        const number entry = filter->factor[i * p + i];
        const number relative = REMEMBERED * column_length(filter, i);
        const number least = larger(larger(relative, filter->floors[i]), FAINTEST);
        if (!(entry >= least)) {
            const number added = ROOT(least * least - entry * entry);
            number cosines;
            number side;
            if (has_estimate == 0) {
                has_estimate = 1;
                (void)solve(filter, filter->work);
            }
            side = added * filter->work[i];
            for (int j = 0; j < p; j++) {
                filter->row[j] = (number)0.0;
            }
            filter->row[i] = added;
            (void)rotate_in(filter, filter->row, isfinite(side) ? side : (number)0.0, i, &cosines);
        }
    }
}

static void weigh_residuals(overact_online_filter *filter, number factor)
{
    filter->squares *= factor;
    filter->rows *= factor;
}

static void discount(overact_online_filter *filter, number factor)
{
    const int p = filter->parameters;
    const number root = ROOT(factor);
    if (!(factor < (number)1.0)) {
        return;
    }
    for (int i = 0; i < (p * p); i++) {
        filter->factor[i] = scaled(filter->factor[i], root);
    }
    for (int i = 0; i < p; i++) {
        filter->side[i] = scaled(filter->side[i], root);
    }
    weigh_residuals(filter, factor);
    keep_regular(filter);
}

overact_online_error overact_online_init(overact_online_filter *filter, int parameters, overact_online_number *memory)
{
    if ((parameters < 1) || (parameters > 10000)) {
        return OVERACT_ONLINE_SETTING;
    }
    filter->parameters = parameters;
    filter->factor = memory;
    filter->side = &memory[parameters * parameters];
    filter->floors = &filter->side[parameters];
    filter->row = &filter->floors[parameters];
    filter->work = &filter->row[parameters];
    for (int i = 0; i < OVERACT_ONLINE_MEMORY(parameters); i++) {
        memory[i] = (number)0.0;
    }
    filter->rule = OVERACT_ONLINE_FORGET_NOTHING;
    filter->forgetting = (number)1.0;
    filter->squares = (number)0.0;
    filter->rows = (number)0.0;
    filter->is_regular = 0;
    return OVERACT_ONLINE_OK;
}

overact_online_error overact_online_set_prior(
    overact_online_filter *filter,
    const overact_online_number *prior,
    const overact_online_number *square_root_information)
{
    const int p = filter->parameters;
    overact_online_error error;
    for (int i = 0; i < (p * p); i++) {
        if (filter->factor[i] != (number)0.0) {
            return OVERACT_ONLINE_SETTING;
        }
    }
    error = check(prior, p, (number)1.0);
    if (error == OVERACT_ONLINE_OK) {
        error = check(square_root_information, p * p, (number)1.0);
    }
    for (int i = 0; (i < p) && (error == OVERACT_ONLINE_OK); i++) {
        number side = (number)0.0;
        number cosines;
        for (int j = 0; j < p; j++) {
            filter->row[j] = square_root_information[i * p + j];
            side += filter->row[j] * prior[j];
        }
        error = check(&side, 1, (number)1.0);
        (void)rotate_in(filter, filter->row, side, 0, &cosines);
    }
    make_diagonal_nonnegative(filter);
    if ((error == OVERACT_ONLINE_OK) && (is_regular(filter) == 0)) {
        error = OVERACT_ONLINE_NOT_POSITIVE_DEFINITE;
    }
    if (error != OVERACT_ONLINE_OK) {
        (void)overact_online_init(filter, p, filter->factor);
        return error;
    }
    for (int i = 0; i < p; i++) {
        filter->floors[i] = filter->factor[i * p + i];
    }
    filter->is_regular = 1;
    return OVERACT_ONLINE_OK;
}

overact_online_error overact_online_set_forgetting(
    overact_online_filter *filter, overact_online_rule rule, overact_online_number factor)
{
    const int is_nothing = (rule == OVERACT_ONLINE_FORGET_NOTHING) ? 1 : 0;
    const int is_known = ((rule == OVERACT_ONLINE_FORGET_EXPONENTIALLY) || (rule == OVERACT_ONLINE_FORGET_DIRECTIONALLY)) ? 1 : 0;
    if ((is_nothing == 0) && ((is_known == 0) || (is_factor(factor) == 0))) {
        return OVERACT_ONLINE_SETTING;
    }
    filter->rule = rule;
    filter->forgetting = factor;
    return OVERACT_ONLINE_OK;
}

static overact_online_error check_row(
    const overact_online_filter *filter, const number *row, number y, number sigma)
{
    const number weight = weight_of(sigma);
    overact_online_error error;
    if (!(weight > (number)0.0)) {
        return OVERACT_ONLINE_SETTING;
    }
    error = check(row, filter->parameters, weight);
    return (error != OVERACT_ONLINE_OK) ? error : check(&y, 1, weight);
}

/* Adds a checked row. */
static void add(
    overact_online_filter *filter, const number *row, number y, number sigma, overact_online_innovation *innovation)
{
    const number weight = weight_of(sigma);
    const overact_online_innovation none = { (number)0.0, (number)0.0, (number)0.0, 0 };
    number cosines;
    number rest;
    if ((filter->rule == OVERACT_ONLINE_FORGET_DIRECTIONALLY) && (filter->forgetting < (number)1.0)) {
        forget_along(filter, row, ROOT(filter->forgetting));
        weigh_residuals(filter, filter->forgetting);
        keep_regular(filter);
    }
    for (int j = 0; j < filter->parameters; j++) {
        filter->row[j] = row[j] * weight;
    }
    rest = rotate_in(filter, filter->row, y * weight, 0, &cosines);
    if (filter->is_regular == 0) {
        filter->is_regular = is_regular(filter);
    }
    filter->squares += rest * rest;
    if (cosines > REGULAR) {
        filter->rows += (number)1.0;
    }
    if (innovation != NULL) {
        *innovation = none;
        if (cosines > REGULAR) {
            innovation->standard_deviation = sigma / cosines;
            innovation->residual = rest * innovation->standard_deviation;
            innovation->normalised = rest;
            innovation->is_determined = 1;
        }
    }
}

overact_online_error overact_online_update_block(
    overact_online_filter *filter,
    int count,
    const overact_online_number *rows,
    const overact_online_number *y,
    const overact_online_number *sigma,
    overact_online_innovation *innovations)
{
    const int p = filter->parameters;
    for (int i = 0; i < count; i++) {
        const overact_online_error error = check_row(filter, &rows[i * p], y[i], sigma[i]);
        if (error != OVERACT_ONLINE_OK) {
            return error;
        }
    }
    if (filter->rule == OVERACT_ONLINE_FORGET_EXPONENTIALLY) {
        discount(filter, filter->forgetting);
    }
    for (int i = 0; i < count; i++) {
        add(filter, &rows[i * p], y[i], sigma[i], (innovations != NULL) ? &innovations[i] : NULL);
    }
    return OVERACT_ONLINE_OK;
}

overact_online_error overact_online_update(
    overact_online_filter *filter,
    const overact_online_number *row,
    overact_online_number y,
    overact_online_number sigma,
    overact_online_innovation *innovation)
{
    return overact_online_update_block(filter, 1, row, &y, &sigma, innovation);
}

overact_online_error overact_online_discount(overact_online_filter *filter, overact_online_number factor)
{
    if (is_factor(factor) == 0) {
        return OVERACT_ONLINE_SETTING;
    }
    discount(filter, factor);
    return OVERACT_ONLINE_OK;
}

overact_online_error overact_online_estimate(const overact_online_filter *filter, overact_online_number *estimate)
{
    if (filter->is_regular == 0) {
        return OVERACT_ONLINE_NOT_DETERMINED;
    }
    return (solve(filter, estimate) != 0) ? OVERACT_ONLINE_OK : OVERACT_ONLINE_OVERFLOW;
}

/* Row `place` of the inverse of R. */
static void inverse_row(const overact_online_filter *filter, int place, number *inverse)
{
    const int p = filter->parameters;
    for (int j = 0; j < p; j++) {
        inverse[j] = (j == place) ? (number)-1.0 : (number)0.0;
    }
    for (int i = place; i < p; i++) {
        const int is_zero = (MAGNITUDE(inverse[i]) > (number)0.0) ? 0 : 1;
        const number own = (is_zero != 0) ? (number)0.0 : (-inverse[i] / filter->factor[i * p + i]);
        inverse[i] = own;
        for (int j = i + 1; j < p; j++) {
            inverse[j] += own * filter->factor[i * p + j];
        }
    }
}

overact_online_error overact_online_standard_deviations(
    const overact_online_filter *filter, overact_online_number *deviations)
{
    const int p = filter->parameters;
    int finite = 1;
    if (filter->is_regular == 0) {
        return OVERACT_ONLINE_NOT_DETERMINED;
    }
    for (int i = 0; i < p; i++) {
        number squares = (number)0.0;
        inverse_row(filter, i, filter->work);
        for (int j = i; j < p; j++) {
            squares += filter->work[j] * filter->work[j];
        }
        deviations[i] = ROOT(squares);
        finite = (isfinite(deviations[i]) && (finite != 0)) ? 1 : 0;
    }
    return (finite != 0) ? OVERACT_ONLINE_OK : OVERACT_ONLINE_OVERFLOW;
}

overact_online_error overact_online_covariance(const overact_online_filter *filter, overact_online_number *covariance)
{
    const int p = filter->parameters;
    int finite = 1;
    if (filter->is_regular == 0) {
        return OVERACT_ONLINE_NOT_DETERMINED;
    }
    for (int i = 0; i < p; i++) {
        inverse_row(filter, i, &covariance[i * p]);
    }
    /* Row i of the product needs rows i and later of the inverse only. */
    for (int i = 0; i < p; i++) {
        for (int j = i; j < p; j++) {
            number sum = (number)0.0;
            for (int k = j; k < p; k++) {
                sum += covariance[i * p + k] * covariance[j * p + k];
            }
            filter->work[j] = sum;
            finite = (isfinite(sum) && (finite != 0)) ? 1 : 0;
        }
        for (int j = i; j < p; j++) {
            covariance[i * p + j] = filter->work[j];
        }
    }
    for (int i = 0; i < p; i++) {
        for (int j = 0; j < i; j++) {
            covariance[i * p + j] = covariance[j * p + i];
        }
    }
    return (finite != 0) ? OVERACT_ONLINE_OK : OVERACT_ONLINE_OVERFLOW;
}

overact_online_error overact_online_change_init(
    overact_online_change_test *test, overact_online_number shift, overact_online_number samples)
{
    const double reference = 0.5 * (double)shift;
    const double target = 4.0 * reference * reference * (double)samples;
    double x = 1.0;
    double threshold;
    if (!((shift >= (number)0.01) && (shift <= (number)100.0) && (samples >= (number)10.0)
            && (samples <= (number)1e15))) {
        return OVERACT_ONLINE_SETTING;
    }
    while ((exp(x) - x - 1.0) < target) {
        x *= 2.0;
    }
    for (int i = 0; i < 60; i++) {
        const double exponential = exp(x);
        x -= (exponential - x - 1.0 - target) / (exponential - 1.0);
    }
    threshold = x / (2.0 * reference) - 1.166;
    threshold = (threshold > 0.0) ? threshold : 0.0;
    test->reference = (number)reference;
    test->threshold = (number)threshold;
    test->largest = (number)(((threshold / 3.0) > 4.0) ? (threshold / 3.0) : 4.0);
    test->above = (number)0.0;
    test->below = (number)0.0;
    return OVERACT_ONLINE_OK;
}

/* A number limited to +-most. */
static number bounded(number x, number most)
{
    const number above = (x > -most) ? x : -most;
    return (above < most) ? above : most;
}

int overact_online_change_update(overact_online_change_test *test, overact_online_number normalised)
{
    int change = 0;
    number e;
    if (!isfinite(normalised)) {
        return 0;
    }
    e = bounded(normalised, test->largest);
    test->above = larger(test->above + e - test->reference, (number)0.0);
    test->below = larger(test->below - e - test->reference, (number)0.0);
    if (test->above > test->threshold) {
        change = 1;
    } else if (test->below > test->threshold) {
        change = -1;
    } else {
        change = 0;
    }
    if (change != 0) {
        test->above = (number)0.0;
        test->below = (number)0.0;
    }
    return change;
}

void overact_online_whitening_init(overact_online_whitening *whitening)
{
    whitening->variance = (number)1.0;
    whitening->covariance = (number)0.0;
    whitening->last = (number)0.0;
    whitening->count = (number)20.0;
}

overact_online_number overact_online_whitening_update(
    overact_online_whitening *whitening, overact_online_number x)
{
    number correlation;
    number variance;
    number white;
    number limited;
    number gain;
    if (!isfinite(x)) {
        return (number)0.0;
    }
    correlation = bounded(whitening->covariance / whitening->variance, (number)0.999);
    variance = whitening->variance * ((number)1.0 - correlation * correlation);
    white = (x - correlation * whitening->last) / ROOT(variance);
    limited = bounded(x, (number)6.0 * ROOT(whitening->variance));
    gain = (number)1.0 / whitening->count;
    whitening->variance += gain * (limited * limited - whitening->variance);
    whitening->variance = larger(whitening->variance, (number)1e-6);
    whitening->covariance += gain * (limited * whitening->last - whitening->covariance);
    whitening->last = limited;
    whitening->count = whitening->count + (number)1.0;
    whitening->count = (whitening->count < (number)1000.0) ? whitening->count : (number)1000.0;
    return white;
}
