#include "comparisons/calculix/deck_parts.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cctype>

namespace springproof::calculix {
namespace {

void write_elastic(const IsotropicMaterial& m, std::ostream& out) {
  fmt::print(out, "** Young's modulus [Pa], Poisson's ratio\n*ELASTIC\n{:.12g}, {:.12g}\n", m.youngs_modulus,
             m.poisson_ratio);
}

void write_neo_hooke(const IsotropicMaterial& m, std::ostream& out) {
  fmt::print(out, "** C10 = mu / 2 [Pa], D1 = 2 / K [1/Pa]\n*HYPERELASTIC, NEO HOOKE\n{:.12g}, {:.12g}\n",
             shear_modulus(m) / 2, 2 / bulk_modulus(m));
}

constexpr Counterpart counterparts[] = {
    {"linear", false, "small displacements, Hooke's law", write_elastic},
    {"neo_hooke_isochoric", true, "W = C10 (J^(-2/3) tr C - 3) + (J - 1)^2 / D1", write_neo_hooke},
    {"st_venant_kirchhoff", true, "S = 2 mu E + lambda tr E I (*ELASTIC with NLGEOM in CalculiX)", write_elastic}};

}  // namespace

const Counterpart& counterpart(const Experiment& experiment) {
  for (const Counterpart& c : counterparts)
    if (experiment.kinematics == c.kinematics) return c;
  throw InputError(SourceLocation{experiment.file.string(), 0, 0},
                   fmt::format("kinematics: CalculiX has no \"{}\" (there: {})", experiment.kinematics,
                               kinematics_with_counterpart()));
}

std::string label(const std::string& name) {
  std::string out;
  for (const char c : name) out += std::isalnum(static_cast<unsigned char>(c)) ? char(std::toupper(c)) : '_';
  return out;
}

std::vector<Section> sections_of(const Deck& deck) {
  std::vector<Section> sections = {{"BODY", "SOLID", deck.material, {}}};
  if (deck.linear.materials.empty()) return sections;
  sections[0].set = "IN_NO_REGION";
  for (const MaterialRegion& r : deck.experiment.regions)
    sections.push_back({"REGION_" + label(r.name), "OF_" + label(r.name), r.material, {}});
  for (std::size_t e = 0; e < deck.linear.materials.size(); ++e)
    sections[deck.linear.materials[e]].elements.push_back(static_cast<int>(e));
  std::erase_if(sections, [](const Section& s) { return s.elements.empty(); });
  return sections;
}

std::string kinematics_with_counterpart() {
  std::vector<std::string> names;
  for (const Counterpart& c : counterparts) names.emplace_back(c.kinematics);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace springproof::calculix
