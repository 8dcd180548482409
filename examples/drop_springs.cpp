// Loads a springs file (springproof export BODY --to springs), lets the body fall on a plane and follows its bounce.
#include <algorithm>
#include <cstdio>
#include <exception>

#include "msm/dynamics/time_step.h"
#include "msm/exchange/springs_file.h"

using namespace springproof;

int main(int count, char** arguments) try {
  if (count != 2) return std::fprintf(stderr, "usage: drop_springs FILE.json\n"), 2;
  const SpringsFile file = read_springs(arguments[1]);
  const Network& network = file.model.network;
  const Eigen::VectorXd mass = masses(network, file.density), per_mass = inverse_masses(network, file.density);
  const double dt = 0.95 * safe_time_step(file.model, file.density);
  const double size = (network.X.colwise().maxCoeff() - network.X.colwise().minCoeff()).maxCoeff();
  const double floor = network.X.col(2).minCoeff() - size / 10;  // it falls a tenth of its size
  const Eigen::RowVector3d gravity(0, 0, -9.81);
  const auto height = [&](const NodalVectors& x) { return mass.dot(x.col(2)) / mass.sum(); };

  NodalVectors x = network.X, v = NodalVectors::Zero(x.rows(), 3);
  double time = 0, touched = 0, lowest = height(x), highest = 0;
  while (time < 1 && (touched == 0 || time < 2 * touched + 0.05)) {
    const NodalVectors f = forces(file.model, x);
    for (Eigen::Index n = 0; n < x.rows(); ++n) {  // semi-implicit Euler
      v.row(n) += dt * (f.row(n) * per_mass[n] + gravity);
      x.row(n) += dt * v.row(n);
      if (x(n, 2) >= floor) continue;
      x(n, 2) = floor;  // the plane takes the momentum of what meets it
      v(n, 2) = std::max(v(n, 2), 0.0);
      if (touched == 0) touched = time;
    }
    carry(network.cells.carried, x);  // of cells of several sizes: nodes that follow others
    carry(network.cells.carried, v);
    time += dt;
    if (height(x) < lowest) {
      lowest = height(x);
      highest = lowest;
    }
    highest = std::max(highest, height(x));
  }
  // What a program draws: the surface, carried by the nodes.
  const NodalVectors drawn = file.surface.weights * x;
  std::printf(
      "%ld nodes, %.4g kg, steps of %.3g s: touches at %.4f s, rebounds by %.3g of its size, %ld vertices drawn\n",
      long(x.rows()), mass.sum(), dt, touched, (highest - lowest) / size, long(drawn.rows()));
  return touched > 0 && highest > lowest ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 2;
}
