// The deck for CalculiX, read back: counts, sets, supports, and the sums of its loads.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "comparisons/calculix/deck.h"
#include "support/tolerances.h"

namespace springproof::deck_test {
namespace {

using calculix::Deck;

const Vec3 size(2, 1, 1.5);
const Cells cells = {3, 2, 2};

Experiment bar() {
  Experiment e;
  e.name = "bar";
  e.what = "two\nlines";
  e.body.size = size;
  e.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}};
  return e;
}

Deck deck_of(const Experiment& e, double nu = 0.3) {
  return calculix::make_deck(e, {1e4, nu, 1000}, block_mesh(size, cells));
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(c));
  return text;
}

/// Lines of data under each keyword line, in order.
struct Block {
  std::string keyword;  ///< "*NSET, NSET=Z_MAX"
  std::vector<std::vector<std::string>> lines;
};

std::vector<Block> read_back(const Deck& deck) {
  std::stringstream text;
  calculix::write(deck, text);
  std::vector<Block> blocks;
  for (std::string line; std::getline(text, line);) {
    EXPECT_LE(line.size(), 132u) << line;
    if (line.starts_with("**")) continue;
    if (line.starts_with("*")) {
      blocks.push_back({line, {}});
      continue;
    }
    std::vector<std::string> words;
    std::istringstream in(line);
    for (std::string word; std::getline(in, word, ',');) {
      if (blocks.back().keyword != "*HEADING") {
        EXPECT_LE(word.size(), 21u) << "CalculiX cuts fields after 20 characters: " << line;
      }
      words.push_back(word);
    }
    blocks.back().lines.push_back(words);
  }
  return blocks;
}

const Block& block(const std::vector<Block>& blocks, const std::string& keyword) {
  for (const Block& b : blocks)
    if (b.keyword.starts_with(keyword)) return b;
  throw std::runtime_error("no " + keyword);
}

int times(const std::vector<Block>& blocks, const std::string& keyword) {
  int n = 0;
  for (const Block& b : blocks) n += b.keyword.starts_with(keyword);
  return n;
}

std::vector<int> numbers(const Block& b) {
  std::vector<int> all;
  for (const auto& line : b.lines)
    for (const std::string& word : line)
      if (word.find_first_not_of(' ') != std::string::npos) all.push_back(std::stoi(word));
  return all;
}

/// Sum of the concentrated loads, and of their moments about the origin.
std::pair<Vec3, Vec3> wrench(const Deck& deck) {
  const std::vector<Block> blocks = read_back(deck);
  const Block& nodes = block(blocks, "*NODE, ");
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  for (const auto& line : block(blocks, "*CLOAD").lines) {
    const auto& at = nodes.lines[std::stoul(line[0]) - 1];
    const Vec3 f = std::stod(line[2]) * Vec3::Unit(std::stoi(line[1]) - 1);
    force += f;
    torque += Vec3(std::stod(at[1]), std::stod(at[2]), std::stod(at[3])).cross(f);
  }
  return {force, torque};
}

TEST(CalculixDeck, HoldsTheMesh) {
  const std::vector<Block> blocks = read_back(deck_of(bar()));
  const int corners = 4 * 3 * 3, middles = 3 * 3 * 3 + 4 * 2 * 3 + 4 * 3 * 2;
  EXPECT_EQ(block(blocks, "*NODE, NSET=ALL_NODES").lines.size(), corners + middles);
  const std::vector<int> elements = numbers(block(blocks, "*ELEMENT, TYPE=C3D20, ELSET=BODY"));
  EXPECT_EQ(elements.size(), 12u * 21);
  EXPECT_EQ(*std::max_element(elements.begin(), elements.end()), corners + middles);
  for (const auto& line : block(blocks, "*ELEMENT").lines) EXPECT_LE(line.size(), 16u);
}

TEST(CalculixDeck, PutsEachMiddleNodeBetweenItsCorners) {
  const calculix::QuadraticMesh mesh = calculix::quadratic(block_mesh(size, cells));
  for (const auto& element : mesh.elements) {
    Eigen::Matrix<double, 20, 3> X;
    for (int i = 0; i < 20; ++i) X.row(i) = mesh.nodes.row(element[i]);
    // A straight-sided box: every shape function's node lies where the linear map of the corners puts it.
    for (int i = 0; i < 20; ++i) {
      const Vec3 xi = 2 * (X.row(i) - X.row(0)).cwiseQuotient(X.row(6) - X.row(0)).transpose() - Vec3::Ones();
      const Eigen::VectorXd shape = calculix::basis(20, xi).value;
      for (int j = 0; j < 20; ++j) EXPECT_NEAR(shape[j], i == j, test::round_off);
    }
  }
}

