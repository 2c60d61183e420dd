#include "dualv_solver.hpp"

#include <algorithm>

namespace inverse_dynamics {

bool DualvSolver::configure(const std::vector<double> &parameters, const std::vector<double> &pose) {
  if (parameters.size() != parameters_.size() || pose.size() != pose_.size()) {
    return false;
  }
  std::copy(parameters.begin(), parameters.end(), parameters_.begin());
  std::copy(pose.begin(), pose.end(), pose_.begin());
  return true;
}

std::vector<std::string> DualvSolver::actuator_names() const {
  return {dualv_actuator_names, dualv_actuator_names + DUALV_ACTUATORS};
}

std::vector<std::string> DualvSolver::parameter_names() const {
  std::vector<std::string> names;
  for (const dualv_parameter &parameter : dualv_parameters) {
    names.emplace_back(parameter.name);
  }
  for (const dualv_parameter &parameter : dualv_payload_parameters) {
    names.emplace_back(parameter.name);
  }
  return names;
}

bool DualvSolver::update(const State &state, std::vector<double> &torques) {
  const bool fits = state.actuators.size() == DUALV_ACTUATORS && state.velocities.size() == DUALV_ACTUATORS &&
                    state.acceleration.size() == DUALV_DOF && torques.size() == DUALV_ACTUATORS;
  if (!fits) {
    return false;
  }
  // The previous pose is near this one; after an error it is kept.
  std::array<double, DUALV_POSE> pose{};
  error_ = dualv_pose_from_actuators(state.actuators.data(), pose_.data(), pose.data());
  if (error_ == DUALV_OK) {
    error_ = dualv_twist_from_actuators(pose.data(), state.velocities.data(), twist_.data());
  }
  if (error_ == DUALV_OK) {
    error_ = dualv_inverse_dynamics(pose.data(), twist_.data(), state.acceleration.data(), parameters_.data(),
                                    torques.data());
  }
  if (error_ == DUALV_OK) {
    pose_ = pose;
  }
  return error_ == DUALV_OK;
}

bool DualvSolver::mass_matrix(std::vector<double> &matrix) const {
  if (matrix.size() != DUALV_DOF * DUALV_DOF) {
    return false;
  }
  error_ = dualv_mass_matrix(pose_.data(), parameters_.data(), matrix.data());
  return error_ == DUALV_OK;
}

}  // namespace inverse_dynamics
