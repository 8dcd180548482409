#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "comparisons/models/motion_run.h"
#include "comparisons/results/picture.h"
#include "comparisons/run/part_run.h"
#include "meshes/volume.h"
#include "problem/case_file/measures.h"

namespace springproof {
namespace {

/// Whether nothing moves: all kinetic energy is below the round-off of the elastic energy, eps E V.
bool is_at_rest(const HistoryRecord& history, const IsotropicMaterial& material, const Mesh& mesh) {
  const std::vector<double>& kinetic = *series(history, "kinetic_energy");
  const double digits = std::numeric_limits<double>::epsilon() * material.youngs_modulus * volume(mesh, mesh.nodes);
  return *std::ranges::max_element(kinetic) < digits;
}

}  // namespace

const Reference* reference_at_rest(const PartRun& run, std::size_t lattice, const std::string& model) {
  const auto& models = run.experiment().models;
  const auto moves = [&](const auto& m) { return m.label == model && m.in_motion; };
  if (run.in_time && std::ranges::any_of(models, moves)) return nullptr;
  return run.reference[lattice] ? &*run.reference[lattice] : nullptr;
}

void add_motion(PartRun& run, std::size_t lattice, const std::string& model, Field field, MotionRecord motion) {
  const RunKey key = run.key(model, lattice);
  static_cast<RunKey&>(motion.history) = key;
  if (is_at_rest(motion.history, run.material, run.mesh(lattice)))
    std::erase_if(motion.history.measured, [](const auto& entry) { return entry.first.ends_with("_drift"); });
  if (run.in_time) {
    motion.history.measured["motion_error"] = history_error(motion.history, run.in_time->history);
    motion.history.probe = run.in_time->history.probe;  // the same component
    for (const MotionMeasure& m : motion_measures())
      if (m.of_probe) motion.history.measured.erase(m.name);
    motion.history.measured.merge(measured_in_time(run.experiment(), motion.history));
  }
  run.part.histories.push_back(std::move(motion.history));
  std::vector<std::pair<double, std::string>> series;
  for (auto& [time, displacement] : motion.frames) {
    field.displacement = std::move(displacement);
    if (!run.vtu.folder.empty()) {
      series.emplace_back(time, fmt::format("{}_{:04}.vtu", file_stem(key), series.size() + 1));
      VtuNotes notes = run.notes(key);
      notes.numbers.emplace_back("time_s", time);
      write_vtu(run.vtu.folder / series.back().second, field, {}, notes);
    }
    for (Picture& p : run.part.pictures) {
      if (!same_run(p, key)) continue;
      p.frame_times.push_back(time);
      p.frames.push_back(p.surface == "cells"
                             ? picture(key, field, nullptr).displacement
                             : smooth_picture(key, field, *run.prepared.body.tetrahedra.back(), nullptr).displacement);
    }
  }
  if (!series.empty()) write_pvd(run.vtu.folder / (file_stem(key) + ".pvd"), series);
}

void run_motion_reference(PartRun& run) {
  run.in_time = solve_motion(run.prepared, run.material, run.keeper);
  MotionReference& r = *run.in_time;
  const RunKey key = run.key(fem_in_motion, r.run.cells);
  static_cast<RunKey&>(r.run) = static_cast<RunKey&>(r.history) = key;
  r.run.kind = "fem";
  run.part.runs.push_back(r.run);
  if (r.run.ok)
    run.part.histories.push_back(r.history);
  else
    run.in_time.reset();
}

void add_motion_rows(PartRun& run, const Row& blank, const HistoryRecord& history) {
  for (const std::string& measure : rows_of_measure("motion", run.experiment())) {
    const std::string name = measure.substr(measure.find('.') + 1);
    const auto measured = history.measured.find(name);
    if (measured == history.measured.end()) continue;
    Row row = blank;
    row.value = measured->second;
    if (run.in_time && run.in_time->measured.contains(name)) {
      const ReferenceValue& r = run.in_time->measured.at(name);
      row.reference = r.value;
      row.reference_uncertainty = r.uncertainty;
      row.error = row.value - r.value;
    }
    add_row(run, row, measure);
  }
  if (!run.in_time) return;
  Row row = blank;
  row.reference = 0.0;
  row.reference_uncertainty = run.in_time->uncertainty;
  row.value = history.measured.at("motion_error");
  row.error = row.value;
  add_row(run, row, "motion_error");
}

}  // namespace springproof
