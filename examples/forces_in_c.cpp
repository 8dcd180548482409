// Reads a springs file with a JSON library alone and computes its forces by springproof_forces.h, without springproof:
// they are those of the file's check, and minus the gradient of the energy.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "springproof_forces.h"

using nlohmann::json;

template <class T>
std::vector<T> flat(const json& rows) {
  std::vector<T> out;
  for (const json& row : rows)
    if (row.is_array())
      for (const json& x : row) out.push_back(x);
    else
      out.push_back(row);
  return out;
}

/// laws.averaged_springs, or those of one of its regions.
struct sp_averaged averaged_of(const json& law) {
  const std::string curve = law.at("curve");
  return {curve == "hencky"      ? SP_HENCKY
          : curve == "neo_hooke" ? SP_NEO_HOOKE
                                 : SP_NEO_HOOKE_ISOCHORIC,
          law.at("shear_modulus_Pa"),
          law.at("lame_lambda_Pa"),
          law.at("bending"),
          law.at("coupling"),
          law.at("torsion"),
          law.at("twist"),
          law.at("warping")};
}

/// laws.measured_cells, if there.
std::vector<double> form_of(const json& file) {
  const json& laws = file.at("laws");
  return laws.contains("measured_cells") ? flat<double>(laws.at("measured_cells").at("form_N_m"))
                                         : std::vector<double>{};
}

/// How far the forces of the branches are from those of the file's check, after its steps, of the largest [1].
double branches_off(const json& file, const std::vector<double>& X, const std::vector<int>& cells,
                    const std::vector<double>& edges, const sp_parts& parts) {
  const json of = file.at("relaxation"), check = file.at("check");
  const auto share = flat<double>(of.at("share")), time = flat<double>(of.at("time_s")),
             x = flat<double>(check.at("position_m")), wanted = flat<double>(check.at("branch_force_N"));
  const std::vector<double> form = form_of(file);
  sp_branches branches = {share.size(), share.data(), time.data(), {}, form.data()};
  if (form.empty())
    branches = {share.size(),
                share.data(),
                time.data(),
                {SP_HENCKY, of.at("shear_modulus_Pa"), 0, of.at("bending"), of.at("coupling"), of.at("torsion"),
                 of.at("twist"), of.at("warping")},
                nullptr};
  std::vector<double> states(edges.size() * SP_STRAINS * (1 + share.size())), f(x.size()), at = X;
  for (std::size_t step = 0; step < check.at("step_s").size(); ++step) {
    for (std::size_t i = 0; i < x.size(); ++i) at[i] = X[i] + check["progress"][step].get<double>() * (x[i] - X[i]);
    std::fill(f.begin(), f.end(), 0);
    sp_relaxing(edges.size(), cells.data(), edges.data(), parts, branches, at.data(), check["step_s"][step],
                states.data(), f.data());
  }
  double off = 0, largest = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    off = std::max(off, std::abs(f[i] - wanted[i]));
    largest = std::max(largest, std::abs(wanted[i]));
  }
  return off / largest;
}

