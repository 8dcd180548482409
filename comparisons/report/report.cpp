#include "comparisons/report/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "comparisons/report/assets.h"
#include "comparisons/results/records.h"
#include "problem/case_file/measures.h"
#include "problem/files/encoding.h"
#include "problem/files/files.h"

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

/// Numbers with seven digits, which is more than the page shows; but for Poisson's ratio, by which pictures are found.
void shorten(Json& json) {
  if (json.is_number_float()) json = std::strtod(fmt::format("{:.7g}", json.get<double>()).c_str(), nullptr);
  if (json.is_array())
    for (Json& item : json) shorten(item);
  if (json.is_object())
    for (auto& [key, item] : json.items())
      if (!key.starts_with("poisson_ratio")) shorten(item);
}

/// A case's rows as {"columns", "named", "words", "values"}, a third of the size: in the named columns values are
/// indices into `words`.
Json table_of(const Json& rows) {
  static const std::vector<std::string> columns = {
      "kinematics", "model",     "poisson_ratio",         "cells", "measure", "value",
      "unit",       "reference", "reference_uncertainty", "error", "samples", "spread",
      "of"};
  static const std::set<std::string> named = {"kinematics", "model", "cells", "measure", "unit", "of"};
  Json values = Json::array(), words = Json::array();
  std::map<std::string, std::size_t> numbers;
  for (const Json& row : rows) {
    Json line = Json::array();
    for (const std::string& column : columns) {
      const Json& item = row.at(column);
      if (!named.contains(column)) {
        line.push_back(item);
        continue;
      }
      const auto [at, is_new] = numbers.try_emplace(item.dump(), words.size());
      if (is_new) words.push_back(item);
      line.push_back(at->second);
    }
    values.push_back(std::move(line));
  }
  return {{"columns", columns}, {"named", named}, {"words", std::move(words)}, {"values", std::move(values)}};
}

/// The results as the page reads them: short, with the titles and meanings of the measures, and in a case that has a
/// note or warning that.
Json packed(Json results, const std::vector<Warning>& warnings) {
  results["measures"] = measures_json();
  for (const MotionMeasure& m : motion_measures()) results["motion_measures"].push_back({m.name, m.heading});
  if (!results.contains("cases")) return results;
  for (Json& result : results.at("cases")) {
    shorten(result);
    result["rows"] = table_of(result["rows"]);
  }
  for (const Warning& w : warnings) results["cases"][w.case_number]["warnings"].push_back(w.text());
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
                           verdict.beside ? " (for comparison)" : "", xml_escaped(verdict.sentence));
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

/// With percent signs that stay with their numbers.
std::string unbroken(std::string text) {
  for (std::size_t at = 0; (at = text.find(" %", at)) != std::string::npos;) text.replace(at, 1, "\u00a0");
  return text;
}

/// A link to the page of a case, whose address first.js fills in.
std::string case_link_html(const Warning& warning) {
  return fmt::format("<a class=\"amber\" data-case=\"{}\">{}</a>", warning.case_number,
                     xml_escaped(unbroken(warning.brief)));
}

std::string answer_html(const Headline& head) {
  const std::string doubt = head.doubt ? case_link_html(*head.doubt) : "";
  if (head.answer.empty() && doubt.empty()) return "";
  const std::string beyond =
      head.no_linear_theory.empty() ? "" : fmt::format("<b>{}</b>", xml_escaped(unbroken(head.no_linear_theory)));
  return fmt::format("<p class=\"answer\">{} {} {}</p>\n", xml_escaped(unbroken(head.answer)), beyond, doubt);
}

/// Notes and warnings, in this order.
std::vector<Warning> told(const Headline& head) {
  std::vector<Warning> all = head.notes;
  all.insert(all.end(), head.warnings.begin(), head.warnings.end());
  return all;
}

/// Up to three at sight, more of them folded.
std::string warnings_html(const std::vector<Warning>& warnings) {
  std::string items;
  for (const Warning& warning : warnings) items += "<li>" + case_link_html(warning) + "</li>\n";
  if (items.empty()) return "";
  const std::string list = "<ul class=\"warnings\">\n" + items + "</ul>\n";
  if (warnings.size() <= 3) return list;
  return fmt::format("<details class=\"words\"><summary>{} notes and warnings</summary>\n{}</details>\n",
                     warnings.size(), list);
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
         folded_html("failures", fmt::format("Runs without a result: {}", head.failed_runs.size()), head.failed_runs) +
         folded_html("words", "Measured, without a reference", head.measured);
}

/// The first screen: the answer, two bodies, facts and warnings, the plot of dots (filled in by first.js), then
/// failures and the sentences.
std::string headline_html(const Headline& head) {
  return "<div class=\"first\">\n" + answer_html(head) +
         fmt::format("<div id=\"first-bodies\" data-closest=\"{}\"></div>\n",
                     xml_escaped(fmt::format("{}", fmt::join(head.closest, "\n")))) +
         "<div>\n<dl id=\"first-facts\"></dl>\n" + counts_html(head) + warnings_html(told(head)) +
         "</div>\n</div>\n<div id=\"first-plot\"></div>\n" + failures_html(head) + words_html(head);
}

}  // namespace

void write_report(const std::filesystem::path& file, const Headline& head, const Json& results, const Json& pictures) {
  using namespace report_assets;
  const bool live = std::filesystem::exists(file.parent_path() / "live.html");
  write_file(file, filled(template_html, {{"style_css", std::string(style_css)},
                                          {"headline", headline_html(head)},
                                          {"live_link", live ? "<a href=\"live.html\">Pull the bodies</a>" : ""},
                                          {"results", script_json(packed(results, told(head)))},
                                          {"pictures", script_json(pictures)},
                                          {"chart_js", std::string(chart_js)},
                                          {"three_js", std::string(three_js)},
                                          {"orbit_controls_js", std::string(orbit_controls_js)},
                                          {"report_js", std::string(report_js)}}));
}

std::string plain_page(const std::string& title, const std::string& header, const std::string& main,
                       const std::string& style) {
  return fmt::format(R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:">
<title>springproof: {}</title>
<link rel="icon" href="data:,">
<style>
{}
{}</style>
</head>
<body>
<header>
<p class="brand">springproof</p>
{}</header>
<main>
{}</main>
</body>
</html>
)",
                     title, report_assets::style_css, style, header, main);
}

// "<" occurs only in strings, where it can be written as an escape.
std::string script_json(const nlohmann::json& json) {
  const std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (char c : text) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

std::string filled(std::string_view text, const std::map<std::string_view, std::string>& values) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t open = text.find('@', at);
    if (open == std::string_view::npos) return out.append(text.substr(at));
    const std::size_t close = text.find('@', open + 1);
    const auto name = close == std::string_view::npos ? "" : text.substr(open + 1, close - open - 1);
    const auto value = values.find(name);
    if (value == values.end()) throw std::logic_error(fmt::format("page template: @{}@ has no value", name));
    out.append(text.substr(at, open - at)).append(value->second);
    at = close + 1;
  }
  return out;
}

}  // namespace springproof
