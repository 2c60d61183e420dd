/* The tensions of a robot without internal torques, if none falls below its minimum. */
static rob_error rob_distribute_tensions(const double system[ROB_ACTUATORS], double *output)
{
    double references[ROB_ACTUATORS];
    double deviations[ROB_ACTUATORS];
    double largest = 0.0;
    for (int i = 0; i < ROB_ACTUATORS; i++) {
        references[i] = (rob_least_tensions[i] > -HUGE_VAL) ? rob_least_tensions[i] : 0.0;
        deviations[i] = system[i] - references[i];
        largest = (fabs(deviations[i]) > largest) ? fabs(deviations[i]) : largest;
        largest = (fabs(references[i]) > largest) ? fabs(references[i]) : largest;
        largest = (fabs(system[i]) > largest) ? fabs(system[i]) : largest;
    }
    const double tolerance = LIMIT_TENSION * largest;
    for (int i = 0; i < ROB_ACTUATORS; i++) {
        if (!isfinite(deviations[i])) {
            return ROB_OVERFLOW;
        }
        if ((rob_least_tensions[i] > -HUGE_VAL) && (deviations[i] < -tolerance)) {
            return ROB_TENSIONS;
        }
        const int is_below = ((rob_least_tensions[i] > -HUGE_VAL) && (deviations[i] < 0.0)) ? 1 : 0;
        deviations[i] = (is_below != 0) ? 0.0 : deviations[i];
    }
    for (int i = 0; i < ROB_ACTUATORS; i++) {
        output[i] = references[i] + deviations[i];
    }
    return ROB_OK;
}
