/* Estimation of parameters while the robot moves, in bounded memory and time: C99 of the Rust module
 * `overact::online`, operation by operation.
 *
 * Sources: overact_online.c has the information filter and the change test, overact_online_signals.c the
 * state-variable filter, overact_online_payload.c the payload. They need only `math.h`. Numbers are `double`, or `float`
 * if OVERACT_ONLINE_SINGLE is defined. Memory is provided by the caller. A function that fails leaves its state
 * unchanged. Do not compile with -ffast-math: it removes the checks for numbers that are not finite. */
#ifndef OVERACT_ONLINE_H
#define OVERACT_ONLINE_H

#ifdef __cplusplus
extern "C" {
#endif

#ifdef OVERACT_ONLINE_SINGLE
typedef float overact_online_number;
#else
typedef double overact_online_number;
#endif

/* Largest order of a state-variable filter. */
#define OVERACT_ONLINE_ORDER 8
/* Numbers of memory of a filter with p parameters. */
#define OVERACT_ONLINE_MEMORY(p) ((p) * (p) + 4 * (p))

typedef enum {
    OVERACT_ONLINE_OK = 0,
    /* A number of an input is NaN or infinite. */
    OVERACT_ONLINE_NOT_FINITE,
    /* A number of an input is too large for its standard deviation. */
    OVERACT_ONLINE_OUT_OF_RANGE,
    /* A setting or standard deviation is not in its range. */
    OVERACT_ONLINE_SETTING,
    /* The information of a prior is not positive definite. */
    OVERACT_ONLINE_NOT_POSITIVE_DEFINITE,
    /* The rows so far do not determine all parameters, and there is no prior. */
    OVERACT_ONLINE_NOT_DETERMINED,
    /* A result is too large for a number. */
    OVERACT_ONLINE_OVERFLOW
} overact_online_error;

typedef enum {
    OVERACT_ONLINE_FORGET_NOTHING = 0,
    /* All information is multiplied by the factor, once per row or block. */
    OVERACT_ONLINE_FORGET_EXPONENTIALLY,
    /* Information along each row's direction is multiplied by the factor (Cao and Schwartz 2000). */
    OVERACT_ONLINE_FORGET_DIRECTIONALLY
} overact_online_rule;

/* Square-root information filter: R x = z with an upper triangular R. */
typedef struct {
    int parameters;
    overact_online_number *factor; /* R, p x p, row by row */
    overact_online_number *side;   /* z, p */
    overact_online_number *floors; /* least diagonal of R, p */
    overact_online_number *row;    /* p */
    overact_online_number *work;   /* p */
    overact_online_rule rule;
    overact_online_number forgetting;
    overact_online_number squares; /* sum of squares of the normalised residuals */
    overact_online_number rows;    /* number of rows with their remaining weight */
    int is_regular;
} overact_online_filter;

/* Difference of a measurement from the prediction by all rows before it. */
typedef struct {
    overact_online_number residual;
    overact_online_number standard_deviation;
    overact_online_number normalised;
    int is_determined;
} overact_online_innovation;

/* A filter that knows nothing. `memory` has OVERACT_ONLINE_MEMORY(parameters) numbers, used while the filter is. */
overact_online_error overact_online_init(overact_online_filter *filter, int parameters, overact_online_number *memory);

/* Adds a prior estimate (p) with a square root S of its information (p x p, S^T S). Once,
 * before any row; otherwise OVERACT_ONLINE_SETTING. */
overact_online_error overact_online_set_prior(
    overact_online_filter *filter,
    const overact_online_number *prior,
    const overact_online_number *square_root_information);

/* Sets the rule of forgetting with a factor above 0 and at most 1. */
overact_online_error overact_online_set_forgetting(
    overact_online_filter *filter, overact_online_rule rule, overact_online_number factor);

/* Adds a row (p): row x = y with the standard deviation sigma of y. `innovation` may be null. */
overact_online_error overact_online_update(
    overact_online_filter *filter,
    const overact_online_number *row,
    overact_online_number y,
    overact_online_number sigma,
    overact_online_innovation *innovation);

/* Adds the rows (count x p) of one sample. `innovations` (count) may be null. */
overact_online_error overact_online_update_block(
    overact_online_filter *filter,
    int count,
    const overact_online_number *rows,
    const overact_online_number *y,
    const overact_online_number *sigma,
    overact_online_innovation *innovations);

/* Multiplies all information by a factor above 0 and at most 1. */
overact_online_error overact_online_discount(overact_online_filter *filter, overact_online_number factor);

/* The estimate (p). */
overact_online_error overact_online_estimate(const overact_online_filter *filter, overact_online_number *estimate);

/* The standard deviations (p). */
overact_online_error overact_online_standard_deviations(
    const overact_online_filter *filter, overact_online_number *deviations);

/* The covariance (p x p). */
overact_online_error overact_online_covariance(const overact_online_filter *filter, overact_online_number *covariance);

/* Two-sided CUSUM test of normalised innovations. */
typedef struct {
    overact_online_number reference;
    overact_online_number threshold;
    overact_online_number largest;
    overact_online_number above;
    overact_online_number below;
} overact_online_change_test;

/* A test for a shift of the mean by `shift` standard deviations (0.01 to 100), with a mean of `samples` samples
 * (10 to 1e15) between false alarms. */
overact_online_error overact_online_change_init(
    overact_online_change_test *test, overact_online_number shift, overact_online_number samples);

/* Adds an innovation: 1 if measurements exceed their predictions, -1 if they are below, 0 without change. */
int overact_online_change_update(overact_online_change_test *test, overact_online_number normalised);

/* First-order whitening of innovations. */
typedef struct {
    overact_online_number variance;
    overact_online_number covariance;
    overact_online_number last;
    overact_online_number count;
} overact_online_whitening;

void overact_online_whitening_init(overact_online_whitening *whitening);

/* Whitens a number; 0 for one that is not finite. */
overact_online_number overact_online_whitening_update(
    overact_online_whitening *whitening, overact_online_number number);

/* Butterworth low-pass filter whose states are the signal and its derivatives. */
typedef struct {
    int order;
    overact_online_number transition[OVERACT_ONLINE_ORDER][OVERACT_ONLINE_ORDER];
    overact_online_number from_last[OVERACT_ONLINE_ORDER];
    overact_online_number from_new[OVERACT_ONLINE_ORDER];
    overact_online_number rate;
    overact_online_number delay;
    overact_online_number state[OVERACT_ONLINE_ORDER];
    overact_online_number last;
    int is_started;
} overact_online_state_variable_filter;

/* A filter of order 3 to 8 with a cutoff (Hz, 1e-5 to 0.45 of the sampling frequency) for samples at a frequency
 * (Hz). */
overact_online_error overact_online_signal_init(
    overact_online_state_variable_filter *filter,
    int order,
    overact_online_number cutoff,
    overact_online_number sampling);

/* Filters a sample: the filtered signal, its first and second derivative. */
overact_online_error overact_online_signal_update(
    overact_online_state_variable_filter *filter, overact_online_number sample, overact_online_number signal[3]);

/* A physically consistent payload. */
typedef struct {
    overact_online_number mass;           /* kg */
    overact_online_number centre[3];      /* m */
    overact_online_number inertia[3][3];  /* about the centre of mass, kg m^2 */
    overact_online_number parameters[10]; /* xx xy xz yy yz zz mx my mz m */
    int is_projected;
} overact_online_payload;

/* A filter for the payload's parameters with the prior of no payload. `columns` (p, at most 10) are places among
 * xx xy xz yy yz zz mx my mz m, from 0; `mass` (kg) and `length` (m) are the largest expected. */
overact_online_error overact_online_payload_init(
    overact_online_filter *filter,
    int parameters,
    const int *columns,
    overact_online_number mass,
    overact_online_number length,
    overact_online_number *memory);

/* The physically consistent payload nearest to the filter's estimate; arguments as for `init`. */
overact_online_error overact_online_payload_estimate(
    const overact_online_filter *filter,
    const int *columns,
    overact_online_number mass,
    overact_online_number length,
    overact_online_payload *payload);

#ifdef __cplusplus
}
#endif

#endif
