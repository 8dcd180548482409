// The table of figures against the case files and docs/measured/reproducing.md.
#include "comparisons/reproduce/figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include "comparisons/sweep/find_cases.h"
#include "problem/case_file/experiment.h"
#include "problem/files/files.h"
#include "problem/system/input_error.h"

namespace springproof::figures_test {
namespace {

std::vector<PaperFigure> all_figures() {
  std::vector<PaperFigure> all;
  for (const Paper& paper : papers()) all.insert(all.end(), paper.figures.begin(), paper.figures.end());
  return all;
}

const Experiment& experiment_of(const std::string& case_name) {
  static std::map<std::string, Experiment> known;
  const auto found = known.find(case_name);
  if (found != known.end()) return found->second;
  return known[case_name] = read_experiment(find_cases({case_name}).at(0));
}

bool has_model(const Experiment& e, const std::string& label) {
  return label == "fem" ||
         std::any_of(e.models.begin(), e.models.end(), [&](const ModelChoice& m) { return m.label == label; });
}

bool has_nu(const Experiment& e, double nu) {
  return std::any_of(e.materials.begin(), e.materials.end(),
                     [&](const auto& m) { return same_poisson_ratio(m.poisson_ratio, nu); });
}

TEST(PaperFigures, AreOfCasesThatAreThere) {
  for (const PaperFigure& figure : all_figures())
    for (const std::string& name : figure.cases) EXPECT_NO_THROW(experiment_of(name)) << figure.title();
}

TEST(PaperFigures, ClaimsAndBodiesAreOfModelsAndRatiosOfTheirCases) {
  for (const PaperFigure& figure : all_figures()) {
    const auto listed = [&](const std::string& name) {
      return std::find(figure.cases.begin(), figure.cases.end(), name) != figure.cases.end();
    };
    for (const Claim& claim : figure.claims) {
      ASSERT_TRUE(listed(claim.case_name)) << figure.title() << ": " << claim.words;
      for (const std::string& model : claim.models)
        EXPECT_TRUE(has_model(experiment_of(claim.case_name), model)) << figure.title() << ": " << model;
      for (double nu : claim.poisson_ratios)
        EXPECT_TRUE(has_nu(experiment_of(claim.case_name), nu)) << figure.title() << ": " << nu;
    }
    for (const BodyPlan& body : figure.bodies) {
      ASSERT_TRUE(listed(body.case_name)) << figure.title();
      EXPECT_TRUE(has_model(experiment_of(body.case_name), body.model)) << figure.title() << ": " << body.model;
      EXPECT_TRUE(has_nu(experiment_of(body.case_name), body.poisson_ratio)) << figure.title();
    }
  }
}

TEST(PaperFigures, AreDrawnOrSayWhyNot) {
  for (const Paper& paper : papers()) {
    std::set<std::string> ids, files;
    for (const PaperFigure& figure : paper.figures) {
      EXPECT_TRUE(ids.insert(figure.id).second) << figure.id;
      EXPECT_TRUE(files.insert(figure.file_stem()).second) << figure.file_stem();
      const bool drawn = figure.charts || !figure.bodies.empty() || !figure.cracks.empty() || figure.is_table();
      if (figure.cases.empty())
        EXPECT_FALSE(figure.reason.empty()) << figure.title();
      else
        EXPECT_TRUE(drawn) << paper.name << " " << figure.title();
    }
  }
}

/// Printed values in the case files of a figure.
std::size_t printed_values(const PaperFigure& figure) {
  std::size_t count = 0;
  const std::string where = figure.printed_where.empty() ? figure.title() : figure.printed_where;
  for (const std::string& name : figure.cases) {
    const Experiment& e = experiment_of(name);
    for (const Expectation& x : e.expectations) count += x.source == Source::published && x.where.starts_with(where);
    for (const PublishedValue& v : e.published) count += v.where.starts_with(where);
  }
  return count;
}

TEST(PaperFigures, TablesHaveEveryPrintedValue) {
  const std::map<std::string, std::size_t> printed = {{"table2", 18}, {"table3", 18}, {"table4", 6},
                                                      {"table5", 6},  {"table6", 24}, {"sec6.2", 6}};
  for (const PaperFigure& figure : paper_named("golec_2019").figures) {
    if (figure.cases.empty() || !figure.is_table()) continue;
    EXPECT_EQ(printed_values(figure), printed.at(figure.id)) << figure.id;
  }
}

TEST(PaperFigures, UnknownPapersAndFiguresAreRefusedWithTheOnesThereAre) {
  try {
    paper_named("golec");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()), "PAPER: there is no \"golec\" (allowed: golec_2019, kot_2014, kot_2015)");
  }
  try {
    figures_named(paper_named("kot_2015"), {"7", "14"});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()),
              "--figure: kot_2015 has no \"14\" (allowed: 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13)");
  }
  EXPECT_EQ(figures_named(paper_named("kot_2015"), {"13", "7"}).size(), 2u);
  EXPECT_EQ(figures_named(paper_named("kot_2015"), {}).size(), 13u);
}

