/* Torques p + N z nearest to the minimum tensions, which they do not fall below. */
static rob_error rob_distribute_tensions(const double system[ROB_ACTUATORS * (1 + ROB_REDUNDANCY)], double *output)
{
    const double *const basis = &system[ROB_ACTUATORS];
    double references[ROB_ACTUATORS];
    double deviations[ROB_ACTUATORS];
    double internal[ROB_REDUNDANCY];
    double largest = 0.0;
    for (int i = 0; i < ROB_ACTUATORS; i++) {
        references[i] = (rob_least_tensions[i] > -HUGE_VAL) ? rob_least_tensions[i] : 0.0;
    }
    for (int k = 0; k < ROB_REDUNDANCY; k++) {
        double sum = 0.0;
        for (int i = 0; i < ROB_ACTUATORS; i++) {
            sum += basis[(i * ROB_REDUNDANCY) + k] * (references[i] - system[i]);
        }
        internal[k] = sum;
    }
    for (int i = 0; i < ROB_ACTUATORS; i++) {
        double torque = system[i];
        for (int k = 0; k < ROB_REDUNDANCY; k++) {
            torque += basis[(i * ROB_REDUNDANCY) + k] * internal[k];
        }
        torque = torque - references[i];
        largest = (fabs(torque) > largest) ? fabs(torque) : largest;
        largest = (fabs(references[i]) > largest) ? fabs(references[i]) : largest;
        largest = (fabs(system[i]) > largest) ? fabs(system[i]) : largest;
        deviations[i] = torque;
    }
    for (int k = 0; k < ROB_REDUNDANCY; k++) {
        internal[k] = 0.0;
    }
    const double tolerance = LIMIT_TENSION * largest;
    if (rob_tension_dual(basis, deviations, tolerance, internal) == 0) {
        return ROB_TENSIONS;
    }
    for (int i = 0; i < ROB_ACTUATORS; i++) {
        const double deviation = rob_tension_deviation(basis, deviations, internal, i);
        if (!isfinite(deviation)) {
            return ROB_OVERFLOW;
        }
        if ((rob_least_tensions[i] > -HUGE_VAL) && (deviation < -tolerance)) {
            return ROB_TENSIONS;
        }
        const int is_below = ((rob_least_tensions[i] > -HUGE_VAL) && (deviation < 0.0)) ? 1 : 0;
        deviations[i] = (is_below != 0) ? 0.0 : deviation;
    }
    for (int i = 0; i < ROB_ACTUATORS; i++) {
        output[i] = references[i] + deviations[i];
    }
    return ROB_OK;
}
