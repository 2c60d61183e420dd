// C++17 wrapper of overact_transmission.h: arrays of wrong length do not compile, matrices have entries (row, column),
// and the compiler warns about ignored errors. Functions neither allocate nor throw. It needs only <array> and <cstddef>,
// and takes the matrices of generated headers, which have `data()`.
#ifndef OVERACT_TRANSMISSION_HPP
#define OVERACT_TRANSMISSION_HPP

#include <array>
#include <cstddef>

#include "overact_transmission.h"

namespace overact {

using Number = ::overact_transmission_number;
using TransmissionError = ::overact_transmission_error;
using Interval = ::overact_transmission_interval;

template <std::size_t Length>
using Vector = std::array<Number, Length>;

// A matrix, stored row by row.
template <std::size_t Rows, std::size_t Columns>
struct Matrix {
    std::array<Number, Rows * Columns> values{};

    Number &operator()(std::size_t row, std::size_t column) { return values[row * Columns + column]; }
    Number operator()(std::size_t row, std::size_t column) const { return values[row * Columns + column]; }
    Number *data() noexcept { return values.data(); }
    const Number *data() const noexcept { return values.data(); }
    static constexpr std::size_t rows() noexcept { return Rows; }
    static constexpr std::size_t columns() noexcept { return Columns; }
};

// Transmission of motors and joints at a pose. The other functions need a successful `set`.
template <std::size_t Motors, std::size_t Joints>
class Transmission {
 public:
    using MotorVector = Vector<Motors>;
    using JointVector = Vector<Joints>;
    // Derivative of the Jacobian: Motors matrices of Joints x Joints.
    using Curvature = std::array<Number, Motors * Joints * Joints>;

    Transmission() = default;
    // The C structure has pointers into this object.
    Transmission(const Transmission &) = delete;
    Transmission &operator=(const Transmission &) = delete;

    // Takes the generated `inverse_jacobian` of a pose, a matrix of Motors x Joints.
    template <typename Jacobian>
    [[nodiscard]] TransmissionError set(const Jacobian &jacobian) noexcept
    {
        static_assert(Jacobian::rows() == Motors && Jacobian::columns() == Joints, "a matrix of motors x joints");
        return ::overact_transmission_init(
            &own_, static_cast<int>(Motors), static_cast<int>(Joints), jacobian.data(), memory_.data());
    }

    [[nodiscard]] TransmissionError in_mode_of(const Transmission &home) noexcept
    {
        return ::overact_transmission_in_mode_of(&own_, &home.own_, work_.data());
    }
    [[nodiscard]] TransmissionError motor_velocities(const JointVector &joints, MotorVector &motors) const noexcept
    {
        return ::overact_transmission_motor_velocities(&own_, joints.data(), motors.data());
    }
    [[nodiscard]] TransmissionError joint_velocities(const MotorVector &motors, JointVector &joints) const noexcept
    {
        return ::overact_transmission_joint_velocities(&own_, motors.data(), joints.data());
    }
    [[nodiscard]] TransmissionError motor_accelerations(
        const JointVector &joints, const MotorVector &bias, MotorVector &motors) const noexcept
    {
        return ::overact_transmission_motor_accelerations(&own_, joints.data(), bias.data(), motors.data());
    }
    [[nodiscard]] TransmissionError joint_accelerations(
        const MotorVector &motors, const MotorVector &bias, JointVector &joints) noexcept
    {
        return ::overact_transmission_joint_accelerations(
            &own_, motors.data(), bias.data(), work_.data(), joints.data());
    }
    [[nodiscard]] TransmissionError joint_torques(const MotorVector &motors, JointVector &joints) const noexcept
    {
        return ::overact_transmission_joint_torques(&own_, motors.data(), joints.data());
    }
    [[nodiscard]] TransmissionError motor_torques(const JointVector &joints, MotorVector &motors) const noexcept
    {
        return ::overact_transmission_motor_torques(&own_, joints.data(), motors.data());
    }
    [[nodiscard]] TransmissionError reflected_inertia(
        const MotorVector &rotors, Matrix<Joints, Joints> &inertia) const noexcept
    {
        return ::overact_transmission_reflected_inertia(&own_, rotors.data(), inertia.data());
    }
    [[nodiscard]] TransmissionError joint_gains(
        const MotorVector &motors, Matrix<Joints, Joints> &joints) const noexcept
    {
        return ::overact_transmission_joint_gains(&own_, motors.data(), joints.data());
    }
    [[nodiscard]] TransmissionError joint_stiffness(
        const MotorVector &gains,
        const MotorVector &torques,
        const Curvature &curvature,
        Matrix<Joints, Joints> &stiffness) const noexcept
    {
        return ::overact_transmission_joint_stiffness(
            &own_, gains.data(), torques.data(), curvature.data(), stiffness.data());
    }
    [[nodiscard]] TransmissionError motor_gains(
        const Matrix<Joints, Joints> &joints, Matrix<Motors, Motors> &motors) noexcept
    {
        return ::overact_transmission_motor_gains(&own_, joints.data(), work_.data(), motors.data());
    }
    [[nodiscard]] TransmissionError motor_stiffness(
        const Matrix<Joints, Joints> &stiffness,
        const MotorVector &torques,
        const Curvature &curvature,
        Matrix<Motors, Motors> &motors) noexcept
    {
        return ::overact_transmission_motor_stiffness(
            &own_, stiffness.data(), torques.data(), curvature.data(), work_.data(), motors.data());
    }
    [[nodiscard]] TransmissionError diagonal_motor_gains(
        const Matrix<Joints, Joints> &joints, MotorVector &motors) noexcept
    {
        return ::overact_transmission_diagonal_motor_gains(&own_, joints.data(), work_.data(), motors.data());
    }
    [[nodiscard]] TransmissionError speed_intervals(
        const std::array<Interval, Motors> &motors, std::array<Interval, Joints> &joints) const noexcept
    {
        return ::overact_transmission_speed_intervals(&own_, motors.data(), joints.data());
    }
    [[nodiscard]] TransmissionError torque_intervals(
        const std::array<Interval, Motors> &motors, std::array<Interval, Joints> &joints) const noexcept
    {
        return ::overact_transmission_torque_intervals(&own_, motors.data(), joints.data());
    }
    [[nodiscard]] TransmissionError speed_factor(
        const JointVector &direction, const std::array<Interval, Motors> &motors, Number &factor) const noexcept
    {
        return ::overact_transmission_speed_factor(&own_, direction.data(), motors.data(), &factor);
    }
    [[nodiscard]] TransmissionError torque_factor(
        const JointVector &direction, const std::array<Interval, Motors> &motors, Number &factor) const noexcept
    {
        return ::overact_transmission_torque_factor(&own_, direction.data(), motors.data(), &factor);
    }

    // Condition number of the Jacobian with scaled columns, at least 1.
    Number condition() const noexcept { return own_.condition; }

 private:
    std::array<Number, OVERACT_TRANSMISSION_MEMORY(Motors, Joints)> memory_{};
    std::array<Number, OVERACT_TRANSMISSION_WORK(Motors, Joints)> work_{};
    ::overact_transmission own_{};
};

}  // namespace overact

#endif
