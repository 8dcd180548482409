#include "msm/exchange/lammps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

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

const char* atom_style(const MassSpringModel& model) { return law_of<AngularSprings>(model) ? "angle" : "bond"; }

/// The angles of the triangles: their coefficients and their nodes, the corner in the middle.
struct Angles {
  long count = 0;
  std::size_t types = 0;
  std::string coefficients, rows;
};

Angles angles_of(const Network& network, const AngularSprings& law) {
  Angles out;
  Types<double> types;
  for (const auto& triangle : network.triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const int a = triangle[corner], b = triangle[(corner + 1) % 3], c = triangle[(corner + 2) % 3];
      const Vec3 to_b = network.X.row(b) - network.X.row(a), to_c = network.X.row(c) - network.X.row(a);
      const double degrees = std::atan2(to_b.cross(to_c).norm(), to_b.dot(to_c)) * 180 / std::numbers::pi;
      const double phi = std::round(degrees * 1e11) / 1e11;  // equal angles get one type
      fmt::format_to(std::back_inserter(out.rows), "{} {} {} {} {}\n", ++out.count, types.of(phi), b + 1, a + 1, c + 1);
    }
  out.types = types.values().size();
  for (std::size_t i = 0; i < out.types; ++i)
    fmt::format_to(std::back_inserter(out.coefficients), "{} {:.17g} {:.17g}\n", i + 1, law.beta / 2,
                   types.values()[i]);
  return out;
}

}  // namespace

std::string lammps_data(const MassSpringModel& model, const NodalVectors& x, const Eigen::VectorXd& mass) {
  const Network& network = model.network;
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
  const AngularSprings* angular = law_of<AngularSprings>(model);
  const Angles angles = angular ? angles_of(network, *angular) : Angles{};
  std::string head =
      fmt::format("springs\n\n{} atoms\n{} atom types\n{} bonds\n{} bond types\n", x.rows(),
                  by_type ? node_types.values().size() : 1, network.springs.size(), bond_types.values().size());
  if (angular) head += fmt::format("{} angles\n{} angle types\n", angles.count, angles.types);
  head += '\n';
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
  if (angular) head += "\nAngle Coeffs\n\n" + angles.coefficients;
  head += fmt::format("\nAtoms # {}\n\n", atom_style(model)) + atoms + "\nBonds\n\n" + bonds;
  if (angular) head += "\nAngles\n\n" + angles.rows;
  return by_type ? head : head + "\nNodeMasses\n\n" + masses;
}

std::string lammps_input(const MassSpringModel& model, const Eigen::VectorXd& mass, const std::string& data_file,
                         double time_step) {
  const bool by_type = types_of(mass).values().size() <= most_types;
  return fmt::format(
      "units si\natom_style {3}\natom_modify sort 0 0.0\nboundary f f f\nnewton on\nspecial_bonds lj/coul 1 1 1\n"
      "bond_style harmonic\n{4}neighbor {0:.6g} bin\ncomm_modify cutoff {0:.6g}\n{1}\n"
      "neigh_modify every 1000000000 delay 1000000000 check no\ntimestep {2:.10g}\nfix move all nve\n",
      1.5 * longest_spring(model.network),
      by_type ? "read_data " + data_file
              : "fix masses all property/atom rmass ghost yes\nread_data " + data_file + " fix masses NULL NodeMasses",
      time_step, atom_style(model), law_of<AngularSprings>(model) ? "angle_style harmonic\n" : "");
}

}  // namespace springproof
