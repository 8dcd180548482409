// The verdict on a terminal.
#include <fmt/format.h>

#include <algorithm>

#include "comparisons/report/headline.h"
#include "comparisons/report/words.h"

namespace springproof {
namespace {

using namespace words;

/// Columns: 99 of a terminal's 100, the two before the model among them.
constexpr const char* row_format = "  {:<22} {:>13} {:<25} {:>8} {:>7} {:>11} {:>7}\n";

/// At most `most` letters; a longer text ends in "…".
std::string fitted(const std::string& text, int most) {
  return fmt::format("{:.{}}", text, most) == text ? text : fmt::format("{:.{}}…", text, most - 1);
}

std::string largest_text(const ByNu& errors) {
  return errors.empty() ? "–" : percent(largest(errors).second.error) + " %";
}

std::string seconds_text(std::vector<double> seconds) {
  if (seconds.empty()) return "–";
  std::ranges::sort(seconds);
  const double middle = seconds[seconds.size() / 2];
  return middle < 60 ? fmt::format("{:.2g} s", middle) : fmt::format("{:.0f} s", middle);
}

std::string row_of(const ModelVerdict& v) {
  const ModelErrors& e = v.errors;
  const ByNu rank = ranked(e, e.rank);
  std::string error = "–", where = e.own_nu ? fmt::format("valid at ν = {} only", nu_text(*e.own_nu)) : "";
  if (!rank.empty()) {
    const auto& [nu, worst] = largest(rank);
    error = fmt::format("{} ± {} %", percent(worst.error), percent(worst.uncertainty));
    where = at_nu(worst.case_name, nu);
  }
  return fmt::format(fmt::runtime(row_format), fitted(v.model, 22), error, fitted(where, 25),
                     largest_text(ranked(e, e.reaction)), largest_text(ranked(e, e.volume)), cells_range(e),
                     seconds_text(e.seconds));
}

std::string model_table(const Headline& h, bool large_deformation, const char* title) {
  std::string springs, beside;
  for (const ModelVerdict& v : h.models)
    if (v.large_deformation == large_deformation) (v.beside ? beside : springs) += row_of(v);
  if ((springs + beside).empty()) return "";
  return fmt::format("\n{}\n", title) +
         fmt::format(fmt::runtime(row_format), "model", "error", "in", "reaction", "volume", "cells", "solve") +
         springs + (beside.empty() ? "" : "  for comparison\n" + beside);
}

std::string model_sentences(const Headline& h) {
  std::string out;
  for (const ModelVerdict& v : h.models)
    out += fmt::format("  {}{}: {}\n", v.model, v.large_deformation ? ", large deformation" : "", v.sentence);
  return out.empty() ? "" : "\n" + out;
}

std::string group(const char* title, const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string out = fmt::format("\n{}\n", title);
  for (const std::string& line : lines) out += "  " + line + "\n";
  return out;
}

std::string marked(const char* mark, const std::vector<std::string>& lines) {
  std::string out;
  for (const std::string& line : lines) out += fmt::format("{}: {}\n", mark, line);
  return out;
}

std::vector<std::string> texts(const std::vector<Warning>& warnings) {
  std::vector<std::string> out;
  for (const Warning& w : warnings) out.push_back(w.text());
  return out;
}

}  // namespace

std::string terminal_text(const Headline& h, bool verbose) {
  std::string first;
  for (const std::string& sentence : {h.answer, h.no_linear_theory, h.doubt ? h.doubt->brief : ""})
    first += (first.empty() || sentence.empty() ? "" : " ") + sentence;
  std::string out = first.empty() ? "" : "\n" + first + "\n";
  out += model_table(h, false, linear_title) + model_table(h, true, large_title);
  if (verbose) out += model_sentences(h);
  out += group("Verification of the reference: value, target, error", h.verification);
  if (verbose)
    out +=
        group("Largest principal strain and rotation of the reference (99 % of the volume stay below)", h.deformations);
  out += group("Measured, without a reference", h.measured);
  if (verbose) out += group("Motion in time", h.motions);
  const std::string marks = marked("note", texts(h.notes)) + marked("warning", texts(h.warnings)) +
                            marked("no result", h.failed_runs) + marked("FAILED", h.failed_checks) +
                            marked("FAILED", h.failures);
  return out + (marks.empty() ? "" : "\n" + marks) + "\n" + expectations_sentence(h) + "\n";
}

}  // namespace springproof
