#include "msm/exchange/springs_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "msm/exchange/json_place.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

using Json = nlohmann::ordered_json;
using Keys = std::vector<std::string>;

/// @throws InputError for numbers that a reader of the file refuses.
void require_readable(const Keys& keys, const std::vector<double>& values, double least = 0) {
  for (const double x : values)
    if (!(std::abs(x) >= least && std::abs(x) <= largest_number_of_file))
      throw InputError(
          fmt::format("{} of the springs file: {:g} (allowed: {:g} to {:g} in size; choose another size, "
                      "density or Young's modulus)",
                      fmt::join(keys, "."), x, least, largest_number_of_file));
}

class DocumentWriter {
 public:
  Json& at(const Keys& keys) {
    Json* place = &document.head;
    for (const std::string& key : keys) place = &(*place)[key];
    return *place;
  }

  template <class T>
  void array(const Keys& keys, std::vector<std::size_t> shape, std::vector<T> values) {
    const std::string name = fmt::format("{}", fmt::join(keys, "."));
    at(keys) = "npy:" + name;
    document.arrays.push_back({name, std::move(shape), std::move(values)});
  }

  void vectors(const Keys& keys, const NodalVectors& x) {
    array<double>(keys, {static_cast<std::size_t>(x.rows()), 3}, {x.data(), x.data() + x.size()});
  }

  /// @param least in size
  void numbers(const Keys& keys, std::vector<double> values, double least = 0) {
    require_readable(keys, values, least);
    const std::size_t count = values.size();
    array<double>(keys, {count}, std::move(values));
  }

  void indices(const Keys& keys, const std::vector<int>& values) {
    array<std::int32_t>(keys, {values.size()}, {values.begin(), values.end()});
  }

  template <std::size_t n>
  void rows(const Keys& keys, const std::vector<std::array<int, n>>& values) {
    std::vector<std::int32_t> flat;
    for (const auto& row : values) flat.insert(flat.end(), row.begin(), row.end());
    array<std::int32_t>(keys, {values.size(), n}, std::move(flat));
  }

  SpringsDocument document;
};

/// Writes the parameters that a law names by its function `fields`.
class LawWriter {
 public:
  LawWriter(DocumentWriter& writer, Keys law, const Network& network)
      : writer_(writer), law_(std::move(law)), network_(network) {
    writer_.at(law_) = Json::object();
  }

  void number(const char* key, double value, double = 0, double = 0) {
    require_readable(with(key), {value});
    writer_.at(law_)[key] = value;
  }
  void flag(const char* key, bool value) { writer_.at(law_)[key] = value; }
  template <class Enum>
  void choice(const char* key, Enum value) {
    writer_.at(law_)[key] = name_of(value);
  }
  void of_springs(const char* key, const std::vector<double>& values) {
    if (!values.empty()) rows(key, network_.springs.size(), values);
  }
  void of_nodes(const char* key, const std::vector<int>& values) {
    if (!values.empty()) writer_.indices(with(key), values);
  }
  void of_cells(const char* key, const std::vector<double>& values, int = 1) {
    rows(key, network_.cells.size(), values);
  }

 private:
  /// So many rows of equal length; of single numbers a list.
  void rows(const char* key, std::size_t count, const std::vector<double>& values) {
    if (values.size() == count)
      writer_.numbers(with(key), values);
    else
      writer_.array<double>(with(key), {count, values.size() / count}, values);
  }
  Keys with(const char* key) const {
    Keys keys = law_;
    keys.emplace_back(key);
    return keys;
  }

  DocumentWriter& writer_;
  Keys law_;
  const Network& network_;
};

Json origin_json(const SpringsOrigin& origin) {
  Json options = Json::object();
  for (const auto& [key, value] : origin.options) std::visit([&, &k = key](const auto& v) { options[k] = v; }, value);
  return {{"program", origin.program},
          {"model", origin.model},
          {"options", options},
          {"input", origin.input},
          {"checksum_xxh3_128", origin.checksum}};
}

Json moduli_json(const IsotropicMaterial& m) {
  return {{"youngs_modulus_Pa", m.youngs_modulus}, {"poisson_ratio", m.poisson_ratio}};
}

Json region_json(const SpringsRegion& region) {
  Json out = {{"name", region.name}};
  out.update(moduli_json(region.material));
  out["density_kg_m3"] = region.material.density;
  return out;
}

