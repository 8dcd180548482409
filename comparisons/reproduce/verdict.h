// Whether a figure or table of a paper is reproduced.
#pragma once

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

}  // namespace springproof
