// Draws the figures and tables of a paper from results: SVG, PDF, CSV and a page.
#pragma once

#include <filesystem>

#include "comparisons/reproduce/verdict.h"

namespace springproof {

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
