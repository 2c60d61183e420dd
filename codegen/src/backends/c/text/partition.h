/** Case 2 for any kept actuators, eq. (36): the factors of J_a transposed in one configuration. */
typedef struct rob_partition {
    double factors[ROB_DOF][ROB_DOF]; /**< L below the diagonal, U on and above it */
    int order[ROB_DOF];               /**< which row of J_a transposed stands in each row */
    double condition;                 /**< condition number of J_a, free of units */
} rob_partition;

/**
 * The partition that keeps some actuators.
 *
 * @param inverse_jacobian J_p^inv, as rob_inverse_jacobian writes it (ROB_ACTUATORS * ROB_DOF)
 * @param kept indices of the kept actuators, from 0 (ROB_DOF)
 * @param[out] partition is left as it was where there is an error
 * @return 0, or an error: a number that is not finite, an actuator that there is not, or actuators that do not
 * determine the platform's motion (a condition number above LIMIT_PARTITION).
 */
rob_error rob_partition_of(
    const double *ROB_RESTRICT inverse_jacobian,
    const int *ROB_RESTRICT kept,
    rob_partition *ROB_RESTRICT partition);

/**
 * From what is projected on the platform to what is projected on the kept actuators, in place: a regressor of
 * case 1 becomes that of case 2, and so do torques.
 *
 * @param partition as rob_partition_of writes it
 * @param inputs ROB_DOF rows of `columns` numbers, row by row
 * @param columns how many columns there are
 * @return 0, or an error: an input that is not finite, or a result that is too large for a number. The inputs that are
 * behind it are left as they were then.
 */
rob_error rob_partition_project(
    const rob_partition *ROB_RESTRICT partition,
    double *ROB_RESTRICT inputs,
    int columns);

