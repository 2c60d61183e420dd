/* Corrects the dependent joints of a pose by Newton's method until the chains close; 0 where they do not. */
static int rob_close(double *pose)
{
    for (int count = 0; count < 40; count++) {
        double errors[ROB_DEPENDENT];
        double jacobian[ROB_DEPENDENT * ROB_POSE];
        double square[ROB_DEPENDENT][ROB_DEPENDENT];
        double largest = 0.0;
        double scale;
        if (rob_pose_error(pose, errors) != ROB_OK) {
            return 0;
        }
        if (rob_pose_error_jacobian(pose, jacobian) != ROB_OK) {
            return 0;
        }
        for (int row = 0; row < ROB_DEPENDENT; row++) {
            for (int column = 0; column < ROB_DEPENDENT; column++) {
                square[row][column] = jacobian[ROB_POSE * row + rob_dependent[column]];
            }
        }
        if (rob_eliminate(square, errors) == 0) {
            return 0;
        }
        for (int i = 0; i < ROB_DEPENDENT; i++) {
            if (!isfinite(errors[i])) {
                return 0;
            }
            largest = (fabs(errors[i]) > largest) ? fabs(errors[i]) : largest;
        }
        if (largest < LIMIT_JOINT_STEP) {
            return 1;
        }
        scale = (largest > 0.5) ? (0.5 / largest) : 1.0;
        for (int i = 0; i < ROB_DEPENDENT; i++) {
            pose[rob_dependent[i]] -= scale * errors[i];
        }
    }
    return 0;
}

/* Moves the independent joints of a pose by the step; the others are found by Newton's method so that the chains
 * close. Long steps are divided, so that the assembly mode stays. Where the chains do not close, the pose stays on the
 * way: functions refuse it. */
static void rob_displace(double *pose, const double *step)
{
    double longest = 0.0;
    int parts = 1;
    int is_closed = 1;
    for (int i = 0; i < ROB_DOF; i++) {
        longest = (fabs(step[i]) > longest) ? fabs(step[i]) : longest;
    }
    while ((parts < 100) && (longest > (0.2 * (double)parts))) {
        parts++;
    }
    for (int part = 0; (part < parts) && (is_closed != 0); part++) {
        for (int i = 0; i < ROB_DOF; i++) {
            pose[rob_independent[i]] += step[i] / (double)parts;
        }
        is_closed = rob_close(pose);
    }
}
