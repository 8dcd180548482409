// Errors of a pilot's models on lattices beyond those that were solved.
#include <algorithm>
#include <cmath>

#include "comparisons/advise/pilot.h"

namespace springproof {
namespace {

constexpr double slowest = 0.5, fastest = 2;  // orders at which errors may fall

double product(const NodalVectors& a, const NodalVectors& b, const Eigen::VectorXd& weights) {
  return weights.dot(a.cwiseProduct(b).rowwise().sum());
}

/// The order at which the last two of three steps along an error fall, edges h; between `slowest` and `fastest`.
double order_of_errors(double coarse, double fine, double ratio) {
  if (!(coarse > 0) || !(fine > 0)) return fastest;
  return std::clamp(std::log(coarse / fine) / std::log(ratio), slowest, fastest);
}

/// By how much too stiff a body is whose displacements are short by an error; an error beyond it stays as it is.
double stiffness_excess(double error) { return error < 0.9 ? error / (1 - error) : 10 * error; }

}  // namespace

void extrapolate_errors(PilotModel& model) {
  const std::size_t n = model.cells.size();
  const double last = model.errors[n - 1];
  model.beyond = {0, 0, last * last};
  if (n < 2) return;
  const double ratio = std::cbrt(model.cells[n - 1] / model.cells[n - 2]);
  model.order = order_of_errors(stiffness_excess(model.errors[n - 2]), stiffness_excess(last), ratio);
}

void extrapolate_fields(PilotModel& model, const std::vector<NodalVectors>& fields, const NodalVectors& truth,
                        const Eigen::VectorXd& weights, double share) {
  const std::size_t n = model.cells.size();
  const auto step = [&](std::size_t i) { return NodalVectors(fields[i] - fields[i - 1]); };
  const auto length = [&](const NodalVectors& u) { return std::sqrt(product(u, u, weights)); };
  const double ratio = std::cbrt(model.cells[n - 1] / model.cells[n - 2]),
               size = share * share * product(truth, truth, weights);
  if (n > 2) model.order = order_of_errors(length(step(n - 2)), length(step(n - 1)), ratio);
  const NodalVectors b = -step(n - 1) / (std::pow(ratio, model.order) - 1), a = fields.back() - truth - b;
  model.beyond = {product(a, a, weights) / size, product(a, b, weights) / size, product(b, b, weights) / size};
}

const PilotModel* Pilot::find(const std::string& label) const {
  for (const auto* list : {&models, &elements})
    for (const PilotModel& m : *list)
      if (m.label == label) return &m;
  return nullptr;
}

Prediction predict(const Pilot& pilot, const PilotModel& model, double cells) {
  const auto& n = model.cells;
  const auto& e = model.errors;
  Prediction out;
  if (n.empty()) return {1, 10, true};
  constexpr double off = 1e-3;  // of a number of cells, which a cut body does not have exactly
  if (cells > n.back() * (1 + off)) {
    const double t = std::pow(n.back() / cells, model.order / 3);
    const double excess = stiffness_excess(std::sqrt(model.beyond.bb)) * t;
    out.error = model.beyond.aa > 0 ? std::sqrt(std::max(0.0, model.beyond.at(t))) : excess / (1 + excess);
    out.beyond = true;
  } else {
    std::size_t i = 1;
    while (i + 1 < n.size() && n[i] < cells) ++i;
    if (n.size() == 1) return {e[0], 2, true};
    const double part = std::log(cells / n[i - 1]) / std::log(n[i] / n[i - 1]);
    out.error = std::exp((1 - part) * std::log(std::max(e[i - 1], 1e-12)) + part * std::log(std::max(e[i], 1e-12)));
    out.beyond = part < -off;
  }
  const double far = cells > n.back() ? std::cbrt(cells / n.back()) : 1;
  out.factor = (1.05 + 0.7 * pilot.uncertainty / std::max(out.error, 1e-12)) * std::sqrt(far);
  return out;
}

}  // namespace springproof
