// Disordered networks homogenised.  The expected numbers are those of an independent implementation (numpy, sparse direct
// solves, two seeds): Kot et al. (2014), set A, n = 1.29, minL = 0.8, a periodic box of side 10 with 1290 nodes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "msm/calibrate.h"
#include "msm/measure/homogenise.h"
#include "msm/topology/random_network.h"

namespace springproof {
namespace {

Network set_a(double springs_per_node, std::uint64_t seed) {
  RandomParameters p;
  p.spacing = std::cbrt(1 / 1.29);
  p.min_length = 0.8 / p.spacing;
  p.springs_per_node = springs_per_node;
  p.seed = seed;
  return periodic_random_network({10, 10, 10}, p);
}

TEST(Probe, Numbers) {
  for (double S : {8., 10., 12., 15., 18., 22., 26., 29.})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      Network n = set_a(S, seed);
      calibrate(1.0, n);
      const Homogenised h = homogenise({n, {Springs{}}});
      printf("S %g seed %d E/E20 %.4f K %.4f nu %.4f aniso %.4f its %d res %.1e\n", S, (int)seed, h.youngs_modulus / 2.5, h.bulk_modulus * 0.6, h.poisson_ratio, h.anisotropy, h.iterations, h.residual);
    }
  for (double S : {12., 16., 22.})
    for (double nu : {-.9, -.5, 0., .25, .4, .45, .49, .499})
      for (auto form : {Dispersion::published, Dispersion::symmetric}) {
        Network n = set_a(S, 1);
        const IsotropicMaterial m{1, nu, 1};
        calibrate(shear_modulus(m), n);
        if (form == Dispersion::published && nu > .495) continue;
        const Homogenised h = homogenise({n, {Springs{}, MomentumDispersion{dispersed_fraction(lame_lambda(m), shear_modulus(m)), form}}});
        printf("S %g nu %g form %d: nu %.4f G/G %.4f asym %.4f its %d res %.1e\n", S, nu, (int)form, h.poisson_ratio, h.shear_modulus / shear_modulus(m), h.asymmetry, h.iterations, h.residual);
      }
}

}  // namespace
}  // namespace springproof
