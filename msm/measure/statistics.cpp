#include "msm/measure/statistics.h"

#include <algorithm>
#include <cmath>

namespace springproof {
namespace {

NetworkStatistics statistics_of(const Network& network, const std::vector<char>& counted) {
  NetworkStatistics s{};
  double ends = 0, sum = 0, volume = 0;
  const auto ends_of = [&](const Spring& spring) {
    return counted[network.master(spring.i)] + counted[network.master(spring.j)];
  };
  for (int n = 0; n < network.nodes(); ++n) {
    s.nodes += counted[n];
    if (counted[network.master(n)]) volume += network.volume[n];
  }
  for (const Spring& spring : network.springs) {
    s.springs += ends_of(spring) > 0;
    ends += ends_of(spring);
    sum += ends_of(spring) * spring.rest_length;
  }
  s.springs_per_node = ends / double(s.nodes);
  s.mean_length = sum / ends;
  double squares = 0;
  for (const Spring& spring : network.springs)
    squares += ends_of(spring) * std::pow(spring.rest_length - s.mean_length, 2);
  s.length_deviation = std::sqrt(squares / ends);
  s.density = double(s.nodes) / volume;
  s.spacing = 1 / std::cbrt(s.density);
  return s;
}

}  // namespace

NetworkStatistics statistics(const Network& network) {
  std::vector<char> counted(network.nodes(), 1);
  for (std::size_t n = 0; n < network.image_of.size(); ++n) counted[n] = network.image_of[n] == static_cast<int>(n);
  return statistics_of(network, counted);
}

std::vector<char> bulk_nodes(const Network& network, const Region& region) {
  double longest = 0;
  for (const Spring& s : network.springs) longest = std::max(longest, s.rest_length);
  std::vector<Vec3> points;
  for (int n = 0; n < network.nodes(); ++n) points.push_back(network.X.row(n).transpose());
  std::vector<char> marked = near_surface(region, points, longest);
  for (char& m : marked) m = !m;
  return marked;
}

NetworkStatistics bulk_statistics(const Network& network, const Region& region) {
  return statistics_of(network, bulk_nodes(network, region));
}

}  // namespace springproof
