/* Largest magnitude of the errors. */
static double rob_largest(const double *errors)
{
    double largest = 0.0;
    for (int i = 0; i < ROB_BLOCKED; i++) {
        largest = (fabs(errors[i]) > largest) ? fabs(errors[i]) : largest;
    }
    return largest;
}

/* A pose after one displacement from the start. */
static void rob_place(double *pose, const double *start, const double *whole)
{
    for (int i = 0; i < ROB_POSE; i++) {
        pose[i] = start[i];
    }
    rob_displace_freely(pose, whole);
}

/* Moves a pose by one displacement, whose independent components are the step; the others are found by Newton's
 * method so that the legs close. A step that does not reduce the largest error is halved. If the legs do not close,
 * functions reject the pose. */
static void rob_displace(double *pose, const double *step)
{
    double whole[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
    double change[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
    double start[ROB_POSE];
    double before = HUGE_VAL;
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
        double longest = 0.0;
        double size = HUGE_VAL;
        double scale;
        rob_place(pose, start, whole);
        if (rob_blocked_error(pose, errors) == ROB_OK) {
            size = rob_largest(errors);
        }
        if (!(size < before)) {
            if (!isfinite(before)) {
                return;
            }
            for (int i = 0; i < 6; i++) {
                change[i] *= 0.5;
                whole[i] -= change[i];
            }
            continue;
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
        }
        longest = rob_largest(errors);
        if (longest < LIMIT_JOINT_STEP) {
            return;
        }
        scale = (longest > 0.5) ? (0.5 / longest) : 1.0;
        for (int i = 0; i < ROB_BLOCKED; i++) {
            change[rob_dependent[i]] = -scale * errors[i];
            whole[rob_dependent[i]] += change[rob_dependent[i]];
        }
        before = size;
    }
    for (int i = 0; i < 6; i++) {
        whole[i] -= change[i];
    }
    rob_place(pose, start, whole);
}
