#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>

#include "msm/algebra/dense.h"
#include "msm/exchange/json_place.h"
#include "msm/exchange/read_cells.h"
#include "msm/exchange/springs_document.h"
#include "msm/laws/capabilities.h"
#include "msm/laws/nodal_gradients.h"
#include "problem/files/files.h"
#include "problem/system/input_error.h"
#include "problem/system/shortened.h"

namespace springproof {
namespace {

using nlohmann::json;

constexpr double unbalanced = 1e-6;  // force at rest over the sum of k L at a node

/// Reads the parameters that a law names by its function `fields`.
class LawReader {
 public:
  LawReader(const JsonPlace& law, const Network& network) : law_(law), network_(network) {}

  void number(const char* key, double& value, double least = -largest_number_of_file,
              double largest = largest_number_of_file) {
    known_.emplace_back(key);
    value = law_.at(key).number(least, largest);
  }
  void flag(const char* key, bool& value) {
    known_.emplace_back(key);
    value = law_.at(key).flag();
  }
  template <class Enum>
  void choice(const char* key, Enum& value) {
    known_.emplace_back(key);
    value = static_cast<Enum>(law_.at(key).choice(names_of(value)));
  }
  void of_springs(const char* key, std::vector<double>& values) {
    known_.emplace_back(key);
    if (const auto place = law_.find(key))
      values = place->numbers(place->first_is_list() ? 2 : 1, network_.springs.size(), "springs");
  }
  void of_nodes(const char* key, std::vector<int>& values) {
    known_.emplace_back(key);
    if (const auto place = law_.find(key))
      values = place->integers(1, network_.nodes() - 1, static_cast<std::size_t>(network_.nodes()), "nodes");
  }
  void of_cells(const char* key, std::vector<double>& values, int each = 1) {
    known_.emplace_back(key);
    values = law_.at(key).numbers(each, network_.cells.size(), "cells");
  }
  /// The laws of the other materials.
  void of_regions(std::vector<AveragedSprings>& laws) {
    known_.emplace_back("regions");
    const auto list = law_.find("regions");
    for (const JsonPlace& item : list ? list->items() : std::vector<JsonPlace>()) {
      LawReader reader(item, network_);
      AveragedSprings law;
      law.fields(reader);
      reader.refuse_others();
      laws.push_back(std::move(law));
    }
  }
  void refuse_others() const { law_.require_known(known_); }

 private:
  JsonPlace law_;
  const Network& network_;
  std::vector<std::string> known_;
};

/// Puts one or two numbers per spring into another order of the springs; of those turned around the two are exchanged.
class SpringOrder {
 public:
  explicit SpringOrder(const std::vector<Spring>& springs) : number_(springs.size()), turned_(springs.size()) {
    std::iota(number_.begin(), number_.end(), 0);
    const auto ends = [&](std::size_t s) { return std::minmax(springs[s].i, springs[s].j); };
    std::stable_sort(number_.begin(), number_.end(), [&](std::size_t a, std::size_t b) { return ends(a) < ends(b); });
    for (std::size_t s = 0; s < springs.size(); ++s) turned_[s] = springs[number_[s]].i > springs[number_[s]].j;
  }

  std::vector<Spring> operator()(const std::vector<Spring>& springs) const {
    std::vector<Spring> sorted;
    for (const std::size_t s : number_) sorted.push_back(springs[s]);
    for (Spring& s : sorted)
      if (s.i > s.j) std::swap(s.i, s.j);
    return sorted;
  }

  void sort(std::vector<double>& values) const {
    const std::size_t each = number_.empty() ? 0 : values.size() / number_.size();
    std::vector<double> sorted;
    for (std::size_t s = 0; s < number_.size(); ++s)
      for (std::size_t end = 0; end < each; ++end)
        sorted.push_back(values[each * number_[s] + (turned_[s] ? each - 1 - end : end)]);
    values = std::move(sorted);
  }

