/* Moves a pose by one displacement, whose independent components are the step; the others are found by Newton's
 * method so that the legs close. Where they do not, the pose stays on the way: functions refuse it. */
static void rob_displace(double *pose, const double *step)
{
    double whole[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
    double start[ROB_POSE];
    for (int i = 0; i < ROB_POSE; i++) {
        start[i] = pose[i];
    }
    for (int i = 0; i < ROB_DOF; i++) {
        whole[rob_independent[i]] = step[i];
    }
    for (int count = 0; count < 40; count++) {
        double errors[ROB_BLOCKED];
        double jacobian[ROB_BLOCKED * 6];
        double square[ROB_BLOCKED][ROB_BLOCKED];
        double largest = 0.0;
        double scale;
        for (int i = 0; i < ROB_POSE; i++) {
            pose[i] = start[i];
        }
        rob_displace_freely(pose, whole);
        if (rob_blocked_error(pose, errors) != ROB_OK) {
            return;
        }
        if (rob_blocked_jacobian(pose, jacobian) != ROB_OK) {
            return;
        }
        for (int row = 0; row < ROB_BLOCKED; row++) {
            for (int column = 0; column < ROB_BLOCKED; column++) {
                square[row][column] = jacobian[6 * row + rob_dependent[column]];
            }
        }
        if (rob_eliminate(square, errors) == 0) {
            return;
        }
        for (int i = 0; i < ROB_BLOCKED; i++) {
            if (!isfinite(errors[i])) {
                return;
            }
            largest = (fabs(errors[i]) > largest) ? fabs(errors[i]) : largest;
        }
        if (largest < LIMIT_JOINT_STEP) {
            return;
        }
        scale = (largest > 0.5) ? (0.5 / largest) : 1.0;
        for (int i = 0; i < ROB_BLOCKED; i++) {
            whole[rob_dependent[i]] -= scale * errors[i];
        }
    }
}
