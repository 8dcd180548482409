#include "msm/exchange/lammps.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

namespace springproof {
namespace {

constexpr std::size_t most_types = 64;

/// Assigns the numbers 1, 2, ... to distinct values.
template <class Key>
class Types {
 public:
  int of(const Key& key) {
    const auto [at, is_new] = number_.try_emplace(key, int(values_.size()) + 1);
    if (is_new) values_.push_back(key);
    return at->second;
  }
  const std::vector<Key>& values() const { return values_; }

 private:
  std::map<Key, int> number_;
  std::vector<Key> values_;
};

Types<double> types_of(const Eigen::VectorXd& mass) {
  Types<double> types;
  for (const double m : mass) types.of(m);
  return types;
}

double longest_spring(const Network& network) {
  double longest = 0;
  for (const Spring& s : network.springs) longest = std::max(longest, s.rest_length);
  return longest;
}

}  // namespace

bool suits_lammps(const MassSpringModel& model) {
  return model.network.image_of.empty() && std::all_of(model.laws.begin(), model.laws.end(), [](const ForceLaw& law) {
           return std::holds_alternative<Springs>(law);
         });
}

std::string lammps_data(const Network& network, const NodalVectors& x, const Eigen::VectorXd& mass) {
  Types<double> node_types = types_of(mass);
  const bool by_type = node_types.values().size() <= most_types;
  Types<std::pair<double, double>> bond_types;
  std::string atoms, bonds, masses;
  for (Eigen::Index n = 0; n < x.rows(); ++n) {
    fmt::format_to(std::back_inserter(atoms), "{} 1 {} {:.17g} {:.17g} {:.17g}\n", n + 1,
                   by_type ? node_types.of(mass[n]) : 1, x(n, 0), x(n, 1), x(n, 2));
    if (!by_type) fmt::format_to(std::back_inserter(masses), "{} {:.17g}\n", n + 1, mass[n]);
  }
  long number = 0;
  for (const Spring& s : network.springs)
    fmt::format_to(std::back_inserter(bonds), "{} {} {} {}\n", ++number, bond_types.of({s.stiffness, s.rest_length}),
                   s.i + 1, s.j + 1);
  std::string head =
      fmt::format("springs\n\n{} atoms\n{} atom types\n{} bonds\n{} bond types\n\n", x.rows(),
                  by_type ? node_types.values().size() : 1, network.springs.size(), bond_types.values().size());
  const double margin = longest_spring(network);
  for (int c = 0; c < 3; ++c)
    head += fmt::format("{0:.17g} {1:.17g} {2}lo {2}hi\n", x.col(c).minCoeff() - margin, x.col(c).maxCoeff() + margin,
                        "xyz"[c]);
  head += "\nMasses\n\n";
  if (by_type)
    for (std::size_t i = 0; i < node_types.values().size(); ++i)
      head += fmt::format("{} {:.17g}\n", i + 1, node_types.values()[i]);
  else
    head += fmt::format("1 {:.17g}\n", mass.mean());
  head += "\nBond Coeffs\n\n";
  for (std::size_t i = 0; i < bond_types.values().size(); ++i)
    head += fmt::format("{} {:.17g} {:.17g}\n", i + 1, bond_types.values()[i].first / 2, bond_types.values()[i].second);
  head += "\nAtoms # bond\n\n" + atoms + "\nBonds\n\n" + bonds;
  return by_type ? head : head + "\nNodeMasses\n\n" + masses;
}

std::string lammps_input(const Network& network, const Eigen::VectorXd& mass, const std::string& data_file,
                         double time_step) {
  const bool by_type = types_of(mass).values().size() <= most_types;
  return fmt::format(
      "units si\natom_style bond\natom_modify sort 0 0.0\nboundary f f f\nnewton on\nspecial_bonds lj/coul 1 1 1\n"
      "bond_style harmonic\nneighbor {0:.6g} bin\ncomm_modify cutoff {0:.6g}\n{1}\n"
      "neigh_modify every 1000000000 delay 1000000000 check no\ntimestep {2:.10g}\nfix move all nve\n",
      1.5 * longest_spring(network),
      by_type ? "read_data " + data_file
              : "fix masses all property/atom rmass ghost yes\nread_data " + data_file + " fix masses NULL NodeMasses",
      time_step);
}

}  // namespace springproof
