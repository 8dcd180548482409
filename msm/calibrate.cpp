#include "msm/calibrate.h"

namespace springproof {

double affine_shear_modulus(const Network& network) {
  double sum = 0;
  for (const Spring& s : network.springs) sum += s.stiffness * s.rest_length * s.rest_length;
  const double d = network.triangles.empty() ? 3 : 2;
  return sum / (d * (d + 2) * network.volume.sum());
}

void calibrate(double shear_modulus, Network& network) {
  const double factor = shear_modulus / affine_shear_modulus(network);
  for (Spring& s : network.springs) s.stiffness *= factor;
  for (Spring& s : network.cell_springs) s.stiffness *= factor;
}

}  // namespace springproof
