#include "comparisons/advise/measure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>

#include "comparisons/run/case_run.h"
#include "comparisons/run/find_cases.h"
#include "comparisons/run/prepare.h"
#include "comparisons/run/status.h"
#include "fem_reference/reference.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

std::atomic<bool> measuring_stopped = false;

/// One body under one load: what a row of the file is measured in.
struct Setting {
  std::string load, body;
  double slenderness, strain;
  std::vector<int> cells_across;
  Cells reference;  ///< of blocks
  std::vector<double> poisson_ratios;
};

const std::vector<double> all_ratios = {0.25, 0.45, 0.499, 0, -0.5}, two_ratios = {0.25, 0.45}, one_ratio = {0.3};

// clang-format off
const std::vector<Setting> settings = {
  {"bending", "block", 4,   0,   {2, 3, 4, 6, 8},     {24, 8, 8},   all_ratios},
  {"axial",   "block", 1,   0,   {2, 3, 4, 6, 8},     {12, 12, 12}, all_ratios},
  {"torsion", "block", 3,   0,   {2, 3, 4, 6, 8},     {24, 8, 8},   all_ratios},
  {"shear",   "block", 1,   0,   {2, 3, 4, 6, 8},     {12, 12, 12}, all_ratios},
  {"bending", "block", 10,  0,   {2, 3, 4, 6},        {40, 8, 8},   two_ratios},
  {"axial",   "block", 4,   0,   {2, 3, 4, 6, 8},     {24, 8, 8},   two_ratios},
  {"bending", "block", 4,   0.2, {2, 4, 6},           {16, 8, 8},   two_ratios},
  {"axial",   "block", 1,   0.2, {2, 4, 8},           {8, 8, 8},    two_ratios},
  {"bending", "round", 4,   0,   {2, 3, 4, 6},        {0, 0, 0},    one_ratio},
};
// clang-format on

constexpr double modulus = 1e4, small_strain = 0.001;

/// The moved end of a body of thickness 1 m whose other end is held.
std::string load_text(const Setting& s) {
  const bool round = s.body == "round";
  const double strain = s.strain > 0 ? s.strain : small_strain, length = s.slenderness;
  const auto vector = [&](double along, double across) {  // the axis of a block is x, that of a cylinder z
    return round ? fmt::format("[{}, 0, {}]", across, along) : fmt::format("[{}, {}, 0]", along, across);
  };
  std::string text = fmt::format("[[load]]\non = \"{}\"\n", round ? "top" : "x_max");
  if (s.load == "axial") return text + fmt::format("displacement_m = {}\n", vector(-strain * length, 0));
  if (s.load == "shear") return text + fmt::format("displacement_m = {}\n", vector(0, strain * length));
  if (s.load == "torsion")
    return text + fmt::format("rotation_deg = {}\naxis = {}\nabout_m = [{}]\n", strain * length * 360 / M_PI,
                              vector(1, 0), round ? "0.5, 0.5, 0" : "0, 0.5, 0.5");
  const double section = round ? M_PI / 32 : 1.0 / 6;  // modulus: the largest strain at the root is `strain`
  return text + fmt::format("force_N = {}\n", vector(0, strain * modulus * section / length));
}

std::string models_text(const Setting& s) {
  if (s.body == "round")
    return R"("hybmss_avg", "hybmss_bt", "hybmss", { model = "hybmss_avg", cut = false }, { model = "hybmss_bt", cut = false }, { model = "hybmss", cut = false }, "emsm")";
  if (s.strain > 0) return R"("hybmss_avg", "hybmss", "emsm")";
  return R"("hybmss_avg", "hybmss_bt", "hybmss", "emsm", "msm_18", "emsm_patch")";
}

