// Times Pinocchio's `computeRNEADerivatives` for successive states of a serial robot.
//
// derivatives MODEL STATES BATCHES [DUMP] prints the shortest and the median time per call in nanoseconds.
// MODEL has the number of joints, gravity, and for each joint its kind, placement and body. A result has ∂τ/∂q, ∂τ/∂v
// and the inertia matrix, row by row.
#include <pinocchio/fwd.hpp>

#include <pinocchio/algorithm/joint-configuration.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/multibody.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

namespace pin = pinocchio;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

static std::vector<double> numbers(const char *path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<char> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    const double *first = reinterpret_cast<const double *>(bytes.data());
    return std::vector<double>(first, first + bytes.size() / sizeof(double));
}

static pin::Model model_of(const std::vector<double> &values) {
    pin::Model model;
    const double *at = values.data();
    const int joints = static_cast<int>(*at++);
    model.gravity.linear() = Eigen::Vector3d(at[0], at[1], at[2]);
    at += 3;
    pin::JointIndex parent = 0;
    for (int k = 0; k < joints; ++k) {
        const bool is_revolute = *at++ == 0.0;
        const pin::SE3 placement(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(at),
                                 Eigen::Map<const Eigen::Vector3d>(at + 9));
        at += 12;
        const std::string name = std::to_string(k);
        parent = is_revolute ? model.addJoint(parent, pin::JointModelRZ(), placement, name)
                             : model.addJoint(parent, pin::JointModelPZ(), placement, name);
        const Eigen::Matrix3d about_centre = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(at + 4);
        const pin::Inertia body(at[0], Eigen::Map<const Eigen::Vector3d>(at + 1), about_centre);
        at += 13;
        model.appendBodyToJoint(parent, body, pin::SE3::Identity());
    }
    return model;
}

int main(int count, char **arguments) {
    if (count < 4) return 2;
    const pin::Model model = model_of(numbers(arguments[1]));
    pin::Data data(model);
    const std::vector<double> values = numbers(arguments[2]);
    const std::size_t n = static_cast<std::size_t>(model.nv);
    std::vector<Eigen::VectorXd> states;
    for (std::size_t k = 0; k + n <= values.size(); k += n)
        states.push_back(Eigen::Map<const Eigen::VectorXd>(values.data() + k, model.nv));
    const std::size_t number = states.size() / 3;
    std::vector<double> times;
    for (int batch = std::atoi(arguments[3]); batch > 0; --batch) {
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t k = 0; k < number; ++k) {
            pin::computeRNEADerivatives(model, data, states[3 * k], states[3 * k + 1], states[3 * k + 2]);
            asm volatile("" : : "r"(data.dtau_dq.data()), "r"(data.dtau_dv.data()), "r"(data.M.data()) : "memory");
        }
        const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
        times.push_back(time.count() / static_cast<double>(number));
    }
    std::sort(times.begin(), times.end());
    if (count > 4) {
        std::ofstream dump(arguments[4], std::ios::binary);
        for (std::size_t k = 0; k < number; ++k) {
            pin::computeRNEADerivatives(model, data, states[3 * k], states[3 * k + 1], states[3 * k + 2]);
            Matrix inertia = data.M;
            inertia.triangularView<Eigen::StrictlyLower>() = inertia.transpose().triangularView<Eigen::StrictlyLower>();
            for (const Matrix &matrix : {Matrix(data.dtau_dq), Matrix(data.dtau_dv), inertia})
                dump.write(reinterpret_cast<const char *>(matrix.data()), sizeof(double) * n * n);
        }
    }
    std::printf("%.3f %.3f\n", times.front(), times[times.size() / 2]);
    return 0;
}
