"""The functions of robots. This file is written by `tools/functions.py`.

r are the degrees of freedom, n the actuators, n_t the joints, n_st, n_b and n_l the standard, base and
payload parameters. Robots without a platform call pose, twist and acceleration `joints`,
`joint_velocities` and `joint_accelerations`; `Function.inputs` has the names of a robot's.
"""

from ._overact import Function

class Functions:
    pose_in_closed_form: Function
    """The pose from the actuators in closed form, in the assembly mode of the home configuration. It uses
    only as many actuators as there are degrees of freedom. Working modes of legs may differ from those
    at home. Inputs: actuators (n; m, rad). Output: (pose,)."""
    joints: Function
    """Positions q_t of all joints (m, rad): inverse kinematics, eq. (7), in the working mode of the home
    configuration. Inputs: pose (m, rad). Output: (n_t,)."""
    actuator_positions: Function
    """Positions q of the actuated joints (m, rad), in the working mode of the home configuration. Inputs:
    pose (m, rad). Output: (n,)."""
    pose_step: Function
    """One Gauss-Newton step v δt from a pose x towards the pose of given actuator positions q: J_p^inv+ (q
    - q(x)), eq. (21), with differences of angles wrapped to ±π. `forward::displace` applies it to a
    pose, `forward::displace_quaternion` if the pose has a quaternion. It fails if the elimination would
    lose digits, even if J_p^inv is regular; `pose_from_actuators` then uses normal equations. Inputs:
    pose (m, rad), actuators (n; m, rad). Output: (r,)."""
    inverse_jacobian: Function
    """J_p^inv: actuator velocities = J_p^inv v, eq. (20). Inputs: pose (m, rad). Output: (n, r)."""
    inverse_jacobian_from_joints: Function
    """J_p^inv: actuator velocities = J_p^inv v, eq. (20). Inputs: joints (n_t; m, rad) and, as its
    `inputs` say, what else it takes. Output: (n, r)."""
    jacobian: Function
    """The pseudo-inverse of J_p^inv: v = J_p^inv+ times the actuator velocities, eqs. (21) and (22).
    Inputs: pose (m, rad). Output: (r, n)."""
    legs_jacobian_from_joints: Function
    """J_k of J_tk v = J_k q̇_t, eq. (9): the independent velocity components of the legs' ends in the base
    frame, leg by leg, per joint rate. Inputs: pose (m, rad), joints (n_t; m, rad). Output: (n_t, n_t)."""
    legs_platform_jacobian_from_joints: Function
    """J_tk of J_tk v = J_k q̇_t, eq. (9): the same velocity components per twist coordinate. Inputs: pose
    (m, rad), joints (n_t; m, rad). Output: (n_t, r)."""
    closure_platform_jacobian_from_joints: Function
    """A_p of the reduced closure A_p v + B_p q̇ = 0, eq. (11); each row is that of the leg's adjugate.
    Inputs: pose (m, rad), joints (n_t; m, rad). Output: (n, r)."""
    closure_actuator_jacobian_from_joints: Function
    """B_p of the reduced closure A_p v + B_p q̇ = 0, eq. (11); diagonal. Inputs: pose (m, rad), joints
    (n_t; m, rad). Output: (n, n)."""
    closure_error_from_joints: Function
    """Closure errors, eq. (7): distances between the legs' ends and the platform in the directions of the
    rows of J_k (m, rad). Inputs: pose (m, rad), joints (n_t; m, rad). Output: (n_t,)."""
    platform_jacobian: Function
    """D of t = D v, eq. (14), from the legs' closures: velocity of the platform's origin and its angular
    velocity, both in the base frame, per independent coordinate. Inputs: pose (m, rad). Output: (6, r)."""
    blocked_error: Function
    """Closure errors of a pose in the directions that the legs block (m, rad). They are zero for reachable
    poses. Inputs: pose (m, rad). Output: (6 - r,)."""
    blocked_jacobian: Function
    """A of A t = 0: the derivative of `blocked_error` along the velocity of the platform's origin and the
    angular velocity t. Inputs: pose (m, rad). Output: (6 - r, 6)."""
    joint_velocities: Function
    """Velocities of all joints (m/s, rad/s), eq. (9). Inputs: pose (m, rad), twist (r; m/s, rad/s).
    Output: (n_t,)."""
    joint_accelerations: Function
    """Accelerations of all joints (m/s², rad/s²), eq. (10). Inputs: pose (m, rad), twist (r; m/s, rad/s),
    acceleration (r; m/s², rad/s²). Output: (n_t,)."""
    twist_from_actuators: Function
    """The twist v from the actuator velocities, by least squares, eq. (21). Inputs: pose (m, rad),
    actuator_velocities (n; m/s, rad/s). Output: (r,)."""
    acceleration_from_actuators: Function
    """The acceleration v̇ from the actuator accelerations, by least squares, eq. (24) with J_p^inv.
    Inputs: pose (m, rad), twist (r; m/s, rad/s), actuator_accelerations (n; m/s², rad/s²). Output:
    (r,)."""
    idm_red_platform: Function
    """IDM_red of the platform projection (case 1): Γ¹ = IDM_red χ, eq. (30). Inputs: pose (m, rad), twist
    (r; m/s, rad/s), acceleration (r; m/s², rad/s²). Output: (r, n_st)."""
    idm_red_platform_from_joints: Function
    """IDM_red of the platform projection (case 1): Γ¹ = IDM_red χ, eq. (30). Inputs: joints (n_t; m, rad)
    and, as its `inputs` say, what else it takes. Output: (r, n_st)."""
    idm_red_platform_from_actuators: Function
    """IDM_red of the platform projection (case 1): Γ¹ = IDM_red χ, eq. (30). Inputs: actuators (n; m, rad)
    and, as its `inputs` say, what else it takes; the pose is found. Output: (r, n_st)."""
    idm_red_actuators: Function
    """IDM_red of the actuator projection (case 2): Γ² = IDM_red χ on the kept actuators, eq. (36). Inputs:
    pose (m, rad), twist (r; m/s, rad/s), acceleration (r; m/s², rad/s²). Output: (r, n_st)."""
    idm_red_actuators_from_joints: Function
    """IDM_red of the actuator projection (case 2): Γ² = IDM_red χ on the kept actuators, eq. (36). Inputs:
    joints (n_t; m, rad) and, as its `inputs` say, what else it takes. Output: (r, n_st)."""
    idm_red_actuators_from_actuators: Function
    """IDM_red of the actuator projection (case 2): Γ² = IDM_red χ on the kept actuators, eq. (36). Inputs:
    actuators (n; m, rad) and, as its `inputs` say, what else it takes; the pose is found. Output: (r,
    n_st)."""
    idm_red_platform_base: Function
    """IDM_red of the platform projection (case 1): Γ¹ = IDM_red χ, eq. (30). Inputs: pose (m, rad), twist
    (r; m/s, rad/s), acceleration (r; m/s², rad/s²). Output: (r, n_b)."""
    idm_red_platform_base_from_joints: Function
    """IDM_red of the platform projection (case 1): Γ¹ = IDM_red χ, eq. (30). Inputs: joints (n_t; m, rad)
    and, as its `inputs` say, what else it takes. Output: (r, n_b)."""
    idm_red_platform_base_from_actuators: Function
    """IDM_red of the platform projection (case 1): Γ¹ = IDM_red χ, eq. (30). Inputs: actuators (n; m, rad)
    and, as its `inputs` say, what else it takes; the pose is found. Output: (r, n_b)."""
    idm_red_actuators_base: Function
    """IDM_red of the actuator projection (case 2): Γ² = IDM_red χ on the kept actuators, eq. (36). Inputs:
    pose (m, rad), twist (r; m/s, rad/s), acceleration (r; m/s², rad/s²). Output: (r, n_b)."""
    idm_red_actuators_base_from_joints: Function
    """IDM_red of the actuator projection (case 2): Γ² = IDM_red χ on the kept actuators, eq. (36). Inputs:
    joints (n_t; m, rad) and, as its `inputs` say, what else it takes. Output: (r, n_b)."""
    idm_red_actuators_base_from_actuators: Function
    """IDM_red of the actuator projection (case 2): Γ² = IDM_red χ on the kept actuators, eq. (36). Inputs:
    actuators (n; m, rad) and, as its `inputs` say, what else it takes; the pose is found. Output: (r,
    n_b)."""
    idm_red_payload: Function
    """The payload's columns of the platform projection (case 1), eq. (38). Inputs: pose (m, rad), twist
    (r; m/s, rad/s), acceleration (r; m/s², rad/s²). Output: (r, n_l)."""
    idm_red_payload_from_joints: Function
    """The payload's columns of the platform projection (case 1), eq. (38). Inputs: joints (n_t; m, rad)
    and, as its `inputs` say, what else it takes. Output: (r, n_l)."""
    idm_red_payload_from_actuators: Function
    """The payload's columns of the platform projection (case 1), eq. (38). Inputs: actuators (n; m, rad)
    and, as its `inputs` say, what else it takes; the pose is found. Output: (r, n_l)."""
    idm_red_payload_actuators: Function
    """The payload's columns of the actuator projection (case 2), eq. (38). Inputs: pose (m, rad), twist
    (r; m/s, rad/s), acceleration (r; m/s², rad/s²). Output: (r, n_l)."""
    project_platform: Function
    """Γ¹ = (J_p^inv)ᵀ τ, the torques projected on the platform, eq. (30). Inputs: pose (m, rad), torques
    (n; N, N m). Output: (r,)."""
    project_actuators: Function
    """Γ² = τ_a + J_a^-T J_bᵀ τ_b, the torques projected on the kept actuators, eq. (36). Inputs: pose (m,
    rad), torques (n; N, N m). Output: (r,)."""
    inverse_dynamics: Function
    """Actuator torques τ of least norm for given parameters: τ = J_p^inv (J_p^invᵀ J_p^inv)⁻¹ Γ¹; the
    unique ones without redundancy, eq. (19). Inputs: pose (m, rad), twist (r; m/s, rad/s), acceleration
    (r; m/s², rad/s²), parameters (n_st + n_l; SI). Output: (n,)."""
    inverse_dynamics_from_joints: Function
    """Actuator torques τ of least norm for given parameters: τ = J_p^inv (J_p^invᵀ J_p^inv)⁻¹ Γ¹; the
    unique ones without redundancy, eq. (19). Inputs: joints (n_t; m, rad) and, as its `inputs` say,
    what else it takes. Output: (n,)."""
    inverse_dynamics_from_actuators: Function
    """Actuator torques τ of least norm for given parameters: τ = J_p^inv (J_p^invᵀ J_p^inv)⁻¹ Γ¹; the
    unique ones without redundancy, eq. (19). Inputs: actuators (n; m, rad) and, as its `inputs` say,
    what else it takes; the pose is found. Output: (n,)."""
    inverse_dynamics_base: Function
    """Actuator torques τ of least norm for given parameters: τ = J_p^inv (J_p^invᵀ J_p^inv)⁻¹ Γ¹; the
    unique ones without redundancy, eq. (19). Inputs: pose (m, rad), twist (r; m/s, rad/s), acceleration
    (r; m/s², rad/s²), base_parameters (n_b + n_l; SI). Output: (n,)."""
    inverse_dynamics_base_from_joints: Function
    """Actuator torques τ of least norm for given parameters: τ = J_p^inv (J_p^invᵀ J_p^inv)⁻¹ Γ¹; the
    unique ones without redundancy, eq. (19). Inputs: joints (n_t; m, rad) and, as its `inputs` say,
    what else it takes. Output: (n,)."""
    inverse_dynamics_base_from_actuators: Function
    """Actuator torques τ of least norm for given parameters: τ = J_p^inv (J_p^invᵀ J_p^inv)⁻¹ Γ¹; the
    unique ones without redundancy, eq. (19). Inputs: actuators (n; m, rad) and, as its `inputs` say,
    what else it takes; the pose is found. Output: (n,)."""
    mass_matrix: Function
    """Mass matrix on the twist coordinates: Γ¹ = M v̇ + bias. Inputs: pose (m, rad), parameters (n_st +
    n_l; SI). Output: (r, r)."""
    mass_matrix_base: Function
    """Mass matrix on the twist coordinates: Γ¹ = M v̇ + bias. Inputs: pose (m, rad), base_parameters (n_b
    + n_l; SI). Output: (r, r)."""
    bias: Function
    """Γ¹ at v̇ = 0: Coriolis, centrifugal, gravity and friction forces. Inputs: pose (m, rad), twist (r;
    m/s, rad/s), parameters (n_st + n_l; SI). Output: (r,)."""
    bias_base: Function
    """Γ¹ at v̇ = 0: Coriolis, centrifugal, gravity and friction forces. Inputs: pose (m, rad), twist (r;
    m/s, rad/s), base_parameters (n_b + n_l; SI). Output: (r,)."""
    forward_dynamics: Function
    """Acceleration under given torques: v̇ = M⁻¹ (Γ¹(τ) - bias), the mass matrix factored as L D Lᵀ.
    Inputs: pose (m, rad), twist (r; m/s, rad/s), torques (n; N, N m), parameters (n_st + n_l; SI).
    Output: (r,)."""
    forward_dynamics_base: Function
    """Acceleration under given torques: v̇ = M⁻¹ (Γ¹(τ) - bias), the mass matrix factored as L D Lᵀ.
    Inputs: pose (m, rad), twist (r; m/s, rad/s), torques (n; N, N m), base_parameters (n_b + n_l; SI).
    Output: (r,)."""
    inverse_dynamics_preloaded: Function
    """Actuator torques of least norm plus N `preload`, where N is the basis from `null_space`. Inputs:
    pose (m, rad), twist (r; m/s, rad/s), acceleration (r; m/s², rad/s²), parameters (n_st + n_l; SI),
    preload (n - r; N, N m). Output: (n,)."""
    project_torques: Function
    """τ* = (I - N Nᵀ) τ: the torques without their internal part, eq. (50); τ itself where there is no
    redundancy. Inputs: pose (m, rad), torques (n; N, N m). Output: (n,)."""
    null_space: Function
    """N: orthonormal basis of the null space of (J_p^inv)ᵀ; column k is positive at the k-th projected
    actuator of case 2. Inputs: pose (m, rad). Output: (n, n - r)."""
    total_mass: Function
    """Sum of all masses among the parameters, kg. Inputs: parameters (n_st + n_l; SI). Output: (1,)."""
    centre_of_mass: Function
    """Centre of mass of the robot in the base frame (m): Σ (m p + R s) / Σ m over all bodies, with the
    first moments s. Inputs: pose (m, rad), parameters (n_st + n_l; SI). Output: (3,)."""
    centre_of_mass_jacobian: Function
    """Velocity of the centre of mass in the base frame, per independent velocity. Inputs: pose (m, rad),
    parameters (n_st + n_l; SI). Output: (3, r)."""
    kinetic_energy: Function
    """Kinetic energy ½ vᵀ M v of all bodies and rotors, J. Inputs: pose (m, rad), twist (r; m/s, rad/s),
    parameters (n_st + n_l; SI). Output: (1,)."""
    potential_energy: Function
    """Potential energy -g · Σ (m p + R s) of all bodies in the description's gravity, J; zero for masses
    at the base's origin. Springs are not included. Inputs: pose (m, rad), parameters (n_st + n_l; SI).
    Output: (1,)."""
    inverse_dynamics_by_displacement: Function
    """∂τ/∂δ: derivative of `inverse_dynamics` with respect to a displacement of the pose, at fixed v and
    v̇ (N or N m per m or rad). The displacement δ moves the pose along the twist coordinates, as
    `forward::displace` does, or `forward::displace_quaternion` if the pose has a quaternion:
    translations (m) and rotations about the base axes (rad). Signs of velocities count as constants.
    Inputs: pose (m, rad), twist (r; m/s, rad/s), acceleration (r; m/s², rad/s²), parameters (n_st +
    n_l; SI). Output: (n, r)."""
    inverse_dynamics_by_displacement_base: Function
    """∂τ/∂δ: derivative of `inverse_dynamics` with respect to a displacement of the pose, at fixed v and
    v̇ (N or N m per m or rad). The displacement δ moves the pose along the twist coordinates, as
    `forward::displace` does, or `forward::displace_quaternion` if the pose has a quaternion:
    translations (m) and rotations about the base axes (rad). Signs of velocities count as constants.
    Inputs: pose (m, rad), twist (r; m/s, rad/s), acceleration (r; m/s², rad/s²), base_parameters (n_b +
    n_l; SI). Output: (n, r)."""
    inverse_dynamics_by_twist: Function
    """∂τ/∂v: derivative of `inverse_dynamics` with respect to the twist, at fixed pose and v̇ (N s or N m
    s per m or rad). Signs of velocities count as constants. Inputs: pose (m, rad), twist (r; m/s,
    rad/s), acceleration (r; m/s², rad/s²), parameters (n_st + n_l; SI). Output: (n, r)."""
    inverse_dynamics_by_twist_base: Function
    """∂τ/∂v: derivative of `inverse_dynamics` with respect to the twist, at fixed pose and v̇ (N s or N m
    s per m or rad). Signs of velocities count as constants. Inputs: pose (m, rad), twist (r; m/s,
    rad/s), acceleration (r; m/s², rad/s²), base_parameters (n_b + n_l; SI). Output: (n, r)."""
    forward_dynamics_by_displacement: Function
    """∂v̇/∂δ: derivative of `forward_dynamics` with respect to a displacement of the pose, at fixed v and
    τ: -M⁻¹ times that of the forces at the acceleration v̇ (m/s² or rad/s² per m or rad). The
    displacement δ moves the pose along the twist coordinates, as `forward::displace` does, or
    `forward::displace_quaternion` if the pose has a quaternion: translations (m) and rotations about
    the base axes (rad). Signs of velocities count as constants. Inputs: pose (m, rad), twist (r; m/s,
    rad/s), torques (n; N, N m), parameters (n_st + n_l; SI). Output: (r, r)."""
    forward_dynamics_by_displacement_base: Function
    """∂v̇/∂δ: derivative of `forward_dynamics` with respect to a displacement of the pose, at fixed v and
    τ: -M⁻¹ times that of the forces at the acceleration v̇ (m/s² or rad/s² per m or rad). The
    displacement δ moves the pose along the twist coordinates, as `forward::displace` does, or
    `forward::displace_quaternion` if the pose has a quaternion: translations (m) and rotations about
    the base axes (rad). Signs of velocities count as constants. Inputs: pose (m, rad), twist (r; m/s,
    rad/s), torques (n; N, N m), base_parameters (n_b + n_l; SI). Output: (r, r)."""
    forward_dynamics_by_twist: Function
    """∂v̇/∂v: derivative of `forward_dynamics` with respect to the twist, at fixed pose and τ: -M⁻¹ times
    that of the forces (1/s, or with m or rad for the other). Signs of velocities count as constants.
    Inputs: pose (m, rad), twist (r; m/s, rad/s), torques (n; N, N m), parameters (n_st + n_l; SI).
    Output: (r, r)."""
    forward_dynamics_by_twist_base: Function
    """∂v̇/∂v: derivative of `forward_dynamics` with respect to the twist, at fixed pose and τ: -M⁻¹ times
    that of the forces (1/s, or with m or rad for the other). Signs of velocities count as constants.
    Inputs: pose (m, rad), twist (r; m/s, rad/s), torques (n; N, N m), base_parameters (n_b + n_l; SI).
    Output: (r, r)."""
