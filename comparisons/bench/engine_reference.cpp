#include "comparisons/bench/engine_reference.h"

#include <cmath>

#include "comparisons/bench/interrupt.h"
#include "fem_reference/exchange/reference.h"
#include "meshes/mesher/mesher.h"
#include "problem/case_file/experiment.h"

namespace springproof::bench {
namespace {

constexpr double towards_faces = 1.5;  // grading, as that of references of cases

fem::Request request_of_bar(std::vector<Load> loads, double poisson_ratio) {
  Body named;
  named.geo = "block.geo";
  fem::Request request;
  request.name = "bar";
  request.geo = find_geo(named, {});
  request.size = Vec3(4, 1, 1);
  request.material = bar_material(poisson_ratio);
  request.loads = std::move(loads);
  request.tolerance = 1e-8;
  for (const int n : {2, 4, 8}) request.grids.push_back({{4 * n, n, n}, "q2", towards_faces});
  return request;
}

std::vector<fem::Solution> solved(const fem::Request& request) {
  const std::vector<fem::Solution> solutions = fem::solve(request);
  throw_if_interrupted();
  for (const fem::Solution& s : solutions)
    if (!s.ok) throw std::runtime_error("the finite element reference failed: " + s.message);
  return solutions;
}

}  // namespace

ReferenceValue bar_reference(BarLoad load, double poisson_ratio) {
  const EngineBar bar = engine_bar({4, 2, 2});
  fem::Request request = request_of_bar(loads_of(load), poisson_ratio);
  request.points.resize(Eigen::Index(bar.watched.size()), 3);
  for (std::size_t i = 0; i < bar.watched.size(); ++i)
    request.points.row(Eigen::Index(i)) = bar.mesh.nodes.row(bar.watched[i]);
  std::vector<double> values;
  for (const fem::Solution& s : solved(request))
    values.push_back(load == BarLoad::pressure ? s.volume_change_first_order
                                               : measure_of_face(load, request.points, s.displacement, bar.weights));
  return extrapolate(values, solver_noise * std::abs(values.back()));
}

ReferenceValue bar_frequency(double poisson_ratio) {
  fem::Request request = request_of_bar({PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}}, poisson_ratio);
  request.modes = 2;
  request.points = NodalVectors::Zero(1, 3);
  request.grids.clear();
  for (const int n : {2, 3, 4}) request.grids.push_back({{4 * n, n, n}, "q2", towards_faces});
  std::vector<double> values;
  for (const fem::Solution& s : solved(request)) values.push_back(s.frequencies.at(0));
  return extrapolate(values, solver_noise * values.back(), clamped_order, {1.5, 4.0 / 3});
}

}  // namespace springproof::bench