Experiment case_of(const Setting& s, double nu) {
  const bool round = s.body == "round";
  std::vector<std::string> cells;
  for (const int n : s.cells_across) {
    const double across = s.slenderness < 1 ? n / s.slenderness : n;  // the thickness is the shortest edge
    cells.push_back(round ? fmt::format("{}", 1.0 / n)
                          : fmt::format("[{:g}, {:g}, {:g}]", across * s.slenderness, across, across));
  }
  std::string text = round ? fmt::format("[body]\ngeo = \"cylinder.geo\"\nsize_m = [1, 1, {}]\nvoxel_edge_m = [{}]\n",
                                         s.slenderness, fmt::join(cells, ", "))
                           : fmt::format("[body]\ngeo = \"block.geo\"\nsize_m = [{}, 1, 1]\ncells = [{}]\n",
                                         s.slenderness, fmt::join(cells, ", "));
  text += fmt::format("[material]\nyoungs_modulus_Pa = {}\npoisson_ratio = {}\n", modulus, nu);
  text += fmt::format("[[load]]\non = \"{}\"\ndisplacement_m = [0, 0, 0]\n", round ? "bottom" : "x_min") + load_text(s);
  text += fmt::format("[compare]\nmodels = [{}]\nelements = [\"q1\", \"q2\"]\nmax_unknowns = 12000\n", models_text(s));
  text += "measures = [\"displacement_error\"]\n";
  if (!round) text += fmt::format("[reference]\ncells = [{}]\n", fmt::join(s.reference, ", "));
  if (s.strain > 0) text = "kinematics = \"hencky\"\n" + text;
  Experiment e = parse_experiment(text, fmt::format("{}-{}-{:g}.toml", s.load, s.body, s.slenderness));
  if (round || s.strain > 0) e.elements.clear();
  return e;
}

/// The rows of one case at its only material; `blank` has what they share, `across` the cells across of each lattice.
void add_rows(const Experiment& e, Measurement blank, const std::vector<double>& across, MeasuredFile& out) {
  const PreparedCase prepared = prepare(e);
  const Part part = run_part(prepared, 0, {});
  blank.poisson_ratio = e.materials.front().poisson_ratio;
  for (const Row& row : part.rows) {
    if (row.measure != "displacement_error" || !row.reference_uncertainty || row.model.ends_with(extrapolated_suffix))
      continue;
    Measurement m = blank;
    m.model = row.model.substr(0, row.model.find(" seeds="));
    m.error = row.value;
    m.uncertainty = *row.reference_uncertainty;
    for (std::size_t i = 0; i < prepared.lattices.size(); ++i)
      if (prepared.lattices[i].cells == row.cells)
        m.cells_across = across.empty() ? std::cbrt(prepared.lattices[i].mesh->hexahedra.size()) : across[i];
    if (m.cells_across > 0) out.rows.push_back(m);
  }
}

struct Work {
  std::string title;
  Measurement blank;
  Experiment experiment;
  std::vector<double> across;
};

std::vector<Work> blocks_and_bars() {
  std::vector<Work> all;
  for (const Setting& s : settings)
    for (const double nu : s.poisson_ratios)
      all.push_back(
          {fmt::format("{}, {}, slenderness {:g}, strain {:g}, nu = {:g}", s.load, s.body, s.slenderness, s.strain, nu),
           {s.load, s.body, s.slenderness, s.strain, nu, {}, 0, 0, 0},
           case_of(s, nu),
           {s.cells_across.begin(), s.cells_across.end()}});
  return all;
}

std::vector<Work> held_out_work() {
  std::vector<Work> all;
  for (const Experiment& e : held_out_cases())
    for (const IsotropicMaterial& material : e.materials) {
      Experiment one = e;
      one.materials = {material};
      const std::string name = case_name(e.file);
      all.push_back({fmt::format("{}, nu = {:g}", name, material.poisson_ratio),
                     {name, e.body.is_voxels() ? "voxels" : "block", 0, 0, material.poisson_ratio, {}, 0, 0, 0},
                     one,
                     {}});
    }
  return all;
}

