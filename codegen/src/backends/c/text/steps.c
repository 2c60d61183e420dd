/* The pose that fits the actuators best in the sense of least squares, found from the one in `pose`. */
static rob_error rob_LOOP(const double *actuators, double *pose)
{
    double before = 0.0;
    for (int count = 0; count < 20; count++) {
        double step[ROB_DOF];
        double largest = 0.0;
        double total = 0.0;
        const rob_error error = rob_FIND(pose, actuators, step);
        /* A pose that has run away is none that was given. */
        if ((error == ROB_NOT_FINITE_POSE) || (error == ROB_OUT_OF_RANGE_POSE)) {
            return ROB_NO_CONVERGENCE;
        }
        if (error != ROB_OK) {
            return error;
        }
        rob_displace(pose, step);
        for (int row = 0; row < ROB_DOF; row++) {
            largest = (fabs(step[row]) > largest) ? fabs(step[row]) : largest;
            total += fabs(step[row]);
        }
        if (!isfinite(total)) {
            return ROB_NO_CONVERGENCE;
        }
        /* The next step is largest * largest / before at most. */
        if ((largest < LIMIT_STEP) || ((largest * largest) < (0.1 * LIMIT_STEP * before))) {
            return ROB_OK;
        }
        /* The step behind a longer one is no sign of how fast steps shrink. */
        before = (largest < 1.0) ? largest : 1.0;
    }
    return ROB_NO_CONVERGENCE;
}
