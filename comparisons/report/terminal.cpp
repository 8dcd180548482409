// The verdict on a terminal.
#include <fmt/format.h>

#include "comparisons/report/headline.h"

namespace springproof {
namespace {

std::string model_lines(const Headline& h, bool large_deformation, const char* title) {
  std::string out;
  for (const ModelVerdict& v : h.models)
    if (v.large_deformation == large_deformation)
      out += fmt::format("  {:<28} {}{}\n", v.model, v.finite_elements ? "(finite elements, for comparison) " : "",
                         v.sentence);
  return out.empty() ? "" : fmt::format("\n{}\n{}", title, out);
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

std::string terminal_text(const Headline& h) {
  const std::string doubt = h.doubt ? h.doubt->brief : "";
  const std::string first = h.answer + (doubt.empty() || h.answer.empty() ? "" : " ") + doubt;
  std::string out = first.empty() ? "" : "\n" + first + "\n";
  out += model_lines(h, false, linear_title) + model_lines(h, true, large_title);
  out += group("Verification of the reference: value, target, error", h.verification);
  out +=
      group("Largest principal strain and rotation of the reference (99 % of the volume stay below)", h.deformations);
  out += group("Motion in time", h.motions);
  const std::string marks = marked("note", texts(h.notes)) + marked("warning", texts(h.warnings)) +
                            marked("no result", h.failed_runs) + marked("FAILED", h.failed_checks) +
                            marked("FAILED", h.failures);
  return out + (marks.empty() ? "" : "\n" + marks) + "\n" + expectations_sentence(h) + "\n";
}

}  // namespace springproof
