/* Whether all numbers are finite. */
static int rob_is_finite(const double *values, int count)
{
    int finite = 1;
    for (int i = 0; i < count; i++) {
        if (!isfinite(values[i])) {
            finite = 0;
        }
    }
    return finite;
}
