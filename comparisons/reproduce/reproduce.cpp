#include "comparisons/reproduce/reproduce.h"

#include <fmt/format.h>

#include "problem/files/encoding.h"
#include "problem/files/files.h"
#include "problem/processes/child.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

BodyPanel panel_of(const PaperResults& results, const BodyPlan& plan) {
  BodyPanel panel{
      plan.title, plan.undeformed ? "" : fmt::format("ν = {:g}", plan.poisson_ratio), {}, "", plan.undeformed};
  panel.shape = results.shape(plan.case_name, plan.model, plan.poisson_ratio, plan.cells);
  if (!panel.shape) panel.missing = results.failure(plan.case_name, plan.model, plan.poisson_ratio);
  return panel;
}

std::string drawn_bodies(const PaperResults& results, const PaperFigure& figure) {
  std::vector<BodyPanel> panels;
  for (const BodyPlan& plan : figure.bodies) panels.push_back(panel_of(results, plan));
  return bodies_svg(panels, figure.columns, figure.view);
}

/// Cracks side by side, seen from above.
std::string drawn_cracks(const PaperResults& results, const PaperFigure& figure) {
  constexpr int size = 340, gap = 20, title = 30;
  std::string out;
  int left = 0;
  for (const std::string& model : figure.cracks) {
    std::string svg = results.cracks(figure.cases.front(), model);
    if (svg.empty())
      throw InputError(fmt::format("no cracks of {} are in the results of {}", model, figure.cases.front()));
    const std::string place =
        fmt::format("<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" ", left, title, size, size);
    out += fmt::format("<text x=\"{}\" y=\"20\">{}</text>\n", left, xml_escaped(model)) +
           svg.replace(0, std::string("<svg ").size(), place);
    left += size + gap;
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"15\">\n{2}</svg>\n",
      std::max(size, left - gap), size + title, out);
}

/// Numbers beside the pictures: every number of the cases that the claims are about.
std::string bodies_csv(const PaperResults& results, const PaperFigure& figure) {
  std::string out = "case,measure,model,poisson_ratio,cells,value,spread,finite_elements,unit\n";
  std::vector<std::pair<std::string, std::string>> wanted;
  for (const Claim& claim : figure.claims)
    if (std::ranges::find(wanted, std::pair(claim.case_name, claim.measure)) == wanted.end())
      wanted.emplace_back(claim.case_name, claim.measure);
  for (const auto& [case_name, measure] : wanted)
    for (const Row& row : results.rows(case_name))
      if (row.measure == measure)
        out += fmt::format("{},{},{},{},{},{},{},{},{}\n", csv_text(case_name), csv_text(measure), csv_text(row.model),
                           csv_number(row.poisson_ratio), cells_text(row.cells), csv_number(row.value),
                           csv_number(row.spread), csv_number(row.reference), csv_text(row.unit));
  return out;
}

std::string values_csv(const std::vector<ValueVerdict>& values) {
  std::string out = "where,case,model,poisson_ratio,cells,measure,printed,ours,finite_elements,unit,agrees,remark\n";
  for (const auto& [v, agrees] : values)
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_text(v.where), csv_text(v.case_name),
                       csv_text(v.model), csv_number(v.poisson_ratio), cells_text(v.cells), csv_text(v.measure),
                       csv_number(v.printed), csv_number(v.ours), csv_number(v.fem), csv_text(v.unit),
                       agrees ? "yes" : "no", csv_text(v.remark));
  return out;
}

/// False if there is no converter; a converter that fails is an error.
bool write_pdf(const fs::path& converter, const fs::path& svg, const fs::path& pdf) {
  if (converter.empty()) return false;
  const ChildEnd end =
      run_child({converter, {"--format=pdf", "--output=" + pdf.string(), svg.string()}, {}, {}, {}, 60});
  if (!end.ok())
    throw std::runtime_error(
        fmt::format("{} of {} {}", converter.filename().string(), svg.string(), words_for(end, 60)));
  return true;
}

}  // namespace

DrawnFigure draw_figure(const PaperResults& results, const PaperFigure& figure) {
  DrawnFigure drawn{figure, judge_figure(results, figure), {}, ""};
  if (drawn.verdict.word == "not redone" || drawn.verdict.word == "not run") return drawn;
  if (figure.charts) {
    const std::vector<Chart> charts = figure.charts(results);
    drawn.svgs.push_back(charts_svg(charts));
    drawn.csv = charts_csv(charts);
  }
  if (!figure.bodies.empty()) {
    drawn.svgs.push_back(drawn_bodies(results, figure));
    if (drawn.csv.empty()) drawn.csv = bodies_csv(results, figure);
  }
  if (!figure.cracks.empty()) {
    drawn.svgs.push_back(drawn_cracks(results, figure));
    drawn.csv = bodies_csv(results, figure);
  }
  if (figure.is_table()) drawn.csv = values_csv(drawn.verdict.values);
  return drawn;
}

bool write_figures(const std::vector<DrawnFigure>& drawn, const Paper& paper, const fs::path& out) {
  const fs::path converter = program_on_path("rsvg-convert"), folder = out / "figures";
  fs::create_directories(folder);
  bool pdfs = true;
  for (const DrawnFigure& d : drawn) {
    for (std::size_t i = 0; i < d.svgs.size(); ++i) {
      const std::string stem = d.figure.file_stem() + (i == 0 ? "" : "_bodies");
      write_file(folder / (stem + ".svg"), d.svgs[i]);
      pdfs &= write_pdf(converter, folder / (stem + ".svg"), folder / (stem + ".pdf"));
    }
    if (!d.csv.empty()) write_file(folder / (d.figure.file_stem() + ".csv"), d.csv);
  }
  write_file(out / "reproduce.html", reproduce_page(drawn, paper));
  return pdfs;
}

std::string verdict_table(const std::vector<DrawnFigure>& drawn) {
  std::string out;
  for (const DrawnFigure& d : drawn)
    out += fmt::format("{:<10} {:<15} {}\n", d.figure.title(), d.verdict.word, d.verdict.sentence);
  return out;
}

}  // namespace springproof
