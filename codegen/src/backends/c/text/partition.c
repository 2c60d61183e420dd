/* L U of a matrix, the largest pivot of each column first. */
static void rob_factorise(rob_partition *partition)
{
    double(*const m)[ROB_DOF] = partition->factors;
    for (int row = 0; row < ROB_DOF; row++) {
        partition->order[row] = row;
    }
    for (int k = 0; k < ROB_DOF; k++) {
        int pivot = k;
        for (int row = k + 1; row < ROB_DOF; row++) {
            pivot = (fabs(m[row][k]) > fabs(m[pivot][k])) ? row : pivot;
        }
        if (pivot != k) {
            const int place = partition->order[k];
            partition->order[k] = partition->order[pivot];
            partition->order[pivot] = place;
            for (int column = 0; column < ROB_DOF; column++) {
                const double entry = m[k][column];
                m[k][column] = m[pivot][column];
                m[pivot][column] = entry;
            }
        }
        for (int row = k + 1; row < ROB_DOF; row++) {
            m[row][k] /= m[k][k];
            for (int column = k + 1; column < ROB_DOF; column++) {
                m[row][column] -= m[row][k] * m[k][column];
            }
        }
    }
}

/* The inverse of J_a transposed times a vector. */
static void rob_partition_solve(
    const rob_partition *partition, const double vector[ROB_DOF], double solution[ROB_DOF])
{
    for (int row = 0; row < ROB_DOF; row++) {
        double known = 0.0;
        for (int column = 0; column < row; column++) {
            known += partition->factors[row][column] * solution[column];
        }
        solution[row] = vector[partition->order[row]] - known;
    }
    for (int row = ROB_DOF - 1; row >= 0; row--) {
        double known = 0.0;
        for (int column = row + 1; column < ROB_DOF; column++) {
            known += partition->factors[row][column] * solution[column];
        }
        solution[row] = (solution[row] - known) / partition->factors[row][row];
    }
}

/* The condition number after every coordinate is scaled by the length of its column in J_p^inv, a shorter one
 * than 1e-5 of the longest by that. */
static double rob_partition_condition(
    const rob_partition *partition, const double *inverse_jacobian, const int *kept)
{
    double scales[ROB_DOF];
    double sums[ROB_DOF];
    double longest = 0.0;
    double largest = 0.0;
    double worst = 0.0;
    int finite = 1;
    for (int i = 0; i < ROB_DOF; i++) {
        double squares = 0.0;
        for (int row = 0; row < ROB_ACTUATORS; row++) {
            const double entry = inverse_jacobian[row * ROB_DOF + i];
            squares += entry * entry;
        }
        scales[i] = sqrt(squares);
        sums[i] = 0.0;
        longest = (scales[i] > longest) ? scales[i] : longest;
    }
    for (int i = 0; i < ROB_DOF; i++) {
        double size = 0.0;
        scales[i] = (scales[i] > (1e-5 * longest)) ? scales[i] : (1e-5 * longest);
        for (int column = 0; column < ROB_DOF; column++) {
            size += fabs(inverse_jacobian[kept[column] * ROB_DOF + i]);
        }
        size /= scales[i];
        largest = (size > largest) ? size : largest;
    }
    for (int i = 0; i < ROB_DOF; i++) {
        double unit[ROB_DOF] = { 0.0 };
        double solution[ROB_DOF];
        unit[i] = scales[i];
        rob_partition_solve(partition, unit, solution);
        for (int row = 0; row < ROB_DOF; row++) {
            sums[row] += fabs(solution[row]);
        }
    }
    for (int row = 0; row < ROB_DOF; row++) {
        /* A maximum would pass over what is no number. */
        finite = (isfinite(sums[row]) && (finite != 0)) ? 1 : 0;
        worst = (sums[row] > worst) ? sums[row] : worst;
    }
    return ((finite != 0) && isfinite(largest)) ? (largest * worst) : HUGE_VAL;
}

rob_error rob_partition_of(
    const double *ROB_RESTRICT inverse_jacobian,
    const int *ROB_RESTRICT kept,
    rob_partition *ROB_RESTRICT partition)
{
    rob_partition found;
    for (int i = 0; i < ROB_DOF; i++) {
        if ((kept[i] < 0) || (kept[i] >= ROB_ACTUATORS)) {
            return ROB_NO_ACTUATOR;
        }
    }
    if (!(rob_is_finite(inverse_jacobian, ROB_ACTUATORS * ROB_DOF))) {
        return ROB_NOT_FINITE_INVERSE_JACOBIAN;
    }
    for (int column = 0; column < ROB_DOF; column++) {
        for (int row = 0; row < ROB_DOF; row++) {
            found.factors[row][column] = inverse_jacobian[kept[column] * ROB_DOF + row];
        }
    }
    rob_factorise(&found);
    found.condition = rob_partition_condition(&found, inverse_jacobian, kept);
    if (!(found.condition < LIMIT_PARTITION)) {
        return ROB_SINGULAR_PARTITION;
    }
    *partition = found;
    return ROB_OK;
}

rob_error rob_partition_project(
    const rob_partition *ROB_RESTRICT partition,
    double *ROB_RESTRICT inputs,
    int columns)
{
    if (!(rob_is_finite(inputs, ROB_DOF * columns))) {
        return ROB_NOT_FINITE_INPUTS;
    }
    for (int column = 0; column < columns; column++) {
        double vector[ROB_DOF];
        double solution[ROB_DOF];
        for (int row = 0; row < ROB_DOF; row++) {
            vector[row] = inputs[row * columns + column];
        }
        rob_partition_solve(partition, vector, solution);
        if (!(rob_is_finite(solution, ROB_DOF))) {
            return ROB_OVERFLOW;
        }
        for (int row = 0; row < ROB_DOF; row++) {
            inputs[row * columns + column] = solution[row];
        }
    }
    return ROB_OK;
}
