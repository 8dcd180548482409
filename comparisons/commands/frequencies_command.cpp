#include "comparisons/commands/frequencies_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "comparisons/results/records.h"
#include "comparisons/run/find_cases.h"
#include "comparisons/run/prepare.h"
#include "comparisons/run/status.h"
#include "fem_reference/reference.h"
#include "meshes/field.h"
#include "problem/system/child.h"
#include "problem/system/files.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

constexpr int frequencies_interrupted = 130;

std::string name_of(const ModelFrequencies& m) {
  return m.consistency > 0 ? fmt::format("{} {:g}", m.label, m.consistency) : m.label;
}

std::string supports_words(const Experiment& e) {
  std::vector<std::string> patches;
  for (const Load& load : supports_of(e))
    if (const std::string& on = *patch_of(load); std::find(patches.begin(), patches.end(), on) == patches.end())
      patches.push_back(on);
  return patches.empty() ? "free" : fmt::format("held on {}", fmt::join(patches, ", "));
}

std::string percent(double error) { return fmt::format("{:+.2f} %", 100 * error); }

/// Frequency, error and MAC of a row.
std::string cell_of(const ModeRow& row, double truth) {
  if (!row.frequency) return fmt::format("no partner  MAC {:.2f}", row.mac);
  return fmt::format("{:.5g}  {}  {:.2f}", *row.frequency, percent(*row.frequency / truth - 1), row.mac);
}

void print(const Experiment& e, const FrequencyTable& t, int modes) {
  fmt::print("\n{}: nu = {:g}, {} cells, {}, E = {:g} Pa, {:g} kg/m^3\n", e.name, t.material.poisson_ratio,
             cells_text(t.lattice->cells, " x "), supports_words(e), t.material.youngs_modulus, t.material.density);
  if (t.failure.empty())
    fmt::print(
        "FEM: {}; {} rigid motions left out.  Models: frequency [Hz], error, MAC; a number after the name is the "
        "share of consistent mass\n\n",
        t.form, t.rigid_motions);
  else
    fmt::print("no reference: {}\n\n", t.failure);
  std::vector<const ModelFrequencies*> shown;
  for (const ModelFrequencies& m : t.models) {
    if (m.message.empty())
      shown.push_back(&m);
    else
      fmt::print("{}: {}\n", name_of(m), m.message);
  }
  constexpr int width = 27;
  fmt::print("{:>4}  {:>20}", "mode", t.failure.empty() ? "FEM [Hz]" : "");
  for (const ModelFrequencies* m : shown) fmt::print("{:>{}}", name_of(*m), width);
  fmt::print("\n");
  for (std::size_t i = 0; i < static_cast<std::size_t>(modes); ++i) {
    const bool known = i < t.reference.size();
    fmt::print("{:>4}  {:>20}", i + 1,
               known ? fmt::format("{:.6g} +- {:.1g}", t.reference[i].value, t.reference[i].uncertainty) : "");
    for (const ModelFrequencies* m : shown)
      fmt::print("{:>{}}",
                 known                             ? cell_of(m->rows[i], t.reference[i].value)
                 : i < m->modes.frequencies.size() ? fmt::format("{:.5g}", m->modes.frequencies[i])
                                                   : "",
                 width);
    fmt::print("\n");
  }
  if (t.reference.empty()) return;
  for (const auto& [word, value] :
       {std::pair("rms", &ModelFrequencies::rms), std::pair("max", &ModelFrequencies::largest)}) {
    fmt::print("{:>4}  {:>20}", word, "");
    for (const ModelFrequencies* m : shown) fmt::print("{:>{}}", fmt::format("{:.2f} %", 100 * m->*value), width);
    fmt::print("\n");
  }
}

nlohmann::json json_of(const FrequencyTable& t) {
  nlohmann::json out = {{"poisson_ratio", t.material.poisson_ratio},
                        {"youngs_modulus_Pa", t.material.youngs_modulus},
                        {"density_kg_m3", t.material.density},
                        {"cells", t.lattice->cells},
                        {"reference",
                         {{"form", t.form},
                          {"failure", t.failure},
                          {"rigid_motions", t.rigid_motions},
                          {"modes", nlohmann::json::array()}}},
                        {"models", nlohmann::json::array()}};
  for (const ReferenceValue& r : t.reference)
    out["reference"]["modes"].push_back(
        {{"frequency_Hz", r.value}, {"uncertainty_Hz", r.uncertainty}, {"note", r.note}});
  for (const ModelFrequencies& m : t.models) {
    nlohmann::json model = {{"model", m.label},
                            {"mass_consistency", m.consistency},
                            {"message", m.message},
                            {"solver", m.solver},
                            {"seconds", m.seconds},
                            {"frequencies_Hz", m.modes.frequencies},
                            {"rms_error", m.rms},
                            {"largest_error", m.largest},
                            {"pairs", nlohmann::json::array()}};
    for (std::size_t i = 0; i < m.rows.size(); ++i)
      model["pairs"].push_back(
          {{"mode", i + 1},
           {"frequency_Hz", m.rows[i].frequency ? nlohmann::json(*m.rows[i].frequency) : nlohmann::json()},
           {"error",
            m.rows[i].frequency ? nlohmann::json(*m.rows[i].frequency / t.reference[i].value - 1) : nlohmann::json()},
           {"mac", m.rows[i].mac}});
    out["models"].push_back(model);
  }
  return out;
}

