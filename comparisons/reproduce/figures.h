// The table of what the three papers print: each figure and table, the cases that give its numbers, how it is drawn,
// and what must hold for it to be called reproduced.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "comparisons/reproduce/bodies.h"
#include "comparisons/reproduce/chart.h"

namespace springproof {

/// A statement of the paper about numbers of a case: those of `models` (empty: all rows of the measure), at
/// `poisson_ratios` (empty: all), on `cells` (none: all).
struct Claim {
  /// What each number is compared with: `value`, the converged finite elements, the Poisson's ratio wanted; or the
  /// numbers of `models` with each other: in ascending order (or within their spread), or the largest over the
  /// smallest less 1; or of several runs of a random network their spread over their mean.
  enum Target { number, finite_elements, wanted_nu, ascending, similar, scatter };

  std::string words;
  std::string case_name, measure;
  std::vector<std::string> models = {};
  Target target = number;
  double value = 0;
  double within = 0;     ///< below zero: the paper states no number, ours is shown and not judged
  bool relative = true;  ///< `within` is a fraction of the target
  std::vector<double> poisson_ratios = {};
  std::optional<Cells> cells = {};
  std::string against = "";  ///< of `similar`: the measure whose ratio of largest to smallest is the bound
  bool papers_bound =
      false;  ///< `within` is the paper's number for this very quantity; else its words are judged by ours

  /// Within a share of a number.
  Claim near(double wanted, double share) const {
    return with([&](Claim& c) { c.value = wanted, c.within = share; });
  }
  /// Within a share of the finite elements' value.
  Claim near_fem(double share) const {
    return with([&](Claim& c) { c.target = finite_elements, c.within = share; });
  }
  /// A distance, in its own unit.
  Claim at_most(double bound) const {
    return with([&](Claim& c) { c.within = bound, c.relative = false; });
  }
  /// Runs of a network spread by at most a share of their mean.
  Claim scattering(double share) const {
    return with([&](Claim& c) { c.target = scatter, c.within = share; });
  }
  /// Largest over smallest less 1.
  Claim alike(double share) const {
    return with([&](Claim& c) { c.target = similar, c.within = share; });
  }
  /// The bound is the paper's.
  Claim by_the_paper() const {
    return with([](Claim& c) { c.papers_bound = true; });
  }
  /// Only at these Poisson's ratios.
  Claim at(const std::vector<double>& ratios) const {
    return with([&](Claim& c) { c.poisson_ratios = ratios; });
  }
  /// Only on this lattice.
  Claim on(const Cells& lattice) const {
    return with([&](Claim& c) { c.cells = lattice; });
  }

 private:
  template <class Change>
  Claim with(const Change& change) const {
    Claim claim = *this;
    change(claim);
    return claim;
  }
};

/// One body of a figure of bodies.
struct BodyPlan {
  std::string title;
  std::string case_name, model;
  double poisson_ratio = 0;
  std::optional<Cells> cells = {};
  bool undeformed = false;
};

/// One row of the table of figures.
struct PaperFigure {
  std::string id;                  ///< "8", "table2"
  std::string what;                ///< what it shows
  std::vector<std::string> cases;  ///< built-in cases that give its numbers; empty: it cannot be redone
  std::string reason;              ///< why it differs, or cannot be redone
  std::vector<Claim> claims = {};
  std::function<std::vector<Chart>(const PaperResults&)> charts = nullptr;
  std::vector<BodyPlan> bodies = {};
  std::vector<std::string> cracks = {};  ///< models of the first case whose cracks are drawn
  int columns = 3;                       ///< of the bodies
  BodyView view = {};
  double last_digit = 0;           ///< of a table: the unit of its last printed digit [SI]
  bool percent = false;            ///< the table prints per cent of what the case files hold
  std::string printed_where = "";  ///< place of its printed values in the case files; empty: "Fig. 8", "Table 2"

  bool is_table() const { return id.starts_with("table") || last_digit > 0; }
  std::string title() const;      ///< "Fig. 8", "Table 2", "Sec. 6.2"
  std::string file_stem() const;  ///< "fig_8", "table_2", "sec_6.2"
};

/// Every figure and table of a paper, in its order.
std::vector<PaperFigure> golec_2019_figures();
std::vector<PaperFigure> kot_2014_figures();
std::vector<PaperFigure> kot_2015_figures();

/// A paper of the table.
struct Paper {
  std::string name;        ///< "golec_2019"
  std::string short_cite;  ///< "Golec et al. (2019)"
  std::string cite;
  std::vector<PaperFigure> figures;
};

const std::vector<Paper>& papers();

/// @throws InputError naming the papers there are.
const Paper& paper_named(const std::string& name);

/// Figures by id; without any all.
/// @throws InputError naming the figures of the paper.
std::vector<PaperFigure> figures_named(const Paper& paper, const std::vector<std::string>& ids);

/// The bodies of `models` (rows, each {label, model}) at `poisson_ratios` (columns), after one that is undeformed.
std::vector<BodyPlan> body_grid(const std::string& case_name,
                                const std::vector<std::pair<std::string, std::string>>& models,
                                const std::vector<double>& poisson_ratios, bool undeformed = false);

}  // namespace springproof
