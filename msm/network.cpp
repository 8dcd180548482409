#include "msm/network.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

namespace springproof {

std::vector<Spring> merge_springs(std::vector<Spring> springs) {
  for (Spring& s : springs)
    if (s.i > s.j) std::swap(s.i, s.j);
  std::sort(springs.begin(), springs.end(),
            [](const Spring& a, const Spring& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); });
  std::vector<Spring> merged;
  for (const Spring& s : springs) {
    if (merged.empty() || merged.back().i != s.i || merged.back().j != s.j) {
      merged.push_back(s);
      continue;
    }
    if (std::abs(merged.back().rest_length - s.rest_length) > 1e-9 * s.rest_length)
      throw std::invalid_argument("springs between the same two nodes differ in rest length");
    merged.back().stiffness += s.stiffness;
  }
  return merged;
}

Eigen::VectorXd masses(const Network& network, double density) { return density * network.volume; }

}  // namespace springproof
