    const double *const goal = ROB_GOAL;
    static const int parts[3] = { 1, 8, 64 };
    rob_error error = ROB_OK;
    for (int attempt = 0; attempt < 3; attempt++) {
        double joints[ROB_JOINTS];
        error = ROB_OK;
        for (int i = 0; i < ROB_JOINTS; i++) {
            joints[i] = rob_home_joints[i];
        }
        for (int part = 1; (part <= parts[attempt]) && (error == ROB_OK); part++) {
            /* The pose a part of the way from home. */
            const double share = (double)part / (double)parts[attempt];
            double way[ROB_POSE];
            for (int i = 0; i < ROB_POSE; i++) {
                const double home = rob_home_pose[i];
                way[i] = (part == parts[attempt]) ? goal[i] : (home + share * (goal[i] - home));
            }
ROB_WAY            error = rob_newton(way, joints);
        }
        if (error == ROB_OK) {
            error = rob_same_mode(goal, joints);
        }
        if (error == ROB_OK) {
            for (int i = 0; i < ROB_JOINTS; i++) {
                output[i] = joints[i];
            }
            return ROB_OK;
        }
    }
    return error;
}
