#include "comparisons/models/external.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "comparisons/prepare/sampling.h"
#include "comparisons/reference/reference_grids.h"
#include "meshes/volume.h"
#include "problem/system/nearest_name.h"

namespace springproof {
namespace {

template <class T>
T option_of(const ModelChoice& choice, const std::string& key, T otherwise) {
  const auto found = choice.options.find(key);
  return found == choice.options.end() ? otherwise : std::get<T>(found->second);
}

double poisson_ratio_of(const ModelChoice& choice) { return option_of(choice, "poisson_ratio", 0.0); }

bool is_y_up(const ModelChoice& choice) { return option_of<std::string>(choice, "up_axis", "z") == "y"; }

std::string vector_text(const Vec3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v[0], v[1], v[2]); }

std::string sizes_text(const Vec3& v) { return fmt::format("{:.4g} x {:.4g} x {:.4g} m", v[0], v[1], v[2]); }

Vec3 extent_of(const NodalVectors& X) { return (X.colwise().maxCoeff() - X.colwise().minCoeff()).transpose(); }

/// An entry with its points.
struct External {
  const PreparedCase& prepared;
  const ModelChoice& choice;
  ExternalPoints points;
  std::size_t lattice;  ///< number of the one that it is compared on
  ScatteredField field;

  const Mesh& mesh() const { return *prepared.lattices[lattice].mesh; }

