// Draws the figures and tables of a paper from results: SVG, PDF, CSV and a page.
#pragma once

#include <filesystem>

#include "comparisons/reproduce/figures.h"

namespace springproof {

/// One statement of the paper, judged.
struct ClaimVerdict {
  std::string words;
  std::string numbers;  ///< "off by at most 1.2 % (allowed 5 %)"
  enum { no, partly, yes, not_judged } holds = no;
};

/// One printed value; of a table it is judged, of a figure shown beside what the paper states.
struct ValueVerdict {
  PrintedValue value;
  bool agrees = false;
};

struct FigureVerdict {
  std::string word;  ///< "agrees", "agrees in part", "differs", "drawn" (nothing to compare), "not redone", "not run"
  std::string sentence;
  std::vector<ClaimVerdict> claims;
  std::vector<ValueVerdict> values;
};

/// Printed values agree within this share of themselves, or within one unit of their last digit.
inline constexpr double printed_tolerance = 0.02;

FigureVerdict judge_figure(const PaperResults& results, const PaperFigure& figure);

/// One figure with the files that show it.
struct DrawnFigure {
  PaperFigure figure;
  FigureVerdict verdict;
  std::vector<std::string> svgs;  ///< as documents; none: not redone, or a table
  std::string csv;
};

DrawnFigure draw_figure(const PaperResults& results, const PaperFigure& figure);

/// Writes OUT/figures/NAME.svg, .csv and, where rsvg-convert is on PATH, .pdf, and OUT/reproduce.html, the page that
/// shows them all.
/// @return whether the PDFs could be written.
/// @throws std::runtime_error if a file cannot be written.
bool write_figures(const std::vector<DrawnFigure>& drawn, const Paper& paper, const std::filesystem::path& out);

/// The page: a table of figures and verdicts, then each figure with its statements and printed values.
std::string reproduce_page(const std::vector<DrawnFigure>& drawn, const Paper& paper);

/// The table of figures and verdicts as text.
std::string verdict_table(const std::vector<DrawnFigure>& drawn);

}  // namespace springproof
