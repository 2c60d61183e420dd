/* Moves a pose that ends with a unit quaternion (w, x, y, z): the last three numbers of a step are a rotation
 * vector in the base frame, by whose exponential the quaternion is multiplied from the left. */
static void rob_displace(double *pose, const double *step)
{
    const double *const turn = &step[ROB_DOF - 3];
    double *const q = &pose[ROB_POSE - 4];
    const double angle = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
    /* sin(a/2)/a tends to 1/2. */
    const double scale = (angle > 1e-12) ? (sin(0.5 * angle) / angle) : 0.5;
    const double a = cos(0.5 * angle);
    const double b = scale * turn[0];
    const double c = scale * turn[1];
    const double d = scale * turn[2];
    double product[4];
    double sum = 0.0;
    for (int i = 0; i < (ROB_DOF - 3); i++) {
        pose[i] += step[i];
    }
    product[0] = a * q[0] - b * q[1] - c * q[2] - d * q[3];
    product[1] = a * q[1] + b * q[0] + c * q[3] - d * q[2];
    product[2] = a * q[2] - b * q[3] + c * q[0] + d * q[1];
    product[3] = a * q[3] + b * q[2] - c * q[1] + d * q[0];
    for (int i = 0; i < 4; i++) {
        sum += product[i] * product[i];
    }
    sum = sqrt(sum);
    for (int i = 0; i < 4; i++) {
        q[i] = product[i] / sum;
    }
}