TEST(CalculixDeck, NamesPatchesAsSetsAndSurfaces) {
  const Deck deck = deck_of(bar());
  const std::vector<Block> blocks = read_back(deck);
  const std::map<std::string, std::string> side = {{"x_min", "S6"}, {"x_max", "S4"}, {"y_min", "S3"},
                                                   {"y_max", "S5"}, {"z_min", "S1"}, {"z_max", "S2"}};
  for (const auto& [name, S] : side) {
    const int axis = name[0] - 'x';
    const double at = name.ends_with("min") ? 0 : size[axis];
    std::set<int> on_face;
    for (int n = 0; n < deck.mesh.nodes.rows(); ++n)
      if (deck.mesh.nodes(n, axis) == at) on_face.insert(n + 1);
    const std::vector<int> set = numbers(block(blocks, "*NSET, NSET=" + upper(name)));
    EXPECT_EQ(std::set<int>(set.begin(), set.end()), on_face) << name;
    const Block& surface = block(blocks, "*SURFACE, NAME=" + upper(name));
    EXPECT_EQ(surface.lines.size(), std::size_t(cells[(axis + 1) % 3] * cells[(axis + 2) % 3]));
    for (const auto& line : surface.lines) EXPECT_EQ(line[1], " " + S);
  }
}

TEST(CalculixDeck, PrescribesEveryComponentOnce) {
  Experiment e = bar();
  e.loads.push_back(PrescribedDisplacement{"x_min", {0.5, {}, {}}});  // its edge belongs to z_min, named first
  const Deck deck = deck_of(e);
  const Block supports = block(read_back(deck), "*BOUNDARY");
  std::map<std::pair<int, int>, double> value;
  for (const auto& line : supports.lines) {
    EXPECT_EQ(line[1], line[2]);
    EXPECT_TRUE(value.try_emplace({std::stoi(line[0]), std::stoi(line[1])}, std::stod(line[3])).second);
  }
  const auto nodes = [&](const char* name) {
    for (const auto& p : deck.mesh.patches)
      if (p.name == name) return p.nodes.size();
    return std::size_t(0);
  };
  EXPECT_EQ(value.size(), 3 * nodes("z_min") + nodes("x_min") - 5);
  EXPECT_EQ(std::count_if(value.begin(), value.end(), [](const auto& v) { return v.second == 0.5; }),
            int(nodes("x_min")) - 5);
}

TEST(CalculixDeck, LoadsSumToTheirTotals) {
  Experiment e = bar();
  e.loads.push_back(Traction{"z_max", Vec3(1, 2, -3)});
  auto [force, torque] = wrench(deck_of(e));
  const Vec3 total = size[0] * size[1] * Vec3(1, 2, -3), middle(size[0] / 2, size[1] / 2, size[2]);
  EXPECT_LE((force - total).norm(), 1e-10);
  EXPECT_LE((torque - middle.cross(total)).norm(), 1e-10);
  e.loads.back() = PatchForce{"x_max", Vec3(7, 0, 5)};
  EXPECT_LE((wrench(deck_of(e)).first - Vec3(7, 0, 5)).norm(), 1e-10);
  e.loads.back() = PointForce{Vec3(1.9, 0.3, 0.7), Vec3(4, 5, 6)};
  std::tie(force, torque) = wrench(deck_of(e));
  EXPECT_LE((force - Vec3(4, 5, 6)).norm(), 1e-10);
  EXPECT_LE((torque - Vec3(1.9, 0.3, 0.7).cross(Vec3(4, 5, 6))).norm(), 1e-10);
}

TEST(CalculixDeck, APointForceActsWithinATetrahedronToo) {
  Mesh mesh;
  mesh.nodes.resize(4, 3);
  mesh.nodes << 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.tetrahedra = {{0, 1, 2, 3}};
  const calculix::QuadraticMesh quadratic = calculix::quadratic(mesh);
  const Vec3 point(0.5, 0.3, 0.2);
  double sum = 0;
  Vec3 first = Vec3::Zero(), second = Vec3::Zero();  // moments: quadratic fields are reproduced
  const calculix::NodalWeights weights = calculix::weights_at(quadratic, mesh, point.transpose());
  for (Eigen::Index node = 0; node < quadratic.nodes.rows(); ++node) {
    const Vec3 x = quadratic.nodes.row(node).transpose();
    const double weight = weights.coeff(0, node);
    sum += weight;
    first += weight * x;
    second += weight * x.cwiseProduct(x);
  }
  EXPECT_NEAR(sum, 1, 1e-14);
  EXPECT_LE((first - point).norm(), 1e-14);
  EXPECT_LE((second - point.cwiseProduct(point)).norm(), 1e-14);
  EXPECT_THROW(calculix::weights_at(quadratic, mesh, Vec3(1, 1, 1).transpose()), InputError);
}

