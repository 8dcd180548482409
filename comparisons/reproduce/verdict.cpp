#include "comparisons/reproduce/reproduce.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace springproof {
namespace {

bool asked_for(const Claim& claim, const Row& row) {
  const auto has = [](const auto& list, const auto& same) { return list.empty() || std::ranges::any_of(list, same); };
  return row.measure == claim.measure && (!claim.cells || row.cells == *claim.cells) &&
         has(claim.models, [&](const std::string& model) { return model == row.model; }) &&
         has(claim.poisson_ratios, [&](double nu) { return same_poisson_ratio(nu, row.poisson_ratio); });
}

std::optional<double> target_of(const Claim& claim, const Row& row) {
  if (claim.target == Claim::finite_elements) return row.reference;
  return claim.target == Claim::wanted_nu ? row.poisson_ratio : claim.value;
}

/// What a claim bounds; no number where there is none.
double off_by(const Claim& claim, const Row& row) {
  if (claim.target == Claim::scatter) return row.spread ? *row.spread / std::abs(row.value) : std::nan("");
  const std::optional<double> target = target_of(claim, row);
  return target ? std::abs(row.value - *target) / (claim.relative ? std::abs(*target) : 1) : std::nan("");
}

/// Models and Poisson's ratios that a claim names and that have no row.
int missing_runs(const PaperResults& results, const Claim& claim) {
  int missing = 0;
  for (const std::string& model : claim.models)
    for (double nu : claim.poisson_ratios)
      if (!results.row(claim.case_name, model, nu, claim.measure, claim.cells)) ++missing;
  return missing;
}

std::string whose(const Claim& claim) { return claim.papers_bound ? "the paper's" : "ours"; }

std::string size_text(const Claim& claim, double size) {
  return claim.relative ? fmt::format("{:.2g} %", 100 * size) : fmt::format("{:.2g}", size);
}

/// The rows of a claim's models, one model after the other.
std::vector<Row> rows_of(const PaperResults& results, const Claim& claim) {
  std::vector<Row> all;
  for (const std::string& model : claim.models)
    for (const Row& row : results.rows(claim.case_name))
      if (row.model == model && asked_for(claim, row)) all.push_back(row);
  return all;
}

/// In order, but for what lies within the spread of both.
bool ascends(const Row& a, const Row& b) { return b.value >= a.value - a.spread.value_or(0) - b.spread.value_or(0); }

/// The largest over the smallest, in size.
double ratio_of(const std::vector<Row>& rows) {
  const auto [low, high] = std::ranges::minmax_element(
      rows, [](const Row& a, const Row& b) { return std::abs(a.value) < std::abs(b.value); });
  return std::abs(high->value) / std::abs(low->value);
}

bool order_holds(const PaperResults& results, const Claim& claim, const std::vector<Row>& rows) {
  if (claim.target == Claim::similar) {
    Claim other = claim;
    other.measure = claim.against;
    const std::vector<Row> others = claim.against.empty() ? std::vector<Row>{} : rows_of(results, other);
    return ratio_of(rows) <= (others.empty() ? 1 + claim.within : ratio_of(others));
  }
  for (std::size_t i = 0; i + 1 < rows.size(); ++i)
    if (!ascends(rows[i], rows[i + 1])) return false;
  return ascends(rows.front(), rows.back());
}

ClaimVerdict judge_order(const PaperResults& results, const Claim& claim) {
  const std::vector<Row> rows = rows_of(results, claim);
  const std::size_t ratios = claim.poisson_ratios.size();
  if (rows.size() < std::max<std::size_t>(2, claim.models.size() * std::max<std::size_t>(1, ratios)))
    return {claim.words, "no result of all", ClaimVerdict::no};
  std::string listed;
  for (const Row& row : rows)
    listed += fmt::format("{}{} {:.2g}{}", listed.empty() ? "" : ", ",
                          ratios > 1 ? fmt::format("{} at ν = {:g}", row.model, row.poisson_ratio) : row.model,
                          row.value, row.spread ? fmt::format(" ± {:.1g}", *row.spread) : "");
  if (claim.target == Claim::similar && claim.against.empty())
    listed += fmt::format(" (allowed {}, {})", size_text(claim, claim.within), whose(claim));
  return {claim.words, listed, order_holds(results, claim, rows) ? ClaimVerdict::yes : ClaimVerdict::no};
}

ClaimVerdict judge_claim(const PaperResults& results, const Claim& claim) {
  if (claim.target == Claim::ascending || claim.target == Claim::similar) return judge_order(results, claim);
  double worst = 0;
  int rows = 0, inside = 0, without = missing_runs(results, claim);
  for (const Row& row : results.rows(claim.case_name)) {
    if (!asked_for(claim, row)) continue;
    const double off = off_by(claim, row);
    std::isfinite(off) ? ++rows : ++without;
    if (std::isfinite(off)) worst = std::max(worst, off);
    if (off <= claim.within) ++inside;
  }
  if (rows == 0) return {claim.words, "no result", ClaimVerdict::no};
  const bool distance = claim.target == Claim::scatter || (claim.target == Claim::number && claim.value == 0);
  std::string numbers = fmt::format("{} {}", distance ? "at most" : "off by at most", size_text(claim, worst));
  if (claim.within < 0) return {claim.words, numbers + " (not judged)", ClaimVerdict::not_judged};
  numbers += fmt::format(" (allowed {}, {})", size_text(claim, claim.within), whose(claim));
  if (inside < rows && rows > 1) numbers += fmt::format(", {} of {} are within", inside, rows);
  if (without > 0) numbers += fmt::format(", {} without a result", without == 1 ? "one" : std::to_string(without));
  return {claim.words, numbers,
          inside == rows && without == 0 ? ClaimVerdict::yes
          : inside > 0                   ? ClaimVerdict::partly
                                         : ClaimVerdict::no};
}

std::vector<ValueVerdict> judge_values(const PaperResults& results, const PaperFigure& figure) {
  std::vector<ValueVerdict> all;
  for (const std::string& case_name : figure.cases)
    for (const PrintedValue& v :
         results.printed(case_name, figure.printed_where.empty() ? figure.title() : figure.printed_where)) {
      const double allowed = std::max(printed_tolerance * std::abs(v.printed), figure.last_digit * (1 + 1e-9));
      const bool agrees = v.ours && std::abs(*v.ours - v.printed) <= allowed;
      all.push_back({v, agrees});
      if (agrees && figure.is_table()) all.back().value.remark.clear();  // remarks of tables say why ours differ
    }
  return all;
}

std::string word_of(std::size_t hold, std::size_t partly, std::size_t all) {
  if (all == 0) return "drawn";
  return hold == all ? "agrees" : hold + partly == 0 ? "differs" : "agrees in part";
}

void judge_claims(const PaperResults& results, const PaperFigure& figure, FigureVerdict& verdict) {
  for (const Claim& claim : figure.claims) verdict.claims.push_back(judge_claim(results, claim));
  const auto count = [&](auto state) {
    return static_cast<std::size_t>(
        std::ranges::count_if(verdict.claims, [&](const ClaimVerdict& c) { return c.holds == state; }));
  };
  const std::size_t hold = count(ClaimVerdict::yes), judged = verdict.claims.size() - count(ClaimVerdict::not_judged);
  verdict.word = word_of(hold, count(ClaimVerdict::partly), judged);
  for (const ClaimVerdict& claim : verdict.claims)
    if (hold == judged || claim.holds != ClaimVerdict::yes)
      verdict.sentence += (verdict.sentence.empty() ? "" : "; ") + claim.words + ": " + claim.numbers;
}

}  // namespace

FigureVerdict judge_figure(const PaperResults& results, const PaperFigure& figure) {
  if (figure.cases.empty()) return {"not redone", figure.reason, {}, {}};
  for (const std::string& case_name : figure.cases)
    if (!results.has(case_name)) return {"not run", "there are no results of " + case_name, {}, {}};
  FigureVerdict verdict;
  verdict.values = judge_values(results, figure);
  if (figure.is_table()) {
    const auto agree =
        static_cast<std::size_t>(std::ranges::count_if(verdict.values, [](const ValueVerdict& v) { return v.agrees; }));
    verdict.word = word_of(agree, 0, verdict.values.size());
    verdict.sentence = fmt::format("{} of {} printed values", agree, verdict.values.size());
    return verdict;
  }
  judge_claims(results, figure, verdict);
  return verdict;
}

}  // namespace springproof