 private:
  std::vector<std::size_t> number_;
  std::vector<char> turned_;
};

NodalVectors vectors(const JsonPlace& place) {
  const std::vector<double> x = place.numbers(3, 0, nullptr, -farthest_node, farthest_node);
  return Eigen::Map<const NodalVectors>(x.data(), static_cast<Eigen::Index>(x.size() / 3), 3);
}

void read_nodes(const JsonPlace& document, SpringsFile& file) {
  file.density = document.at("density_kg_m3").number(smallest_of_file, largest_number_of_file);
  const JsonPlace nodes = document.at("nodes");
  nodes.require_known({"position_m", "mass_kg", "attached_kg", "weight_kg"});
  Network& network = file.model.network;
  network.X = vectors(nodes.at("position_m"));
  if (network.nodes() == 0) nodes.at("position_m").refuse("is empty", "at least one node");
  const bool some_carried = document.find("carried").has_value();  // read_carried() sees to their masses
  const std::vector<double> mass = nodes.at("mass_kg").numbers(1, static_cast<std::size_t>(network.nodes()), "nodes",
                                                               some_carried ? 0 : smallest_of_file);
  Eigen::VectorXd own = Eigen::Map<const Eigen::VectorXd>(mass.data(), static_cast<Eigen::Index>(mass.size()));
  if (const auto place = nodes.find("attached_kg")) {
    const std::vector<double> attached = place->numbers(1, mass.size(), "nodes", 0);
    network.attached = Eigen::Map<const Eigen::VectorXd>(attached.data(), own.size());
    own -= network.attached;
    for (std::size_t n = 0; n < mass.size(); ++n)
      if (!(own[static_cast<Eigen::Index>(n)] > 0) && mass[n] > 0)
        place->refuse(fmt::format("node {} has {:g} kg attached, of {:g} kg in all", n, attached[n], mass[n]),
                      "less than its mass_kg, which has them in it");
  }
  network.volume = own / file.density;
}

/// In the order of the file.
std::vector<Spring> read_springs_of(const JsonPlace& document, const NodalVectors& X) {
  const JsonPlace place = document.at("springs");
  place.require_known({"nodes", "stiffness_N_m", "rest_length_m"});
  const auto ends = rows<2>(place.at("nodes"), static_cast<int>(X.rows()) - 1, "spring");
  const auto stiffness = place.at("stiffness_N_m").numbers(1, ends.size(), "springs", smallest_of_file);
  const auto length = place.at("rest_length_m").numbers(1, ends.size(), "springs", smallest_of_file, farthest_node);
  std::vector<Spring> springs;
  for (std::size_t s = 0; s < ends.size(); ++s) {
    if (X.row(ends[s][0]) == X.row(ends[s][1]))
      place.at("nodes").refuse(fmt::format("spring {} connects two nodes at the same place", s),
                               "springs with a direction");
    springs.push_back({ends[s][0], ends[s][1], stiffness[s], length[s]});
  }
  return springs;
}

double version_of(const JsonPlace& document) {
  return document.at("version").number(springs_version, springs_version_of_stiff_walls);
}

/// Calls `act` with a default value of each law of the list.
template <class Act, class... Laws>
void for_each_law(std::variant<Laws...>*, const Act& act) {
  (act(Laws{}), ...);
}

/// Every form of a cell has its energy.
void require_positive(const MeasuredCells& law, const Network& network, const JsonPlace& place) {
  constexpr double round_off = 1e-9;
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const Eigen::VectorXd values = symmetric_eigenvalues(law.form_of_cell(c));
    if (values[0] < -round_off * values[values.size() - 1])
      place.at("form_N_m")
          .refuse(fmt::format("the form of cell {} has the eigenvalue {:.3g} N/m", c, values[0]),
                  "forms without negative eigenvalues");
  }
}

/// One law for the cells of each material.
void require_of_materials(const ForceLaw& law, const Network& network, const JsonPlace& place) {
  const auto* averaged = std::get_if<AveragedSprings>(&law);
  const std::size_t materials = std::max<std::size_t>(1, network.cells.relative_densities.size());
  if (materials > 1 && !averaged && traits(law).reach != Reach::springs)
    place.refuse("acts on cells of one material", "averaged_springs alone");
  if (averaged && averaged->regions.size() + 1 != materials)
    place.refuse(fmt::format("has constants of {} materials, of {}", averaged->regions.size() + 1, materials),
                 "in regions a law for each of /regions");
}

void require_its_parts(const ForceLaw& law, const Network& network, const JsonPlace& place) {
  require_of_materials(law, network, place);
  if (traits(law).reach == Reach::cells && network.cells.empty())
    place.refuse("has no cells to act on", "beside cells");
  const bool of_cells = traits(law).reach == Reach::cells;
  if (!lacks(law, Capability::cells_of_any_shape).empty()) {
    if (of_cells && network.cells.cut())
      place.refuse("acts on whole cells, these are cut", "averaged_springs in cut cells");
    if (network.cells.kind() == CellKind::sizes)
      place.refuse("is beside cells of several sizes", "averaged_springs alone");
    if (of_cells && network.cells.kind() == CellKind::boxes)
      place.refuse("acts on cubes, the cells are boxes", "averaged_springs in boxes");
  }
  if (std::holds_alternative<AngularSprings>(law) && network.triangles.empty())
    place.refuse("has no triangles to act on", "beside triangles");
  if (const auto* measured = std::get_if<MeasuredCells>(&law)) require_positive(*measured, network, place);
  const auto* dispersion = std::get_if<MomentumDispersion>(&law);
  if (dispersion && dispersion->form == Dispersion::finite_strain) try {
      const NodalGradients every_node(*dispersion, network);
    } catch (const std::invalid_argument& e) {
      place.refuse(e.what(), "the form symmetric");
    }
}

void read_laws(const JsonPlace& document, const SpringOrder& order, MassSpringModel& model) {
  const JsonPlace laws = document.at("laws");
  const Network& network = model.network;
  std::vector<std::string> known;
  for_each_law(static_cast<ForceLaw*>(nullptr), [&](auto law) {
    known.push_back(key_of_law(law.traits));
    const auto place = laws.find(known.back());
    if (!place) return;
    LawReader reader(*place, network);
    law.fields(reader);
    if constexpr (std::is_same_v<decltype(law), AveragedSprings>) reader.of_regions(law.regions);
    reader.refuse_others();
    if constexpr (std::is_same_v<decltype(law), MomentumDispersion>) order.sort(law.weight);
    require_its_parts(law, network, *place);
    model.small_displacements_only |= !lacks(law, Capability::large_displacements).empty();
    model.laws.emplace_back(std::move(law));
  });
  laws.require_known(known);
}

/// Branches of the cells, from version 6 on.
void read_relaxation(const JsonPlace& document, SpringsFile& file) {
  const auto place = document.find("relaxation");
  if (!place) return;
  if (version_of(document) < springs_version_of_branches)
    place->refuse("is in a file of an earlier version", fmt::format("version {}", springs_version_of_branches));
  if (const std::string why = lacks(file.model, Capability::relaxation); !why.empty())
    place->refuse(fmt::format("does not suit these springs: {}", why), "beside cells of one material");
  std::vector<std::string> known = {"share", "time_s"};
  const std::vector<double> share = place->at("share").numbers(1, 0, nullptr, smallest_of_file);
  if (share.empty()) place->at("share").refuse("is empty", "one branch at least");
  const std::vector<double> time = place->at("time_s").numbers(1, share.size(), "shares", smallest_of_file);
  for (std::size_t i = 0; i < share.size(); ++i) file.relaxing.relaxation.branches.push_back({share[i], time[i]});
  if (law_of<MeasuredCells>(file.model)) {
    place->require_known(known);
    file.relaxing = RelaxingCells::of(file.model, {}, file.relaxing.relaxation);
    return;
  }
  for (auto& [key, constant] : branch_constants(file.relaxing.cells)) {
    constant = place->at(key).number(std::string_view(key) == "coupling" ? -largest_number_of_file : 0,
                                     largest_number_of_file);
    known.emplace_back(key);
  }
  place->require_known(known);
}

/// The internal forces vanish at rest.
void require_rest(const JsonPlace& document, const MassSpringModel& model) {
  const Network& network = model.network;
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(network.nodes());
  for (const Spring& s : network.springs) {
    scale[s.i] += s.stiffness * s.rest_length;
    scale[s.j] += s.stiffness * s.rest_length;
  }
  if (const AveragedSprings* averaged = averaged_springs_of(model))
    for (std::size_t c = 0; c < network.cells.size(); ++c)
      for (const int n : network.cells.corners[c])
        scale[n] += averaged->in(network.cells.material(c)).shear_modulus * std::pow(network.cells.edge_of(c), 2);
  if (const auto* measured = law_of<MeasuredCells>(model))
    for (std::size_t c = 0; c < network.cells.size(); ++c)
      for (const int n : network.cells.corners[c])
        scale[n] += measured->form_of_cell(c).trace() * network.cells.edge_of(c);
  const NodalVectors f = forces(model, network.X);
  for (int n = 0; n < network.nodes(); ++n)
    if (const double force = f.row(n).norm(); !(force <= unbalanced * scale[n]))
      document.at("nodes").refuse(fmt::format("node {} is not at rest: a force of {:.3g} N acts on it", n, force),
                                  "positions at which all forces balance, as where rest lengths are distances");
  for (int n = 0; n < network.nodes(); ++n)
    if (scale[n] == 0)
      document.at("springs").refuse(fmt::format("node {} has no spring", n),
                                    "one at least, or a cell with averaged springs or a measured form");
}

void read_patches(const JsonPlace& document, SpringsFile& file) {
  const auto patches = document.find("patches");
  if (!patches) return;
  for (const std::string& name : patches->keys()) {
    std::vector<int> nodes = patches->at(name).integers(1, file.model.network.nodes() - 1);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (const CarriedPoint& c : file.model.network.cells.carried)
      if (std::binary_search(nodes.begin(), nodes.end(), c.point))
        patches->at(name).refuse(fmt::format("node {} follows others and cannot be held", c.point),
                                 "nodes that are not carried");
    file.patches[name] = std::move(nodes);
  }
}

void read_surface(const JsonPlace& document, SpringsFile& file) {
  const auto place = document.find("surface");
  if (!place) return;
  place->require_known({"position_m", "facets", "first", "nodes", "weights"});
  EmbeddedSurface& surface = file.surface;
  surface.vertices = vectors(place->at("position_m"));
  const auto vertices = static_cast<std::size_t>(surface.vertices.rows());
  surface.facets = rows<3>(place->at("facets"), static_cast<int>(vertices) - 1);
  const std::vector<int> nodes = place->at("nodes").integers(1, file.model.network.nodes() - 1);
  const std::vector<double> weights = place->at("weights").numbers(1, nodes.size(), "nodes of vertices");
  const std::vector<int> first =
      place->at("first").integers(1, static_cast<int>(nodes.size()), vertices + 1, "vertices and one more");
  if (first.front() != 0 || first.back() != static_cast<int>(nodes.size()) ||
      !std::is_sorted(first.begin(), first.end()))
    place->at("first").refuse("does not ascend from 0 to the number of nodes",
                              "where each vertex's nodes begin, and the end");
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t v = 0; v < vertices; ++v)
    for (int at = first[v]; at < first[v + 1]; ++at) entries.emplace_back(static_cast<int>(v), nodes[at], weights[at]);
  surface.weights.resize(surface.vertices.rows(), file.model.network.nodes());
  surface.weights.setFromTriplets(entries.begin(), entries.end());
}