/// Moments of the filled parts (meshes/voxels/filled_part.h).
void add_filled(const std::vector<FilledPart>& filled, DocumentWriter& out) {
  std::vector<double> fraction;
  for (const FilledPart& part : filled) fraction.push_back(part.fraction);
  out.numbers({"cells", "fraction"}, std::move(fraction));
  for (const auto& [key, moment] :
       {std::pair("mean", &FilledPart::mean), {"mixed", &FilledPart::mixed}, {"variance", &FilledPart::variance}}) {
    NodalVectors rows(filled.size(), 3);
    for (std::size_t c = 0; c < filled.size(); ++c)
      rows.row(static_cast<Eigen::Index>(c)) = (filled[c].*moment).transpose();
    out.vectors({"cells", key}, rows);
  }
}

void add_cells(const CellSet& cells, DocumentWriter& out) {
  if (cells.kind() == CellKind::sizes)
    out.numbers({"cells", "edge_m"}, cells.edges);
  else
    out.at({"cells", "edge_m"}) = cells.edge;
  if (cells.kind() == CellKind::boxes)
    out.at({"cells", "proportions"}) = {cells.proportions[0], cells.proportions[1], cells.proportions[2]};
  out.rows({"cells", "nodes"}, cells.corners);
  if (cells.cut()) add_filled(cells.filled, out);
  if (!cells.materials.empty()) out.indices({"cells", "material"}, {cells.materials.begin(), cells.materials.end()});
  if (cells.carried.empty()) return;
  std::vector<int> nodes;
  std::vector<std::array<int, 4>> by;
  for (const CarriedPoint& c : cells.carried) {
    nodes.push_back(c.point);
    for (std::array<int, 4>& of = by.emplace_back(); int& node : of) node = c.by[(&node - of.data()) % c.by.size()];
  }
  out.indices({"carried", "nodes"}, nodes);
  out.rows({"carried", "by"}, by);
}

void add_bonds(const std::vector<InterfaceBond>& bonds, DocumentWriter& out) {
  std::vector<std::array<int, 16>> nodes;
  std::vector<double> weights, stiffness;
  for (const InterfaceBond& b : bonds) {
    std::array<int, 16>& both = nodes.emplace_back();
    for (int side = 0; side < 2; ++side) {
      std::copy(b.corners[side].begin(), b.corners[side].end(), both.begin() + 8 * side);
      weights.insert(weights.end(), b.weights[side].begin(), b.weights[side].end());
    }
    stiffness.insert(stiffness.end(), b.stiffness.data(), b.stiffness.data() + 9);
  }
  out.rows({"bonds", "nodes"}, nodes);
  out.array<double>({"bonds", "weights"}, {bonds.size(), 16}, std::move(weights));
  require_readable({"bonds", "stiffness_N_m"}, stiffness);
  out.array<double>({"bonds", "stiffness_N_m"}, {bonds.size(), 9}, std::move(stiffness));
}

void add_network(const Network& network, double density, DocumentWriter& out) {
  out.vectors({"nodes", "position_m"}, network.X);
  const Eigen::VectorXd mass = masses(network, density);
  const double least_mass =
      network.cells.carried.empty() ? smallest_of_file : 0;  // what is carried has its mass elsewhere
  out.numbers({"nodes", "mass_kg"}, {mass.begin(), mass.end()}, least_mass);
  if (network.attached.size() > 0)
    out.numbers({"nodes", "attached_kg"}, {network.attached.begin(), network.attached.end()});
  std::vector<std::array<int, 2>> ends;
  std::vector<double> stiffness, rest_length;
  for (const Spring& s : network.springs) {
    ends.push_back({s.i, s.j});
    stiffness.push_back(s.stiffness);
    rest_length.push_back(s.rest_length);
  }
  out.rows({"springs", "nodes"}, ends);
  out.numbers({"springs", "stiffness_N_m"}, std::move(stiffness), smallest_of_file);
  out.numbers({"springs", "rest_length_m"}, std::move(rest_length), smallest_of_file);
  if (!network.cells.empty()) add_cells(network.cells, out);
  if (!network.bonds.empty()) add_bonds(network.bonds, out);
  if (!network.triangles.empty()) out.rows({"triangles"}, network.triangles);
}

/// The constants of the other materials.
void add_regions(const AveragedSprings& law, Keys keys, const Network& network, DocumentWriter& out) {
  keys.emplace_back("regions");
  Json list = Json::array();
  for (AveragedSprings region : law.regions) {
    LawWriter writer(out, keys, network);
    region.fields(writer);
    list.push_back(out.at(keys));
  }
  if (!list.empty()) out.at(keys) = std::move(list);
}

