#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/commands/commands.h"
#include "comparisons/sweep/status.h"
#include "meshes/mesher/mesher.h"
#include "meshes/patches/rule_region.h"
#include "meshes/surface/surface.h"
#include "meshes/volume.h"
#include "problem/case_file/experiment.h"
#include "problem/case_file/keys.h"
#include "problem/case_file/toml_reader.h"
#include "problem/material.h"
#include "problem/system/number_checks.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

constexpr int tetrahedra_of_a_look = 5000;
constexpr double strain = 0.01;

/// What a case says of a body.
struct Measured {
  Vec3 low, size;     ///< of its box [m]
  double volume = 0;  ///< [m^3]
  double thick = 0;   ///< 2 V / A [m]: that of a sheet, two thirds of a ball's radius
  int longest = 0;    ///< axis
  std::vector<std::string> notes;
  Vec3 along;                     ///< from the end that is held to the one that is pulled
  double length = 0;              ///< along that [m]
  std::array<PatchRule, 2> ends;  ///< which are held and pulled
};

double area_of(const PatchRule& rule, const Surface& surface) {
  double sum = 0;
  for (const FacetPart& part : parts_of(rule, surface)) sum += part.area.norm();
  return sum;
}

/// The direction in which the nodes lie farthest from their middle; nothing of a round body or a square plate.
std::optional<Vec3> own_axis(const Surface& surface) {
  constexpr double least = 1.5;  // of the squared distances, over those in the next direction
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : surface.points) mean += p / static_cast<double>(surface.points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : surface.points) spread += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> own(spread);
  if (own.eigenvalues()[2] < least * own.eigenvalues()[1]) return {};
  const Vec3 axis = own.eigenvectors().col(2);
  return axis.sum() < 0 ? Vec3(-axis) : axis;
}

/// The ends along an axis of the box, if each has half the area of a mean section or more.  A round body or one that
/// lies askew has a point or a corner there: held at it, it turns about it.  Then what is beyond planes across the
/// body's own length, or that axis, each as deep as it takes for a section's area.
void find_ends(const Surface& surface, Measured& m) {
  constexpr double enough = 0.5, deepest = 0.3;
  m.along = Vec3::Unit(m.longest);
  m.length = m.size[m.longest];
  for (int end = 0; end < 2; ++end) {
    m.ends[end].side = static_cast<BodySide>(2 * m.longest + end);
    m.ends[end].name = names_of(BodySide{})[2 * m.longest + end];
  }
  const auto suffices = [&](const PatchRule& end) { return area_of(end, surface) >= enough * m.volume / m.length; };
  if (std::ranges::all_of(m.ends, suffices)) return;
  if (const std::optional<Vec3> axis = own_axis(surface)) m.along = *axis;
  const auto [low, high] =
      std::ranges::minmax_element(surface.points, {}, [&](const Vec3& p) { return m.along.dot(p); });
  m.length = m.along.dot(*high - *low);
  for (int end = 0; end < 2; ++end) {
    const Vec3 out = end ? m.along : Vec3(Vec3::Zero() - m.along);  // no -0
    PatchRule& rule = m.ends[end] = {};
    rule.name = end ? "high" : "low";
    for (double depth = 0.05; depth < deepest; depth += 0.05) {
      rule.beyond = PatchRule::Beyond{(end ? *high : *low) - depth * m.length * out, out};
      if (area_of(rule, surface) >= m.volume / m.length) break;
    }
  }
}

Measured measured(const MeshRequest& request) {
  const MeshedBody meshed = mesh_body(request);
  const Surface outside = outside_of(meshed.mesh);
  const Box box = bounding_box(outside);
  Measured m{box.low, box.high - box.low, volume(meshed.mesh, meshed.mesh.nodes), 0, 0, meshed.notes, {}, 0, {}};
  m.thick = 2 * m.volume / area(outside);
  m.size.maxCoeff(&m.longest);
  find_ends(outside, m);
  return m;
}

/// So many cells that two lie across the thickness, between the bounds.
int cells_for(const Measured& m, int least, int most) {
  const double two_across = m.volume / std::pow(m.thick / 2, 3);
  return static_cast<int>(std::clamp(std::ceil(two_across / 100) * 100, double(least), double(most)));
}

/// "about 1500 cells of 0.0041 m, 3.2 across the thickness"
std::string cell_words(const Measured& m, int cells) {
  const double edge = std::cbrt(m.volume / cells);
  return fmt::format("about {} cells of {:.3g} m, {:.2g} across the thickness", cells, edge, m.thick / edge);
}

/// A TOML string, as of JSON.
std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }

/// Round-off of a component is 0: a case takes no numbers as small as 1e-34.
std::string list(const Vec3& v) {
  const double least = std::max(1e-12 * v.cwiseAbs().maxCoeff(), smallest_number);
  const Vec3 w = (v.array().abs() < least).select(0, v);
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", w[0], w[1], w[2]);
}

std::string body_of(const Measured& m, const MeshRequest& request, const std::string& geo) {
  const int coarse = cells_for(m, 1500, 20000), fine = std::min(4 * coarse, 60000);
  std::string text = fmt::format("[body]\ngeo = {}\n", quoted(geo));
  if (!request.size.isZero(0)) text += fmt::format("size_m = {}\n", list(request.size));
  if (request.size.isZero(0) && (request.scale != 1 || m.size.maxCoeff() > 10))
    text += fmt::format("scale = {:g}{}\n", request.scale,
                        request.scale == 1 ? "  # 0.001 if the file is in millimetres" : "");
  text += fmt::format("voxels = {}  # {}\n# voxels = {}  # {}: some five times the time\n", coarse,
                      cell_words(m, coarse), fine, cell_words(m, fine));
  return text;
}

