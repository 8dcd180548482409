#include "comparisons/sweep/suite_results.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "comparisons/judge/calibration.h"
#include "comparisons/judge/judge.h"
#include "comparisons/judge/validation.h"
#include "comparisons/reference/vtu_output.h"
#include "comparisons/report/headline.h"
#include "comparisons/report/report.h"
#include "comparisons/results/crack_picture.h"
#include "comparisons/results/picture.h"
#include "comparisons/sweep/find_cases.h"
#include "meshes/volume.h"
#include "msm/parameters/model_options.h"
#include "problem/files/file_name.h"
#include "problem/files/files.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

template <class T>
void append(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

nlohmann::json host() {
  utsname u{};
  uname(&u);
  std::string processor, line;
  for (std::ifstream in("/proc/cpuinfo"); std::getline(in, line);)
    if (line.starts_with("model name")) {
      processor = line.substr(line.find(':') + 2);
      break;
    }
  return {{"system", fmt::format("{} {}", u.sysname, u.machine)},
          {"processor", processor},
          {"cores", std::thread::hardware_concurrency()}};
}

std::vector<KnownQuantity> known_quantities(const std::vector<CaseResult>& results) {
  std::vector<KnownQuantity> all;
  for (const CaseResult& r : results) append(known_quantities(r), all);
  return all;
}

nlohmann::json document(const std::vector<CaseResult>& results, const std::vector<KnownQuantity>& known,
                        const std::string& libraries) {
  nlohmann::json cases = nlohmann::json::array();
  for (const CaseResult& r : results) cases.push_back(to_json(r));
  return {{"program", {{"name", "springproof"}, {"version", SPRINGPROOF_VERSION}, {"libraries", libraries}}},
          {"generated", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()))},
          {"host", host()},
          {"cases", cases},
          {"calibration", calibration_json(known)}};
}

/// What a model of the case is made of.
std::string made_of(const PreparedCase& p, std::size_t model) {
  const ModelChoice& choice = p.experiment.models[model];
  if (!is_external(choice)) return made_of(p.models[model]);
  return is_own_model(choice) ? "springs of another program" : "another program's, for comparison";
}

/// What is in no region, and each region.
std::vector<RegionRecord> regions_of(const PreparedCase& p) {
  const Experiment& e = p.experiment;
  const Mesh& body = *p.body.of_regions;
  const Eigen::VectorXd volumes = cell_volumes(body, body.nodes);
  std::vector<RegionRecord> all;
  for (std::size_t r = 0; r <= e.regions.size(); ++r) {
    const std::vector<IsotropicMaterial> materials = e.materials_of_part(r);
    RegionRecord& record = all.emplace_back(RegionRecord{
        r == 0 ? "" : e.regions[r - 1].name, material_colour(r), {}, {}, materials.front().density, 0, {}});
    for (const IsotropicMaterial& m : materials) {
      record.youngs_modulus_Pa.push_back(m.youngs_modulus);
      record.poisson_ratio.push_back(m.poisson_ratio);
    }
    for (std::size_t c = 0; c < body.materials.size(); ++c)
      if (body.materials[c] == r) record.volume_m3 += volumes[static_cast<Eigen::Index>(c)];
    for (const Lattice& lattice : p.lattices)
      record.cells.push_back(static_cast<int>(lattice.cut
                                                  ? std::ranges::count(lattice.cut->cells, int(r), &CutCell::material)
                                                  : std::ranges::count(lattice.mesh->materials, r)));
  }
  return all;
}

/// The law, as `kinematics` names it, that a curve follows or is tuned to.
const char* law_of(StrainCurve curve) {
  return name_of(curve == StrainCurve::springs_hencky      ? StrainCurve::hencky
                 : curve == StrainCurve::springs_neo_hooke ? StrainCurve::neo_hooke_isochoric
                                                           : curve);
}

}  // namespace

std::string key_of(const fs::path& file) {
  std::string key = case_name(file);
  std::ranges::replace(key, '/', '-');
  return file_name(key);
}

CaseResult case_of(const PreparedCase& p) {
  CaseResult result;
  result.experiment = p.experiment;
  result.size = p.body.size;
  for (const Lattice& lattice : p.lattices) result.cells.push_back(lattice.cells);
  result.notes = p.body.notes;
  if (p.body.of_regions) {
    result.regions = regions_of(p);
    result.section_svg = section_svg(*p.body.of_regions);
  }
  for (std::size_t m = 0; m < p.models.size(); ++m) {
    const std::string& label = p.experiment.models[m].label;
    result.made_of[label] = made_of(p, m);
    if (const auto own = own_poisson_ratio(p.models[m].row)) result.own_poisson_ratios[label] = *own;
    if (p.models[m].curve && p.experiment.model_kinematics() == Kinematics::finite)
      result.laws[label] = law_of(*p.models[m].curve);
  }
  return result;
}

void append(const Part& from, Part& to) {
  append(from.runs, to.runs);
  append(from.rows, to.rows);
  append(from.references, to.references);
  append(from.pictures, to.pictures);
  append(from.lines, to.lines);
  append(from.histories, to.histories);
  append(from.splits, to.splits);
  append(from.deformations, to.deformations);
  append(from.cracks, to.cracks);
  append(from.limits, to.limits);
  append(from.varied, to.varied);
}

bool write_results(std::vector<CaseResult> results, const std::string& libraries, const SuiteOptions& options) {
  const fs::path& out = options.out;
  if (!options.live_page.empty()) write_file(out / "live.html", text_of_file(options.live_page));
  for (CaseResult& r : results) {
    validate(r);
    judge(r);
    if (options.vtu) write_series(r, out / "vtu" / key_of(r.experiment.file));
    if (options.gltf) write_gltf(r, out / "gltf" / key_of(r.experiment.file));
  }
  const std::vector<KnownQuantity> known = known_quantities(results);
  for (CaseResult& r : results) give_in_units_of_case(r);
  const nlohmann::json doc = document(results, known, libraries);
  nlohmann::json pictures = nlohmann::json::array();
  for (const CaseResult& r : results) pictures.push_back(pictures_to_json(r));
  write_file(out / "results.json", doc.dump(1, ' ', false, nlohmann::json::error_handler_t::replace));
  write_file(out / "results.csv", to_csv(results));
  write_crack_pictures(results, out);
  const Headline h = headline(results);
  write_report(out / "report.html", h, doc, pictures);
  for (const CaseResult& r : results) to_stdout("{}", validation_table(r));
  to_stdout("{}{}report: {}\n", terminal_text(h, options.verbose), calibration_table(known),
            (out / "report.html").string());
  return success(h);
}

}  // namespace springproof