  [[noreturn]] void fail(const std::string& message, int line = 0) const {
    throw InputError({choice.file.string(), line, line > 0 ? 1 : 0}, message);
  }
};

/// The lattice whose number of nodes is nearest to the number of points, by their ratio.
std::size_t lattice_for(const PreparedCase& prepared, double points) {
  const auto distance = [&](const Lattice& l) { return std::abs(std::log(double(l.mesh->nodes.rows()) / points)); };
  const auto& all = prepared.lattices;
  return static_cast<std::size_t>(
      std::ranges::min_element(all, [&](const Lattice& a, const Lattice& b) { return distance(a) < distance(b); }) -
      all.begin());
}

External read_external(const PreparedCase& prepared, std::size_t number) {
  const ModelChoice& choice = prepared.experiment.models[number];
  ExternalPoints points =
      read_external_points(choice.file, {option_of(choice, "scale", 1.0), is_y_up(choice), poisson_ratio_of(choice)});
  const std::size_t lattice = lattice_for(prepared, double(points.X.rows()));
  ScatteredField field(points.X, points.u);
  return {prepared, choice, std::move(points), lattice, std::move(field)};
}

/// Points in another unit: their extent is that of the body to a factor of more than three.
void check_units(const External& e) {
  const Vec3 body = extent_of(e.mesh().nodes), data = extent_of(e.points.X);
  const double scale = option_of(e.choice, "scale", 1.0);
  const Named unit = unit_in(e.prepared.experiment.units, "m");
  if (data.maxCoeff() > 0) {
    const double times = body.maxCoeff() / data.maxCoeff(), digits = std::log10(times);
    if (std::abs(digits) > 0.5)
      e.fail(fmt::format(
          "the points span {}, the body {}: {} (allowed: scale in [[external]] such that lengths are in {}, "
          "perhaps scale = {:g})",
          sizes_text(data), sizes_text(body),
          digits < 0 ? fmt::format("{:.4g} times too large", 1 / times) : fmt::format("{:.4g} times too small", times),
          unit.name, scale / unit.in_si * std::pow(10, std::round(digits))));
  }
  Eigen::Index at = 0;
  if (const double largest = e.points.u.rowwise().norm().maxCoeff(&at); largest > 10 * body.norm())
    e.fail(fmt::format("the displacement is {:.4g} m, and the body spans {} (allowed: up to ten times its size; rest "
                       "positions and displacements in one unit, with scale in [[external]] m)",
                       largest, sizes_text(body)),
           e.points.lines[at]);
}

/// Points that are not in the body: farther from its nodes than these, or the points, are from each other.
void check_inside(const External& e) {
  const ScatteredField nodes(e.mesh().nodes, e.mesh().nodes);
  const double allowed = 1.5 * std::max(nodes.spacing(), e.field.spacing());
  for (Eigen::Index n = 0; n < e.points.X.rows(); ++n) {
    const Vec3 p = e.points.X.row(n).transpose();
    const double distance = nodes.distance(p);
    if (distance <= allowed) continue;
    const Vec3 low = e.mesh().nodes.colwise().minCoeff().transpose(), high = low + extent_of(e.mesh().nodes);
    e.fail(fmt::format("the point {} m is {:.4g} m from the nearest node of the body, which reaches from {} to {} m "
                       "(allowed: up to {:.4g} m; scale and up_axis = \"{}\" in [[external]] turn the file's axes and "
                       "unit into the case's)",
                       vector_text(p), distance, vector_text(low), vector_text(high), allowed,
                       is_y_up(e.choice) ? "z" : "y"),
           e.points.lines[n]);
  }
}

/// Where displacements are wanted: at the nodes of the lattice, or, for the nodes of a body of voxels that lie outside
/// of it, at the points within from which theirs follow.
struct WantedPoints {
  NodalVectors at;
  bool at_nodes;  ///< of the lattice
};

WantedPoints wanted_points(const External& e) {
  const NodalVectors& nodes = e.mesh().nodes;
  bool all = true;
  for (Eigen::Index n = 0; n < nodes.rows() && all; ++n) all = e.field.is_at(nodes.row(n).transpose());
  if (all || e.prepared.samples.of_nodes.empty()) return {nodes, true};
  return {e.prepared.samples.points, false};
}

/// Typical distance of the points from each other, also of such that lie in pairs [m].
double spacing_of(const External& e) {
  return std::max(e.field.spacing(), std::cbrt(volume(e.mesh(), e.mesh().nodes) / double(e.points.X.rows())));
}

/// Several states of one point, as in a file of several times.
void check_one_state(const External& e) {
  const double allowed = 1e-3 * e.points.u.rowwise().norm().maxCoeff();
  for (Eigen::Index n = 0; n < e.points.X.rows(); ++n)
    for (const int other : e.field.points_at(e.points.X.row(n).transpose()))
      if (other < n && (e.points.u.row(n) - e.points.u.row(other)).norm() > allowed)
        e.fail(fmt::format("is the point of line {} with another displacement, {} and {} m (allowed: one state of the "
                           "body in a file)",
                           e.points.lines[other], vector_text(e.points.u.row(n)), vector_text(e.points.u.row(other))),
               e.points.lines[n]);
}

/// A body that lies elsewhere or is longer: an end of the points is farther than half their spacing from that of the
/// body, of a body of voxels from that of its cells and of the body itself.
void check_ends(const External& e) {
  const double allowed = 0.5 * spacing_of(e);
  std::vector<const NodalVectors*> bodies = {&e.mesh().nodes};
  if (!e.prepared.body.tetrahedra.empty()) bodies.push_back(&e.prepared.body.tetrahedra.back()->nodes);
  const auto ends = [](const NodalVectors& X, int axis) {
    return Eigen::Vector2d(X.col(axis).minCoeff(), X.col(axis).maxCoeff());
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector2d data = ends(e.points.X, axis);
    Eigen::Vector2d off = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
    for (const NodalVectors* body : bodies) off = off.cwiseMin((ends(*body, axis) - data).cwiseAbs());
    if (off.maxCoeff() <= 1.001 * allowed) continue;
    const Eigen::Vector2d body = ends(*bodies.back(), axis);
    e.fail(
        fmt::format("the points reach along {} from {:.6g} to {:.6g} m, the body from {:.6g} to {:.6g} m (allowed: "
                    "ends that differ by up to {:.4g} m, half the spacing of the points; move the points to where "
                    "the body of the case lies)",
                    "xyz"[axis], data[0], data[1], body[0], body[1], allowed));
  }
}

/// A node where nothing is known: no point within the spacing of the points.
void check_covered(const External& e) {
  const double allowed = 1.1 * spacing_of(e);
  const auto covered = [&](const Vec3& p) { return e.field.distance(p) <= allowed; };
  const auto refuse_gap = [&](const std::string& what) {
    e.fail(
        fmt::format("{} (allowed: points all over the body, also inside, no farther apart than {:.4g} m, the "
                    "spacing of these {})",
                    what, allowed, e.points.X.rows()));
  };
  for (const Patch& patch : e.mesh().patches) {
    const std::vector<int> nodes = nodes_of(patch);
    if (std::ranges::none_of(nodes, [&](int n) { return covered(e.mesh().nodes.row(n).transpose()); }))
      refuse_gap(fmt::format("there is no point near the patch '{}'", patch.name));
  }
  const WantedPoints wanted = wanted_points(e);
  for (Eigen::Index n = 0; n < wanted.at.rows(); ++n)
    if (const Vec3 p = wanted.at.row(n).transpose(); !covered(p))
      refuse_gap(fmt::format("there is no point near {} m, where the body is compared; the nearest is {:.4g} m away",
                             vector_text(p), e.field.distance(p)));
}

void check_reactions(const External& e) {
  std::vector<std::string> patches;
  for (const Patch& p : e.mesh().patches) patches.push_back(p.name);
  for (const auto& [key, value] : e.choice.options) {
    if (!key.starts_with("force.")) continue;
    const std::string patch = key.substr(6, key.size() - 8);
    if (std::ranges::find(patches, patch) == patches.end())
      throw InputError(e.choice.where, fmt::format("external.reaction_N: the body has no patch '{}' (allowed: {}){}",
                                                   patch, fmt::join(patches, ", "), did_you_mean(patch, patches)));
  }
}

/// At the nodes of its lattice.
NodalVectors displacement_of(const External& e) try {
  const WantedPoints wanted = wanted_points(e);
  NodalVectors u(wanted.at.rows(), 3);
  for (Eigen::Index n = 0; n < u.rows(); ++n) u.row(n) = e.field.at(wanted.at.row(n).transpose()).transpose();
  return wanted.at_nodes ? u : at_nodes(e.prepared.lattices[e.lattice], at_lattice_nodes(e.prepared, u));
} catch (const std::invalid_argument& error) {
  e.fail(fmt::format("{} (allowed: points all over the body, also inside)", error.what()));
}

/// The given force on each patch of reaction_N, as rows of the measure reaction.
void add_reactions(const ModelChoice& choice, std::map<std::string, double>& scalars) {
  std::map<std::string, double> squares;
  for (const auto& [key, value] : choice.options) {
    if (!key.starts_with("force.")) continue;
    const double force = std::get<double>(value);
    scalars[key] = force;
    squares[key.substr(0, key.size() - 2)] += force * force;
  }
  for (const auto& [patch, square] : squares) scalars[patch + ".magnitude"] = std::sqrt(square);
}

/// What makes displacements 10^digits times as large.
std::string cause_of(int digits) {
  struct Units {
    int digits;
    const char *length, *modulus;
  };
  for (const auto& [of, length, modulus] : {Units{2, "cm", ""}, {3, "mm", "kPa"}, {6, "um", "MPa"}, {9, "nm", "GPa"}})
    if (std::abs(digits) == of) {
      const auto taken = [&](const char* small, const char* SI) {
        return digits > 0 ? fmt::format("in {} taken for {}", small, SI) : fmt::format("in {} taken for {}", SI, small);
      };
      return fmt::format("displacements {}{}", taken(length, "m"),
                         *modulus ? ", or a modulus " + taken(modulus, "Pa") : "");
    }
  return "another unit of displacement, load or modulus";
}

}  // namespace

