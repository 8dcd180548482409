// Pairs the natural modes of a model with those of the reference by their shapes.
#pragma once

#include <optional>
#include <vector>

#include "problem/vector.h"

namespace springproof {

/// Modes sampled at common points, in ascending order of frequency.
struct ModeSet {
  std::vector<double> frequencies;   ///< [Hz]
  std::vector<NodalVectors> shapes;  ///< n x 3 each
  std::vector<double> damping = {};  ///< by branches that relax, share of critical; empty: none
};

/// Modes whose frequencies differ by less, one from the next, are taken for one multiple mode: within its subspace
/// shapes are arbitrary.
inline constexpr double multiplet_width = 0.01;
inline constexpr double equal_frequencies = 1e-4;  ///< relative: a multiplet by symmetry
inline constexpr double least_mac = 0.8;           ///< of partners

struct ModePair {
  std::optional<std::size_t> partner;  ///< number of the computed mode
  double mac = 0;  ///< modal assurance criterion, cosine^2 of the angle between a mode and the span of the other's
                   ///< multiplet; of the best candidate if there is no partner
};

/// One pair per reference mode: the assignment with the largest sum of MACs in the inner product of nodal `weights`;
/// within a multiplet that of the most similar shapes (MACs of modes whose frequencies are equal), and of equal ones
/// that in the order of frequency (Hungarian method).
std::vector<ModePair> pair_modes(const ModeSet& reference, const ModeSet& computed, const Eigen::VectorXd& weights);

}  // namespace springproof
