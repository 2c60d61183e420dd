
/* Gauss-Newton steps from the pose `inputs[1]` to the least-squares pose of the actuators `inputs[0]`. */
#include <math.h>
#include <string.h>

void model(const double **inputs, double *output) {
    double pose[@POSE@], step[@DOF@];
    memcpy(pose, inputs[1], sizeof pose);
    for (int k = 0; k < 20; ++k) {
        const double *given[] = {pose, inputs[0]};
        newton_step(given, step);
        double largest = 0.0;
        for (int i = 0; i < @DOF@; ++i) largest = fmax(largest, fabs(step[i]));
        for (int i = 0; i < @LINEAR@; ++i) pose[i] += step[i];
#if @QUATERNION@
        const double *t = step + @LINEAR@;
        double *q = pose + @LINEAR@;
        double angle = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
        double c = cos(0.5 * angle), s = angle > 1e-12 ? sin(0.5 * angle) / angle : 0.5;
        double x = s * t[0], y = s * t[1], z = s * t[2];
        double r[4] = {c * q[0] - x * q[1] - y * q[2] - z * q[3], c * q[1] + x * q[0] + y * q[3] - z * q[2],
                       c * q[2] - x * q[3] + y * q[0] + z * q[1], c * q[3] + x * q[2] - y * q[1] + z * q[0]};
        double n = 1.0 / sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
        for (int i = 0; i < 4; ++i) q[i] = n * r[i];
#endif
        if (largest < 1e-12) break;
    }
    memcpy(output, pose, sizeof pose);
}
