#include "comparisons/judge/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "problem/files/files.h"

namespace springproof {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(KnownQuantity, case_name, poisson_ratio, element, measure, unit, kind, known,
                                   known_uncertainty, where, value, uncertainty, note)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CalibrationShare, kind, quantities, inside, median_ratio, largest_ratio)

namespace {

using Json = nlohmann::json;

constexpr const char* header = "case,poisson_ratio,element,measure,value,uncertainty,where";
constexpr double near_incompressible = 0.45;  // Poisson's ratio
constexpr double largest_known_uncertainty =
    0.25;  // fraction of the stated uncertainty or of the error, as a verdict requires of a reference

struct KnownLine {
  std::string case_name;
  double poisson_ratio;
  std::string element, measure;
  double value, uncertainty;
  std::string where;
};

double number_of(const std::string& text, const SourceLocation& at, const char* column) try {
  std::size_t end = 0;
  const double x = std::stod(text, &end);
  if (end != text.size() || !std::isfinite(x)) throw std::invalid_argument(text);
  return x;
} catch (const std::logic_error&) {
  throw InputError(at, fmt::format("{}: '{}' is no number (allowed: a finite number)", column, text));
}

/// The last column may contain commas.
KnownLine read_line(const std::string& text, const SourceLocation& at) {
  std::array<std::string, 7> cells;
  std::istringstream in(text);
  for (std::size_t i = 0; i < 6; ++i)
    if (!std::getline(in, cells[i], ','))
      throw InputError(at, fmt::format("{} columns (allowed: seven, {})", i, header));
  std::getline(in, cells[6]);
  return {cells[0], number_of(cells[1], at, "poisson_ratio"), cells[2],
          cells[3], number_of(cells[4], at, "value"),         number_of(cells[5], at, "uncertainty"),
          cells[6]};
}

std::vector<KnownLine> read_table(const std::filesystem::path& file) {
  std::istringstream in(text_of_file(file));
  std::vector<KnownLine> lines;
  std::string text;
  for (int number = 1; std::getline(in, text); ++number) {
    const SourceLocation at{file.string(), number, 1};
    if (number == 1 && text != header)
      throw InputError(at, fmt::format("'{}' is no header (allowed: {})", text, header));
    if (number > 1 && !text.empty()) lines.push_back(read_line(text, at));
  }
  return lines;
}

constexpr std::array kinds = {"hexahedra",     "tetrahedra", "bodies in files", "near-incompressible",
                              "finite strain", "in motion",  "frequencies",     "all"};

std::string kind_of(const Experiment& e, const ReferenceRecord& r) {
  if (r.measure.starts_with("frequency.")) return "frequencies";
  if (r.measure.starts_with("motion")) return "in motion";
  if (e.model_kinematics() == Kinematics::finite) return "finite strain";
  if (r.poisson_ratio >= near_incompressible) return "near-incompressible";
  if (!e.body.is_script()) return "bodies in files";
  return r.element[0] == 'q' ? "hexahedra" : "tetrahedra";
}

double ratio(const KnownQuantity& q) {
  return q.uncertainty > 0 ? q.error() / q.uncertainty : q.error() > 0 ? HUGE_VAL : 0;
}

CalibrationShare share_of(const std::string& kind, const std::vector<KnownQuantity>& quantities) {
  CalibrationShare share{kind, 0, 0, 0, 0};
  std::vector<double> ratios;
  for (const KnownQuantity& q : quantities) {
    if (kind != "all" && q.kind != kind) continue;
    ratios.push_back(ratio(q));
    share.inside += q.inside();
  }
  share.quantities = static_cast<int>(ratios.size());
  if (ratios.empty()) return share;
  std::ranges::sort(ratios);
  share.median_ratio = (ratios[(ratios.size() - 1) / 2] + ratios[ratios.size() / 2]) / 2;
  share.largest_ratio = ratios.back();
  return share;
}

}  // namespace

double KnownQuantity::error() const { return std::abs(value - known); }

std::vector<KnownQuantity> known_quantities(const Experiment& e, const std::vector<ReferenceRecord>& records) {
  const std::filesystem::path file = e.file.parent_path() / "known.csv";
  std::vector<KnownQuantity> quantities;
  if (!std::filesystem::exists(file)) return quantities;
  for (const KnownLine& line : read_table(file))
    for (const ReferenceRecord& r : records) {
      if (line.case_name != e.name || line.element != r.element || line.measure != r.measure ||
          !same_poisson_ratio(line.poisson_ratio, r.poisson_ratio))
        continue;
      if (line.uncertainty > largest_known_uncertainty * std::max(r.uncertainty, std::abs(r.value - line.value)))
        continue;
      quantities.push_back({e.name, r.poisson_ratio, r.element, r.measure, r.unit, kind_of(e, r), line.value,
                            line.uncertainty, line.where, r.value, r.uncertainty, r.note});
    }
  return quantities;
}

std::vector<KnownQuantity> known_quantities(const CaseResult& result) {
  std::vector<ReferenceRecord> records = result.references;
  for (const Row& row : result.rows) {  // the same beside every model
    if (!row.measure.starts_with("motion.") || !row.reference || !row.reference_uncertainty) continue;
    ReferenceRecord r;
    r.poisson_ratio = row.poisson_ratio;
    r.measure = row.measure;
    r.unit = row.unit;
    r.value = *row.reference;
    r.uncertainty = *row.reference_uncertainty;
    r.element = result.experiment.body.is_voxels() ? "p2" : "q2";
    const auto same = [&](const auto& x) {
      return x.measure == r.measure && same_poisson_ratio(x.poisson_ratio, r.poisson_ratio);
    };
    if (std::ranges::none_of(records, same)) records.push_back(r);
  }
  return known_quantities(result.experiment, records);
}

std::vector<CalibrationShare> calibration_shares(const std::vector<KnownQuantity>& quantities) {
  std::vector<CalibrationShare> shares;
  for (const char* kind : kinds)
    if (const CalibrationShare share = share_of(kind, quantities); share.quantities > 0) shares.push_back(share);
  return shares;
}

Json calibration_json(const std::vector<KnownQuantity>& quantities) {
  if (quantities.empty()) return nullptr;
  Json all = quantities;
  for (Json& q : all) {
    q["case"] = q.at("case_name");
    q.erase("case_name");
  }
  return {{"shares", calibration_shares(quantities)}, {"quantities", all}};
}

std::string calibration_table(const std::vector<KnownQuantity>& quantities) {
  if (quantities.empty()) return "";
  std::string out = fmt::format("{:<20} {:>10} {:>7} {:>7} {:>13} {:>8}\n", "known quantities of", "number", "inside",
                                "share", "median ratio", "largest");
  for (const CalibrationShare& s : calibration_shares(quantities))
    out += fmt::format("{:<20} {:>10} {:>7} {:>6.1f}% {:>13.2f} {:>8.2f}\n", s.kind, s.quantities, s.inside,
                       100.0 * s.inside / s.quantities, s.median_ratio, s.largest_ratio);
  for (const KnownQuantity& q : quantities)
    if (!q.inside())
      out += fmt::format("outside: {}, nu = {:g}, {}, {}: {:.6g} +- {:.1e} {}, known {:.6g} ({})\n", q.case_name,
                         q.poisson_ratio, q.element, q.measure, q.value, q.uncertainty, q.unit, q.known, q.where);
  return out;
}

}  // namespace springproof