void write_shapes(const fs::path& file, const FrequencyTable& t, const ModeSet& modes) {
  if (modes.shapes.empty()) return;
  std::vector<std::pair<std::string, NodalVectors>> shapes;
  for (std::size_t i = 0; i < modes.shapes.size(); ++i)
    shapes.emplace_back(fmt::format("mode {:02} {:.5g} Hz", i + 1, modes.frequencies[i]), modes.shapes[i]);
  const NodalVectors rest = NodalVectors::Zero(t.lattice->mesh->nodes.rows(), 3);
  write_vtu(file, {t.lattice->mesh, rest, {}}, shapes);
}

void write_all_shapes(const fs::path& folder, const Experiment& e, const FrequencyTable& t) {
  const std::string stem =
      fmt::format("{}-nu{:g}-{}", e.name, t.material.poisson_ratio, cells_text(t.lattice->cells, "x"));
  write_shapes(folder / (stem + "-fem.vtu"), t, t.shapes);
  for (const ModelFrequencies& m : t.models)
    write_shapes(folder / fmt::format("{}-{}-theta{:g}.vtu", stem, m.label, m.consistency), t, m.modes);
}

/// The case with the wanted of its materials.
Experiment with_materials(Experiment e, const std::vector<double>& poisson_ratios) {
  if (poisson_ratios.empty()) return e;
  std::vector<double> known;
  for (const IsotropicMaterial& m : e.materials) known.push_back(m.poisson_ratio);
  std::erase_if(e.materials, [&](const IsotropicMaterial& m) {
    return std::none_of(poisson_ratios.begin(), poisson_ratios.end(),
                        [&](double nu) { return same_poisson_ratio(nu, m.poisson_ratio); });
  });
  if (e.materials.empty())
    throw InputError(fmt::format("--poisson-ratio: {:g} is none of the case's (allowed: {:g})",
                                 fmt::join(poisson_ratios, ", "), fmt::join(known, ", ")));
  return e;
}

}  // namespace

void FrequenciesCommand::add_options(CLI::App& command) {
  command.add_option("CASE", case_, "case file (*.toml) or built-in name (springproof list)")->required();
  command.add_option("--modes", options_.modes, "natural modes to compare, rigid motions not counted")
      ->check(CLI::Range(1, 200))
      ->capture_default_str();
  command
      .add_option("--mass-consistency", options_.consistency,
                  "lattices of cells: shares of consistent mass beside lumped corner masses, each computed")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command.add_flag("--free", options_.free, "leave the supports out: a free body");
  command.add_option("--poisson-ratio", poisson_ratios_, "only these of the case's Poisson's ratios (0.25,0.49)")
      ->delimiter(',');
  command.add_option("--out", out_, "folder for frequencies.json (default: no file)");
  command.add_flag("--vtu", vtu_, "also write the shapes of the modes as VTU files, for ParaView (needs --out)");
  command.footer(
      "The case's supports are held, its other loads left out.  Exit status: 0 all have a result, 1 the reference or a "
      "model has none, 2 the input is unusable, 130 interrupted.");
}

int FrequenciesCommand::run() const try {
  if (vtu_ && out_.empty()) throw InputError("--vtu: needs a folder (allowed: with --out DIR)");
  const std::vector<fs::path> found = find_cases({case_});
  if (found.size() > 1) throw InputError(fmt::format("{} is a folder of {} cases; name one", case_, found.size()));
  const Experiment experiment =
      with_materials(case_of_modes(read_experiment(found.front()), options_), poisson_ratios_);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { fem::interrupt(); });
  Status status;
  bool all = true;
  nlohmann::json tables = nlohmann::json::array();
  const PreparedCase prepared = [&] {
    const Status::Working working(status, experiment.name);
    return prepare_lattices(experiment);
  }();
  if (!out_.empty()) fs::create_directories(out_);
  for (const IsotropicMaterial& material : experiment.materials) {
    const auto solved = [&] {
      const Status::Working working(status, fmt::format("{}, nu = {:g}", experiment.name, material.poisson_ratio));
      return natural_frequencies(prepared, material, options_);
    }();
    for (const FrequencyTable& t : solved) {
      print(experiment, t, options_.modes);
      std::fflush(stdout);
      all = all && t.failure.empty() &&
            std::all_of(t.models.begin(), t.models.end(), [](const auto& m) { return m.message.empty(); });
      if (out_.empty()) continue;
      tables.push_back(json_of(t));
      if (vtu_) write_all_shapes(out_, experiment, t);
    }
  }
  if (!out_.empty())
    write_file(
        fs::path(out_) / "frequencies.json",
        nlohmann::json{{"case", experiment.name}, {"supports", supports_words(experiment)}, {"tables", tables}}.dump(
            2) +
            "\n");
  return all ? 0 : 1;
} catch (const std::runtime_error&) {
  if (children_interrupted()) return frequencies_interrupted;
  throw;
}

}  // namespace springproof
