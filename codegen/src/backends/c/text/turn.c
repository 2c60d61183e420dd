/* Turns a pose that ends with a unit quaternion (w, x, y, z): the quaternion is multiplied from the left by the
 * exponential of a rotation vector. Small turns take no root and no quotient. */
static void rob_turn(double *pose, const double *turn)
{
    double *const q = &pose[ROB_POSE - 4];
    const double square = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    /* sin(a/2)/a and cos(a/2) of an angle a, by their series in its square where that is small. */
    double scale = 0.5 - square * (1.0 / 48.0 - square * (1.0 / 3840.0 - square * (1.0 / 645120.0)));
    double a = 1.0 - square * (1.0 / 8.0 - square * (1.0 / 384.0 - square * (1.0 / 46080.0)));
    double b;
    double c;
    double d;
    double product[4];
    if (!(square < (1.0 / 256.0))) {
        const double angle = sqrt(square);
        scale = sin(0.5 * angle) / angle;
        a = cos(0.5 * angle);
    }
    b = scale * turn[0];
    c = scale * turn[1];
    d = scale * turn[2];
    product[0] = a * q[0] - b * q[1] - c * q[2] - d * q[3];
    product[1] = a * q[1] + b * q[0] + c * q[3] - d * q[2];
    product[2] = a * q[2] - b * q[3] + c * q[0] + d * q[1];
    product[3] = a * q[3] + b * q[2] - c * q[1] + d * q[0];
    for (int i = 0; i < 4; i++) {
        q[i] = product[i];
    }
    (void)rob_unit_quaternion(pose, pose);
}
