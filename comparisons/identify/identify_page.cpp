#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "comparisons/identify/identified.h"
#include "comparisons/judge/validation.h"
#include "comparisons/report/report.h"
#include "problem/files/encoding.h"

namespace springproof {
namespace {

std::string number_cell(const std::optional<double>& x, const char* form) {
  return fmt::format("<td class=\"number\">{}</td>",
                     x && std::isfinite(*x) ? fmt::format(fmt::runtime(form), *x) : "–");
}

std::string parameters_html(const Identified& out) {
  std::string rows;
  for (const IdentifiedParameter& p : out.parameters)
    rows += fmt::format(
        "<tr><th>{}</th>{}{}<td class=\"number\">{:.4g} … {:.4g}</td>{}{}{}<td>{}</td></tr>\n", xml_escaped(p.name),
        number_cell(p.value, "{:.5g}"), number_cell(p.u, "{:.2g}"), p.from, p.to, number_cell(p.u_data, "{:.2g}"),
        number_cell(p.u_inputs, "{:.2g}"), number_cell(p.u_numerical, "{:.2g}"),
        p.held ? "<span class=\"chip coarse\">held: not told</span>" : "<span class=\"chip pass\">told</span>");
  return "<div class=\"scroll\"><table><thead><tr><th>parameter</th><th class=\"number\">value</th><th "
         "class=\"number\">u</th>"
         "<th class=\"number\">95 % limits</th><th class=\"number\">u by the data</th><th class=\"number\">by "
         "inputs</th>"
         "<th class=\"number\">by cells</th><th></th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string table_html(const std::vector<std::string>& heads, const std::string& rows) {
  std::string head;
  for (const std::string& h : heads) head += fmt::format("<th class=\"number\">{}</th>", xml_escaped(h));
  return "<div class=\"scroll\"><table><thead><tr><th></th>" + head + "</tr></thead><tbody>\n" + rows +
         "</tbody></table></div>\n";
}

/// Beside each other, the worst known direction first.
std::string correlations_html(const Identified& out) {
  if (out.parameters.size() < 2) return "";
  std::vector<std::string> names, directions = {"u"};
  for (const IdentifiedParameter& p : out.parameters) names.push_back(p.name + (p.held ? " (held)" : ""));
  std::string rows, of_directions;
  for (std::size_t i = 0; i < names.size(); ++i) {
    rows += "<tr><th>" + xml_escaped(names[i]) + "</th>";
    for (std::size_t k = 0; k < names.size(); ++k)
      rows += number_cell(k < i ? std::optional(out.correlation[i][k]) : std::nullopt, "{:.3f}");
    rows += "</tr>\n";
  }
  directions.insert(directions.end(), names.begin(), names.end());
  for (std::size_t d = 0; d < out.directions.size(); ++d) {
    of_directions += fmt::format("<tr><th>direction {}</th>{}", d + 1, number_cell(out.directions[d].u, "{:.2g}"));
    for (const double along : out.directions[d].along) of_directions += number_cell(along, "{:+.2f}");
    of_directions += "</tr>\n";
  }
  return "<h3>Told together</h3>\n<p class=\"note\">Correlations, of a parameter that is held as if it were "
         "not.</p>\n" +
         table_html(names, rows) +
         "<p class=\"note\">Directions in which the fitted values tell all parameters, the worst known first: u along "
         "each, by the data, and its components; logarithms of what is positive.</p>\n" +
         table_html(directions, of_directions);
}

std::string synthetic_html(const Identified& out) {
  if (out.synthetic.sets == 0) return "";
  std::string rows;
  std::size_t free = 0;
  for (const IdentifiedParameter& p : out.parameters)
    if (!p.held) {
      const int inside = out.synthetic.inside[free++];
      rows += fmt::format("<tr><th>{}</th><td class=\"number\">{} of {}</td><td class=\"number\">{:.1f} %</td></tr>\n",
                          xml_escaped(p.name), inside, out.synthetic.sets, 100.0 * inside / out.synthetic.sets);
    }
  return "<h3>Synthetic sets</h3>\n<p class=\"note\">Values made of the fit, with noise of their u, and fitted anew: "
         "how "
         "often the limits of 95 %, by the data, hold what they were made with.</p>\n" +
         table_html({"inside", ""}, rows);
}

std::string values_html(const Identified& out) {
  std::string rows;
  for (const bool fitted : {true, false})
    for (const IdentifiedValue& v : out.values) {
      if (v.fitted != fitted) continue;
      const std::string verdict = fitted    ? "<span class=\"chip\">fitted</span>"
                                  : v.ratio ? fmt::format("<span class=\"chip {}\">{:.1f}</span>",
                                                          *v.ratio > no_model_error ? "fail" : "pass", *v.ratio)
                                            : "–";
      rows += fmt::format(
          "<tr><th>{}</th><td>{}</td>{}{}<td>{}</td>{}{}<td>{}</td></tr>\n", xml_escaped(v.name),
          xml_escaped(v.load_case), number_cell(v.simulated, "{:.5g}"), number_cell(v.measured, "{:.5g}"), v.unit,
          number_cell(v.residual, "{:+.2f}"),
          number_cell(v.u_val ? std::optional(100 * *v.u_val / std::abs(v.measured)) : v.u_val, "{:.1f}"), verdict);
    }
  return "<div class=\"scroll\"><table><thead><tr><th>value</th><th>load case</th><th class=\"number\">S</th>"
         "<th class=\"number\">D</th><th>unit</th><th class=\"number\">E/u_D</th><th class=\"number\">u_val [%]</th>"
         "<th>|E|/u_val</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

/// E over its standard uncertainty, a line per value: u_D of what was fitted, u_val of what was predicted.
std::string residuals_svg(const Identified& out) {
  constexpr double left = 250, width = 560, line = 24, top = 26;
  double reach = 3;
  std::vector<std::pair<const IdentifiedValue*, double>> points;
  for (const bool fitted : {true, false})
    for (const IdentifiedValue& v : out.values) {
      if (v.fitted != fitted || (fitted ? !v.residual : !v.ratio)) continue;
      points.emplace_back(&v, fitted ? *v.residual : std::copysign(*v.ratio, *v.residual));
      reach = std::max(reach, std::ceil(std::abs(points.back().second)));
    }
  const double height = top + line * static_cast<double>(points.size()) + 30;
  const auto at = [&](double x) { return left + width * (x + reach) / (2 * reach); };
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {0} {1}\" role=\"img\" font-size=\"13\" style=\"max-width:{0}px;width:100%\">\n"
      "<rect x=\"{2}\" y=\"{3}\" width=\"{4}\" height=\"{5}\" fill=\"var(--band)\"/>\n",
      left + width + 20, height, at(-no_model_error), top - 6, at(no_model_error) - at(-no_model_error),
      height - top - 18);
  const double step = std::max(1.0, std::ceil(reach / 4));
  for (double x = -step * std::floor(reach / step); x <= reach; x += step)
    svg += fmt::format(
        "<line x1=\"{0}\" x2=\"{0}\" y1=\"{1}\" y2=\"{2}\" stroke=\"var(--{3})\"/><text x=\"{0}\" y=\"{4}\" "
        "text-anchor=\"middle\" fill=\"var(--soft)\">{5:g}</text>\n",
        at(x), top - 6, height - 24, x == 0 ? "ink" : "line", height - 8, x);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [v, x] = points[i];
    const double y = top + line * (static_cast<double>(i) + 0.4);
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\" fill=\"var(--ink)\">{}</text>\n", left - 12, y + 4,
                       xml_escaped(v->name));
    svg +=
        v->fitted
            ? fmt::format(
                  "<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"none\" stroke=\"var(--model-0)\" stroke-width=\"2\"/>\n",
                  at(x), y)
            : fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"var(--model-1)\"/>\n", at(x), y);
  }
  return svg + "</svg>\n";
}

