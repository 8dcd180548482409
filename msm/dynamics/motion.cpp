#include "msm/dynamics/motion.h"

namespace springproof {

const char* name_of(Integrator integrator) {
  switch (integrator) {
    case Integrator::energy_momentum:
      return "energy-momentum";
    case Integrator::implicit_euler:
      return "implicit Euler";
    default:
      return "semi-implicit Euler";
  }
}

MotionOfNodes::MotionOfNodes(const MassSpringModel& model, const MotionOptions& options)
    : model_(model),
      overstrains_(model.network, options.relaxation),
      x_(model.network.X),
      v_(NodalVectors::Zero(x_.rows(), 3)) {}

void MotionOfNodes::move_supports() {
  for (Eigen::Index i = 0; i < x_.size(); ++i)
    if (conditions_.fixed[i]) x_.data()[i] = model_.network.X.data()[i] + conditions_.prescribed.data()[i];
}

void MotionOfNodes::set_state(const NodalVectors& x, const NodalVectors& v) {
  x_ = x;
  v_ = v;
  carry(model_.network.cells.carried, x_);
  carry(model_.network.cells.carried, v_);
}

}  // namespace springproof
