// The interface of a plugin for inverse dynamics, as controllers in ROS 2 load it (pluginlib): nothing of it is
// known of the robot, and `update` allocates nothing, so that it may run in a real-time loop.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace inverse_dynamics {

// What a robot measures and what is wanted of it.
struct State {
  std::vector<double> actuators;     // measured positions (m, rad)
  std::vector<double> velocities;    // measured velocities (m/s, rad/s)
  std::vector<double> acceleration;  // wanted acceleration of the platform (m/s2, rad/s2)
};

class Solver {
 public:
  virtual ~Solver() = default;

  // Takes the values of the parameters, in the order of `parameter_names`, and a pose near the first one. False
  // if they are not as many as there are names.
  virtual bool configure(const std::vector<double> &parameters, const std::vector<double> &pose) = 0;

  virtual std::size_t actuator_count() const = 0;
  virtual std::size_t coordinate_count() const = 0;
  virtual std::vector<std::string> actuator_names() const = 0;
  virtual std::vector<std::string> parameter_names() const = 0;

  // Torques of least norm for an acceleration, from what the actuators measure. False where the robot has no
  // value here (`message` says why); `torques` is as it was then.
  virtual bool update(const State &state, std::vector<double> &torques) = 0;

  // Mass matrix of the platform's coordinates, row by row, at the pose of the last update.
  virtual bool mass_matrix(std::vector<double> &matrix) const = 0;

  // Why the last call failed.
  virtual std::string message() const = 0;
};

}  // namespace inverse_dynamics
