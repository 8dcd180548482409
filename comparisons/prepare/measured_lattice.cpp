#include "comparisons/prepare/measured_lattice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "meshes/mesher/mesh_cache.h"
#include "msm/embedding/cut_lattice.h"
#include "msm/periodic/laws_of_model.h"
#include "problem/files/checksum.h"
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
  return constants.all;
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
  return fmt::format("{} {} {} {} {} {} {} ", checksum(bytes_of(body.nodes) + bytes_of(body.tetrahedra) + supports),
                     g.origin[0], g.origin[1], g.origin[2], g.edge, measuring_ratio, coarse.cells.size());
}

// File format: the heading (problem/files/checked_file.h), the key, and these numbers in the machine's bytes.
const KeptKind kept_cells = {"cells", ".bin", "springproof measured cells 2 "};

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
                                 std::vector<std::string> held)
    : coarse_(std::move(coarse)), body_(std::move(body)), held_(std::move(held)) {}

MeasuredBody MeasuredLattice::measure(const AveragedSprings& law) {
  const std::size_t cells = coarse_->cells.size();
  const KeptFile place(kept_folder(), kept_cells, line_of(*coarse_, *body_, held_) + constants_of(law) + "\n");
  if (std::optional<MeasuredBody> kept =
          place.find([&](const std::string& bytes) { return from_content(bytes, cells); }))
    return std::move(*kept);
  if (!fine_) fine_ = fine_cells(*coarse_, *body_, measuring_ratio);
  progress::detail([&] { return fmt::format("measuring {} cells in {}", cells, fine_->body.cells.size()); });
  MeasureOptions options;
  options.threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 16u));
  options.interrupted = children_interrupted;
  MeasuredBody measured = measure_cells({*coarse_, *fine_, law, held_}, options);
  place.keep(content_of(measured));
  return measured;
}

const MeasuredBody& MeasuredLattice::measured(const ModelParameters& parameters, const IsotropicMaterial& material) {
  const AveragedSprings law = measuring_law(parameters, material);
  const std::scoped_lock lock(one_at_a_time_);
  const std::string constants = constants_of(law);
  const auto known = known_.find(constants);
  return known != known_.end() ? known->second : known_.emplace(constants, measure(law)).first->second;
}

MeasuredCells MeasuredLattice::law(const ModelParameters& parameters, const IsotropicMaterial& material) {
  const CellSet cells = cut_lattice(*coarse_, {}, 1).cells;
  return in_material(measured(parameters, material).cells, cells, measuring_law(parameters, material),
                     averaged_law(parameters, material));
}

}  // namespace springproof
