#include "comparisons/judge/line_measure.h"

#include <algorithm>
#include <cmath>

#include "msm/measure/local_fields.h"

namespace springproof {
namespace {

constexpr double strain_reach = 2, stress_reach = 2;  // mean spacings

constexpr std::array<const char*, 6> components = {"xx", "yy", "zz", "xy", "yz", "xz"};
constexpr std::array<std::array<int, 2>, 6> places = {{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

void append(const Eigen::Matrix3d& tensor, LineTensors& out) {
  for (const auto& [i, j] : places) out.push_back(tensor(i, j));
}

/// The springs within `reach` of the line, so that not every spring is visited for every point.
Network near_line(const Network& network, const Line& line, double reach, std::vector<double>& tensions) {
  Network near;
  near.X = network.X;
  std::vector<double> kept;
  const Vec3 along = line.to - line.from;
  const auto distance = [&](const Vec3& p) {
    return (p - line.from - std::clamp(along.dot(p - line.from) / along.squaredNorm(), 0.0, 1.0) * along).norm();
  };
  for (std::size_t s = 0; s < tensions.size(); ++s) {
    const Spring& spring = network.springs[s];
    const Vec3 a = network.X.row(spring.i), b = network.X.row(spring.j);
    if (distance((a + b) / 2) > reach + (b - a).norm() / 2) continue;
    near.springs.push_back(spring);
    kept.push_back(tensions[s]);
  }
  tensions = std::move(kept);
  return near;
}

/// Norm of a symmetric tensor given as xx yy zz xy yz xz.
double norm(const std::array<double, 6>& t) {
  double sum = 0;
  for (int c = 0; c < 6; ++c) sum += (c < 3 ? 1 : 2) * t[c] * t[c];
  return std::sqrt(sum);
}

void add_deviations(const std::string& name, const LineRecord& record, const LineTensors& ours,
                    const LineTensors& exact, std::map<std::string, double>& out) {
  std::array<double, 6> off{}, size{};
  double off_all = 0, size_all = 0;
  for (int p = record.first - 1; p < record.last; ++p) {
    std::array<double, 6> difference, value;
    for (int c = 0; c < 6; ++c) {
      value[c] = exact[6 * p + c];
      difference[c] = ours[6 * p + c] - value[c];
      off[c] += std::abs(difference[c]);
      size[c] += std::abs(value[c]);
    }
    off_all += norm(difference);
    size_all += norm(value);
  }
  for (int c = 0; c < 6; ++c)
    out[name + "." + components[c]] = off[c] / (size[c] > 1e-9 * size_all ? size[c] : size_all);
  out[name + ".all"] = off_all / size_all;
}

/// Rows of one measure and model, coarse lattices first.
std::vector<Row> over_lattices(const std::vector<Row>& rows, const Row& like) {
  std::vector<Row> found;
  for (const Row& r : rows)
    if (r.measure == like.measure && r.model == like.model) found.push_back(r);
  std::ranges::stable_sort(found, [](const Row& a, const Row& b) { return a.cells[0] < b.cells[0]; });
  return found;
}

}  // namespace

LineRecord sample_line(const Line& line, const KelvinSolution& solution, const MassSpringModel& model,
                       const NodalVectors& u) {
  LineRecord record;
  record.first = line.middle[0];
  record.last = line.middle[1];
  const double spacing = std::cbrt(model.network.volume.sum() / model.network.nodes());
  std::vector<double> tensions = linear_tensions(model, u);
  const Network near = near_line(model.network, line, stress_reach * spacing, tensions);
  for (int i = 1; i <= line.points; ++i) {
    const Vec3 p = point_of(line, i);
    record.distance.push_back((p - line.from).norm());
    const Eigen::Matrix3d gradient = displacement_gradient(model.network, u, p, strain_reach * spacing);
    append((gradient + gradient.transpose()) / 2, record.strain);
    append(kelvin_strain(solution, p), record.exact_strain);
    append(kelvin_stress(solution, p), record.exact_stress);
    if (consists_of<Springs, MomentumDispersion>(model))
      append(hardy_stress(near, near.X, tensions, p, stress_reach * spacing), record.stress);
  }
  return record;
}

std::map<std::string, double> line_deviations(const LineRecord& record) {
  std::map<std::string, double> out;
  add_deviations("line.strain", record, record.strain, record.exact_strain, out);
  if (!record.stress.empty()) add_deviations("line.stress", record, record.stress, record.exact_stress, out);
  return out;
}

void add_line_orders(const Experiment& experiment, std::vector<Row>& rows) {
  std::vector<Row> orders;
  for (const ModelChoice& choice : experiment.models)
    for (const std::string field : {"line.strain", "line.stress"}) {
      Row like;
      like.model = choice.label;
      like.measure = field + ".all";
      const std::vector<Row> series = over_lattices(rows, like);
      for (std::size_t i = 1; i < series.size(); ++i) {
        Row order = series[i];
        order.measure = field + ".order";
        order.value = std::log(series[i - 1].value / series[i].value) /
                      std::log(double(series[i].cells[0]) / series[i - 1].cells[0]);
        order.spread = order.error = {};
        orders.push_back(order);
      }
    }
  rows.insert(rows.end(), orders.begin(), orders.end());
}

}  // namespace springproof
