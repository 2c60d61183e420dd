/* Reads transmissions from the standard input and writes all results, numbers as hexadecimal floating point. */
#include "overact_transmission.h"

#include <stdio.h>

#define MOST 8

typedef overact_transmission_number number;

static void read(number *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        double x = 0.0;
        if (scanf("%la", &x) != 1) {
            puts("no number");
        }
        numbers[i] = (number)x;
    }
}

static void print(const char *name, overact_transmission_error error, const number *numbers, int count)
{
    printf("%s %d", name, (int)error);
    for (int i = 0; (i < count) && (error == OVERACT_TRANSMISSION_OK); i++) {
        printf(" %a", (double)numbers[i]);
    }
    printf("\n");
}

static int sizes[2];
static number curvature[MOST * MOST * MOST];

/* Accelerations of motors with the given curvature. */
static int bias(void *context, const number *twist, number *accelerations)
{
    const int r = sizes[1];
    (void)context;
    for (int a = 0; a < sizes[0]; a++) {
        accelerations[a] = 0;
        for (int i = 0; i < r; i++) {
            for (int j = 0; j < r; j++) {
                accelerations[a] += twist[i] * curvature[(a * r + i) * r + j] * twist[j];
            }
        }
    }
    return 0;
}

int main(void)
{
    static number memory[2][OVERACT_TRANSMISSION_MEMORY(MOST, MOST)];
    static number work[OVERACT_TRANSMISSION_WORK(MOST, MOST)];
    static number jacobian[MOST * MOST];
    static number gains[MOST * MOST];
    static number out[MOST * MOST * MOST];
    static number limits[2 * MOST];
    number joints[MOST];
    number motors[MOST];
    overact_transmission home = { 0 };
    while (scanf("%d %d", &sizes[0], &sizes[1]) == 2) {
        const int n = sizes[0];
        const int r = sizes[1];
        overact_transmission own;
        overact_transmission_interval motor_limits[MOST];
        overact_transmission_interval joint_limits[MOST];
        overact_transmission_error error;
        read(jacobian, n * r);
        read(joints, r);
        read(motors, n);
        read(gains, r * r);
        read(curvature, n * r * r);
        read(limits, 2 * n);
        for (int a = 0; a < n; a++) {
            motor_limits[a].least = limits[2 * a];
            motor_limits[a].most = limits[2 * a + 1];
        }
        error = overact_transmission_init(&own, n, r, jacobian, memory[0]);
        print("inverse", error, own.inverse, n * r);
        if (error != OVERACT_TRANSMISSION_OK) {
            continue;
        }
        print("condition", error, &own.condition, 1);
        for (int i = 0; i < n * r; i++) {
            jacobian[i] = (i % r == 0) ? -jacobian[i] : jacobian[i];
        }
        (void)overact_transmission_init(&home, n, r, jacobian, memory[1]);
        print("mode", overact_transmission_in_mode_of(&own, &home, work), out, 0);
        print("motor_velocities", overact_transmission_motor_velocities(&own, joints, out), out, n);
        print("joint_velocities", overact_transmission_joint_velocities(&own, motors, out), out, r);
        print("motor_accelerations", overact_transmission_motor_accelerations(&own, joints, motors, out), out, n);
        print("joint_accelerations", overact_transmission_joint_accelerations(&own, motors, limits, work, out), out, r);
        print("joint_torques", overact_transmission_joint_torques(&own, motors, out), out, r);
        print("motor_torques", overact_transmission_motor_torques(&own, joints, out), out, n);
        print("reflected_inertia", overact_transmission_reflected_inertia(&own, motors, out), out, r * r);
        print("joint_stiffness", overact_transmission_joint_stiffness(&own, motors, motors, curvature, out), out, r * r);
        print("motor_gains", overact_transmission_motor_gains(&own, gains, work, out), out, n * n);
        print("motor_stiffness", overact_transmission_motor_stiffness(&own, gains, motors, curvature, work, out), out, n * n);
        print("diagonal_motor_gains", overact_transmission_diagonal_motor_gains(&own, gains, work, out), out, n);
        error = overact_transmission_speed_intervals(&own, motor_limits, joint_limits);
        for (int i = 0; i < r; i++) {
            out[2 * i] = joint_limits[i].least;
            out[2 * i + 1] = joint_limits[i].most;
        }
        print("speed_intervals", error, out, 2 * r);
        error = overact_transmission_torque_intervals(&own, motor_limits, joint_limits);
        for (int i = 0; i < r; i++) {
            out[2 * i] = joint_limits[i].least;
            out[2 * i + 1] = joint_limits[i].most;
        }
        print("torque_intervals", error, out, 2 * r);
        print("speed_factor", overact_transmission_speed_factor(&own, joints, motor_limits, out), out, 1);
        print("torque_factor", overact_transmission_torque_factor(&own, joints, motor_limits, out), out, 1);
        print("curvature", (overact_transmission_error)overact_transmission_curvature(n, r, bias, 0, work, out), out, n * r * r);
    }
    return 0;
}