constexpr const char* header_of_settings =
    R"( Displacement errors of models and finite elements in clamped blocks and round bars, against the finite element reference.
 Made by:  springproof advise --measure FILE   (keeps what FILE holds already; a quarter of an hour of one core)
 slenderness: length over thickness; cells_across: of the thinnest part; strain 0: small; error, uncertainty: as parts of the displacement.
)";
constexpr const char* header_of_held_out =
    R"( Displacement errors in cases that were not used to make the predictions, by which these are judged (springproof advise --check).
 Made by:  springproof advise --measure-held-out FILE
 load: the case; cells_across: cube root of the number of cells; error, uncertainty: as parts of the displacement.
)";

}  // namespace

int measure(const fs::path& file, bool held_out) {
  MeasuredFile out;
  if (fs::exists(file)) out = read_measurements(file);
  out.header = held_out ? header_of_held_out : header_of_settings;
  for (const int signal : {SIGINT, SIGTERM})
    std::signal(signal, [](int) {
      measuring_stopped = true;
      fem::interrupt();
    });
  const std::vector<Work> all = held_out ? held_out_work() : blocks_and_bars();
  Status status;
  std::size_t number = 0;
  for (const Work& w : all) {
    ++number;
    const bool known = std::any_of(out.rows.begin(), out.rows.end(), [&](const Measurement& m) {
      return m.load == w.blank.load && m.body == w.blank.body && m.slenderness == w.blank.slenderness &&
             m.strain == w.blank.strain && same_poisson_ratio(m.poisson_ratio, w.blank.poisson_ratio);
    });
    if (known) continue;
    const std::size_t before = out.rows.size();
    {
      const Status::Working working(status, fmt::format("[{}/{}] {}", number, all.size(), w.title));
      add_rows(w.experiment, w.blank, w.across, out);
    }
    if (measuring_stopped) return 130;
    write_measurements(file, out);
    status.print(fmt::format("[{}/{}] {}: {} errors", number, all.size(), w.title, out.rows.size() - before));
  }
  return 0;
}

Experiment measured_case(const Measurement& row) {
  for (const Setting& s : settings)
    if (s.load == row.load && s.body == row.body && s.slenderness == row.slenderness && s.strain == row.strain)
      return case_of(s, row.poisson_ratio);
  throw std::invalid_argument("no such case was measured");
}

std::vector<Experiment> held_out_cases() {
  struct Chosen {
    std::string name;
    std::vector<double> poisson_ratios;
  };
  const std::vector<Chosen> chosen = {{"golec_2019/compression", {-0.5, 0.25, 0.499}},
                                      {"golec_2019/tension", {-0.5, 0.45}},
                                      {"golec_2019/shear", {0.25, 0.45}},
                                      {"golec_2019/torsion", {0.45}},
                                      {"golec_2019/bending", {-0.5, 0.25, 0.499}},
                                      {"kot_2014/fig_13", {}},
                                      {"bodies/l_bracket", {0.3}},
                                      {"bodies/rabbit", {0.25}},
                                      {"bodies/hand_pressed", {0.3}}};
  std::vector<Experiment> cases;
  const auto keep = [](Experiment e, const std::vector<double>& ratios) {
    std::erase_if(e.materials, [&](const IsotropicMaterial& m) {
      return !ratios.empty() && std::none_of(ratios.begin(), ratios.end(),
                                             [&](double nu) { return same_poisson_ratio(nu, m.poisson_ratio); });
    });
    // Only models that advice knows, without options.
    static const std::vector<std::string> known = {"hybmss_avg", "hybmss_bt", "hybmss", "emsm", "msm_18", "emsm_patch"};
    std::erase_if(e.models,
                  [&](const ModelChoice& m) { return std::find(known.begin(), known.end(), m.label) == known.end(); });
    e.measures = {"displacement_error"};
    e.elements.clear();
    e.probes.clear();
    e.section.reset();
    e.expectations.clear();
    e.published.clear();
    return e;
  };
  for (const fs::path& file : find_cases({(advise_folder() / "held_out").string()}))
    cases.push_back(keep(read_experiment(file), {}));
  for (const Chosen& c : chosen) cases.push_back(keep(read_experiment(find_cases({c.name}).front()), c.poisson_ratios));
  return cases;
}

}  // namespace springproof
