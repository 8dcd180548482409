#include "comparisons/reference/reference_grids.h"

#include <cmath>

#include "problem/case_file/measures.h"

namespace springproof {

std::map<std::string, double> region_measures(const std::vector<MaterialRegion>& regions,
                                              const std::vector<fem::RegionMeans>& means) {
  constexpr const char* components[6] = {"xx", "yy", "zz", "xy", "yz", "xz"};
  std::map<std::string, double> out;
  for (std::size_t r = 0; r < std::min(regions.size(), means.size()); ++r) {
    const std::string region = "region." + regions[r].name + ".";
    const fem::RegionMeans& m = means[r];
    out[region + "volume_change"] = m.volume_change;
    if (!std::isnan(m.energy)) out[region + "energy"] = m.energy;
    out[region + "pressure"] = -m.stress.leftCols<3>().mean();
    for (int c = 0; c < 6; ++c) out[region + "mean_stress." + components[c]] = m.stress(0, c);
    for (int d = 0; d < 3; ++d) out[region + "displacement." + "xyz"[d]] = m.displacement[d];
    out[region + "displacement.magnitude"] = m.displacement.norm();
  }
  return out;
}

std::map<std::string, double> interface_measures(const std::vector<MaterialRegion>& regions,
                                                 const std::vector<fem::InterfaceForce>& interfaces) {
  std::map<std::string, double> out;
  for (const fem::InterfaceForce& i : interfaces) {
    const std::string name = interface_of(regions, i.material, i.other);
    for (int d = 0; d < 3; ++d) out[name + '.' + "xyz"[d]] = i.force[d];
    out[name + ".magnitude"] = i.force.norm();
  }
  return out;
}

}  // namespace springproof
