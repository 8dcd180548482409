// Figures of Kot et al. (2014).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "comparisons/reproduce/curves.h"
#include "comparisons/reproduce/figures.h"

namespace springproof {
namespace {

const std::string kot_a = "kot_2014/figs_3_4_5_set_a", kot_b = "kot_2014/figs_3_4_5_set_b",
                  bar_small = "kot_2014/fig_13", bar_large = "kot_2014/fig_14",
                  kelvin_held = "kot_2014/figs_6_to_11_surface_held",
                  kelvin_exact = "kot_2014/figs_6_to_11_surface_kelvin";
const char* springs_per_node = "average number of springs per node ⟨S⟩";

/// E by (20) over k0/a0 of a network of equal springs: sum of L^2 over 6 V, V = 70 x 15 x 15 a0^3 (a0 = 1 m).
std::map<std::string, double> estimates(const PaperResults& results, const std::string& case_name) {
  std::map<std::string, double> all;
  for (const Row& row : results.rows(case_name)) {
    if (row.measure != "network.springs") continue;
    const Row* mean = results.row(case_name, row.model, 0.25, "network.mean_length");
    const Row* deviation = results.row(case_name, row.model, 0.25, "network.length_deviation");
    if (mean && deviation)
      all[row.model] =
          row.value * (mean->value * mean->value + deviation->value * deviation->value) / (6 * 70 * 15 * 15);
  }
  return all;
}

/// E against <S> in k0/a0: measured over `calibrated` (the E that (20) gives in the case) times the estimate.
void add_moduli(const PaperResults& results, const std::string& case_name, const std::string& set, Chart& chart) {
  constexpr double calibrated = 1e4;
  Curve estimate{"set " + set + ", eq. (20)", set == "A" ? CurveStyle::theory : CurveStyle::fem, {}},
      measured{"set " + set + ", measured", CurveStyle::ours_points, {}};
  for (const auto& [model, value] : estimates(results, case_name)) {
    const Row* S = results.row(case_name, model, 0.25, "network.springs_per_node");
    const Row* E = results.row(case_name, model, 0.25, "moduli.youngs_modulus");
    if (S) estimate.points.push_back({S->value, value});
    if (S && E) measured.points.push_back({S->value, E->value / calibrated * value});
  }
  for (Curve* curve : {&estimate, &measured})
    std::ranges::stable_sort(curve->points, [](const CurvePoint& a, const CurvePoint& b) { return a.x < b.x; });
  chart.curves.push_back(std::move(estimate));
  chart.curves.push_back(std::move(measured));
}

std::vector<Chart> moduli_chart(const PaperResults& results) {
  Chart chart{"", springs_per_node, "Young's modulus E [k₀/a₀]", {}};
  add_moduli(results, kot_a, "A", chart);
  add_moduli(results, kot_b, "B", chart);
  return {chart};
}

std::vector<Chart> poisson_chart(const PaperResults& results) {
  Chart chart{"", springs_per_node, "Poisson's ratio ν", {}};
  const std::string x = "network.springs_per_node", y = "moduli.poisson_ratio";
  chart.curves = {level_band(8, 25, 0.25, 0.005, "within 2 % of 1/4 (the paper)"),
                  formula(
                      8, 25, {"theory, ν = 1/4", CurveStyle::theory, {}}, [](double) { return 0.25; }, 2),
                  against_measure(results, kot_a, 0.25, x, y, {"set A (ours)", CurveStyle::ours_points, {}}),
                  against_measure(results, kot_b, 0.25, x, y, {"set B (ours)", CurveStyle::ours_points, {}})};
  return {chart};
}

Curve relative_difference_of_E(const PaperResults& results, const std::string& case_name, const std::string& measure,
                               const Curve& look) {
  Curve curve = against_measure(results, case_name, 0.25, "network.springs_per_node", measure, look, 100 / 1e4);
  for (CurvePoint& p : curve.points) p.y -= 100;
  return curve;
}

std::vector<Chart> difference_chart(const PaperResults& results) {
  Chart chart{"", springs_per_node, "E measured over eq. (20), difference [%]", {}};
  const std::string nominal = "moduli.youngs_modulus", local = "moduli.youngs_modulus_local";
  chart.curves = {
      level_band(15, 25, 0, 5, "within 5 % (the paper)"),
      relative_difference_of_E(results, kot_a, nominal, {"set A, as the paper measures", CurveStyle::ours_points, {}}),
      relative_difference_of_E(results, kot_b, nominal, {"set B, as the paper measures", CurveStyle::ours_points, {}}),
      relative_difference_of_E(results, kot_a, local, {"set A, strain in the middle", CurveStyle::ours_points, {}}),
      relative_difference_of_E(results, kot_b, local, {"set B, strain in the middle", CurveStyle::ours_points, {}})};
  return {chart};
}

using Charts = std::function<std::vector<Chart>(const PaperResults&)>;

PaperFigure chart_figure(const std::string& id, const std::string& what, const std::vector<std::string>& cases,
                         const Charts& charts, const std::vector<Claim>& claims, const std::string& reason) {
  return {id, what, cases, reason, claims, charts};
}

/// Profile of component 12 along the line; the values near the force run off the axes.
std::vector<Chart> profile(const PaperResults& results, bool stress, const std::string& model) {
  constexpr int xy = 3;
  Chart chart{"", "position on the line [%]: 0 force, 100 surface", stress ? "stress σ₁₂ [k₀/a₀]" : "strain ε₁₂", {}};
  chart.curves = {along_line(results, kelvin_held, model, stress, xy, false,
                             {model + ", surface held (ours)", CurveStyle::ours_bare, {}}),
                  along_line(results, kelvin_exact, model, stress, xy, false,
                             {model + ", Kelvin's displacement on the surface (ours)", CurveStyle::ours_bare, {}}),
                  along_line(results, kelvin_held, model, stress, xy, true,
                             {stress ? "Kelvin, eq. (24)" : "Kelvin, eq. (23)", CurveStyle::theory, {}})};
  double low = 0, high = 0;
  for (const Curve& curve : chart.curves)
    for (const CurvePoint& p : curve.points)
      if (p.x >= 15) low = std::min(low, p.y), high = std::max(high, p.y);
  chart.y_range = {1.1 * low, high > 0 ? 1.1 * high : -0.05 * low};
  chart.x_range = {0, 100};
  return {chart};
}

std::vector<Chart> deviations(const PaperResults& results, const std::string& quantity) {
  Chart chart{"", "component", "mean deviation from Kelvin [%]", {}};
  chart.categories = {"11", "22", "33", "12", "23", "13"};
  const char* components[] = {"xx", "yy", "zz", "xy", "yz", "xz"};
  for (const char* model : {"cubic", "S18", "S15", "S11"}) {
    Curve curve{std::string(model) + " (ours)", CurveStyle::ours, {}};
    for (int c = 0; c < 6; ++c)
      if (const Row* row = results.row(kelvin_held, model, 0.25, "line." + quantity + "." + components[c]))
        curve.points.push_back(
            {static_cast<double>(c), 100 * row->value, row->spread ? std::optional(100 * *row->spread) : std::nullopt});
    chart.curves.push_back(std::move(curve));
  }
  return {chart};
}

constexpr double beam_length = 4, beam_modulus = 250;

/// (25): y = F/E 2 x^2 (3 L - x).
double equation_25(double x, double force) { return force / beam_modulus * 2 * x * x * (3 * beam_length - x); }

Chart deflections(const PaperResults& results, const std::string& case_name, double force) {
  const std::vector<std::pair<double, std::string>> probes = {{0.5, "x05"}, {1, "x1"}, {1.5, "x15"}, {2, "x2"},
                                                              {2.5, "x25"}, {3, "x3"}, {3.5, "x35"}, {4, "x4"}};
  const Cells low = {8, 2, 2}, high = {16, 4, 4};
  const auto ours = [&](const char* label, const char* model, const Cells& cells) {
    return along_probes(results, case_name, model, 0.25, "y", probes, {label, CurveStyle::ours, {}}, cells);
  };
  Chart chart{"", "distance from the fixed end x [a₀]", "deflection Δy [a₀]", {}};
  chart.curves = {
      formula(0, beam_length, {"eq. (25)", CurveStyle::theory, {}}, [&](double x) { return equation_25(x, force); }),
      along_probes(results, case_name, "msm_18", 0.25, "y", probes, {"finite elements (ours)", CurveStyle::fem, {}},
                   high, true),
      ours("low resolution cubic, 32 nodes", "msm_centred", low),
      ours("high resolution cubic, 256 nodes", "msm_centred", high),
      ours("low resolution random, about 57 nodes (mean and spread of ten)", "random low", low),
      ours("medium resolution random, about 161 nodes (mean and spread of ten)", "random medium", high),
      ours("superposed cubes, 2 across", "msm_18", low),
      ours("superposed cubes, 4 across", "msm_18", high)};
  return chart;
}

/// Of the networks whose ⟨S⟩, counted over the whole block, is 16 to 24.
Claim in_range(const std::string& words, const std::string& case_name, const std::string& measure, double value,
               double within) {
  return Claim{words, case_name, measure, {"S18", "S22", "S26"}}.near(value, within);
}

/// Shown and not judged: the paper prints no numbers.
Claim deviation_of(const std::string& model, const std::string& quantity) {
  return Claim{
      "mean deviation from Kelvin, all components, " + model, kelvin_held, "line." + quantity + ".all", {model}}
      .at_most(-1);
}

Claim tip_of_bar(const std::string& case_name, const std::string& model, const std::string& words) {
  return {words, case_name, "displacement.x4.y", {model}};
}

const std::string relaxes =
    "a disordered network relaxes, (20) is an upper bound: E of the strain in the middle is 3 to 10 % below it "
    "(docs/papers.md #17)";

std::vector<PaperFigure> moduli_figures() {
  const std::string E = "moduli.youngs_modulus", nu = "moduli.poisson_ratio", local_E = "moduli.youngs_modulus_local";
  const std::vector<std::string> sets = {kot_a, kot_b};
  return {
      chart_figure("3", "Young's modulus of random networks against ⟨S⟩", sets, moduli_chart,
                   {in_range("set A: E within 5 % of (20) for ⟨S⟩ of 16 to 24", kot_a, E, 1e4, 0.05).by_the_paper(),
                    in_range("set B: E within 5 % of (20) for ⟨S⟩ of 16 to 24", kot_b, E, 1e4, 0.05).by_the_paper()},
                   "as the paper measures it, over the nominal length; " + relaxes),
      chart_figure("4", "Poisson's ratio of random networks against ⟨S⟩", sets, poisson_chart,
                   {in_range("set A: ν within 2 % of 1/4 for ⟨S⟩ of 16 to 24", kot_a, nu, 0.25, 0.02).by_the_paper(),
                    in_range("set B: ν within 2 % of 1/4 for ⟨S⟩ of 16 to 24", kot_b, nu, 0.25, 0.02).by_the_paper()},
                   ""),
      chart_figure(
          "5", "E measured over (20)", sets, difference_chart,
          {in_range("set A: within 5 % for ⟨S⟩ of 16 to 24, as the paper measures", kot_a, E, 1e4, 0.05).by_the_paper(),
           in_range("set B: within 5 % for ⟨S⟩ of 16 to 24, as the paper measures", kot_b, E, 1e4, 0.05).by_the_paper(),
           in_range("set A: by the strain in the middle", kot_a, local_E, 1e4, 0.05),
           in_range("set B: by the strain in the middle", kot_b, local_E, 1e4, 0.05)},
          relaxes),
  };
}

std::vector<PaperFigure> line_figures() {
  const std::vector<std::string> both = {kelvin_held, kelvin_exact};
  const std::string reason =
      "the paper does not say what holds the sphere: both cases are drawn; (24) is printed with the wrong sign "
      "(docs/papers.md #19)";
  const Claim strain{"errors of strain grow as ⟨S⟩ falls",
                     kelvin_held,
                     "line.strain.all",
                     {"cubic", "S18", "S15", "S11"},
                     Claim::ascending},
      cubic{"stress of the cubic lattice is the nearest",
            kelvin_held,
            "line.stress.all",
            {"cubic", "S18"},
            Claim::ascending};
  Claim stress = Claim{
      "errors of stress change less with ⟨S⟩ than those of strain",
      kelvin_held,
      "line.stress.all",
      {"S18", "S15",
       "S11"}}.alike(0);
  stress.against = "line.strain.all";
  const auto along = [&](const std::string& id, const std::string& model, bool of_stress) {
    return chart_figure(
        id, fmt::format("{} along the line, {}", of_stress ? "Stress σ₁₂" : "Strain ε₁₂", model), both,
        [=](const PaperResults& r) { return profile(r, of_stress, model); },
        {deviation_of(model, of_stress ? "stress" : "strain")}, reason);
  };
  return {
      along("6", "S18", true),
      along("7", "S11", true),
      along("8", "S18", false),
      along("9", "S11", false),
      chart_figure(
          "10", "Mean deviation of the strain components", {kelvin_held},
          [](const PaperResults& r) { return deviations(r, "strain"); }, {strain},
          "no numbers are printed; nearly half of the growth to S11 is (20), which makes networks too soft "
          "(docs/papers.md #17)"),
      chart_figure(
          "11", "Mean deviation of the stress components", {kelvin_held},
          [](const PaperResults& r) { return deviations(r, "stress"); }, {cubic, stress}, "no numbers are printed"),
  };
}

/// The paper's 5 % and 10 to 15 % are how much its own runs of a random network differ, no distance from (25).
PaperFigure small_force() {
  const double tip = equation_25(beam_length, 0.1);
  const Cells low = {8, 2, 2}, high = {16, 4, 4};
  const auto of = [](const std::string& model, const std::string& words) {
    return tip_of_bar(bar_small, model, words);
  };
  return chart_figure(
      "13", "Deflection of a bar by a small force: four networks and (25)", {bar_small},
      [](const PaperResults& r) { return std::vector{deflections(r, bar_small, 0.1)}; },
      {of("msm_centred", "cubic networks depend only weakly on the resolution").alike(0.05),
       of("msm_centred", "cubic networks follow (25)").near(tip, 0.05),
       of("random medium", "runs of medium random networks scatter").scattering(0.05).on(high).by_the_paper(),
       of("random low", "runs of low resolution random networks scatter").scattering(0.15).on(low).by_the_paper(),
       of("random medium", "medium random networks beside (25)").near(tip, -1).on(high),
       of("random low", "low resolution random networks beside (25)").near(tip, -1).on(low)},
      "(25) leaves out shear: the solid is 3 % softer. The paper's 5 and 15 % are its scatter between runs; no "
      "distance "
      "from (25) is stated. Random networks of so few nodes are soft and scatter; their construction is not printed in "
      "full (docs/papers.md, section 6)");
}

PaperFigure large_force() {
  PaperFigure figure = chart_figure(
      "14", "A bar bent by a large force: four networks", {bar_large},
      [](const PaperResults& r) {
        Chart chart = deflections(r, bar_large, 4.1);
        chart.curves.erase(chart.curves.begin());  // (25) does not hold there
        return std::vector{chart};
      },
      {tip_of_bar(bar_large, "msm_centred", "cubic networks agree with each other and with the solid").near_fem(0.1),
       tip_of_bar(bar_large, "random medium", "medium random networks are near them").near_fem(0.1).on({16, 4, 4}),
       tip_of_bar(bar_large, "random low", "low resolution random networks are near them").near_fem(0.1).on({8, 2, 2})},
      "the small random networks are 13 % too soft and scatter by as much (docs/papers.md, section 6)");
  const Cells drawn = {8, 2, 2};  // the lattice whose nodes the report keeps
  figure.bodies = {{"cubic, superposed", bar_large, "msm_18", 0.25, drawn},
                   {"cubic, node-centred", bar_large, "msm_centred", 0.25, drawn},
                   {"random, low", bar_large, "random low", 0.25, drawn},
                   {"random, medium", bar_large, "random medium", 0.25, drawn}};
  figure.columns = 4;
  figure.view = {{0.25, 0.2, 1}, {0, 1, 0}};
  return figure;
}

PaperFigure cracks() {
  const std::string drying = "kot_2014/fig_15";
  PaperFigure figure{"15",
                     "Cracks on a drying cylinder, seen from above",
                     {drying},
                     "the paper states neither drying nor breaking: the protocol is ours "
                     "(docs/fracture.md)"};
  figure.claims = {
      Claim{"cracks of 14 springs follow the axes of their lattice (mean of cos 4φ, 0 without a direction)",
            drying,
            "fracture.along_4",
            {"14 springs"}}
          .near(0.4, 0.5),
      Claim{"cracks of disordered networks follow no direction (|mean of cos 4φ| up to 0.15)",
            drying,
            "fracture.along_4",
            {"msm_random"}}
          .at_most(0.15)};
  figure.cracks = {"18 springs", "14 springs", "msm_random"};
  return figure;
}

}  // namespace

std::vector<PaperFigure> kot_2014_figures() {
  std::vector<PaperFigure> all = {{"1", "Elementary cell of a cubic lattice", {}, "a drawing"},
                                  {"2", "Random point distribution", {}, "a drawing"}};
  for (const std::vector<PaperFigure>& some : {moduli_figures(), line_figures()})
    all.insert(all.end(), some.begin(), some.end());
  all.push_back({"12", "A segment of a bent beam", {}, "a drawing"});
  all.push_back(small_force());
  all.push_back(large_force());
  all.push_back(cracks());
  return all;
}

}  // namespace springproof
