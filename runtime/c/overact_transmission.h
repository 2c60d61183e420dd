/* Transmissions between motors and joints at a pose: C99 of the Rust module `overact::transmission`, operation by
 * operation.
 *
 * J is the generated `inverse_jacobian` of a pose, n motors x r joints, row by row: motor velocities per joint
 * velocity. The source needs only `math.h`. Numbers are `double`, or `float` if OVERACT_TRANSMISSION_SINGLE is defined.
 * Memory is provided by the caller. Outputs must not overlap inputs. A function that fails leaves its output
 * undefined. Do not compile with -ffast-math: it removes the checks for numbers that are not finite. */
#ifndef OVERACT_TRANSMISSION_H
#define OVERACT_TRANSMISSION_H

#ifdef __cplusplus
extern "C" {
#endif

#ifdef OVERACT_TRANSMISSION_SINGLE
typedef float overact_transmission_number;
#else
typedef double overact_transmission_number;
#endif

/* Numbers of memory for n motors and r joints. */
#define OVERACT_TRANSMISSION_MEMORY(n, r) (2 * (n) * (r) + (r) * (r) + (r))
/* Numbers of working memory of the gains. */
#define OVERACT_TRANSMISSION_WORK(n, r) ((n) * (n) + (n) * (r) + (r) * (r) + (n) + (r))

typedef enum {
    OVERACT_TRANSMISSION_OK = 0,
    /* A number of an input is NaN or infinite. */
    OVERACT_TRANSMISSION_NOT_FINITE,
    /* The motors do not determine the motion of all joints at this pose. */
    OVERACT_TRANSMISSION_SINGULAR,
    /* The pose is beyond a singularity: the same motor positions have another pose in the mode of home. */
    OVERACT_TRANSMISSION_ANOTHER_MODE,
    /* Several choices of motor gains have the same effect on the joints. */
    OVERACT_TRANSMISSION_AMBIGUOUS,
    /* A number, limit or direction is not in its range. */
    OVERACT_TRANSMISSION_SETTING,
    /* A result is too large for a number. */
    OVERACT_TRANSMISSION_OVERFLOW
} overact_transmission_error;

typedef struct {
    int motors;
    int joints;
    overact_transmission_number *jacobian; /* J, motors x joints */
    overact_transmission_number *inverse;  /* J+, joints x motors */
    overact_transmission_number *upper;    /* working memory, joints x joints */
    overact_transmission_number *scales;   /* lengths of the columns of J, joints */
    overact_transmission_number condition; /* condition number of J with scaled columns, at least 1 */
} overact_transmission;

/* Interval of a speed or torque, which contains zero; an infinite end means no limit. */
typedef struct {
    overact_transmission_number least;
    overact_transmission_number most;
} overact_transmission_interval;

/* The transmission with the Jacobian of a pose. `memory` has OVERACT_TRANSMISSION_MEMORY(motors, joints) numbers, used
 * while the transmission is. */
overact_transmission_error overact_transmission_init(
    overact_transmission *transmission,
    int motors,
    int joints,
    const overact_transmission_number *jacobian,
    overact_transmission_number *memory);

/* Checks that no singularity separates the pose from home. `work` has joints x joints numbers. */
overact_transmission_error overact_transmission_in_mode_of(
    const overact_transmission *transmission, const overact_transmission *home, overact_transmission_number *work);

/* Velocities of the motors, J v. */
overact_transmission_error overact_transmission_motor_velocities(
    const overact_transmission *transmission,
    const overact_transmission_number *joint_velocities,
    overact_transmission_number *motor_velocities);

/* Velocities of the joints; least squares with more motors than joints. */
overact_transmission_error overact_transmission_joint_velocities(
    const overact_transmission *transmission,
    const overact_transmission_number *motor_velocities,
    overact_transmission_number *joint_velocities);

/* Accelerations of the motors, J a + bias; `bias` (motors) are their accelerations while the twist is constant. */
overact_transmission_error overact_transmission_motor_accelerations(
    const overact_transmission *transmission,
    const overact_transmission_number *joint_accelerations,
    const overact_transmission_number *bias,
    overact_transmission_number *motor_accelerations);

/* Accelerations of the joints. `work` has `motors` numbers. */
overact_transmission_error overact_transmission_joint_accelerations(
    const overact_transmission *transmission,
    const overact_transmission_number *motor_accelerations,
    const overact_transmission_number *bias,
    overact_transmission_number *work,
    overact_transmission_number *joint_accelerations);

/* Torques that the joints receive from the motors. */
overact_transmission_error overact_transmission_joint_torques(
    const overact_transmission *transmission,
    const overact_transmission_number *motor_torques,
    overact_transmission_number *joint_torques);

/* Motor torques of least norm that give joint torques. */
overact_transmission_error overact_transmission_motor_torques(
    const overact_transmission *transmission,
    const overact_transmission_number *joint_torques,
    overact_transmission_number *motor_torques);

/* Inertia of the rotors (motors, after the gear) as the joints feel it, joints x joints. */
overact_transmission_error overact_transmission_reflected_inertia(
    const overact_transmission *transmission,
    const overact_transmission_number *rotor_inertias,
    overact_transmission_number *inertia);

/* Joint gains (joints x joints) of the gains of independent drives (motors). */
overact_transmission_error overact_transmission_joint_gains(
    const overact_transmission *transmission,
    const overact_transmission_number *motor_gains,
    overact_transmission_number *joint_gains);

/* Joint stiffness of position gains, with the geometric stiffness of motor torques (motors). `curvature` (motors x
 * joints x joints) is the derivative of J; see overact_transmission_curvature. */
overact_transmission_error overact_transmission_joint_stiffness(
    const overact_transmission *transmission,
    const overact_transmission_number *motor_gains,
    const overact_transmission_number *motor_torques,
    const overact_transmission_number *curvature,
    overact_transmission_number *joint_stiffness);

/* Motor gains (motors x motors, a full matrix) of joint gains. `work` has OVERACT_TRANSMISSION_WORK numbers. */
overact_transmission_error overact_transmission_motor_gains(
    const overact_transmission *transmission,
    const overact_transmission_number *joint_gains,
    overact_transmission_number *work,
    overact_transmission_number *motor_gains);

/* Position gains (motors x motors) for a joint stiffness under motor torques. */
overact_transmission_error overact_transmission_motor_stiffness(
    const overact_transmission *transmission,
    const overact_transmission_number *joint_stiffness,
    const overact_transmission_number *motor_torques,
    const overact_transmission_number *curvature,
    overact_transmission_number *work,
    overact_transmission_number *motor_gains);

/* Gains of independent drives (motors) whose joint gains are nearest to the given ones. */
overact_transmission_error overact_transmission_diagonal_motor_gains(
    const overact_transmission *transmission,
    const overact_transmission_number *joint_gains,
    overact_transmission_number *work,
    overact_transmission_number *motor_gains);

/* Speed of each joint at which a motor reaches a limit while the other joints rest. */
overact_transmission_error overact_transmission_speed_intervals(
    const overact_transmission *transmission,
    const overact_transmission_interval *motor_speeds,
    overact_transmission_interval *joint_speeds);

/* Torque of each joint at which a motor reaches a limit while the other joints have no torque. */
overact_transmission_error overact_transmission_torque_intervals(
    const overact_transmission *transmission,
    const overact_transmission_interval *motor_torques,
    overact_transmission_interval *joint_torques);

/* Largest factor by which joint speeds along a direction are within the limits of all motors. */
overact_transmission_error overact_transmission_speed_factor(
    const overact_transmission *transmission,
    const overact_transmission_number *direction,
    const overact_transmission_interval *motor_speeds,
    overact_transmission_number *factor);

/* Largest factor by which joint torques along a direction are within the limits of all motors. */
overact_transmission_error overact_transmission_torque_factor(
    const overact_transmission *transmission,
    const overact_transmission_number *direction,
    const overact_transmission_interval *motor_torques,
    overact_transmission_number *factor);

/* Accelerations of the motors at a constant twist (joints), as generated functions compute them: 0, or an error. */
typedef int (*overact_transmission_bias)(
    void *context, const overact_transmission_number *twist, overact_transmission_number *accelerations);

/* Derivative of J (motors x joints x joints) from accelerations at r (r + 1) / 2 twists; returns the first error of
 * `bias`. `work` has motors + joints numbers. */
int overact_transmission_curvature(
    int motors,
    int joints,
    overact_transmission_bias bias,
    void *context,
    overact_transmission_number *work,
    overact_transmission_number *curvature);

#ifdef __cplusplus
}
#endif

#endif
