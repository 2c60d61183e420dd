/* Solves S x = y in place for a symmetric positive definite S, of which the upper triangle is read and overwritten;
   0 where a pivot vanishes. */
static int rob_solve(double matrix[ROB_DOF][ROB_DOF], double vector[ROB_DOF])
{
    double largest = 0.0;
    int is_regular = 1;
    for (int k = 0; k < ROB_DOF; k++) {
        largest = (matrix[k][k] > largest) ? matrix[k][k] : largest;
    }
    for (int k = 0; (k < ROB_DOF) && (is_regular != 0); k++) {
        const double pivot = matrix[k][k];
        if (pivot > (LIMIT_PIVOT * largest)) {
            for (int row = k + 1; row < ROB_DOF; row++) {
                const double factor = matrix[k][row] / pivot;
                for (int column = row; column < ROB_DOF; column++) {
                    matrix[row][column] -= factor * matrix[k][column];
                }
                vector[row] -= factor * vector[k];
            }
        } else {
            is_regular = 0;
        }
    }
    if (is_regular != 0) {
        for (int k = ROB_DOF - 1; k >= 0; k--) {
            double rest = 0.0;
            for (int column = k + 1; column < ROB_DOF; column++) {
                rest += matrix[k][column] * vector[column];
            }
            vector[k] = (vector[k] - rest) / matrix[k][k];
        }
    }
    return is_regular;
}

/* The step of least squares from a pose: by normal equations. */
static rob_error rob_normal_step(const double *pose, const double *actuators, double *step)
{
    double reached[ROB_ACTUATORS];
    double jacobian[ROB_ACTUATORS * ROB_DOF];
    double normal[ROB_DOF][ROB_DOF];
    rob_error error = rob_actuator_positions(pose, reached);
    if (error == ROB_OK) {
        error = rob_inverse_jacobian(pose, jacobian);
    }
    if (error != ROB_OK) {
        return error;
    }
    for (int row = 0; row < ROB_DOF; row++) {
        step[row] = 0.0;
        for (int column = 0; column < ROB_DOF; column++) {
            normal[row][column] = 0.0;
        }
    }
    for (int i = 0; i < ROB_ACTUATORS; i++) {
        const double *const entries = &jacobian[i * ROB_DOF];
        double difference = actuators[i] - reached[i];
        if (rob_actuator_is_revolute[i] != 0) {
            difference = rob_wrap_angle(difference);
        }
        for (int row = 0; row < ROB_DOF; row++) {
            step[row] += entries[row] * difference;
            for (int column = row; column < ROB_DOF; column++) {
                normal[row][column] += entries[row] * entries[column];
            }
        }
    }
    return (rob_solve(normal, step) == 0) ? ROB_SINGULAR_ACTUATORS : ROB_OK;
}
