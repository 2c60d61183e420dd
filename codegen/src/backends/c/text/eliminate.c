/* Solves a square system in place by elimination with row pivoting; 0 where it is singular. */
static int rob_eliminate(double matrix[ROB_COUNT][ROB_COUNT], double *vector)
{
    int is_regular = 1;
    for (int k = 0; (k < ROB_COUNT) && (is_regular != 0); k++) {
        int pivot = k;
        for (int row = k + 1; row < ROB_COUNT; row++) {
            if (fabs(matrix[row][k]) > fabs(matrix[pivot][k])) {
                pivot = row;
            }
        }
        if (pivot != k) {
            double side = vector[k];
            vector[k] = vector[pivot];
            vector[pivot] = side;
            for (int column = k; column < ROB_COUNT; column++) {
                side = matrix[k][column];
                matrix[k][column] = matrix[pivot][column];
                matrix[pivot][column] = side;
            }
        }
        is_regular = (fabs(matrix[k][k]) > 0.0) ? 1 : 0;
        for (int row = k + 1; (row < ROB_COUNT) && (is_regular != 0); row++) {
            const double factor = matrix[row][k] / matrix[k][k];
            for (int column = k; column < ROB_COUNT; column++) {
                matrix[row][column] -= factor * matrix[k][column];
            }
            vector[row] -= factor * vector[k];
        }
    }
    for (int k = ROB_COUNT - 1; (k >= 0) && (is_regular != 0); k--) {
        for (int column = k + 1; column < ROB_COUNT; column++) {
            vector[k] -= matrix[k][column] * vector[column];
        }
        vector[k] /= matrix[k][k];
    }
    return is_regular;
}