std::string patches_of(const Measured& m) {
  const auto names = names_of(BodySide{});
  std::string text;
  for (int side = 0; side < 6; ++side) {
    const char* before = m.ends[0].side && side / 2 == m.longest ? "" : "# ";
    text += fmt::format("{0}[[patch]]\n{0}name = \"{1}\"\n{0}side = \"{1}\"\n", before, names[side]);
  }
  for (const PatchRule& end : m.ends)
    if (end.beyond)
      text += fmt::format("[[patch]]\nname = \"{}\"\nbeyond = {{ point_m = {}, normal = {} }}\n", end.name,
                          list(end.beyond->point), list(end.beyond->normal));
  return text + "# A part of a side: box_m, beyond, facing, near (docs/keys.md).\n";
}

/// Held at its lower end along its length and pulled at the other, to 1 % on average.
std::string loads_of(const Measured& m, const IsotropicMaterial& material) {
  const Vec3 force = strain * material.youngs_modulus * m.volume / m.length * m.along;
  return fmt::format(
      "[[load]]\non = \"{}\"\ndisplacement_m = [0, 0, 0]\n\n"
      "[[load]]\non = \"{}\"\nforce_N = {}  # {:g} E V / length: a strain of 1 % on average\n# [[load]]\n# "
      "gravity_m_s2 = [0, 0, "
      "-9.81]\n",
      m.ends[0].name, m.ends[1].name, list(force), strain);
}

std::string case_of(const Measured& m, const MeshRequest& request, const std::string& geo,
                    const IsotropicMaterial& material) {
  const Vec3 high = m.low + m.size;
  std::string text = fmt::format(
      "# {}: {:.4g} x {:.4g} x {:.4g} m, from {} to {} m,\n# of {:.5g} m³; thickness {:.3g} m (2 volume / surface).\n",
      quoted(std::filesystem::path(geo).filename().string()), m.size[0], m.size[1], m.size[2], list(m.low), list(high),
      m.volume, m.thick);
  for (const std::string& note : m.notes) text += "# " + note + "\n";
  text += "# springproof compare THIS-FILE        every key: docs/keys.md\n";
  text += fmt::format(
      "what = {}\n# kinematics = \"hencky\"  # here, above all tables: beyond strains of a few per cent\n\n",
      quoted(std::filesystem::path(geo).stem().string() + ", held at one end and pulled at the other."));
  text += body_of(m, request, geo) + "\n" + patches_of(m) + "\n";
  text += fmt::format("[material]\nyoungs_modulus_Pa = {:g}\npoisson_ratio = {:g}\ndensity_kg_m3 = {:g}\n\n",
                      material.youngs_modulus, material.poisson_ratio, material.density);
  text += loads_of(m, material) + "\n";
  return text +
         "[compare]\nmodels = [\"hybmss_avg\", \"hybmss\", \"emsm\", \"msm_18\"]\n"
         "# measures = [\"displacement_error\", \"reaction\", \"stress_error\", \"stress_peak\"]\n";
}

/// `springproof new BODY > case.toml`.
class NewCommand {
 public:
  void add_options(CLI::App& command);
  /// Prints the case.  @return 0.
  /// @throws InputError if the file is no body, or the moduli cannot be used.
  int run() const;

 private:
  std::string body_;
  double scale_ = 1;
  std::vector<double> size_;
  Moduli moduli_;
  double density_ = 1000;
};

void NewCommand::add_options(CLI::App& command) {
  command.add_option("BODY", body_, "closed .stl, .obj or .ply, .msh, .step, .brep, or a script for gmsh (*.geo)")
      ->required();
  command.add_option("--scale", scale_, "coordinates are multiplied by it, to metres")
      ->check(positive())
      ->capture_default_str();
  command.add_option("--size", size_, "of a script: its size_x size_y size_z [m]")->expected(3)->check(positive());
  command.add_option("--youngs-modulus,-E", moduli_.youngs_modulus, "Young's modulus [Pa] (default: 1e5)");
  command.add_option("--poisson-ratio,--nu", moduli_.poisson_ratio, "Poisson's ratio (default: 0.45)");
  command.add_option("--density", density_, "[kg/m^3]")->check(positive())->capture_default_str();
}

int NewCommand::run() const {
  Body body;
  body.geo = body_;
  body.scale = scale_;
  if (!size_.empty()) body.size = Vec3(size_[0], size_[1], size_[2]);
  const auto& endings = body_file_endings();
  if (std::ranges::find(endings, extension_of(body_)) == endings.end())
    throw InputError(fmt::format("{}: is no body (allowed: {})", body_, fmt::join(endings, ", ")));
  if (body.is_script() && size_.empty())
    throw InputError(fmt::format("{}: a script needs its size (allowed: --size X Y Z [m])", body_));
  IsotropicMaterial material{moduli_.youngs_modulus.value_or(1e5), moduli_.poisson_ratio.value_or(0.45), density_};
  try {
    check(material);
  } catch (const std::invalid_argument& error) {
    throw InputError(error.what());
  }
  MeshRequest request;
  request.file = find_geo(body, "case.toml");
  request.size = body.size;
  request.scale = scale_;
  request.tetrahedra = tetrahedra_of_a_look;
  Status status(false);
  const Status::Working working(status, body_);
  const std::string text = case_of(measured(request), request, body_, material);
  parse_experiment(text, "case.toml");
  to_stdout("{}", text);
  return 0;
}

}  // namespace

RunCommand new_command(CLI::App& parser) { return made<NewCommand>(parser); }

}  // namespace springproof
