/* Solves a leg's block of J_k x = e in place by elimination with row pivoting; the sign of the block's
 * determinant. `condition` gets the ratio of its largest and smallest pivots. */
static double rob_eliminate(
    double matrix[ROB_JOINTS][ROB_JOINTS],
    double vector[ROB_JOINTS],
    int leg,
    double *condition)
{
    const int begin = rob_first_joints[leg];
    const int end = rob_first_joints[leg + 1];
    double sign = 1.0;
    double largest = 0.0;
    double smallest = HUGE_VAL;
    *condition = HUGE_VAL;
    for (int k = begin; k < end; k++) {
        int pivot_row = k;
        double pivot = 0.0;
        for (int row = k + 1; row < end; row++) {
            if (fabs(matrix[row][k]) > fabs(matrix[pivot_row][k])) {
                pivot_row = row;
            }
        }
        if (pivot_row != k) {
            const double side = vector[k];
            vector[k] = vector[pivot_row];
            vector[pivot_row] = side;
            for (int column = begin; column < end; column++) {
                const double entry = matrix[k][column];
                matrix[k][column] = matrix[pivot_row][column];
                matrix[pivot_row][column] = entry;
            }
            sign = -sign;
        }
        pivot = matrix[k][k];
        largest = (fabs(pivot) > largest) ? fabs(pivot) : largest;
        smallest = (fabs(pivot) < smallest) ? fabs(pivot) : smallest;
        if (!(fabs(pivot) > 0.0) || !isfinite(pivot)) {
            return 0.0;
        }
        sign = (pivot < 0.0) ? -sign : sign;
        for (int row = k + 1; row < end; row++) {
            const double factor = matrix[row][k] / pivot;
            for (int column = k; column < end; column++) {
                matrix[row][column] -= factor * matrix[k][column];
            }
            vector[row] -= factor * vector[k];
        }
    }
    for (int k = end - 1; k >= begin; k--) {
        for (int column = k + 1; column < end; column++) {
            vector[k] -= matrix[k][column] * vector[column];
        }
        vector[k] /= matrix[k][k];
    }
    *condition = largest / smallest;
    return sign;
}

/* Closure error and Jacobian of the legs. */
static rob_error rob_closure(
    const double *pose,
    const double *joints,
    double matrix[ROB_JOINTS][ROB_JOINTS],
    double vector[ROB_JOINTS])
{
    rob_error error = rob_closure_error_from_joints(pose, joints, vector);
    if (error == ROB_OK) {
        error = rob_legs_jacobian_from_joints(pose, joints, &matrix[0][0]);
    }
    return error;
}

/* Largest magnitude of a leg's part of a vector. */
static double rob_largest(const double *vector, int leg)
{
    double largest = 0.0;
    for (int i = rob_first_joints[leg]; i < rob_first_joints[leg + 1]; i++) {
        largest = (fabs(vector[i]) > largest) ? fabs(vector[i]) : largest;
    }
    return largest;
}

/* Newton's method from the joints in `joints`. */
static rob_error rob_newton(const double *pose, double *joints)
{
    double matrix[ROB_JOINTS][ROB_JOINTS];
    double vector[ROB_JOINTS];
    rob_error error = ROB_OK;
    double worst = 0.0;
    for (int count = 0; count < 30; count++) {
        double largest = 0.0;
        error = rob_closure(pose, joints, matrix, vector);
        if (error != ROB_OK) {
            return error;
        }
        for (int leg = 0; leg < ROB_LEGS; leg++) {
            double condition = 0.0;
            double step = 0.0;
            double scale = 1.0;
            (void)rob_eliminate(matrix, vector, leg, &condition);
            if (!((condition * LIMIT_SINGULAR) <= 1.0)) {
                return rob_singular_legs[leg];
            }
            step = rob_largest(vector, leg);
            scale = (step > 0.5) ? (0.5 / step) : 1.0;
            for (int i = rob_first_joints[leg]; i < rob_first_joints[leg + 1]; i++) {
                joints[i] += scale * vector[i];
            }
            largest = (step > largest) ? step : largest;
        }
        if (largest < LIMIT_JOINT_STEP) {
            return ROB_OK;
        }
    }
    error = rob_closure(pose, joints, matrix, vector);
    if (error != ROB_OK) {
        return error;
    }
    /* The leg whose error is the largest is the one that cannot follow. */
    for (int leg = 0; leg < ROB_LEGS; leg++) {
        const double size = rob_largest(vector, leg);
        if ((size >= LIMIT_CLOSED) && (size > worst)) {
            worst = size;
            error = rob_legs_out_of_reach[leg];
        }
    }
    return error;
}

/* Whether every leg's determinant has the sign that it has at home. */
static rob_error rob_same_mode(const double *pose, const double *joints)
{
    double matrix[ROB_JOINTS][ROB_JOINTS];
    double vector[ROB_JOINTS];
    double home[ROB_LEGS];
    double condition = 0.0;
    rob_error error = rob_closure(rob_home_pose, rob_home_joints, matrix, vector);
    if (error != ROB_OK) {
        return error;
    }
    for (int leg = 0; leg < ROB_LEGS; leg++) {
        home[leg] = rob_eliminate(matrix, vector, leg, &condition);
    }
    error = rob_closure(pose, joints, matrix, vector);
    if (error != ROB_OK) {
        return error;
    }
    for (int leg = 0; leg < ROB_LEGS; leg++) {
        const double here = rob_eliminate(matrix, vector, leg, &condition);
        if ((home[leg] * here) <= 0.0) {
            return rob_singular_legs[leg];
        }
    }
    return ROB_OK;
}