const PaperFigure& figure_of(const std::string& paper, const std::string& id) {
  for (const PaperFigure& figure : paper_named(paper).figures)
    if (figure.id == id) return figure;
  throw std::invalid_argument(id);
}

TEST(PaperFigures, ThePapersScatterOfABarIsNoDistanceFromItsFormula) {
  int scatter = 0;
  for (const Claim& claim : figure_of("kot_2014", "13").claims) {
    EXPECT_TRUE(!claim.papers_bound || claim.target == Claim::scatter) << claim.words;
    scatter += claim.target == Claim::scatter;
  }
  EXPECT_EQ(scatter, 2);
}

TEST(PaperFigures, DispersionAsPublishedIsJudgedOnThePapersBlock) {
  for (const Claim& claim : figure_of("kot_2015", "7").claims) {
    if (claim.models != std::vector<std::string>{"published"} || claim.within < 0) continue;
    const Body& body = experiment_of(claim.case_name).body;
    EXPECT_EQ(body.cells, (std::vector<Cells>{{70, 15, 15}}));
    EXPECT_EQ(claim.measure, "moduli.poisson_ratio");
    return;
  }
  FAIL() << "it is not judged";
}

/// Cells of the rows "| Fig. 8 | ... |" below the heading of a paper.
std::map<std::string, std::vector<std::string>> documented(const std::string& paper) {
  std::ifstream in(std::string(SPRINGPROOF_SOURCE_DIR) + "/docs/measured/reproducing.md");
  std::map<std::string, std::vector<std::string>> rows;
  std::string heading;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("## ")) heading = line.substr(3);
    if (heading != paper || !line.starts_with("| ")) continue;
    std::vector<std::string> cells;
    for (std::size_t at = 1; at < line.size();) {
      const std::size_t end = std::min(line.find('|', at), line.size());
      cells.push_back(trimmed(line.substr(std::min(at + 1, end), end - std::min(at + 1, end))));
      at = end + 1;
    }
    EXPECT_EQ(rows.count(cells[0]), 0u) << cells[0] << " twice";
    rows[cells[0]] = cells;
  }
  return rows;
}

TEST(PaperFigures, AreAllInThePageOfReproducedFigures) {
  const std::set<std::string> words = {"agrees", "agrees in part", "differs", "drawn", "not redone"};
  for (const Paper& paper : papers()) {
    auto rows = documented(paper.name);
    rows.erase("figure");
    rows.erase("---");
    for (const PaperFigure& figure : paper.figures) {
      const auto found = rows.find(figure.title());
      ASSERT_NE(found, rows.end()) << paper.name << " " << figure.title() << " has no row";
      const std::vector<std::string>& cells = found->second;
      ASSERT_GE(cells.size(), 5u) << figure.title();
      for (const std::string& name : figure.cases)
        EXPECT_NE(cells[2].find("`" + name + "`"), std::string::npos) << figure.title() << ": " << name;
      const std::string file =
          figure.cases.empty() ? "none" : figure.file_stem() + (figure.is_table() ? ".csv" : ".svg");
      EXPECT_NE(cells[3].find(file), std::string::npos) << figure.title();
      EXPECT_TRUE(words.contains(cells[4].substr(0, cells[4].find(':')))) << figure.title() << ": " << cells[4];
      EXPECT_EQ(cells[4].starts_with("not redone"), figure.cases.empty()) << figure.title();
      rows.erase(found);
    }
    EXPECT_TRUE(rows.empty()) << paper.name << ": the table of figures has no "
                              << (rows.empty() ? "" : rows.begin()->first);
  }
}

}  // namespace
}  // namespace springproof::figures_test
