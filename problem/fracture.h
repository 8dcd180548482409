// How a body dries and breaks.
#pragma once

#include <cstdint>
#include <limits>

namespace springproof {

/// Drying of a body from its top (its largest z): all rest lengths shorten, in equal steps, by up to
/// shrinkage * exp(-d / depth), d the depth of the spring's middle below the top; springs break beyond a stretch.
struct Fracture {
  double shrinkage = 0;                                    ///< of the rest lengths at the top at the end [1], 0 to 0.5
  int steps = 100;                                         ///< from rest to that shrinkage
  double depth = std::numeric_limits<double>::infinity();  ///< [m]; infinite: the body shrinks everywhere alike
  double threshold = 0;                                    ///< mean stretch T / (k L) at which springs break [1]
  double scatter = 0;  ///< relative standard deviation of the springs' thresholds, which are distributed evenly
  double apart = 5;    ///< overloaded springs break together if they are so many mean spring lengths apart; else one
                       ///< after the other, the most overloaded first
  std::uint64_t seed = 1;  ///< of the thresholds of the first sample; of its disordered network too
  int seeds = 1;           ///< number of samples
};

}  // namespace springproof