std::string unit_doubt(const NodalVectors& u, const NodalVectors& reference) {
  const double factor = u.norm() / reference.norm();
  if (!(factor > 0) || !std::isfinite(factor)) return {};
  const int digits = static_cast<int>(std::lround(std::log10(factor)));
  const double power = std::pow(10, digits);
  if (digits == 0 || (u / power - reference).norm() > 0.2 * reference.norm()) return {};
  return fmt::format("the displacements are {:g} times those of the reference; {} would explain it", power,
                     cause_of(digits));
}

ModelParameters parameters_of_external(const ModelChoice& choice) {
  ModelParameters p{};  // without an extension
  p.row.name = choice.label;
  p.row.what = external_model;
  p.row.topology = Topology::file;
  p.cut = false;
  return p;
}

void check_external(const PreparedCase& prepared, std::size_t number) {
  const External e = read_external(prepared, number);
  check_units(e);
  check_inside(e);
  check_one_state(e);
  check_covered(e);
  check_ends(e);
  check_reactions(e);
  displacement_of(e);
}

std::vector<ModelSample> external_samples(const PreparedCase& prepared, const Lattice& lattice, std::size_t number,
                                          const IsotropicMaterial& material) {
  if (!same_poisson_ratio(poisson_ratio_of(prepared.experiment.models[number]),
                          prepared.experiment.setting_of(material)))
    return {};
  const External e = read_external(prepared, number);
  if (&lattice != &prepared.lattices[e.lattice]) return {};
  const NodalVectors& nodes = e.mesh().nodes;
  Eigen::Index given = 0;
  for (Eigen::Index n = 0; n < nodes.rows(); ++n) given += e.field.is_at(nodes.row(n).transpose());
  ModelSample sample;
  sample.state.ok = true;
  sample.state.solver = fmt::format("{} points of {}, at {} of {} nodes", e.points.X.rows(),
                                    e.choice.file.filename().string(), given, nodes.rows());
  sample.field.mesh = lattice.mesh;
  sample.field.displacement = displacement_of(e);
  sample.field.volume_change = volume_change(e.mesh(), sample.field.displacement);
  sample.field.volume_change_first_order = volume_change_first_order(e.mesh(), sample.field.displacement);
  sample.scalars =
      field_measures(prepared, sample.field, at_measured_points(prepared, lattice, sample.field.displacement));
  if (given < nodes.rows())
    std::erase_if(sample.scalars, [](const auto& s) { return s.first.starts_with("volume_change"); });
  add_reactions(e.choice, sample.scalars);
  return {sample};
}

}  // namespace springproof
