// results.csv.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comparisons/results/records.h"

namespace springproof {

std::string csv_text(const std::string& field) {
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string out = "\"";
  for (char c : field) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string csv_number(const std::optional<double>& x) { return x && std::isfinite(*x) ? fmt::format("{}", *x) : ""; }

namespace {

/// A printed value of a case, whichever table of the case file it is from.
std::vector<PublishedRow> printed_values(const CaseResult& result) {
  std::vector<PublishedRow> all;
  for (const Check& c : result.checks)
    if (c.source == "published") all.push_back({c, c.measure, c.unit, c.expected, c.computed, c.where, ""});
  all.insert(all.end(), result.published.begin(), result.published.end());
  return all;
}

bool printed_for(const PublishedRow& printed, const Row& row) {
  return same_run(printed, row) && printed.measure == row.measure;
}

std::string csv_line(const Row& r, const PublishedRow* printed, const std::string& listed) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_text(r.case_name), csv_text(r.kinematics),
                     csv_text(r.model), csv_number(r.poisson_ratio), cells_text(r.cells), csv_text(r.measure),
                     csv_number(r.value), csv_text(r.unit), csv_number(r.reference),
                     csv_number(r.reference_uncertainty), csv_number(r.error), r.samples, csv_number(r.spread),
                     printed ? csv_number(printed->published) : "", printed ? csv_text(printed->where) : "",
                     csv_text(listed));
}

}  // namespace

std::string to_csv(const std::vector<CaseResult>& results) {
  std::string out =
      "case,kinematics,model,poisson_ratio,cells,measure,value,unit,reference,reference_uncertainty,error,samples,"
      "spread,published,published_where,listed\n";
  for (const CaseResult& result : results) {
    const std::vector<PublishedRow> printed = printed_values(result);
    const std::string listed = result.experiment.listed.region > 0 ? result.experiment.listed_words() : "";
    for (const Row& row : result.rows) {
      const auto found = std::ranges::find_if(printed, [&](const PublishedRow& p) { return printed_for(p, row); });
      out += csv_line(row, found == printed.end() ? nullptr : &*found, listed);
    }
    for (const PublishedRow& p : printed) {
      const bool has_row = std::ranges::any_of(result.rows, [&](const Row& row) { return printed_for(p, row); });
      const double ours = p.computed.value_or(std::nan(""));
      if (!has_row)
        out += csv_line({p, result.experiment.name, result.experiment.kinematics, p.measure, ours, p.unit, {}, {}, {}},
                        &p, listed);
    }
  }
  return out;
}

}  // namespace springproof