void add_laws(const MassSpringModel& model, DocumentWriter& out) {
  out.at({"laws"}) = Json::object();
  for (const ForceLaw& law : model.laws) {
    if (std::holds_alternative<Anchors>(law) && !model.network.bonds.empty()) continue;  // bonds act by being there
    const Keys keys = {"laws", key_of_law(traits(law))};
    if (out.at({"laws"}).contains(keys.back()))
      throw std::invalid_argument(fmt::format("a springs file has one {} only", traits(law).name));
    LawWriter writer(out, keys, model.network);
    std::visit([&](auto l) { l.fields(writer); }, law);
    if (const auto* averaged = std::get_if<AveragedSprings>(&law)) add_regions(*averaged, keys, model.network, out);
  }
}

void add_anchors(const std::string& patch, const std::vector<Anchor>& anchors, const NodalVectors& X,
                 DocumentWriter& out) {
  std::vector<Hexahedron> corners;
  std::vector<double> weights, stiffness;
  NodalVectors points(anchors.size(), 3);
  for (const Anchor& a : anchors) {
    points.row(static_cast<Eigen::Index>(corners.size())) = anchored_point(a, X).transpose();
    corners.push_back(a.corners);
    weights.insert(weights.end(), a.weights.begin(), a.weights.end());
    stiffness.insert(stiffness.end(), a.stiffness.data(), a.stiffness.data() + 9);
  }
  out.vectors({"anchors", patch, "position_m"}, points);
  out.rows({"anchors", patch, "nodes"}, corners);
  out.array<double>({"anchors", patch, "weights"}, {anchors.size(), 8}, std::move(weights));
  out.array<double>({"anchors", patch, "stiffness_N_m"}, {anchors.size(), 9}, std::move(stiffness));
}

void add_load(const std::string& patch, const PatchShares& shares, DocumentWriter& out) {
  std::vector<int> nodes;
  std::vector<double> area;
  for (Eigen::Index n = 0; n < shares.area.size(); ++n)
    if (shares.area[n] != 0) {
      nodes.push_back(static_cast<int>(n));
      area.push_back(shares.area[n]);
    }
  NodalVectors normal(nodes.size(), 3);
  for (std::size_t n = 0; n < nodes.size(); ++n) normal.row(static_cast<Eigen::Index>(n)) = shares.normal.row(nodes[n]);
  out.indices({"loads", patch, "nodes"}, nodes);
  out.numbers({"loads", patch, "area_m2"}, std::move(area));
  out.vectors({"loads", patch, "normal_m2"}, normal);
}

void add_surface(const EmbeddedSurface& surface, DocumentWriter& out) {
  if (surface.vertices.rows() == 0) return;
  out.vectors({"surface", "position_m"}, surface.vertices);
  out.rows({"surface", "facets"}, surface.facets);
  std::vector<int> first = {0}, nodes;
  std::vector<double> weights;
  for (Eigen::Index v = 0; v < surface.weights.rows(); ++v) {
    for (decltype(surface.weights)::InnerIterator at(surface.weights, v); at; ++at) {
      nodes.push_back(static_cast<int>(at.col()));
      weights.push_back(at.value());
    }
    first.push_back(static_cast<int>(nodes.size()));
  }
  out.indices({"surface", "first"}, first);
  out.indices({"surface", "nodes"}, nodes);
  out.numbers({"surface", "weights"}, std::move(weights));
}

/// Branches, and the constants of the cells that these have the shares of; of measured cells those are the law's.
void add_relaxation(const RelaxingCells& relaxing, DocumentWriter& out) {
  if (!relaxing.acts()) return;
  std::vector<double> share, time;
  for (const RelaxationBranch& b : relaxing.relaxation.branches) {
    share.push_back(b.share);
    time.push_back(b.time);
  }
  out.numbers({"relaxation", "share"}, std::move(share));
  out.numbers({"relaxation", "time_s"}, std::move(time), smallest_of_file);
  if (relaxing.of_measured()) return;
  for (const auto& [key, value] : branch_constants(relaxing.cells)) {
    require_readable({"relaxation", key}, {value});
    out.at({"relaxation", key}) = value;
  }
}