TEST(CalculixDeck, PressurePushesInwards) {
  Experiment e = bar();
  for (const auto& [name, inwards] : {std::pair("x_min", Vec3(1.5, 0, 0)), std::pair("x_max", Vec3(-1.5, 0, 0)),
                                      std::pair("y_max", Vec3(0, -3, 0)), std::pair("z_max", Vec3(0, 0, -2))}) {
    e.loads.resize(1);
    e.loads.push_back(Pressure{name, 10});
    EXPECT_LE((wrench(deck_of(e)).first - 10 * inwards).norm(), 1e-10) << name;
  }
}

TEST(CalculixDeck, BodyForcesAreConsistent) {
  const calculix::QuadraticMesh mesh = calculix::quadratic(block_mesh(size, cells));
  const NodalVectors forces = calculix::nodal_body_forces(mesh, [](const Vec3& X) { return Vec3(1, X[0], 0); });
  EXPECT_LE((forces.colwise().sum().transpose() - Vec3(3, 3, 0)).norm(), test::round_off * 10);
  EXPECT_LE((forces.col(0) - calculix::nodal_volumes(mesh)).norm(), test::round_off);
}

TEST(CalculixDeck, GravityIsTheBodysWeight) {
  Experiment e = bar();
  e.loads.push_back(Gravity{Vec3(0, 3, -4)});
  const Deck deck = deck_of(e);
  const auto line = block(read_back(deck), "*DLOAD").lines.front();
  EXPECT_EQ(line, (std::vector<std::string>{"BODY", " GRAV", " 5", " 0", " 0.6", " -0.8"}));
  EXPECT_LE((calculix::external_loads(deck).colwise().sum().transpose() - 3000 * Vec3(0, 3, -4)).norm(), 1e-8);
}

TEST(CalculixDeck, HasASectionForEachRegion) {
  Experiment e = bar();
  e.loads.push_back(Gravity{Vec3(0, 0, -10)});
  e.regions = {{"stiff end", {1e7, 0.45, 3000}, {}, {}}};
  Mesh mesh = block_mesh(size, cells);
  for (const Hexahedron& cell : mesh.hexahedra) mesh.materials.push_back(mesh.nodes(cell[0], 0) > 1);
  const Deck deck = calculix::make_deck(e, {1e4, 0.3, 1000}, mesh);
  EXPECT_EQ(deck.element, "C3D20R");
  std::map<std::string, std::string> material_of;
  std::map<std::string, std::size_t> elements_of;
  for (const Block& b : read_back(deck)) {
    if (const std::string head = "*SOLID SECTION, ELSET="; b.keyword.starts_with(head)) {
      const std::size_t comma = b.keyword.find(',', head.size());
      material_of[b.keyword.substr(head.size(), comma - head.size())] = b.keyword.substr(comma + 2);
    }
    if (const std::string head = "*ELSET, ELSET="; b.keyword.starts_with(head))
      for (const auto& line : b.lines) elements_of[b.keyword.substr(head.size())] += line.size();
  }
  EXPECT_EQ(material_of, (std::map<std::string, std::string>{{"IN_NO_REGION", "MATERIAL=SOLID"},
                                                             {"REGION_STIFF_END", "MATERIAL=OF_STIFF_END"}}));
  EXPECT_EQ(elements_of, (std::map<std::string, std::size_t>{{"IN_NO_REGION", 8}, {"REGION_STIFF_END", 4}}));
  const double kg = 1000 * 2 + 3000;
  EXPECT_LE((calculix::external_loads(deck).colwise().sum().transpose() - kg * Vec3(0, 0, -10)).norm(), 1e-8);
}

TEST(CalculixDeck, WritesEachLawAsItsCounterpart) {
  Experiment e = bar();
  EXPECT_EQ(block(read_back(deck_of(e)), "*STEP").keyword, "*STEP");
  EXPECT_EQ(std::stod(block(read_back(deck_of(e)), "*ELASTIC").lines[0][1]), 0.3);
  e.kinematics = "st_venant_kirchhoff";
  EXPECT_NE(block(read_back(deck_of(e)), "*STEP").keyword.find("NLGEOM"), std::string::npos);
  EXPECT_EQ(times(read_back(deck_of(e)), "*ELASTIC"), 1);
  e.kinematics = "neo_hooke_isochoric";
  const auto line = block(read_back(deck_of(e)), "*HYPERELASTIC, NEO HOOKE").lines.front();
  EXPECT_NEAR(std::stod(line[0]), 1e4 / 2.6 / 2, 1e-7);
  EXPECT_NEAR(std::stod(line[1]), 2 / (1e4 / 1.2), 1e-14);
  for (const char* other : {"hencky", "log_cauchy", "neo_hooke"}) {
    e.kinematics = other;
    try {
      deck_of(e);
      FAIL() << other;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("linear, neo_hooke_isochoric, st_venant_kirchhoff"), std::string::npos);
    }
  }
}

