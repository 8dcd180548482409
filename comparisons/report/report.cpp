#include "comparisons/report/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "comparisons/report/assets.h"
#include "comparisons/report/headline.h"
#include "comparisons/report/page.h"
#include "comparisons/report/results.h"
#include "problem/case_file/measures.h"
#include "problem/system/encoding.h"
#include "problem/system/files.h"

namespace springproof {
namespace {

using Json = nlohmann::json;

/// Titles and meanings of the measures.
Json measures_json() {
  Json all;
  for (const Measure& m : measure_table())
    if (!m.title.empty()) all[m.name] = {{"title", m.title}, {"meaning", m.meaning}};
  return all;
}

/// The results with each case's rows as one table {"columns", "values"}: half the size; and the titles and meanings of
/// the measures.
Json packed(Json results) {
  static const std::vector<std::string> columns = {
      "kinematics", "model",     "poisson_ratio",         "cells", "measure", "value",
      "unit",       "reference", "reference_uncertainty", "error", "samples", "spread"};
  results["measures"] = measures_json();
  if (!results.contains("cases")) return results;
  for (Json& result : results.at("cases")) {
    Json values = Json::array();
    for (const Json& row : result.at("rows")) {
      Json line = Json::array();
      for (const std::string& column : columns) line.push_back(row.at(column));
      values.push_back(std::move(line));
    }
    result["rows"] = {{"columns", columns}, {"values", std::move(values)}};
  }
  return results;
}

std::string list_html(const std::vector<std::string>& lines) {
  constexpr std::size_t most = 20;
  std::string out = "<ul>\n";
  for (std::size_t i = 0; i < std::min(most, lines.size()); ++i)
    out += fmt::format("<li>{}</li>\n", xml_escaped(lines[i]));
  if (lines.size() > most) out += fmt::format("<li>and {} more, on the case pages</li>\n", lines.size() - most);
  return out + "</ul>\n";
}

std::string folded_html(const char* kind, const std::string& title, const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  return fmt::format("<details class=\"{}\"{}><summary>{}</summary>\n{}</details>\n", kind,
                     lines.size() <= 6 ? " open" : "", title, list_html(lines));
}

std::string model_list_html(const Headline& head, bool large_deformation) {
  std::string items;
  for (const ModelVerdict& verdict : head.models)
    if (verdict.large_deformation == large_deformation)
      items += fmt::format("<li data-model=\"{0}\"><b>{0}</b>{1} {2}</li>\n", xml_escaped(verdict.model),
                           verdict.finite_elements ? " (finite elements, for comparison)" : "",
                           xml_escaped(verdict.sentence));
  return items.empty() ? "" : "<ul class=\"verdicts\">\n" + items + "</ul>\n";
}

/// The sentences on every model, folded.
std::string words_html(const Headline& head) {
  const std::string linear = model_list_html(head, false), large = model_list_html(head, true);
  std::string out;
  if (!linear.empty())
    out += fmt::format("<details class=\"words\"><summary>{}</summary>\n{}</details>\n", linear_title, linear);
  if (!large.empty())
    out += fmt::format("<details class=\"words\"{}><summary>{}</summary>\n{}</details>\n",
                       linear.empty() ? " open" : "", large_title, large);
  return out;
}

std::string answer_html(const Headline& head) {
  std::string out;
  const std::string doubt =
      head.doubt.empty() ? "" : fmt::format("<span class=\"amber\">{}</span> ", xml_escaped(head.doubt));
  if (const std::string first = doubt + xml_escaped(head.answer); !first.empty())
    out += fmt::format("<p class=\"answer\">{}</p>\n", first);
  for (const std::string& line : head.warnings) out += fmt::format("<p class=\"amber\">{}</p>\n", xml_escaped(line));
  return out;
}

std::string count_html(const char* verdict, int count, const char* words) {
  return count == 0 ? "" : fmt::format("<span class=\"chip {}\">{} {}</span> ", verdict, count, words);
}

std::string counts_html(const Headline& head) {
  const std::string chips = count_html("pass", head.held, "hold") + count_html("fail", head.failed, "fail") +
                            count_html("coarse", head.reference_too_coarse, "reference too coarse") +
                            count_html("none", head.no_reference, "no reference") +
                            count_html("none", head.no_result, "no result");
  return fmt::format("<p class=\"counts\" title=\"{}\">Expectations: {}</p>\n",
                     xml_escaped(expectations_sentence(head)), chips.empty() ? "none stated" : chips);
}

std::string failures_html(const Headline& head) {
  return folded_html("failures", fmt::format("Expectations that fail: {}", head.failed), head.failed_checks) +
         folded_html("failures", fmt::format("Not compared: {}", head.failures.size()), head.failures) +
         folded_html("failures", fmt::format("Runs without a result: {}", head.failed_runs.size()), head.failed_runs);
}

/// The first screen: the answer with its facts, two bodies and the plot of dots (filled in by first.js), then failures
/// and the sentences.
std::string headline_html(const Json& results) {
  const Headline head = headline(results);
  return "<div class=\"first\">\n<div>\n" + answer_html(head) + "<dl id=\"first-facts\"></dl>\n" + counts_html(head) +
         fmt::format("</div>\n<div id=\"first-bodies\" data-closest=\"{}\"></div>\n</div>\n",
                     xml_escaped(fmt::format("{}", fmt::join(head.closest, "\n")))) +
         "<div id=\"first-plot\"></div>\n" + failures_html(head) + words_html(head);
}

}  // namespace

void write_report(const std::filesystem::path& file, const Json& results, const Json& pictures) {
  using namespace report_assets;
  const bool live = std::filesystem::exists(file.parent_path() / "live.html");
  write_file(file, filled(template_html, {{"style_css", std::string(style_css)},
                                          {"headline", headline_html(results)},
                                          {"live_link", live ? "<a href=\"live.html\">Pull the bodies</a>" : ""},
                                          {"results", script_json(packed(results))},
                                          {"pictures", script_json(pictures)},
                                          {"chart_js", std::string(chart_js)},
                                          {"three_js", std::string(three_js)},
                                          {"orbit_controls_js", std::string(orbit_controls_js)},
                                          {"report_js", std::string(report_js)}}));
}

}  // namespace springproof
