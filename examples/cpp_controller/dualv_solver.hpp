// The DualV behind the interface: a thin wrapper of the generated C.
#pragma once

#include <array>

#include "dualv.h"
#include "inverse_dynamics_solver.hpp"

namespace inverse_dynamics {

class DualvSolver final : public Solver {
 public:
  bool configure(const std::vector<double> &parameters, const std::vector<double> &pose) override;
  std::size_t actuator_count() const override { return DUALV_ACTUATORS; }
  std::size_t coordinate_count() const override { return DUALV_DOF; }
  std::vector<std::string> actuator_names() const override;
  std::vector<std::string> parameter_names() const override;
  bool update(const State &state, std::vector<double> &torques) override;
  bool mass_matrix(std::vector<double> &matrix) const override;
  std::string message() const override { return dualv_error_text(error_); }

  // The pose of the last update.
  const std::array<double, DUALV_POSE> &pose() const { return pose_; }
  // The platform's velocity of the last update.
  const std::array<double, DUALV_DOF> &twist() const { return twist_; }

 private:
  std::array<double, DUALV_PARAMETERS + DUALV_PAYLOAD_PARAMETERS> parameters_{};
  std::array<double, DUALV_POSE> pose_{};
  std::array<double, DUALV_DOF> twist_{};
  mutable dualv_error error_ = DUALV_OK;
};

}  // namespace inverse_dynamics
