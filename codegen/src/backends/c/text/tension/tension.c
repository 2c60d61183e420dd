/* The deviation d + N z of an actuator from its minimum. */
static double rob_tension_deviation(
    const double *basis, const double deviations[ROB_ACTUATORS], const double internal[ROB_REDUNDANCY], int at)
{
    double sum = deviations[at];
    for (int k = 0; k < ROB_REDUNDANCY; k++) {
        sum += basis[(at * ROB_REDUNDANCY) + k] * internal[k];
    }
    return sum;
}

/* The step that moves condition `at` with the active ones unchanged: r with G G' r = G g, and g - G' r. */
static void rob_tension_step(
    const double *basis, int at, int count, const int active[ROB_REDUNDANCY], double changes[ROB_REDUNDANCY],
    double direction[ROB_REDUNDANCY])
{
    double products[ROB_REDUNDANCY][ROB_REDUNDANCY];
    for (int i = 0; i < count; i++) {
        const double *const own = &basis[active[i] * ROB_REDUNDANCY];
        for (int j = 0; j < count; j++) {
            double product = 0.0;
            for (int k = 0; k < ROB_REDUNDANCY; k++) {
                product += own[k] * basis[(active[j] * ROB_REDUNDANCY) + k];
            }
            products[i][j] = product;
        }
        double sum = 0.0;
        for (int k = 0; k < ROB_REDUNDANCY; k++) {
            sum += own[k] * basis[(at * ROB_REDUNDANCY) + k];
        }
        changes[i] = sum;
    }
    for (int i = 0; i < count; i++) {
        for (int j = i + 1; j < count; j++) {
            const double factor = products[j][i] / products[i][i];
            for (int k = i; k < count; k++) {
                products[j][k] -= factor * products[i][k];
            }
            changes[j] -= factor * changes[i];
        }
    }
    for (int i = count - 1; i >= 0; i--) {
        double sum = changes[i];
        for (int k = i + 1; k < count; k++) {
            sum -= products[i][k] * changes[k];
        }
        changes[i] = sum / products[i][i];
    }
    for (int k = 0; k < ROB_REDUNDANCY; k++) {
        double sum = basis[(at * ROB_REDUNDANCY) + k];
        for (int j = 0; j < count; j++) {
            sum -= basis[(active[j] * ROB_REDUNDANCY) + k] * changes[j];
        }
        direction[k] = sum;
    }
}

/* Active conditions, with their multipliers and the internal torques. */
typedef struct rob_tension_state {
    int count;
    int active[ROB_REDUNDANCY];
    double multipliers[ROB_REDUNDANCY];
    double internal[ROB_REDUNDANCY];
} rob_tension_state;

/* Adds condition `at`, and drops active conditions that no longer hold it back; whether that is possible. */
static int rob_tension_add(
    const double *basis, const double deviations[ROB_ACTUATORS], int at, rob_tension_state *state)
{
    double multiplier = 0.0;
    for (int turn = 0; turn < (ROB_REDUNDANCY + 1); turn++) {
        double changes[ROB_REDUNDANCY];
        double direction[ROB_REDUNDANCY];
        rob_tension_step(basis, at, state->count, state->active, changes, direction);
        double square = 0.0;
        double length = 0.0;
        for (int k = 0; k < ROB_REDUNDANCY; k++) {
            const double own = basis[(at * ROB_REDUNDANCY) + k];
            square += direction[k] * direction[k];
            length += own * own;
        }
        double longest = HUGE_VAL;
        int dropped = state->count;
        for (int j = 0; j < state->count; j++) {
            if (changes[j] > 0.0) {
                const double ratio = state->multipliers[j] / changes[j];
                if (ratio < longest) {
                    longest = ratio;
                    dropped = j;
                }
            }
        }
        const int is_free = (square > (LIMIT_TENSION * length)) ? 1 : 0;
        const double full = (is_free != 0)
            ? (-rob_tension_deviation(basis, deviations, state->internal, at) / square)
            : HUGE_VAL;
        const int is_full = (full <= longest) ? 1 : 0;
        const double size = (is_full != 0) ? full : longest;
        if (!isfinite(size)) {
            return 0;
        }
        for (int k = 0; (k < ROB_REDUNDANCY) && (is_free != 0); k++) {
            state->internal[k] += size * direction[k];
        }
        for (int j = 0; j < state->count; j++) {
            state->multipliers[j] -= size * changes[j];
        }
        multiplier += size;
        if (is_full != 0) {
            state->active[state->count] = at;
            state->multipliers[state->count] = multiplier;
            state->count += 1;
            return 1;
        }
        for (int j = dropped + 1; j < state->count; j++) {
            state->active[j - 1] = state->active[j];
            state->multipliers[j - 1] = state->multipliers[j];
        }
        state->count -= 1;
    }
    return 0;
}

/* The internal torques by the dual method of Goldfarb and Idnani; whether there are any. */
static int rob_tension_dual(
    const double *basis, const double deviations[ROB_ACTUATORS], double tolerance, double internal[ROB_REDUNDANCY])
{
    rob_tension_state state = { 0 };
    for (int turn = 0; turn < (10 * (ROB_ACTUATORS + ROB_REDUNDANCY)); turn++) {
        double worst = -tolerance;
        int at = ROB_ACTUATORS;
        for (int i = 0; i < ROB_ACTUATORS; i++) {
            int is_active = 0;
            for (int j = 0; j < state.count; j++) {
                is_active = (state.active[j] == i) ? 1 : is_active;
            }
            if ((rob_least_tensions[i] > -HUGE_VAL) && (is_active == 0)) {
                const double value = rob_tension_deviation(basis, deviations, state.internal, i);
                if (value < worst) {
                    worst = value;
                    at = i;
                }
            }
        }
        if (at == ROB_ACTUATORS) {
            for (int k = 0; k < ROB_REDUNDANCY; k++) {
                internal[k] = state.internal[k];
            }
            return 1;
        }
        if (rob_tension_add(basis, deviations, at, &state) == 0) {
            return 0;
        }
    }
    return 0;
}
