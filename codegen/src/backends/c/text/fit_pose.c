/* The pose by steps with positions and Jacobian in one; what they do not find, normal equations may. */
static rob_error rob_fit_pose(const double *actuators, double *pose)
{
    double stepped[ROB_POSE];
    rob_error error = ROB_OK;
    for (int i = 0; i < ROB_POSE; i++) {
        stepped[i] = pose[i];
    }
    error = rob_steps_at_once(actuators, stepped);
    for (int i = 0; i < ROB_POSE; i++) {
        /* Farther poses are rounded by more than the last step: steps vanish that have led nowhere. */
        if ((error == ROB_OK) && (fabs(stepped[i]) > LIMIT_FARTHEST)) {
            error = ROB_NO_CONVERGENCE;
        }
    }
    if (error == ROB_OK) {
        for (int i = 0; i < ROB_POSE; i++) {
            pose[i] = stepped[i];
        }
    } else {
        error = rob_gauss_newton(actuators, pose);
    }
    return error;
}
