/* Copies a pose with its quaternion scaled to length 1; 0 if the quaternion is zero. */
static int rob_unit_quaternion(const double *pose, double *unit)
{
    double *const q = &unit[ROB_POSE - 4];
    double square = 0.0;
    int is_rotation = 1;
    for (int i = 0; i < ROB_POSE; i++) {
        unit[i] = pose[i];
    }
    square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (fabs(square - 1.0) > LIMIT_QUATERNION) {
        /* The largest number is scaled to 1 first, so that squares are neither too small nor too large. */
        double largest = 0.0;
        for (int i = 0; i < 4; i++) {
            largest = (fabs(q[i]) > largest) ? fabs(q[i]) : largest;
        }
        if (largest > 0.0) {
            double sum = 0.0;
            for (int i = 0; i < 4; i++) {
                q[i] /= largest;
                sum += q[i] * q[i];
            }
            sum = sqrt(sum);
            for (int i = 0; i < 4; i++) {
                q[i] /= sum;
            }
        } else {
            is_rotation = 0;
        }
    } else {
        /* Mostly the length is 1 but for rounding; one over its root is (3 - square)/2 then. */
        const double scale = 1.5 - 0.5 * square;
        for (int i = 0; i < 4; i++) {
            q[i] *= scale;
        }
    }
    return is_rotation;
}
