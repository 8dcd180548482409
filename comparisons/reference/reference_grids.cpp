#include "comparisons/reference/reference_grids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "comparisons/judge/judge.h"
#include "comparisons/judge/measures.h"
#include "comparisons/prepare/rims.h"
#include "comparisons/reference/solve_each.h"
#include "fem_reference/exchange/case_request.h"
#include "msm/embedding/boundary.h"
#include "problem/case_file/measures.h"
#include "problem/exact_field.h"
#include "problem/processes/child.h"

namespace springproof {
namespace {

/// An element's three grids, coarse to fine; the finest with a file for ParaView.
void add_reference_grids(const PreparedCase& prepared, const std::string& element, double grading, const VtuOutput& vtu,
                         fem::Request& request) {
  for (int divisor : {4, 2, 1}) request.grids.push_back({divided(prepared.reference_cells, divisor), element, grading});
  request.grids.back().vtu = reference_file(vtu, element, prepared.experiment.setting_of(request.material));
}

/// Elements that fail on graded grids, whose thin cells are inverted first, are solved on three uniform ones.
void fall_back(const PreparedCase& prepared, fem::Request request, const VtuOutput& vtu, const RunKeeper& keeper,
               std::vector<ElementGrids>& elements) {
  if (prepared.experiment.reference.grading == 1) return;
  for (ElementGrids& e : elements) {
    const auto failed = std::ranges::find_if(e.grids, [](const fem::Solution& s) { return !s.ok; });
    if (failed == e.grids.end()) continue;
    const std::string why = fmt::format("the graded grid of {} cells has no result ({})",
                                        cells_text(failed->grid.cells, " x "), failed->message);
    request.grids.clear();
    add_reference_grids(prepared, e.element, 1, vtu, request);
    try {
      e.grids = solve_each(request, keeper);
    } catch (const NoRoom&) {
      throw;
    } catch (const std::runtime_error& error) {
      for (fem::Solution& s : e.grids) s.ok = false, s.message = error.what();
    }
    e.note = "uniform grids: " + why;
    for (fem::Solution& s : e.grids)
      if (!s.ok) s.message = fmt::format("on a uniform grid {}; {}", s.message, why);
  }
}

/// The loads' forces on the nodes of the first lattice [N].
NodalVectors nodal_loads(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  return transfer(lattice_loads(prepared), *prepared.lattices.front().mesh, e.materials.front().density,
                  e.model_kinematics())
      .external;
}

/// Sum of their magnitudes: it does not vanish where the loads balance each other.
double force_of_loads(const PreparedCase& prepared) { return nodal_loads(prepared).rowwise().norm().sum(); }

/// "tip" of "displacement.tip.x" and "stress.tip.xx"; of other measures nothing.
std::string probe_of(const std::string& measure) {
  const std::string kind = kind_of(measure);
  if (kind != "displacement" && kind != "stress") return {};
  const std::size_t from = kind.size() + 1;
  return measure.substr(from, measure.rfind('.') - from);
}

/// The patch at whose rim each probe lies that lies at one, by the probe's name.
std::map<std::string, std::string> rims_at_probes(const PreparedCase& prepared) {
  const std::vector<Probe>& probes = prepared.experiment.probes;
  const std::vector<std::optional<NearRim>> nearest = rims_near(prepared, probes);
  std::map<std::string, std::string> rims;
  for (std::size_t i = 0; i < probes.size(); ++i)
    if (nearest[i]) rims[probes[i].name] = nearest[i]->patch;
  return rims;
}

/// What the values of a body's measures are large or small beside.
struct BodyScale {
  double size = 0;            ///< [m]
  double displacement = 0;    ///< the largest [m]
  double force = 0;           ///< of the loads at least [N]
  double youngs_modulus = 0;  ///< [Pa]
};

/// Scale of the values of a measure: the largest displacement, the strain, the largest force (also of those that
/// balance torques, and times the body's size for torques), or the largest stress, at least that of the strain: probes
/// may all lie where there is none.
double scale_of(const std::string& measure, const std::map<std::string, double>& values, const BodyScale& body) {
  const std::string kind = kind_of(measure);
  if (kind == "displacement" || kind == "mean_displacement") return body.displacement;
  const double strain = body.displacement / body.size;
  if (kind == "turn") return strain * 180 / std::numbers::pi;
  if (kind == "volume_change") return strain;
  double force = body.force, stress = body.youngs_modulus * strain;
  for (const auto& [name, value] : values) {
    if (name.starts_with("force.")) force = std::max(force, std::abs(value));
    if (name.starts_with("torque.")) force = std::max(force, std::abs(value) / body.size);
    if (name.starts_with("stress.")) stress = std::max(stress, std::abs(value));
  }
  if (kind == "energy") return force * body.displacement;
  return kind == "stress" || kind == "mean_stress" ? stress : force * (kind == "torque" ? body.size : 1);
}

std::vector<ReferenceRecord> exact_records(const PreparedCase& prepared, double nu, const ElementGrids& e) {
  const Lattice& lattice = prepared.lattices.front();
  NodalVectors truth = lattice.mesh->nodes;
  for (Eigen::Index n = 0; n < truth.rows(); ++n)
    truth.row(n) = exact_displacement(prepared.experiment.exact, Vec3(truth.row(n).transpose())).transpose();
  const Eigen::VectorXd weights = nodal_volumes(*lattice.mesh);
  std::vector<double> errors;
  for (const fem::Solution& s : e.grids)
    errors.push_back(displacement_error(at_nodes(lattice, s.displacement), truth, weights));
  const double coarse = std::log2(errors[0] / errors[1]), fine = std::log2(errors[1] / errors[2]);
  const std::string note = "against the exact field '" + prepared.experiment.exact + "', finest grid";
  return {{.poisson_ratio = nu,
           .measure = "displacement_error",
           .unit = "1",
           .cells = {},
           .values = errors,
           .observed_order = fine,
           .value = errors[2],
           .note = note,
           .element = e.element},
          {.poisson_ratio = nu,
           .measure = "displacement_error_order",
           .unit = "1",
           .cells = {},
           .values = {std::numeric_limits<double>::quiet_NaN(), coarse, fine},
           .observed_order = {},
           .value = fine,
           .note = "of the two finest grids",
           .element = e.element}};
}

/// The value that the case file expects of a measure of an element, or nothing.
std::optional<double> target(const Experiment& experiment, const ReferenceRecord& r) {
  if (r.measure == "displacement_error") return 0;
  for (const Expectation& e : experiment.expectations)
    if (e.value && e.measure == r.measure && reference_element(experiment, e.model) == r.element &&
        (!e.poisson_ratio || same_poisson_ratio(*e.poisson_ratio, r.poisson_ratio)))
      return e.value;
  return {};
}

}  // namespace

Cells divided(const Cells& cells, int divisor) {
  Cells coarse;
  for (int d = 0; d < 3; ++d) coarse[d] = std::max(1, cells[d] / divisor);
  return coarse;
}

int fewest_across(const Experiment& e) {
  constexpr double pressures_above = 0.4;  // Poisson's ratio; of quadratic elements
  const auto has_pressures = [](const IsotropicMaterial& m) { return m.poisson_ratio > pressures_above; };
  std::vector<IsotropicMaterial> regions = materials_of(e.regions);
  regions.insert(regions.end(), e.listed.materials.begin(), e.listed.materials.end());
  const bool any = std::ranges::any_of(e.materials, has_pressures) || std::ranges::any_of(regions, has_pressures);
  return any ? two_on_the_coarsest : two_on_the_coarsest / 2;
}

Cells divisible_cells(const Vec3& size, double elements, int fewest) {
  const double edge = std::cbrt(size.prod() / elements);
  Cells cells;
  for (int d = 0; d < 3; ++d) cells[d] = std::max(fewest, 4 * static_cast<int>(std::lround(size[d] / edge / 4)));
  return cells;
}

std::map<std::string, double> field_measures(const PreparedCase& prepared, const Field& field, const NodalVectors& u) {
  const std::vector<Probe>& probes = prepared.experiment.probes;
  const auto count = static_cast<Eigen::Index>(probes.size());
  auto values = scalar_measures(field, probes, u.topRows(count));
  values.merge(mean_displacements(prepared.samples.of_patches, u.bottomRows(u.rows() - count)));
  if (wanted("turn", prepared.experiment.measures))
    values.merge(turns(prepared.samples.of_patches, u.bottomRows(u.rows() - count)));
  return values;
}

bool complete(const ElementGrids& e) {
  return e.grids.size() == 3 && std::ranges::all_of(e.grids, [](const auto& s) { return s.ok; });
}

std::string with_note(const ElementGrids& e, const std::string& note) {
  return e.note.empty() || note.empty() ? e.note + note : note + "; " + e.note;
}

ReferenceGrids solve_grids(const PreparedCase& prepared, const IsotropicMaterial& material, const VtuOutput& vtu,
                           const RunKeeper& keeper, const CoarsestField& coarsest) {
  const Experiment& experiment = prepared.experiment;
  fem::Request request = fem::request_of(experiment, material);
  request.points = stacked(lattice_points(prepared), measured_points(prepared));
  request.stress_points = requested_stress_points(prepared);
  request.vtu_single = vtu.single;
  for (const std::string& element : experiment.reference.elements)
    add_reference_grids(prepared, element, experiment.reference.grading, vtu, request);
  const std::size_t references = request.grids.size();
  std::vector<std::size_t> lattices;
  if (!experiment.models.empty())
    for (std::size_t i = 0; i < prepared.lattices.size(); ++i)
      for (const std::string& element : experiment.elements)
        if (small_enough(experiment, *prepared.lattices[i].mesh, degree_of(element))) {
          request.grids.push_back({prepared.lattices[i].cells, element, 1.0});
          lattices.push_back(i);
        }
  try {
    const std::vector<fem::Solution> solutions = solve_each(request, keeper, [&](std::size_t g, const auto& s) {
      if (coarsest && g == 0) coarsest(s.displacement);
    });
    ReferenceGrids out;
    auto at = solutions.begin();
    for (const std::string& element : experiment.reference.elements) {
      out.elements.push_back({element, {at, at + 3}});
      at += 3;
    }
    fall_back(prepared, request, vtu, keeper, out.elements);
    out.peers.resize(prepared.lattices.size());
    for (std::size_t i = 0; i < lattices.size(); ++i) out.peers[lattices[i]].push_back(solutions[references + i]);
    return out;
  } catch (const NoRoom&) {  // no fault of the case
    throw;
  } catch (const std::runtime_error& e) {
    return {{}, {}, {}, e.what()};
  }
}

Field sampled_field(const Lattice& lattice, const fem::Solution& s) {
  return {lattice.mesh, at_nodes(lattice, s.displacement), s.reactions, s.volume_change, s.volume_change_first_order};
}

std::map<std::string, double> measures_of(const PreparedCase& prepared, const fem::Solution& s) {
  const std::vector<Probe>& probes = prepared.experiment.probes;
  auto values = field_measures(prepared, sampled_field(prepared.lattices.front(), s),
                               s.displacement.bottomRows(s.displacement.rows() - prepared.nodes()));
  if (const Eigen::Index measured = stress_probes(prepared); measured > 0 && s.stress.rows() >= measured)
    values.merge(stress_measures(probes, s.stress.topRows(measured)));
  values.merge(region_measures(prepared.experiment.regions, s.regions));
  values.merge(interface_measures(prepared.experiment.regions, s.interfaces));
  return values;
}

bool comparable(const PreparedCase& prepared, const std::string& measure) {
  if (!measure.starts_with("force.") && !measure.starts_with("torque.")) return true;
  const auto from = measure.find('.') + 1;
  return !prepared.sharing.contains(measure.substr(from, measure.rfind('.') - from));
}

std::optional<ReactionDifference> reaction_error(const PreparedCase& prepared,
                                                 const std::map<std::string, double>& values,
                                                 const std::map<std::string, ReferenceValue>& truth) {
  return reaction_difference(values, values_of(truth), truth, comparable_moved_patches(prepared),
                             prepared.body.size.maxCoeff());
}

Vec3 sum_of_loads(const PreparedCase& prepared) { return nodal_loads(prepared).colwise().sum().transpose(); }

std::vector<std::string> comparable_moved_patches(const PreparedCase& prepared) {
  std::vector<std::string> patches = moved_patches(prepared.experiment);
  std::erase_if(patches, [&](const std::string& patch) { return prepared.sharing.contains(patch); });
  return patches;
}

DisplacementScale scale_of_errors(const PreparedCase& prepared, const Lattice& lattice, const NodalVectors& truth) {
  const Experiment& e = prepared.experiment;
  return displacement_scale(*lattice.mesh, truth, !moved_patches(e).empty(), e.model_kinematics());
}

GridRatios ratios_of(const ElementGrids& e) {
  const auto cells = [&](int grid) -> const Cells& { return e.grids[grid].grid.cells; };
  return {size_ratio(cells(0), cells(1), cells(2)), size_ratio(cells(1), cells(2), cells(2))};
}

void widen(double spread, ReferenceField& field) {
  field.uncertainty += spread;
  field.nodal_uncertainty += spread * field.displacement.rowwise().norm();
}

namespace {

/// Every scalar measure on each grid.
std::vector<std::map<std::string, double>> measures_on_grids(const PreparedCase& prepared, const ElementGrids& e) {
  std::vector<std::map<std::string, double>> values;
  for (const fem::Solution& s : e.grids) values.push_back(measures_of(prepared, s));
  for (auto& on_grid : values)  // two regions may touch on one mesh alone
    for (const auto& [measure, value] : values.back())
      if (measure.starts_with("interface.")) on_grid.try_emplace(measure, 0);
  return values;
}

/// Of a region the smaller of its own and the body's, whose strain it has at most.
double modulus_behind(const std::string& measure, const Experiment& e) {
  double modulus = e.materials.front().youngs_modulus;
  for (const MaterialRegion& r : e.regions)
    if (measure.starts_with("region." + r.name + ".")) modulus = std::min(modulus, r.material.youngs_modulus);
  return modulus;
}

}  // namespace

std::map<std::string, ReferenceValue> limits_of(const PreparedCase& prepared, const ElementGrids& e) {
  const std::vector<std::map<std::string, double>> values = measures_on_grids(prepared, e);
  const Experiment& experiment = prepared.experiment;
  BodyScale body{prepared.body.size.norm(), e.grids[2].displacement.rowwise().norm().maxCoeff(),
                 force_of_loads(prepared)};
  const std::map<std::string, std::string> rims = rims_at_probes(prepared);
  std::map<std::string, ReferenceValue> limits;
  for (const auto& [measure, fine] : values[2]) {
    body.youngs_modulus = modulus_behind(measure, experiment);
    const double scale = scale_of(measure, values[2], body);
    const std::vector<double> sequence = {values[0].at(measure), values[1].at(measure), fine};
    ReferenceValue& limit = limits[measure];
    limit = extrapolate(sequence, solver_noise * scale, trusted_orders(measure, e.element, experiment.reference.smooth),
                        ratios_of(e));
    if (const auto rim = rims.find(probe_of(measure)); rim != rims.end()) {
      limit = finest_of(sequence, limit);
      if (limit.sequence == Sequence::converging)
        limit.note = fmt::format("finest grid, 3 times the spread of the three: at the rim of patch '{}'", rim->second);
    }
    limit.matters = std::abs(limit.value) >= 0.1 * scale;
  }
  raise_to_usual(limits);
  for (auto& [measure, limit] : limits) limit.uncertainty += prepared.body.load_spread * std::abs(limit.value);
  return limits;
}

std::vector<ReferenceRecord> records_of(const PreparedCase& prepared, const IsotropicMaterial& material,
                                        const ElementGrids& e) {
  const Experiment& experiment = prepared.experiment;
  const double nu = experiment.setting_of(material);
  const std::vector<std::map<std::string, double>> values = measures_on_grids(prepared, e);
  std::vector<ReferenceRecord> records;
  for (const auto& [measure, limit] : limits_of(prepared, e)) {
    if (!wanted(measure, experiment.measures) || !comparable(prepared, measure)) continue;
    std::vector<double> sequence;
    for (const auto& on_grid : values) sequence.push_back(on_grid.at(measure));
    records.push_back({.poisson_ratio = nu,
                       .measure = measure,
                       .unit = unit_of(measure),
                       .cells = {},
                       .values = sequence,
                       .observed_order = limit.observed_order,
                       .value = limit.value,
                       .uncertainty = limit.uncertainty,
                       .note = limit.note,
                       .element = e.element,
                       .converging = limit.sequence != Sequence::not_converging});
    if (!records.back().converging && limit.matters)
      records.back().note += "; " + cause_and_remedy(prepared, material, e, measure);
  }
  if (!experiment.exact.empty())
    for (const ReferenceRecord& r : exact_records(prepared, nu, e))
      if (wanted(r.measure, experiment.measures)) records.push_back(r);
  for (ReferenceRecord& r : records) {
    r.note = with_note(e, r.note);
    for (const fem::Solution& s : e.grids) r.cells.push_back(s.grid.cells);
  }
  return records;
}

std::vector<Row> rows_of(const PreparedCase& prepared, const std::vector<ReferenceRecord>& records) {
  const Experiment& experiment = prepared.experiment;
  std::vector<Row> rows;
  for (const ReferenceRecord& r : records)
    for (std::size_t i = 0; i < r.values.size(); ++i) {
      if (!std::isfinite(r.values[i])) continue;
      Row row = of_run<Row>({"fem_" + r.element, r.poisson_ratio, r.cells[i]});
      row.case_name = experiment.name;
      row.kinematics = experiment.kinematics;
      row.measure = r.measure;
      row.value = r.values[i];
      row.unit = r.unit;
      row.reference = target(experiment, r);
      if (row.reference) row.error = row.value - *row.reference;
      rows.push_back(row);
    }
  return rows;
}

}  // namespace springproof
