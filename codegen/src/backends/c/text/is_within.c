/* Whether the magnitudes of all numbers are at most that of one; not where one is no number. */
static int rob_is_within(const double *values, int count, double most)
{
    int within = 1;
    for (int i = 0; i < count; i++) {
        if (!(fabs(values[i]) <= most)) {
            within = 0;
        }
    }
    return within;
}
