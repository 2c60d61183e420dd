/* The deviation d + N z of an actuator from its minimum. */
static double rob_tension_deviation(
    const double *basis, const double deviations[ROB_ACTUATORS], const double internal[ROB_REDUNDANCY], int at)
{
    double sum = deviations[at];
    for (int k = 0; k < ROB_REDUNDANCY; k++) {
        sum += basis[(at * ROB_REDUNDANCY) + k] * internal[k];
    }
    return sum;
}

/* The internal torque nearest to zero in the intersection of the half lines of all cables. */
static int rob_tension_dual(
    const double *basis, const double deviations[ROB_ACTUATORS], double tolerance, double internal[ROB_REDUNDANCY])
{
    double lower = -HUGE_VAL;
    double upper = HUGE_VAL;
    for (int i = 0; i < ROB_ACTUATORS; i++) {
        if ((rob_least_tensions[i] > -HUGE_VAL) && (basis[i] > LIMIT_TENSION)) {
            const double bound = -deviations[i] / basis[i];
            lower = (bound > lower) ? bound : lower;
        }
        if ((rob_least_tensions[i] > -HUGE_VAL) && (basis[i] < -LIMIT_TENSION)) {
            const double bound = -deviations[i] / basis[i];
            upper = (bound < upper) ? bound : upper;
        }
    }
    (void)tolerance;
    internal[0] = (lower > 0.0) ? lower : ((upper < 0.0) ? upper : 0.0);
    return 1;
}