std::string section_html(const Identified& out) {
  std::vector<std::string> cells;
  for (const Cells& c : out.cells) cells.push_back(cells_text(c, "×"));
  std::string html =
      fmt::format("<section><h2>{}</h2>\n<p class=\"lead\">{}, by {} on {} cells; {} runs</p>\n", xml_escaped(out.name),
                  xml_escaped(out.case_name), xml_escaped(out.model), fmt::join(cells, ", "), out.runs + out.kept);
  if (!out.ok) return html + "<p class=\"notice\">no result: " + xml_escaped(out.message) + "</p></section>\n";
  html += parameters_html(out);
  for (const std::string& sentence : out.sentences) html += "<p>" + xml_escaped(sentence) + "</p>\n";
  html +=
      residuals_svg(out) +
      "<p class=\"note\">E = S − D over its standard uncertainty. Circles: fitted values, over u_D. Dots: predicted "
      "values, over u_val. Within the band, 2 on both sides, no error of the model shows.</p>\n";
  return html + values_html(out) + fmt::format("<p class=\"note\">χ² = {:.3g} of {}.</p>\n", out.chi2, out.freedom) +
         correlations_html(out) + synthetic_html(out) + "</section>\n";
}

}  // namespace

std::string identify_page(const std::vector<Identified>& all) {
  std::string sections;
  for (const Identified& out : all) sections += section_html(out);
  const std::string title = all.empty() ? "" : xml_escaped(all.front().case_name);
  return plain_page(title + ", identified", "<h1>" + title + ": what was measured, and what it tells</h1>\n", sections);
}

}  // namespace springproof
