#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "comparisons/commands/commands.h"
#include "comparisons/judge/calibration.h"
#include "comparisons/models/frequencies.h"
#include "comparisons/report/words.h"
#include "comparisons/results/records.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/find_cases.h"
#include "comparisons/sweep/status.h"
#include "meshes/field.h"
#include "problem/files/files.h"
#include "problem/processes/child.h"
#include "problem/processes/interrupts.h"
#include "problem/system/json.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

std::string name_of(const ModelFrequencies& m) {
  return m.consistency > 0 ? fmt::format("{} {:g}", m.label, m.consistency) : m.label;
}

std::string supports_words(const Experiment& e) {
  std::vector<std::string> patches;
  for (const Load& load : supports_of(e))
    if (const std::string& on = *patch_of(load); std::ranges::find(patches, on) == patches.end()) patches.push_back(on);
  return patches.empty() ? "free" : fmt::format("held on {}", fmt::join(patches, ", "));
}

using ModelCells = std::array<std::string, 3>;  ///< frequency, error, MAC
constexpr std::size_t models_abreast = 2;       // in 80 columns

void print_line(const std::string& mode, const std::string& fem, const std::string& uncertainty,
                const std::vector<ModelCells>& models) {
  to_stdout("{:>4}{:>11}{:>10}", mode, fem, uncertainty);
  for (const auto& [frequency, error, mac] : models) to_stdout("{:>12}{:>10}{:>5}", frequency, error, mac);
  to_stdout("\n");
}

/// Of a model's frequency from the reference's; none of a mode without a partner.
std::optional<double> error_of(const FrequencyTable& t, const ModelFrequencies& m, std::size_t i) {
  const std::optional<double>& frequency = m.rows[i].frequency;
  return frequency ? std::optional(*frequency / t.reference[i].value - 1) : std::nullopt;
}

ModelCells cells_of(const FrequencyTable& t, const ModelFrequencies& m, std::size_t i) {
  if (i >= t.reference.size())
    return {i < m.modes.frequencies.size() ? fmt::format("{:.5g}", m.modes.frequencies[i]) : "", "", ""};
  const ModeRow& row = m.rows[i];
  const std::string mac = fmt::format("{:.2f}", row.mac);
  if (!row.frequency) return {"no partner", "", mac};
  return {fmt::format("{:.5g}", *row.frequency), fmt::format("{:+.2f}", 100 * *error_of(t, m, i)), mac};
}

void print_modes(const FrequencyTable& t, const std::vector<const ModelFrequencies*>& models, int modes) {
  to_stdout("\n{:{}}", "", models.empty() ? 0 : 25);
  std::vector<ModelCells> rms, largest;
  for (const ModelFrequencies* m : models) {
    to_stdout("{:>27.26}", name_of(*m));
    rms.push_back({"", fmt::format("{:.2f}", 100 * m->rms), ""});
    largest.push_back({"", fmt::format("{:.2f}", 100 * m->largest), ""});
  }
  if (!models.empty()) to_stdout("\n");
  print_line("mode", "FEM [Hz]", "+- [Hz]", std::vector<ModelCells>(models.size(), {"[Hz]", "error [%]", "MAC"}));
  for (std::size_t i = 0; i < static_cast<std::size_t>(modes); ++i) {
    const bool known = i < t.reference.size();
    std::vector<ModelCells> cells;
    for (const ModelFrequencies* m : models) cells.push_back(cells_of(t, *m, i));
    print_line(std::to_string(i + 1), known ? fmt::format("{:.5g}", t.reference[i].value) : "",
               known ? fmt::format("{:.1g}", t.reference[i].uncertainty) : "", cells);
  }
  if (t.reference.empty() || models.empty()) return;
  print_line("rms", "", "", rms);
  print_line("max", "", "", largest);
}

/// "nu = 0.3", beside a list in a region "E of core = 1e+06 Pa, nu = 0.3".
std::string words_of(const Experiment& e, const IsotropicMaterial& m) {
  const std::string listed = e.listed.region > 0 ? words::setting_text(e, e.settings().front()) + ", " : "";
  return fmt::format("{}nu = {:g}", listed, m.poisson_ratio);
}

void print(const Experiment& e, const FrequencyTable& t, int modes) {
  to_stdout("\n{}: {}, {} cells, {}, E = {:g} Pa, {:g} kg/m^3\n", e.name, words_of(e, t.material),
            cells_text(t.lattice->cells, " x "), supports_words(e), t.material.youngs_modulus, t.material.density);
  if (t.failure.empty())
    to_stdout(
        "FEM: {}; {} rigid motions left out.\n"
        "Error of a model's frequency from that of FEM; MAC: likeness of their shapes, 1: the same.\n"
        "A number after a model's name: share of consistent mass.\n",
        t.form, t.rigid_motions);
  else
    to_stdout("no reference: {}\n", t.failure);
  std::vector<const ModelFrequencies*> shown;
  for (const ModelFrequencies& m : t.models) {
    if (m.message.empty())
      shown.push_back(&m);
    else
      to_stdout("{}: {}\n", name_of(m), m.message);
  }
  for (std::size_t first = 0; first == 0 || first < shown.size(); first += models_abreast)
    print_modes(t, {shown.begin() + first, shown.begin() + std::min(first + models_abreast, shown.size())}, modes);
  for (const ModelFrequencies* m : shown) {
    std::vector<std::string> percent;
    for (std::size_t i = 0; i < std::min(m->modes.damping.size(), static_cast<std::size_t>(modes)); ++i)
      percent.push_back(fmt::format("{:.3g}", 100 * m->modes.damping[i]));
    if (!percent.empty())
      to_stdout("damping of {} by its branches, in % of critical, mode by mode: {}\n", name_of(*m),
                fmt::join(percent, ", "));
  }
}