/// What branches pull with after the steps of the check.
void add_check_of_branches(const SpringsFile& springs, const NodalVectors& x, DocumentWriter& out) {
  if (!springs.relaxing.acts()) return;
  const Network& network = springs.model.network;
  Overstrains branches(network, springs.relaxing);
  std::vector<double> duration, progress;
  NodalVectors f = NodalVectors::Zero(x.rows(), 3);
  for (const CheckStep& step : check_steps(springs.relaxing.relaxation)) {
    NodalVectors at = network.X + step.progress * (x - network.X);
    carry(network.cells.carried, at);
    branches.advance(at, step.duration);
    f.setZero();
    branches.add_forces(at, 0, f);
    duration.push_back(step.duration);
    progress.push_back(step.progress);
  }
  out.numbers({"check", "step_s"}, std::move(duration));
  out.numbers({"check", "progress"}, std::move(progress));
  out.vectors({"check", "branch_force_N"}, f);
}

int version_of(const SpringsFile& springs) {
  if (!springs.anchors.empty() || springs.relaxing.of_measured()) return springs_version_of_stiff_walls;
  if (springs.relaxing.acts()) return springs_version_of_branches;
  const CellSet& cells = springs.model.network.cells;
  if (!cells.materials.empty()) return springs_version_of_materials;
  const CellKind kind = cells.kind();
  return kind == CellKind::cut     ? springs_version_of_cut_cells
         : kind == CellKind::sizes ? springs_version_of_several_sizes
         : kind == CellKind::boxes ? springs_version_of_boxes
                                   : springs_version;
}

}  // namespace

std::string key_of_law(const LawTraits& traits) {
  std::string key = traits.name;
  std::replace(key.begin(), key.end(), ' ', '_');
  return key;
}

NodalVectors check_positions(const NodalVectors& X) {
  NodalVectors x = X;
  const Eigen::RowVector3d low = X.colwise().minCoeff(), extent = X.colwise().maxCoeff() - low;
  const double size = extent.maxCoeff();
  for (Eigen::Index n = 0; n < X.rows(); ++n) {
    const Eigen::RowVector3d s = size > 0 ? Eigen::RowVector3d((X.row(n) - low) / size) : Eigen::RowVector3d::Zero();
    x(n, 0) += 0.01 * size * (s[0] * s[1] + s[1] * s[2] - s[2] / 2);
    x(n, 1) += 0.01 * size * (s[1] * s[1] * s[2] + s[2] * s[0] / 2 + s[0] / 3);
    if (extent[2] > 0) x(n, 2) += 0.01 * size * (s[0] * s[2] - s[1] * s[1] + s[0] * s[1] / 3);
  }
  return x;
}

std::vector<CheckStep> check_steps(const Relaxation& relaxation) {
  const double first = relaxation.branches.front().time, last = relaxation.branches.back().time;
  return {{first / 3, 0.5}, {last, 1}, {2 * first, 1}};
}

SpringsDocument document_of(const SpringsFile& springs) {
  DocumentWriter out;
  const Network& network = springs.model.network;
  if (!network.cells.materials.empty() && !network.cells.cut())
    throw std::invalid_argument(
        "a springs file of several materials is of cut cells (allowed: these, or one material)");
  out.document.head = {{"format", springs_format}, {"version", version_of(springs)}};
  out.at({"origin"}) = origin_json(springs.origin);
  if (springs.material) out.at({"material"}) = moduli_json(*springs.material);
  out.at({"density_kg_m3"}) = springs.density;
  for (const SpringsRegion& region : springs.regions) out.at({"regions"}).push_back(region_json(region));
  out.at({"grip_m"}) = springs.grip;
  out.at({"grip_from"}) = springs.grip_from_cells ? "cells" : "surface";
  out.at({"derived"}) = springs.derived;
  add_laws(springs.model, out);
  add_relaxation(springs.relaxing, out);
  add_network(network, springs.density, out);
  out.at({"patches"}) = Json::object();
  for (const auto& [name, nodes] : springs.patches) out.indices({"patches", name}, nodes);
  for (const auto& [name, anchors] : springs.anchors) add_anchors(name, anchors, network.X, out);
  for (const auto& [name, shares] : springs.loads) add_load(name, shares, out);
  if (springs.volumes.size() > 0) {
    Eigen::VectorXd weight = springs.density * springs.volumes;
    if (network.attached.size() > 0) weight += network.attached;
    out.numbers({"nodes", "weight_kg"}, {weight.begin(), weight.end()});
  }
  add_surface(springs.surface, out);
  const NodalVectors x = check_positions(network.X);
  out.vectors({"check", "position_m"}, x);
  out.vectors({"check", "force_N"}, forces(springs.model, x));
  add_check_of_branches(springs, x, out);
  return std::move(out.document);
}

}  // namespace springproof
