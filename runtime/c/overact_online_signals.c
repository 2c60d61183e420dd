/* State-variable filter of `overact::online`. */
#include "overact_online.h"

#include <math.h>

typedef overact_online_number number;

#define N OVERACT_ONLINE_ORDER
#define DOUBLINGS 8
#define TERMS 12

static const double pi = 3.14159265358979323846;

/* c = a b */
static void multiply(int order, double a[N][N], double b[N][N], double c[N][N])
{
    for (int i = 0; i < order; i++) {
        for (int j = 0; j < order; j++) {
            c[i][j] = 0.0;
        }
        for (int k = 0; k < order; k++) {
            for (int j = 0; j < order; j++) {
                c[i][j] += a[i][k] * b[k][j];
            }
        }
    }
}

/* a = b + value times the unit matrix */
static void add_unit(int order, double a[N][N], double b[N][N], double value)
{
    for (int i = 0; i < order; i++) {
        for (int j = 0; j < order; j++) {
            a[i][j] = b[i][j] + ((i == j) ? value : 0.0);
        }
    }
}

/* exp(Z), phi1(Z) and phi2(Z) by scaling and doubling. */
static void exponentials(
    int order, double system[N][N], double exponential[N][N], double first[N][N], double second[N][N])
{
    double scaled[N][N];
    double product[N][N];
    double factorial = 1.0;
    for (int i = 0; i < order; i++) {
        for (int j = 0; j < order; j++) {
            scaled[i][j] = system[i][j] / (double)(1 << DOUBLINGS);
            second[i][j] = 0.0;
        }
    }
    for (int k = 1; k <= (TERMS + 2); k++) {
        factorial *= (double)k;
    }
    for (int term = TERMS; term >= 0; term--) {
        multiply(order, scaled, second, product);
        add_unit(order, second, product, 1.0 / factorial);
        factorial /= (double)(term + 2);
    }
    multiply(order, scaled, second, product);
    add_unit(order, first, product, 1.0);
    multiply(order, scaled, first, product);
    add_unit(order, exponential, product, 1.0);
    for (int doubling = 0; doubling < DOUBLINGS; doubling++) {
        double sum[N][N];
        multiply(order, first, first, product);
        for (int i = 0; i < order; i++) {
            for (int j = 0; j < order; j++) {
                const double once = product[i][j] + second[i][j];
                second[i][j] = 0.25 * (once + second[i][j]);
            }
        }
        add_unit(order, sum, exponential, 1.0);
        multiply(order, sum, first, product);
        for (int i = 0; i < order; i++) {
            for (int j = 0; j < order; j++) {
                first[i][j] = 0.5 * product[i][j];
            }
        }
        multiply(order, exponential, exponential, product);
        add_unit(order, exponential, product, 0.0);
    }
}

overact_online_error overact_online_signal_init(
    overact_online_state_variable_filter *filter,
    int order,
    overact_online_number cutoff,
    overact_online_number sampling)
{
    const double ratio = (double)cutoff / (double)sampling;
    const double rate = 2.0 * pi * (double)cutoff;
    const double step = 2.0 * pi * ratio;
    double coefficients[N] = { 1.0 };
    double system[N][N] = { { 0.0 } };
    double exponential[N][N];
    double first[N][N];
    double second[N][N];
    if ((order < 3) || (order > N)) {
        return OVERACT_ONLINE_SETTING;
    }
    if (!((sampling > (number)0.0) && isfinite(sampling) && (ratio >= 1e-5) && (ratio <= 0.45))) {
        return OVERACT_ONLINE_SETTING;
    }
    for (int k = 1; k < order; k++) {
        const double angle = 0.5 * pi / (double)order;
        coefficients[k] = coefficients[k - 1] * (cos((double)(k - 1) * angle) / sin((double)k * angle));
    }
    for (int i = 0; i < order; i++) {
        for (int j = 0; j < order; j++) {
            if ((i + 1) == order) {
                system[i][j] = -step * coefficients[j];
            } else {
                system[i][j] = (j == (i + 1)) ? step : 0.0;
            }
        }
    }
    exponentials(order, system, exponential, first, second);
    filter->order = order;
    for (int i = 0; i < order; i++) {
        const double steady = first[i][order - 1] * step;
        const double ramp = second[i][order - 1] * step;
        for (int j = 0; j < order; j++) {
            filter->transition[i][j] = (number)exponential[i][j];
        }
        filter->from_last[i] = (number)(steady - ramp);
        filter->from_new[i] = (number)ramp;
        filter->state[i] = (number)0.0;
    }
    filter->rate = (number)rate;
    filter->delay = (number)(coefficients[1] / rate);
    filter->last = (number)0.0;
    filter->is_started = 0;
    return OVERACT_ONLINE_OK;
}

overact_online_error overact_online_signal_update(
    overact_online_state_variable_filter *filter, overact_online_number sample, overact_online_number signal[3])
{
    number state[N] = { (number)0.0 };
    number found[3];
    int finite = 1;
    if (!isfinite(sample)) {
        return OVERACT_ONLINE_NOT_FINITE;
    }
    if (filter->is_started == 0) {
        for (int i = 0; i < filter->order; i++) {
            filter->state[i] = (number)0.0;
        }
        filter->state[0] = sample;
        filter->last = sample;
        filter->is_started = 1;
        signal[0] = sample;
        signal[1] = (number)0.0;
        signal[2] = (number)0.0;
        return OVERACT_ONLINE_OK;
    }
    for (int i = 0; i < filter->order; i++) {
        number own = (number)0.0;
        for (int j = 0; j < filter->order; j++) {
            own += filter->transition[i][j] * filter->state[j];
        }
        state[i] = own + filter->from_last[i] * filter->last + filter->from_new[i] * sample;
        finite = (isfinite(state[i]) && (finite != 0)) ? 1 : 0;
    }
    found[0] = state[0];
    found[1] = state[1] * filter->rate;
    found[2] = state[2] * filter->rate * filter->rate;
    if ((finite == 0) || !isfinite(found[1]) || !isfinite(found[2])) {
        return OVERACT_ONLINE_OVERFLOW;
    }
    for (int i = 0; i < filter->order; i++) {
        filter->state[i] = state[i];
    }
    filter->last = sample;
    for (int i = 0; i < 3; i++) {
        signal[i] = found[i];
    }
    return OVERACT_ONLINE_OK;
}
