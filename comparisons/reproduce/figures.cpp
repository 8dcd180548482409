#include "comparisons/reproduce/figures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "problem/system/input_error.h"

namespace springproof {

std::string PaperFigure::title() const {
  if (id.starts_with("table")) return "Table " + id.substr(5);
  if (id.starts_with("sec")) return "Sec. " + id.substr(3);
  return "Fig. " + id;
}

std::string PaperFigure::file_stem() const {
  if (id.starts_with("table")) return "table_" + id.substr(5);
  if (id.starts_with("sec")) return "sec_" + id.substr(3);
  return "fig_" + id;
}

const std::vector<Paper>& papers() {
  static const std::vector<Paper> all = {
      {"golec_2019", "Golec et al. (2019)",
       "Golec, Palierne, Zara, Nicolle, Damiand: Hybrid 3D mass-spring system for simulation of isotropic materials "
       "with any Poisson's ratio. The Visual Computer 36 (2020) 809-825",
       golec_2019_figures()},
      {"kot_2014", "Kot et al. (2014)",
       "Kot, Nagahashi, Szymczak: Elastic moduli of simple mass spring models. The Visual Computer 31 (2015) 1339-1350",
       kot_2014_figures()},
      {"kot_2015", "Kot & Nagahashi (2015)",
       "Kot, Nagahashi: Mass spring models with adjustable Poisson's ratio. The Visual Computer 33 (2017) 283-291",
       kot_2015_figures()},
  };
  return all;
}

const Paper& paper_named(const std::string& name) {
  std::vector<std::string> names;
  for (const Paper& paper : papers()) {
    if (paper.name == name) return paper;
    names.push_back(paper.name);
  }
  throw InputError(fmt::format("PAPER: there is no \"{}\" (allowed: {})", name, fmt::join(names, ", ")));
}

std::vector<PaperFigure> figures_named(const Paper& paper, const std::vector<std::string>& ids) {
  if (ids.empty()) return paper.figures;
  std::vector<std::string> known;
  for (const PaperFigure& figure : paper.figures) known.push_back(figure.id);
  for (const std::string& id : ids)
    if (std::ranges::find(known, id) == known.end())
      throw InputError(fmt::format("--figure: {} has no \"{}\" (allowed: {})", paper.name, id, fmt::join(known, ", ")));
  std::vector<PaperFigure> wanted;
  for (const PaperFigure& figure : paper.figures)
    if (std::ranges::find(ids, figure.id) != ids.end()) wanted.push_back(figure);
  return wanted;
}

std::vector<BodyPlan> body_grid(const std::string& case_name,
                                const std::vector<std::pair<std::string, std::string>>& models,
                                const std::vector<double>& poisson_ratios, bool undeformed) {
  std::vector<BodyPlan> all;
  for (const auto& [label, model] : models) {
    if (undeformed) all.push_back({"undeformed", case_name, model, poisson_ratios.front(), {}, true});
    for (double nu : poisson_ratios) all.push_back({label, case_name, model, nu});
  }
  return all;
}

}  // namespace springproof
