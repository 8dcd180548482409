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

}  // namespace springproof