void require_format(const JsonPlace& document) {
  if (const auto format = document.find("format"); !format || format->text() != springs_format)
    document.refuse("is no springs file", fmt::format("\"format\": \"{}\"", springs_format));
  if (const double version = version_of(document); version != std::floor(version))
    document.at("version").refuse("is no whole number", "1 to 7");
  document.require_known({"format", "version",   "origin",  "material",  "density_kg_m3", "regions",
                          "grip_m", "grip_from", "derived", "laws",      "nodes",         "springs",
                          "cells",  "bonds",     "carried", "triangles", "patches",       "anchors",
                          "loads",  "surface",   "check",   "relaxation"});
}

SpringsFile read_document(const JsonPlace& document) {
  require_format(document);
  SpringsFile file;
  read_nodes(document, file);
  Network& network = file.model.network;
  if (const auto material = document.find("material")) {
    material->require_known({"youngs_modulus_Pa", "poisson_ratio"});
    file.material =
        IsotropicMaterial{material->at("youngs_modulus_Pa").number(smallest_of_file, largest_number_of_file),
                          material->at("poisson_ratio").number(-1, 0.5), file.density};
  }
  if (const auto grip = document.find("grip_m")) file.grip = grip->number(0, farthest_node);
  if (const auto from = document.find("grip_from"))
    file.grip_from_cells = from->choice(std::array{"surface", "cells"}) == 1;
  const std::vector<Spring> unsorted = read_springs_of(document, network.X);
  const SpringOrder order(unsorted);
  network.springs = order(unsorted);
  const double version = version_of(document);
  read_cells(document, version, network);
  read_carried(document, network);
  read_materials(document, version, file);
  read_laws(document, order, file.model);
  if (!network.bonds.empty() && !law_of<Anchors>(file.model)) file.model.laws.emplace_back(Anchors{});
  read_relaxation(document, file);
  require_rest(document, file.model);
  read_patches(document, file);
  read_supports_and_loads(document, version, file);
  read_surface(document, file);
  return file;
}