int main(int count, char** arguments) try {
  if (count != 2) return std::fprintf(stderr, "usage: forces_in_c FILE.json\n"), 2;
  const json file = json::parse(std::ifstream(arguments[1])), laws = file.at("laws"), derived = file.at("derived");
  const json of_cells = file.value("cells", json::object());
  const std::vector<std::string> known = {"springs",          "volume_correction", "hourglass_correction",
                                          "averaged_springs", "measured_cells",    "anchors"};
  bool all = !of_cells.contains("proportions") && of_cells.contains("nodes");
  for (const auto& [name, law] : laws.items()) all = all && std::find(known.begin(), known.end(), name) != known.end();
  if (!all)
    return std::fprintf(stderr, "boxes, no cells, or a law that is not here: examples/springs.py has them\n"), 2;
  const auto X = flat<double>(file.at("nodes").at("position_m")), mass = flat<double>(file.at("nodes").at("mass_kg"));
  const auto ends = flat<int>(file.at("springs").at("nodes")), cells = flat<int>(file.at("cells").at("nodes"));
  const auto k = flat<double>(file.at("springs").at("stiffness_N_m")),
             L = flat<double>(file.at("springs").at("rest_length_m"));
  const auto moment = [&](const char* key) { return flat<double>(file.at("cells").value(key, json::array())); };
  const auto fraction = moment("fraction"), mean = moment("mean"), mixed = moment("mixed"),
             variance = moment("variance");
  const json edge = file.at("cells").at("edge_m"), carried = file.value("carried", json::object());
  const auto edges = edge.is_array() ? flat<double>(edge) : std::vector<double>(cells.size() / 8, edge);
  const auto carried_nodes = flat<int>(carried.value("nodes", json::array())),
             carried_by = flat<int>(carried.value("by", json::array()));
  const json bonds = file.value("bonds", json::object());
  const auto material = flat<int>(file.at("cells").value("material", json::array())),
             bonded = flat<int>(bonds.value("nodes", json::array()));
  const auto bond_weights = flat<double>(bonds.value("weights", json::array())),
             bond_stiffness = flat<double>(bonds.value("stiffness_N_m", json::array()));
  const std::vector<double> form = form_of(file);
  const sp_parts parts = {fraction.empty() ? nullptr : fraction.data(), mean.data(), mixed.data(), variance.data()};
  const auto energy = [&](std::vector<double> x, double* f) {
    sp_carry(carried_nodes.size(), carried_nodes.data(), carried_by.data(), x.data());
    double W = sp_springs(k.size(), ends.data(), k.data(), L.data(), x.data(), f);
    if (laws.contains("volume_correction"))
      W += sp_volume(cells.size() / 8, cells.data(), edges[0], laws.at("volume_correction").at("kappa_Pa"),
                     laws.at("volume_correction").at("form") == "paper", x.data(), f);
    if (laws.contains("hourglass_correction"))
      W += sp_hourglass(cells.size() / 8, cells.data(),
                        {derived.at("hourglass_bending_N_m"), derived.at("hourglass_coupling_N_m"),
                         derived.at("hourglass_torsion_N_m"), derived.at("hourglass_torsion_coupling_N_m")},
                        X.data(), x.data(), f);
    if (laws.contains("measured_cells"))
      W += sp_measured(cells.size() / 8, cells.data(), edges[0], parts, form.data(), x.data(), f);
    if (laws.contains("averaged_springs")) {
      const json& law = laws.at("averaged_springs");
      std::vector<struct sp_averaged> of = {averaged_of(law)};
      for (const json& region : law.value("regions", json::array())) of.push_back(averaged_of(region));
      const struct sp_averaged& springs = of[0];
      const std::size_t number = cells.size() / 8;
      W += !material.empty()
               ? sp_averaged_materials(number, cells.data(), edges[0], parts, of.data(), material.data(), x.data(), f)
           : edge.is_array() ? sp_averaged_sizes(number, cells.data(), edges.data(), parts, springs, x.data(), f)
                             : sp_averaged_cut(number, cells.data(), edges[0], parts, springs, x.data(), f);
    }
    W += sp_bonds(bonded.size() / 16, bonded.data(), bond_weights.data(), bond_stiffness.data(),
                  edges.empty() ? 1 : edges[0], x.data(), f);
    if (f) sp_hand_back(carried_nodes.size(), carried_nodes.data(), carried_by.data(), f);
    return W;
  };

  auto x = flat<double>(file.at("check").at("position_m"));
  const auto wanted = flat<double>(file.at("check").at("force_N"));
  std::vector<double> f(x.size()), v(x.size());
  energy(x, f.data());
  double largest = 0, off = 0, off_gradient = 0;
  for (double force : wanted) largest = std::max(largest, std::abs(force));
  for (std::size_t i = 0; i < x.size(); ++i) off = std::max(off, std::abs(f[i] - wanted[i]));
  for (std::size_t i = 0; i < std::min<std::size_t>(30, x.size()); ++i) {
    const double h = 1e-6 * edges[0], at = x[i];
    x[i] = at + h;
    const double above = energy(x, nullptr);
    x[i] = at - h;
    off_gradient = std::max(off_gradient, std::abs((energy(x, nullptr) - above) / (2 * h) - f[i]));
    x[i] = at;
  }
  sp_step(mass.size(), mass.data(), f.data(), 0.95 * derived.at("safe_time_step_s").get<double>(), 0, x.data(),
          v.data());
  std::printf("forces differ by %.1e of the largest, by %.1e from the gradient of the energy\n", off / largest,
              off_gradient / largest);
  const double relaxing = file.contains("relaxation") ? branches_off(file, X, cells, edges, parts) : 0;
  if (relaxing > 0) std::printf("forces of branches by %.1e\n", relaxing);
  return off < 1e-12 * largest && off_gradient < 1e-5 * largest && relaxing < 1e-12 ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 2;
}
