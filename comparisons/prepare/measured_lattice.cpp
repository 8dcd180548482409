#include "comparisons/prepare/measured_lattice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "meshes/mesher/mesh_cache.h"
#include "msm/coarsening/states.h"
#include "msm/embedding/cut_lattice.h"
#include "msm/periodic/laws_of_model.h"
#include "problem/files/files.h"
#include "problem/files/kept_file.h"
#include "problem/processes/child.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

/// Collects the constants of a law.
struct Constants {
  std::string all;
  void number(const char*, double value, double = 0, double = 0) { all += fmt::format("{} ", value); }
  void flag(const char*, bool value) { all += value ? "1 " : "0 "; }
  template <class Enum>
  void choice(const char*, Enum) {}  // of large strain
};

std::string constants_of(AveragedSprings law) {
  Constants constants;
  law.fields(constants);
  for (AveragedSprings& region : law.regions) region.fields(constants);
  return constants.all;
}

Mesh of_one_material(Mesh body) {
  body.materials.clear();
  return body;
}

template <class Matrix>
std::string bytes_of(const Matrix& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(*values.data())};
}

/// All that the measured forms follow from but the law.
std::string line_of(const CutBody& coarse, const Mesh& body, const std::vector<std::string>& held) {
  const VoxelGrid& g = coarse.grid;
  std::string supports;
  for (const std::string& name : held)
    for (const PatchInCell& part : coarse.patches.at(name))
      supports += fmt::format("{} {} ", part.cell, fmt::join(part.area, " "));
  return fmt::format("{} {} {} {} {} {} {} ",
                     checksum(bytes_of(body.nodes) + bytes_of(body.tetrahedra) + bytes_of(body.materials) + supports),
                     g.origin[0], g.origin[1], g.origin[2], g.edge, measuring_ratio, coarse.cells.size());
}

// File format: the heading (problem/files/new_file.h), the key, and these numbers in the machine's bytes.
const KeptKind kept_cells = {"cells", ".bin", "springproof measured cells 3 "};

std::string content_of(const MeasuredBody& measured) {
  const std::array<double, 3> head = {static_cast<double>(measured.as_averaged), measured.error,
                                      measured.error_of_averaged};
  return bytes_of(head) + bytes_of(measured.cells.form);
}

/// @throws std::runtime_error unless there are so many cells.
MeasuredBody from_content(const std::string& bytes, std::size_t cells) {
  std::vector<double> numbers(3 + numbers_of_form * cells);
  if (bytes.size() != numbers.size() * sizeof(double)) throw std::runtime_error("not the forms of these cells");
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return {{{numbers.begin() + 3, numbers.end()}}, static_cast<int>(numbers[0]), numbers[1], numbers[2]};
}

}  // namespace

MeasuredLattice::MeasuredLattice(std::shared_ptr<const CutBody> coarse, std::shared_ptr<const Mesh> body,
                                 std::vector<std::string> held, std::vector<IsotropicMaterial> regions)
    : coarse_(std::move(coarse)), body_(std::move(body)), held_(std::move(held)), regions_(std::move(regions)) {
  if (!regions_.empty()) coarse_ = std::make_shared<CutBody>(cut_body(coarse_->grid, of_one_material(*body_)));
}

const FineCells& MeasuredLattice::fine() {
  if (!fine_) fine_ = fine_cells(*coarse_, *body_, measuring_ratio);
  return *fine_;
}

MeasuredBody MeasuredLattice::measure(const AveragedSprings& law) {
  const std::size_t cells = coarse_->cells.size();
  const KeptFile place(kept_folder(), kept_cells, line_of(*coarse_, *body_, held_) + constants_of(law) + "\n");
  if (std::optional<MeasuredBody> kept =
          place.find([&](const std::string& bytes) { return from_content(bytes, cells); }))
    return std::move(*kept);
  progress::detail([&] { return fmt::format("measuring {} cells in {}", cells, fine().body.cells.size()); });
  MeasureOptions options;
  options.threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 16u));
  options.interrupted = children_interrupted;
  MeasuredBody measured = measure_cells({*coarse_, fine(), law, held_}, options);
  place.keep(content_of(measured));
  return measured;
}

const MeasuredBody& MeasuredLattice::measured(const ModelParameters& parameters, const IsotropicMaterial& material) {
  const AveragedSprings law = measuring_law(parameters, material, regions_);
  const std::scoped_lock lock(one_at_a_time_);
  const std::string constants = constants_of(law);
  const auto known = known_.find(constants);
  return known != known_.end() ? known->second : known_.emplace(constants, measure(law)).first->second;
}

void MeasuredLattice::apply(const ModelParameters& parameters, const IsotropicMaterial& material,
                            const std::vector<std::string>& held, EmbeddedModel& built) {
  const MeasuredCells& measured_cells = measured(parameters, material).cells;
  const AveragedSprings of = measuring_law(parameters, material, regions_),
                        at = averaged_law(parameters, material, regions_);
  const std::scoped_lock lock(one_at_a_time_);
  const FineCells* of_materials = regions_.empty() ? nullptr : &fine();
  MassSpringModel& model = built.model;
  erase_laws<AveragedSprings>(model);
  model.laws.emplace_back(in_material(measured_cells, model.network.cells, of, at, of_materials));
  if (!of_materials) return;
  set_anchors(*coarse_, held, *of_materials, at, model.network);
  built.embedding.volumes.head(coarse_->points.rows()) = weighed_volumes(material);
}

/// Of the coarse nodes [m^3], a part of another density by its mass.
Eigen::VectorXd MeasuredLattice::weighed_volumes(const IsotropicMaterial& material) {
  std::vector<IsotropicMaterial> materials = {material};
  materials.insert(materials.end(), regions_.begin(), regions_.end());
  const Eigen::VectorXd fine_volumes = embed(fine().body, {}, cut_lattice(fine().body, {}, materials), Mesh{}).volumes;
  const Eigen::VectorXd volumes = prolongation(*coarse_, fine()).transpose() * fine_volumes;
  return fine_volumes.sum() / volumes.sum() * volumes;
}

}  // namespace springproof
