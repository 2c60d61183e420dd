// Interface of an inverse dynamics plugin, as loaded by ROS 2 controllers (pluginlib). It is independent of the
// robot, and `update` does not allocate, so that it can run in a real-time loop.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace inverse_dynamics {

// Measured motion and desired acceleration of a robot.
struct State {
  std::vector<double> actuators;     // measured positions (m, rad)
  std::vector<double> velocities;    // measured velocities (m/s, rad/s)
  std::vector<double> acceleration;  // desired acceleration of the platform (m/s2, rad/s2)
};

class Solver {
 public:
  virtual ~Solver() = default;

  // Sets the parameter values, in the order of `parameter_names`, and a pose near the first one. False if their
  // number is wrong.
  virtual bool configure(const std::vector<double> &parameters, const std::vector<double> &pose) = 0;

  virtual std::size_t actuator_count() const = 0;
  virtual std::size_t coordinate_count() const = 0;
  virtual std::vector<std::string> actuator_names() const = 0;
  virtual std::vector<std::string> parameter_names() const = 0;

  // Least-norm torques for an acceleration, from the measured actuator motion. False if there is no value here
  // (`message` gives the reason); `torques` is then unchanged.
  virtual bool update(const State &state, std::vector<double> &torques) = 0;

  // Mass matrix of the platform's coordinates, row by row, at the pose of the last update.
  virtual bool mass_matrix(std::vector<double> &matrix) const = 0;

  // Why the last call failed.
  virtual std::string message() const = 0;
};

}  // namespace inverse_dynamics
