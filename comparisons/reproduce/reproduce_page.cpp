#include <fmt/format.h>

#include <cmath>

#include "comparisons/report/report.h"
#include "comparisons/reproduce/reproduce.h"
#include "problem/files/encoding.h"

namespace springproof {
namespace {

/// Class of the chip that shows a verdict (style.css).
std::string chip_class(const std::string& word) {
  return word == "agrees" ? "pass" : word == "differs" ? "fail" : word == "agrees in part" ? "coarse" : "none";
}

std::string chip(const std::string& word) {
  return fmt::format("<span class=\"chip {}\">{}</span>", chip_class(word), word);
}

std::string listed_cases(const PaperFigure& figure) {
  std::string out;
  for (const std::string& name : figure.cases)
    out += fmt::format("{}<code>{}</code>", out.empty() ? "" : ", ", xml_escaped(name));
  return out;
}

bool shows_reason(const FigureVerdict& verdict) {
  return verdict.word != "agrees" && verdict.word != "not redone" && verdict.word != "not run";
}

bool has_section(const DrawnFigure& d) { return !d.svgs.empty() || !d.verdict.values.empty(); }

std::string overview_row(const DrawnFigure& d) {
  const bool reason = shows_reason(d.verdict) && !d.figure.reason.empty();
  const std::string title = xml_escaped(d.figure.title());
  return fmt::format("<tr><th>{}</th><td>{}<small>{}</small></td><td>{}</td><td>{}{}</td></tr>\n",
                     has_section(d) ? fmt::format("<a href=\"#{}\">{}</a>", d.figure.file_stem(), title) : title,
                     xml_escaped(d.figure.what), listed_cases(d.figure), chip(d.verdict.word),
                     xml_escaped(d.verdict.sentence),
                     reason ? fmt::format("<small>{}</small>", xml_escaped(d.figure.reason)) : "");
}

std::string amount(const std::optional<double>& value, const char* missing) {
  if (!value || !std::isfinite(*value)) return missing;
  const bool count = *value == std::round(*value) && std::abs(*value) < 1e9;
  return count ? fmt::format("{:.0f}", *value) : fmt::format("{:.5g}", *value);
}

std::string difference_text(const PrintedValue& v, double factor) {
  if (!v.ours) return "";
  if (v.printed == 0) return fmt::format("{:+.2g}", factor * *v.ours);
  return fmt::format("{:+.1f} %", 100 * (*v.ours - v.printed) / std::abs(v.printed));
}

/// A printed value with the digits that the paper prints.
std::string printed_text(double value, double last_digit) {
  constexpr double finest = 1e-6;
  if (last_digit < finest) return fmt::format("{:g}", value);
  return fmt::format("{:.{}f}", value, std::max(0, static_cast<int>(std::lround(-std::log10(last_digit)))));
}

std::optional<double> scaled(const std::optional<double>& value, double factor) {
  return value ? std::optional(factor * *value) : std::nullopt;
}

std::string value_row(const ValueVerdict& value, const PaperFigure& figure) {
  const PrintedValue& v = value.value;
  const double factor = figure.percent ? 100 : 1;
  const std::string name = v.case_name.substr(v.case_name.rfind('/') + 1);
  return fmt::format(
      "<tr><td>{}</td><td>{}<small>{}{}</small></td><td class=\"number\">{:g}</td><td class=\"measure\">{} [{}]</td>"
      "<td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
      "<td>{}{}</td></tr>\n",
      xml_escaped(v.where), xml_escaped(v.model), xml_escaped(name),
      v.cells[0] > 0 ? ", " + cells_text(v.cells, "×") + " cells" : "", v.poisson_ratio, xml_escaped(v.measure),
      figure.percent ? "%" : xml_escaped(v.unit), printed_text(factor * v.printed, factor * figure.last_digit),
      amount(scaled(v.ours, factor), "no result"), difference_text(v, factor), amount(scaled(v.fem, factor), ""),
      figure.is_table() ? chip(value.agrees ? "agrees" : "differs") : "",
      v.remark.empty() ? "" : fmt::format("<small>{}</small>", xml_escaped(v.remark)));
}

std::string values_html(const DrawnFigure& d) {
  if (d.verdict.values.empty()) return "";
  std::string out =
      "<div class=\"scroll\"><table class=\"values\"><thead><tr><th>printed in</th><th>model here</th><th "
      "class=\"number\">ν</th><th>quantity</th><th class=\"number\">printed</th><th class=\"number\">ours</th><th "
      "class=\"number\">difference</th><th class=\"number\">FEM, "
      "converged</th><th>" +
      std::string(d.figure.is_table() ? "verdict" : "remark") + "</th></tr></thead><tbody>\n";
  for (const ValueVerdict& value : d.verdict.values) out += value_row(value, d.figure);
  return out + "</tbody></table></div>\n";
}

std::string word_for(const ClaimVerdict& claim) {
  switch (claim.holds) {
    case ClaimVerdict::yes:
      return "agrees";
    case ClaimVerdict::partly:
      return "agrees in part";
    case ClaimVerdict::no:
      return "differs";
    default:
      return "not judged";
  }
}

std::string claims_html(const FigureVerdict& verdict) {
  if (verdict.claims.empty()) return "";
  std::string out = "<ul class=\"parts\">\n";
  for (const ClaimVerdict& claim : verdict.claims)
    out += fmt::format("<li>{} {}: {}</li>\n", chip(word_for(claim)), xml_escaped(claim.words),
                       xml_escaped(claim.numbers));
  return out + "</ul>\n";
}

/// An SVG inside a page has no identifiers of its own: those of clip paths get the figure's name.
std::string inlined(std::string svg, const std::string& prefix) {
  for (const std::string mark : {"id=\"axes", "url(#axes"})
    for (std::size_t at = 0; (at = svg.find(mark, at)) != std::string::npos; at += prefix.size() + mark.size())
      svg.insert(at + mark.size() - 4, prefix);
  return svg;
}

std::string files_html(const DrawnFigure& d) {
  std::string out;
  const auto link = [&](const std::string& name) {
    out += fmt::format("{}<a href=\"figures/{}\">{}</a>", out.empty() ? "" : " · ", name, name);
  };
  for (std::size_t i = 0; i < d.svgs.size(); ++i) link(d.figure.file_stem() + (i == 0 ? ".svg" : "_bodies.svg"));
  if (!d.csv.empty()) link(d.figure.file_stem() + ".csv");
  return out.empty() ? "" : "<p class=\"note\">" + out + "</p>\n";
}

std::string figure_html(const DrawnFigure& d) {
  std::string out = fmt::format("<section id=\"{}\"><h2>{}: {} {}</h2>\n<p class=\"lead\">{}</p>\n",
                                d.figure.file_stem(), xml_escaped(d.figure.title()), xml_escaped(d.figure.what),
                                chip(d.verdict.word), listed_cases(d.figure));
  for (std::size_t i = 0; i < d.svgs.size(); ++i)
    out += "<div class=\"scroll drawing\">" + inlined(d.svgs[i], d.figure.file_stem() + (i ? "b_" : "_")) + "</div>\n";
  out += claims_html(d.verdict) + values_html(d);
  if (!d.figure.reason.empty()) out += fmt::format("<p class=\"note\">{}</p>\n", xml_escaped(d.figure.reason));
  return out + files_html(d) + "</section>\n";
}

}  // namespace

std::string reproduce_page(const std::vector<DrawnFigure>& drawn, const Paper& paper) {
  std::string rows, sections;
  for (const DrawnFigure& d : drawn) {
    rows += overview_row(d);
    if (has_section(d)) sections += figure_html(d);
  }
  const std::string cite = xml_escaped(paper.short_cite);
  const std::string header = fmt::format(
      R"(<h1>The figures and tables of {}, redone</h1>
<p class="lead">{}</p>
<p>Printed values are open markers or columns named so, theory is solid black, our finite elements are dashed, everything else is computed with mass-spring models here. A printed value agrees within {:g} % or one unit of its last digit; a figure agrees if the paper's statements about it hold for our numbers. Pages named docs/ are in the source tree of springproof.</p>
<div class="scroll"><table class="cases"><thead><tr><th>figure</th><th>what it shows</th><th>verdict</th><th>in numbers</th></tr></thead><tbody>
{}</tbody></table></div>
)",
      cite, xml_escaped(paper.cite), 100 * printed_tolerance, rows);
  return plain_page(cite + " redone", header, sections,
                    ".drawing { background: #fff; border-radius: 8px; margin: 8px 0; text-align: center; }\n"
                    ".cases th, .values td:first-child { white-space: nowrap; }\n"
                    ".drawing svg { max-width: 100%; height: auto; }\n");
}

}  // namespace springproof
