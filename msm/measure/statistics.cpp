#include "msm/measure/statistics.h"

#include <cmath>

namespace springproof {

NetworkStatistics statistics(const Network& network) {
  NetworkStatistics s{};
  for (int n = 0; n < network.nodes(); ++n) s.nodes += network.master(n) == n;
  s.springs = static_cast<long>(network.springs.size());
  const auto springs = static_cast<double>(s.springs);
  for (const Spring& spring : network.springs) s.mean_length += spring.rest_length / springs;
  double squares = 0;
  for (const Spring& spring : network.springs) squares += std::pow(spring.rest_length - s.mean_length, 2);
  s.springs_per_node = 2 * springs / static_cast<double>(s.nodes);
  s.length_deviation = std::sqrt(squares / springs);
  s.density = static_cast<double>(s.nodes) / network.volume.sum();
  s.spacing = 1 / std::cbrt(s.density);
  return s;
}

}  // namespace springproof