nlohmann::json json_of(const FrequencyTable& t) {
  nlohmann::json out = {{"poisson_ratio", t.material.poisson_ratio},
                        {"youngs_modulus_Pa", t.material.youngs_modulus},
                        {"density_kg_m3", t.material.density},
                        {"cells", t.lattice->cells},
                        {"reference",
                         {{"element", t.element},
                          {"form", t.form},
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
                            {"damping_ratios", m.modes.damping},
                            {"rms_error", m.rms},
                            {"largest_error", m.largest},
                            {"pairs", nlohmann::json::array()}};
    for (std::size_t i = 0; i < m.rows.size(); ++i)
      model["pairs"].push_back({{"mode", i + 1},
                                {"frequency_Hz", m.rows[i].frequency},
                                {"error", error_of(t, m, i)},
                                {"mac", m.rows[i].mac}});
    out["models"].push_back(model);
  }
  return out;
}

void write_shapes(const fs::path& file, const FrequencyTable& t, const ModeSet& modes) {
  if (modes.shapes.empty()) return;
  NodalFields shapes;
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

/// The case with the wanted of its settings.
Experiment with_settings(Experiment e, const std::vector<double>& wanted) {
  if (wanted.empty()) return e;
  const std::vector<double> known = e.settings();
  e.leave_out_settings([&](double setting) {
    return std::ranges::none_of(wanted, [&](double w) { return same_poisson_ratio(w, setting); });
  });
  if (e.settings().empty())
    throw InputError(fmt::format("--poisson-ratio: {:g} is none of the case's (allowed: {:g})", fmt::join(wanted, ", "),
                                 fmt::join(known, ", ")));
  return e;
}

/// `springproof frequencies CASE`.
class FrequenciesCommand {
 public:
  void add_options(CLI::App& command);
  /// @return 0, or 1 if the reference or a model has no result; 130 if interrupted.
  int run() const;

 private:
  std::string case_, out_;
  std::vector<double> poisson_ratios_;
  FrequencyOptions options_;
  bool vtu_ = false;
};

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
  const Experiment whole = read_experiment(find_case(case_));
  const Experiment experiment = with_settings(case_of_modes(whole, options_), poisson_ratios_);
  require_one_listed(experiment);
  end_at_interrupts();
  Status status;
  bool all = true;
  nlohmann::json tables = nlohmann::json::array();
  std::vector<KnownQuantity> known;
  const PreparedCase prepared = [&] {
    const Status::Working working(status, experiment.name);
    return at_setting(prepare_lattices(experiment), 0);
  }();
  if (!out_.empty()) fs::create_directories(out_);
  const std::string listed =
      experiment.listed.region > 0 ? words::setting_text(experiment, experiment.settings().front()) : "";
  for (const IsotropicMaterial& material : experiment.materials) {
    const auto solved = [&] {
      const Status::Working working(status, fmt::format("{}, {}", experiment.name, words_of(experiment, material)));
      return natural_frequencies(prepared, material, options_);
    }();
    std::ranges::copy(known_quantities(experiment, records_of(solved.front())), std::back_inserter(known));
    for (const FrequencyTable& t : solved) {
      print(experiment, t, options_.modes);
      std::fflush(stdout);
      all = all && t.failure.empty() && std::ranges::all_of(t.models, [](const auto& m) { return m.message.empty(); });
      if (out_.empty()) continue;
      tables.push_back(json_of(t));
      if (vtu_) write_all_shapes(out_, experiment, t);
    }
  }
  if (!out_.empty())
    write_file(fs::path(out_) / "frequencies.json", nlohmann::json{{"case", experiment.name},
                                                                   {"listed", listed},
                                                                   {"supports", supports_words(experiment)},
                                                                   {"tables", tables},
                                                                   {"calibration", calibration_json(known)}}
                                                            .dump(2) +
                                                        "\n");
  if (!known.empty()) to_stdout("\n{}", calibration_table(known));
  return all ? 0 : 1;
} catch (const std::runtime_error&) {
  if (children_interrupted()) return interrupted_status;
  throw;
}

}  // namespace

RunCommand frequencies_command(CLI::App& parser) { return made<FrequenciesCommand>(parser); }

}  // namespace springproof
