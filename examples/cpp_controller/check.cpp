// Checks that the solver's torques obey the equations of motion: projected on the platform they are M a + h, eq. (30).
// Mass matrix, bias and Jacobian come from separate functions. An unreachable pose must be reported and change nothing.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "dualv_solver.hpp"

namespace {

void require(bool holds, const char *what) {
  if (!holds) {
    std::fprintf(stderr, "%s\n", what);
    std::exit(1);
  }
}

}  // namespace

int main() {
  inverse_dynamics::DualvSolver solver;
  const std::vector<std::string> names = solver.parameter_names();
  std::vector<double> parameters;
  for (const std::string &name : names) {
    const bool is_inertia = name.rfind("m_", 0) == 0 || name.rfind("zz_", 0) == 0 || name.rfind("ia_", 0) == 0;
    parameters.push_back(is_inertia ? 0.5 : 0.01);
  }
  const std::vector<double> home(dualv_home_pose, dualv_home_pose + DUALV_POSE);
  require(solver.configure(parameters, home), "the solver takes the parameters");
  require(!solver.configure({1.0}, home), "one parameter is too few");

  // The robot is near home.
  const double pose[DUALV_POSE] = {home[0] + 0.02, home[1] - 0.01, home[2] + 0.1};
  double actuators[DUALV_ACTUATORS];
  require(dualv_actuator_positions(pose, actuators) == DUALV_OK, "the pose is within reach");
  inverse_dynamics::State state;
  state.actuators.assign(actuators, actuators + DUALV_ACTUATORS);
  state.velocities = {0.3, -0.2, 0.1, 0.4};
  state.acceleration = {1.0, -2.0, 3.0};
  std::vector<double> torques(solver.actuator_count());
  require(solver.update(state, torques), "there are torques");
  for (int i = 0; i < DUALV_POSE; i++) {
    require(std::fabs(solver.pose()[i] - pose[i]) < 1e-9, "the pose is found");
  }

  double jacobian[DUALV_ACTUATORS * DUALV_DOF];
  double bias[DUALV_DOF];
  std::vector<double> masses(DUALV_DOF * DUALV_DOF);
  require(dualv_inverse_jacobian(solver.pose().data(), jacobian) == DUALV_OK, "there is a Jacobian");
  require(dualv_bias(solver.pose().data(), solver.twist().data(), parameters.data(), bias) == DUALV_OK,
          "there is a bias");
  require(solver.mass_matrix(masses), "there are masses");
  for (int row = 0; row < DUALV_DOF; row++) {
    double projected = 0.0;
    double wanted = bias[row];
    for (int i = 0; i < DUALV_ACTUATORS; i++) {
      projected += jacobian[i * DUALV_DOF + row] * torques[i];
    }
    for (int column = 0; column < DUALV_DOF; column++) {
      wanted += masses[row * DUALV_DOF + column] * state.acceleration[column];
    }
    std::printf("coordinate %s: %.12g N or N m\n", dualv_coordinates[row], projected);
    require(std::fabs(projected - wanted) < 1e-10 * (1.0 + std::fabs(wanted)), "the torques obey M a + h");
  }

  const std::vector<double> before = torques;
  state.actuators[0] = NAN;
  require(!solver.update(state, torques) && torques == before, "a NaN is refused");
  require(solver.message() == "`actuators` has a number that is not finite", "the input is named");
  return 0;
}