TEST(CalculixDeck, TakesReducedIntegrationNearTheIncompressibleLimit) {
  EXPECT_EQ(deck_of(bar(), 0.4).element, "C3D20");
  EXPECT_EQ(deck_of(bar(), 0.41).element, "C3D20R");
}

TEST(CalculixDeck, LeadsALargeRotationAlongItsArc) {
  Experiment e = bar();
  e.kinematics = "st_venant_kirchhoff";
  e.loads.push_back(PrescribedRotation{"z_max", Vec3(1, 0.5, 1.5), Vec3::UnitZ(), 45 * std::numbers::pi / 180});
  const std::vector<Block> blocks = read_back(deck_of(e));
  EXPECT_EQ(times(blocks, "*STEP"), 3);
  EXPECT_EQ(times(blocks, "*NODE PRINT, NSET=ALL_NODES"), 1);
  e.kinematics = "linear";
  EXPECT_EQ(times(read_back(deck_of(e)), "*STEP"), 1);
}

TEST(CalculixDeck, KnowsTetrahedra) {
  Mesh mesh;
  mesh.nodes.resize(4, 3);
  mesh.nodes << 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3;
  mesh.tetrahedra = {{0, 1, 2, 3}};
  mesh.patches = {{"x_min", {{0, 3, 2, -1}}}, {"slope", {{1, 2, 3, -1}}}};
  const calculix::QuadraticMesh quadratic = calculix::quadratic(mesh);
  EXPECT_EQ(quadratic.nodes.rows(), 10);
  EXPECT_NEAR(calculix::nodal_volumes(quadratic).sum(), 1, test::round_off);
  EXPECT_EQ(quadratic.patches[0].sides[0].face, 4);
  EXPECT_EQ(quadratic.patches[1].sides[0].face, 3);
  const Eigen::VectorXd areas = calculix::nodal_areas(quadratic, quadratic.patches[0]);
  EXPECT_NEAR(areas.sum(), 3, test::round_off);
  for (const int corner : {0, 2, 3}) EXPECT_NEAR(areas[corner], 0, test::round_off);  // the middles carry all
  EXPECT_EQ(quadratic.patches[0].nodes.size(), 6u);
  EXPECT_LE(
      (calculix::nodal_area_vectors(quadratic, quadratic.patches[1]).colwise().sum() + Eigen::RowVector3d(3, 1.5, 1))
          .norm(),
      test::round_off);
  for (int n = 0; n < 10; ++n) {
    const Vec3 xi = quadratic.nodes.row(n).transpose().cwiseQuotient(Vec3(1, 2, 3));
    const Eigen::VectorXd shape = calculix::basis(10, xi).value;
    for (int j = 0; j < 10; ++j) EXPECT_NEAR(shape[j], quadratic.elements[0][j] == n, test::round_off);
  }
}

TEST(CalculixDeck, MeasuresVolumeExactly) {
  const calculix::QuadraticMesh mesh = calculix::quadratic(block_mesh(size, cells));
  Eigen::Matrix3d gradient;
  gradient << 0.1, 0.2, -0.05, -0.15, 0.07, 0.03, 0.09, -0.11, -0.06;
  NodalVectors u = mesh.nodes * gradient.transpose();
  calculix::VolumeChange change = calculix::volume_change(mesh, u);
  EXPECT_NEAR(change.exact, (Eigen::Matrix3d::Identity() + gradient).determinant() - 1, test::round_off);
  EXPECT_NEAR(change.first_order, gradient.trace(), test::round_off);
  u = NodalVectors::Zero(u.rows(), 3);
  u.col(0) = 0.1 * mesh.nodes.col(0).array().square() * mesh.nodes.col(1).array();  // mean of 0.2 x y
  change = calculix::volume_change(mesh, u);
  EXPECT_NEAR(change.exact, 0.1, test::round_off);
  EXPECT_NEAR(change.first_order, 0.1, test::round_off);
}

TEST(CalculixDeck, RefusesNamesItCannotTellApart) {
  Experiment e = bar();
  e.probes = {{"tip-1", Vec3(2, 0, 0)}, {"tip 1", Vec3(2, 1, 0)}};
  EXPECT_THROW(deck_of(e), InputError);
}

}  // namespace
}  // namespace springproof::deck_test