SourceLocation location_of_byte(std::string_view text, std::size_t byte, const std::string& name) {
  const std::string_view before = text.substr(0, byte > 0 ? byte - 1 : 0);
  const auto line = std::count(before.begin(), before.end(), '\n');
  const std::size_t start = before.rfind('\n');  // npos + 1 = 0
  return {name, static_cast<int>(line) + 1, static_cast<int>(before.size() - (start + 1)) + 1};
}

}  // namespace

SpringsFile parse_springs(std::string_view text, const std::string& name) {
  json document;
  try {
    document = json::parse(text.begin(), text.end());
  } catch (const json::parse_error& e) {
    const std::string words = e.what();
    const std::size_t end = words.rfind(" - ");
    throw InputError(location_of_byte(text, e.byte, name),
                     shortened(fmt::format("not valid JSON: {} (allowed: a springs file, docs/springs_file.md; NaN and "
                                           "Infinity are no numbers of JSON)",
                                           end == std::string::npos ? words : words.substr(end + 3))));
  } catch (const json::exception& e) {
    throw InputError({name, 0, 0}, shortened(fmt::format("not valid JSON: {}", e.what())));
  }
  return read_document({document, "", name});
}

SpringsFile read_springs(const std::filesystem::path& file) {
  return parse_springs(read_named_file(file, "a springs file, NAME.json"), file.string());
}

}  // namespace springproof
