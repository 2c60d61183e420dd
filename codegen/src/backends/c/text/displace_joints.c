/* Largest magnitude of the errors. */
static double rob_largest(const double *errors)
{
    double largest = 0.0;
    for (int i = 0; i < ROB_DEPENDENT; i++) {
        largest = (fabs(errors[i]) > largest) ? fabs(errors[i]) : largest;
    }
    return largest;
}

/* Corrects the dependent joints of a pose by Newton's method until the chains close; 0 if they do not. A step that does
 * not reduce the largest error is halved, so that a pose beside a dead centre is not left for one that is less closed. */
static int rob_close(double *pose)
{
    double step[ROB_DEPENDENT];
    double before = HUGE_VAL;
    for (int i = 0; i < ROB_DEPENDENT; i++) {
        step[i] = 0.0;
    }
    for (int count = 0; count < 40; count++) {
        double errors[ROB_DEPENDENT];
        double jacobian[ROB_DEPENDENT * ROB_POSE];
        double square[ROB_DEPENDENT][ROB_DEPENDENT];
        double longest = 0.0;
        double size = HUGE_VAL;
        double scale;
        if (rob_pose_error(pose, errors) == ROB_OK) {
            size = rob_largest(errors);
        }
        if (!(size < before)) {
            if (!isfinite(before)) {
                return 0;
            }
            for (int i = 0; i < ROB_DEPENDENT; i++) {
                step[i] *= 0.5;
                pose[rob_dependent[i]] -= step[i];
            }
            continue;
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
        }
        longest = rob_largest(errors);
        if (longest < LIMIT_JOINT_STEP) {
            return 1;
        }
        scale = (longest > 0.5) ? (0.5 / longest) : 1.0;
        for (int i = 0; i < ROB_DEPENDENT; i++) {
            step[i] = -scale * errors[i];
            pose[rob_dependent[i]] += step[i];
        }
        before = size;
    }
    for (int i = 0; i < ROB_DEPENDENT; i++) {
        pose[rob_dependent[i]] -= step[i];
    }
    return 0;
}

/* Moves the independent joints of a pose by the step; the others are found by Newton's method so that the chains
 * close. Long steps are divided, so that the assembly mode stays. If the chains do not close, functions reject the
 * pose. */
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
