// A body of voxels: its loads are those of the true body, whatever carries them; what cannot be run is refused by name.
#include "comparisons/prepare/voxel_body.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "comparisons/models/frequencies.h"
#include "comparisons/prepare/load_resultants.h"
#include "comparisons/prepare/sampling.h"
#include "meshes/patches/rule_region.h"
#include "meshes/volume.h"
#include "msm/embedding/boundary.h"
#include "msm/models.h"
#include "problem/files/files.h"
#include "support/surfaces.h"
#include "support/voxel_case.h"
#include "support/vtu_reader.h"

namespace springproof::voxel_body_test {
namespace {

using namespace test;

const PreparedCase& loaded_ball() {
  static const PreparedCase ball = prepared_ball(300, every_load, "\"hybmss\"", "elements = []\nedge_m = 0.03");
  return ball;
}

/// Of a load on the finest tetrahedra, by the middles of their facets and cells.
Wrench wrench_on_the_body(const Load& load, const Mesh& body, const Vec3& about) {
  Wrench w{Vec3::Zero(), Vec3::Zero(), about};
  const auto add = [&](const Vec3& at, const Vec3& force) {
    w.force += force;
    w.moment += (at - about).cross(force);
  };
  const auto X = [&](int n) -> Vec3 { return body.nodes.row(n).transpose(); };
  const auto each_facet = [&](const std::string& on, const auto& force) {
    for (const auto& f : patch(body, on).facets) {
      const Vec3 area = (X(f[1]) - X(f[0])).cross(X(f[2]) - X(f[0])) / 2;
      add((X(f[0]) + X(f[1]) + X(f[2])) / 3, force(area));
    }
  };
  if (const auto* t = std::get_if<Traction>(&load))
    each_facet(t->on, [&](const Vec3& a) -> Vec3 { return a.norm() * t->traction; });
  if (const auto* q = std::get_if<Pressure>(&load))
    each_facet(q->on, [&](const Vec3& a) -> Vec3 { return -q->pressure * a; });
  if (const auto* f = std::get_if<PatchForce>(&load)) {
    double area = 0;
    each_facet(f->on, [&](const Vec3& a) -> Vec3 {
      area += a.norm();
      return Vec3::Zero();
    });
    each_facet(f->on, [&](const Vec3& a) -> Vec3 { return a.norm() / area * f->force; });
  }
  if (const auto* g = std::get_if<Gravity>(&load)) {
    const Eigen::VectorXd volumes = cell_volumes(body, body.nodes);
    for (std::size_t c = 0; c < body.tetrahedra.size(); ++c) {
      const auto& t = body.tetrahedra[c];
      add((X(t[0]) + X(t[1]) + X(t[2]) + X(t[3])) / 4, 1000 * volumes[static_cast<Eigen::Index>(c)] * g->acceleration);
    }
  }
  if (const auto* p = std::get_if<PointForce>(&load)) add(p->at, p->force);
  return w;
}

void expect_wrench(const NodalVectors& force, const NodalVectors& X, const Wrench& expected) {
  Vec3 total = Vec3::Zero(), moment = Vec3::Zero();
  for (Eigen::Index n = 0; n < force.rows(); ++n) {
    const Vec3 f = force.row(n).transpose(), x = X.row(n).transpose();
    total += f;
    moment += (x - expected.about).cross(f);
  }
  const double size = 0.2;
  EXPECT_LE((total - expected.force).norm(), 1e-12 * expected.force.norm());
  EXPECT_LE((moment - expected.moment).norm(), 1e-12 * size * expected.force.norm());
}

class LoadsOfTheBall : public testing::TestWithParam<std::size_t> {
 protected:
  const PreparedCase& ball = loaded_ball();
  const Load& load = ball.loads[1 + GetParam()];
  const Mesh& voxels = *ball.lattices.front().mesh;
  const Vec3 about{0.3, -0.1, 0.05};
  const Wrench expected = wrench_on_the_body(load, *ball.body.tetrahedra.back(), about);
};

TEST_P(LoadsOfTheBall, AreThoseOfTheBodyOnVoxels) {
  ASSERT_GT(expected.force.norm(), 1e-3);
  expect_wrench(transfer({load}, voxels, 1000, Kinematics::linear).external, voxels.nodes, expected);
}

TEST_P(LoadsOfTheBall, AreThoseOfTheBodyInEveryModel) {
  for (const ModelRow& row : model_table()) {
    if (row.topology == Topology::hexagonal) continue;  // planar
    SCOPED_TRACE(row.name);
    ModelChoice choice;
    choice.name = row.name;
    const EmbeddedModel built =
        build_embedded(resolve(choice), voxels, {1e4, 0.25, 1000}, ball.lattices.front().region.get());
    const Network& network = built.model.network;
    expect_wrench(transfer({load}, voxels, built.embedding, network, 1000, Kinematics::linear).external, network.X,
                  expected);
  }
}

const char* const load_names[] = {"traction", "pressure", "patch_force", "gravity", "point_force"};
INSTANTIATE_TEST_SUITE_P(Kinds, LoadsOfTheBall, testing::Values(0, 1, 2, 3, 4),
                         [](const auto& i) { return std::string(load_names[i.param]); });

TEST(VoxelBody, PressureOnAClosedSurfacePushesNowhere) {
  const PreparedCase ball = prepared_ball(100, "[[load]]\non = \"surface\"\npressure_Pa = 1000", "\"hybmss\"",
                                          "elements = []\nedge_m = 0.03");
  const NodalVectors f = transfer({ball.loads[1]}, *ball.lattices[0].mesh, 1000, Kinematics::linear).external;
  EXPECT_LE(f.colwise().sum().norm(), 1e-12 * f.cwiseAbs().sum());
  EXPECT_GT(f.cwiseAbs().sum(), 1000 * 4 * 0.01);
}

TEST(VoxelBody, LinearFieldsComeBackAtEveryLatticeNode) {
  const PreparedCase ball = prepared_ball(120, "", "\"hybmss\"", "edge_m = 0.03");
  Eigen::Matrix3d G;
  G << 1, 2, -3, 4, -5, 6, 7, 8, 9;
  const auto field = [&](const NodalVectors& X) -> NodalVectors {
    return (X * G.transpose()).rowwise() + Eigen::RowVector3d(0.3, -2, 1);
  };
  NodalVectors nodes = ball.lattices[0].mesh->nodes;
  const NodalVectors u = at_lattice_nodes(ball, field(ball.samples.points));
  ASSERT_EQ(u.rows(), nodes.rows());
  EXPECT_LE((u - field(nodes)).cwiseAbs().maxCoeff(), 1e-12);
  const auto outside = std::count_if(ball.samples.of_nodes.begin(), ball.samples.of_nodes.end(),
                                     [](const NodeSample& s) { return s.within >= 0; });
  EXPECT_GT(outside, nodes.rows() / 10);
}

TEST(VoxelBody, ProbesOnTheTrueSurfaceAreTaken) {
  std::string text = ball_case(100, "", "\"hybmss\"", "elements = []\nedge_m = 0.03");
  const std::string inside = "at_m = [0.1, 0.1, 0.19]";
  for (const char* at : {"at_m = [0.1, 0.1, 0.2]", "at_m = [0.1577, 0.1577, 0.1577]", "at_m = [0.2, 0.1, 0.1]",
                         "at_m = [0.0293, 0.1, 0.1707]"}) {
    std::string other = text;
    other.replace(other.find(inside), inside.size(), at);
    EXPECT_NO_THROW(prepare(parse_experiment(other, "ball.toml"))) << at;
  }
}

TEST(VoxelBody, ThinPartsAreSaidToBeLost) {
  const auto notes = [](const std::string& voxels) {
    std::string text = ball_case(100, "", "\"hybmss\"", "elements = []\nedge_m = 0.03");
    text.replace(text.find("voxels = 100"), 12, voxels);
    std::string all;
    for (const std::string& note : prepare(parse_experiment(text, "ball.toml")).body.notes) all += note + "\n";
    return all;
  };
  // 8 cubes of 0.1 m fill the box around the ball: 6 / pi = 1.91 times its volume (0.3 % more, as its facets stay in
  // the box).
  const std::string whole = "voxel_edge_m = 0.1\ncut = false";
  EXPECT_NE(notes(whole).find("8 cubes of 0.1 m fill 1.9"), std::string::npos) << notes(whole);
  EXPECT_EQ(notes("voxel_edge_m = 0.1").find("cubes of 0.1 m fill"), std::string::npos) << "no model takes them";
  EXPECT_EQ(notes("voxels = 1000").find("cubes of"), std::string::npos) << notes("voxels = 1000");
}

TEST(VoxelBody, CutCellsHaveALimitFromTwoLatticesAndWholeCubesHaveNone) {
  std::string text = ball_case(100, "[[load]]\non = \"high\"\nforce_N = [0, 0, 1]",
                               "\"hybmss\", { model = \"hybmss\", cut = false }", "elements = []\nedge_m = 0.03");
  text.replace(text.find("voxels = 100"), 12, "voxels = [100, 300]");
  const PreparedCase prepared = prepare(parse_experiment(text, "ball.toml"));
  const Part part = run_part(prepared, 0, {});
  const auto top = [&](const std::string& model, const Cells& cells) {
    for (const Row& row : part.rows)
      if (row.model == model && row.cells == cells && row.measure == "displacement.top.z") return row;
    ADD_FAILURE() << "no row of " << model;
    return Row{};
  };
  const Lattice &coarse = prepared.lattices[0], &fine = prepared.lattices[1];
  const double u = top("hybmss", fine.cells).value, step = u - top("hybmss", coarse.cells).value;
  const Row limit = top("hybmss extrapolated", fine.cells);
  const double factor = fine.voxel_edge / (coarse.voxel_edge - fine.voxel_edge);
  EXPECT_NEAR(limit.value, u + factor * step, 1e-12 * std::abs(u));
  EXPECT_NEAR(limit.spread.value(), std::abs(factor * step), 1e-12 * std::abs(u));
  EXPECT_TRUE(std::none_of(part.rows.begin(), part.rows.end(),
                           [](const Row& row) { return row.model == "hybmss cut=false extrapolated"; }));
}

/// The file shows cells of more than one size, displaced, which hold the volume of the body.
void expect_cells_fill_the_body(const std::filesystem::path& file, const CutBody& cut, double body_volume) {
  const std::string document = text_of_file(file);
  const std::vector<double> filled = read_array<double>(document, "filled_fraction"),
                            edge = read_array<double>(document, "edge_m"),
                            u = read_array<double>(document, "displacement");
  ASSERT_EQ(filled.size(), cut.cells.size());
  ASSERT_EQ(edge.size(), cut.cells.size());
  EXPECT_EQ(u.size(), static_cast<std::size_t>(cut.points.size()));
  EXPECT_GE(std::set(edge.begin(), edge.end()).size(), 2u);
  double held = 0;
  for (std::size_t c = 0; c < filled.size(); ++c) held += filled[c] * std::pow(edge[c], 3);
  EXPECT_NEAR(held, body_volume, 1e-2 * body_volume);
  EXPECT_GT(*std::max_element(u.begin(), u.end()), 0);
}

TEST(VoxelBody, RefinedLatticesKeepTheirPromiseAndHaveALimit) {
  std::string text = ball_case(100, "[[load]]\non = \"high\"\nforce_N = [0, 0, 1]", "\"hybmss_avg\", \"emsm\"",
                               "elements = []\nedge_m = 0.03");
  text.replace(text.find("voxels = 100"), 12, "voxels = 60\naccuracy = [0.15, 0.14, 0.05]");
  const Experiment experiment = parse_experiment(text, "ball.toml");
  const PreparedCase prepared = prepare(experiment);
  const std::filesystem::path vtu = std::filesystem::path(testing::TempDir()) / "refined_cells";
  std::filesystem::create_directories(vtu);
  const Part part = run_part(prepared, 0, {vtu, false});
  const auto value = [&](const std::string& model, const Lattice& on, const std::string& measure) {
    for (const Row& row : part.rows)
      if (row.model == model && row.cells == on.cells && row.measure == measure) return row.value;
    ADD_FAILURE() << "no " << measure << " of " << model;
    return 0.0;
  };
  const Lattice &coarse = prepared.lattices[0], &fine = prepared.lattices[1];
  EXPECT_FALSE(fine.cut->carried.empty());
  EXPECT_GT(fine.cut->cells.size(), coarse.cut->cells.size());
  EXPECT_LE(coarse.falls_short * coarse.estimated, 0.15);
  EXPECT_LE(fine.falls_short * fine.estimated, 0.1);
  const double promised = fine.falls_short * fine.estimated;
  EXPECT_NEAR(value("hybmss_avg", fine, "promised_error"), promised, 1e-3 * promised);
  for (const Lattice* lattice : {&coarse, &fine}) EXPECT_NEAR(value("hybmss_avg", *lattice, "force.low.z"), -1, 1e-8);
  const double u = value("hybmss_avg", fine, "displacement.top.z"),
               step = u - value("hybmss_avg", coarse, "displacement.top.z");
  EXPECT_NEAR(value("hybmss_avg extrapolated", fine, "displacement.top.z"),
              u + step * fine.estimated / (coarse.estimated - fine.estimated), 1e-12 * std::abs(u));
  EXPECT_NE(value("emsm", fine, "displacement.top.z"), 0);
  const std::string notes = fmt::format("{}", fmt::join(prepared.body.notes, "\n"));
  EXPECT_NE(notes.find("promise a displacement error of"), std::string::npos) << notes;
  EXPECT_THROW(case_of_modes(experiment, {.free = true}), InputError);
  expect_cells_fill_the_body(vtu / (file_stem({"hybmss_avg", 0.3, fine.cells}) + "_cells.vtu"), *fine.cut,
                             volume(*prepared.body.tetrahedra.back(), prepared.body.tetrahedra.back()->nodes));
  std::filesystem::remove_all(vtu);
}

TEST(VoxelBody, TorquesMoveToTheTruePatch) {
  const PreparedCase& ball = loaded_ball();
  const Mesh& voxels = *ball.lattices[0].mesh;
  const Vec3 from = centroid(voxels, patch(voxels, "low")),
             to = centroid(*ball.body.tetrahedra.back(), patch(*ball.body.tetrahedra.back(), "low"));
  ASSERT_GT((from - to).norm(), 1e-4);
  const Vec3 force(1, 2, 3), at(0.05, 0.1, 0.02);
  const auto moved = about_true_patches(ball, voxels, {{"low", force, (at - from).cross(force)}});
  EXPECT_LE((moved[0].torque - (at - to).cross(force)).norm(), 1e-15);
  EXPECT_EQ(moved[0].force, force);
}

TEST(VoxelBody, TetrahedraAreSmallWhereAHeldPatchEndsOnASmoothSurface) {
  const auto growth = [](const std::string& from, const std::string& to) {
    std::string text = ball_case(100, "", "\"hybmss_avg\"", "elements = [\"p2\"]\nedge_m = 0.05");
    text.replace(text.find(from), from.size(), to);
    const PreparedCase prepared = prepare(parse_experiment(text, "ball.toml"));
    return double(prepared.body.tetrahedra.back()->tetrahedra.size()) / prepared.body.uncut.back();
  };
  const std::string low = "beyond = { point_m = [0.1, 0.1, 0.06], normal = [0.2, 0, -1] }";
  EXPECT_GT(growth(low, low), 5);
  EXPECT_LT(growth(low, "facing = { direction = [0, 0, -1], within_deg = 60 }"), 2) << "a ragged border";
  EXPECT_LT(growth("[body]", "kinematics = \"hencky\"\n[body]"), 2) << "at large strain small cells snap";
  EXPECT_LT(growth("on = \"low\"", "on = \"surface\""), 2) << "held all around";
}

TEST(VoxelBody, WeightAndPatchesAreThoseOfTheFilesFacets) {
  const Surface ball = moved(sphere(1, 3), 0.1, {0.1, 0.1, 0.1});
  const std::filesystem::path file = std::filesystem::temp_directory_path() / fmt::format("ball_{}.stl", getpid());
  write_stl_binary(file, ball);
  std::string text =
      ball_case(100, "[[load]]\ngravity_m_s2 = [1, -2, -9.81]", "\"hybmss\"", "elements = []\nedge_m = 0.05");
  text.replace(text.find("sphere.geo"), 10, file.string());
  text.erase(text.find("size_m"), text.find("voxels") - text.find("size_m"));
  const PreparedCase prepared = prepare(parse_experiment(text, "ball.toml"));
  std::filesystem::remove(file);
  const Mesh& mesh = *prepared.body.tetrahedra.back();
  ASSERT_GT(std::abs(volume(mesh, mesh.nodes) / volume(ball) - 1), 1e-5) << "other facets than the file's";
  const Wrench weight = *std::get<Gravity>(prepared.loads.back()).wrench;
  EXPECT_LE((weight.force - 1000 * volume(ball) * Vec3(1, -2, -9.81)).norm(), 1e-6 * weight.force.norm());
  EXPECT_LE((weight.about - Vec3(0.1, 0.1, 0.1)).norm(), 1e-8);
  Vec3 moments = Vec3::Zero();
  double area = 0;
  for (const FacetPart& p : parts_of(prepared.experiment.patches.front(), ball)) {
    area += p.area.norm();
    moments += p.area.norm() * p.centroid;
  }
  const Vec3 from = centroid(mesh, patch(mesh, "low")), force(1, 2, 3);
  const auto shifted = about_true_patches(prepared, mesh, {{"low", force, Vec3::Zero()}});
  EXPECT_LE((shifted[0].torque - (from - moments / area).cross(force)).norm(), 1e-7);
  EXPECT_GT(shifted[0].torque.norm(), 1e-6);
}

struct Mistake {
  const char* name;
  const char* of;  ///< in the good case
  const char* to;
  const char* says;  ///< from the start of the message; "*" stands for anything
};
void PrintTo(const Mistake& m, std::ostream* out) { *out << m.name; }

class VoxelMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(VoxelMistakes, AreRefusedWithTheirPlace) {
  std::string text = ball_case(100, "[[load]]\non = \"high\"\nforce_N = [0, 0, 1]", "\"hybmss\", \"emsm_random\"",
                               "elements = []\nedge_m = 0.03");
  const std::string of = GetParam().of;
  ASSERT_NE(text.find(of), std::string::npos);
  text.replace(text.find(of), of.size(), GetParam().to);
  std::string said = "accepted";
  try {
    prepare(parse_experiment(text, "ball.toml"));
  } catch (const InputError& e) {
    said = e.what();
  }
  std::string says = GetParam().says;
  EXPECT_EQ(said.find(says.substr(0, says.find('*'))), 0u) << said;
  if (const auto star = says.find('*'); star != std::string::npos) {
    EXPECT_NE(said.find(says.substr(star + 1)), std::string::npos) << said;
  }
}

/// What is said of a probe of the ball.
std::vector<std::string> notes_on_a_probe(const Vec3& at) {
  std::string text = ball_case(300, every_load, "\"hybmss\"", "elements = []\nedge_m = 0.03");
  const std::string there = "at_m = [0.1, 0.1, 0.19]";
  text.replace(text.find(there), there.size(), fmt::format("at_m = [{}, {}, {}]", at[0], at[1], at[2]));
  std::vector<std::string> notes = prepare(parse_experiment(text, "ball.toml")).body.notes;
  std::erase_if(notes, [](const std::string& n) { return n.find("probe") == std::string::npos; });
  return notes;
}

TEST(VoxelBody, ProbesOutsideAreNotedWithTheirDistance) {
  const Vec3 centre(0.1, 0.1, 0.1);
  for (const Vec3& n : {Vec3(0, 0, 1), Vec3(0.6, 0, 0.8), Vec3(0.36, 0.48, -0.8), Vec3(-0.5, 0.1, 0.4).normalized()}) {
    EXPECT_TRUE(notes_on_a_probe(centre + 0.1 * n).empty())
        << "on the true surface, between the facets' corners or not";
    const std::vector<std::string> notes = notes_on_a_probe(centre + 0.108 * n);
    ASSERT_EQ(notes.size(), 1u);
    ASSERT_TRUE(notes[0].starts_with("probe 'top' lies 0.00")) << notes[0];
    const double distance = std::stod(notes[0].substr(std::string("probe 'top' lies ").size()));
    EXPECT_NEAR(distance, 0.008, 0.0015) << "from the facets, which lie up to 1.5 mm inside and outside of the ball";
    EXPECT_TRUE(notes[0].ends_with(" m outside the body: its displacement is extrapolated")) << notes[0];
  }
}

const Mistake mistakes[] = {
    {"seed_of_a_network_on_vertices", "\"emsm_random\"", "{ model = \"emsm_patch\", seed = 2 }",
     "ball.toml:*emsm_patch: seed: the nodes of this network are the vertices of a mesh"},
    {"unknown_patch", "on = \"high\"", "on = \"hihg\"", "ball.toml:18:1: load.on: *'hihg'"},
    {"two_displacements_of_a_place", "on = \"high\"\nforce_N = [0, 0, 1]",
     "on = \"surface\"\ndisplacement_m = [\"free\", \"free\", 1e-3]",
     "ball.toml:18:1: load: 'surface' has the displacement z = 0.001 m at *where 'low' of the load in line 15 has 0 m"},
    {"a_force_on_a_held_face", "on = \"high\"\nforce_N = [0, 0, 1]",
     "on = \"tip\"\nforce_N = [0, 0, 1]\n[[patch]]\nname = \"tip\"\nbeyond = { point_m = [0.1, 0.1, 0.05], normal = "
     "[0.2, 0, -1] }",
     "ball.toml:18:1: load: the force on 'tip' acts where the load in line 15 holds 'low'"},
    {"rule_selects_nothing", "[0.1, 0.1, 0.15]", "[0.1, 0.1, 0.35]", "ball.toml:8:*selects no facet"},
    {"rule_with_a_name_that_is_taken", "name = \"high\"", "name = \"surface\"", "ball.toml:8:*surface"},
    {"voxels_too_coarse", "voxels = 100", "voxel_edge_m = 1",
     "ball.toml:2:7: voxels: 1 cubes of 1 m fill *times the volume of the body"},
    {"no_voxel", "voxels = 100", "voxels = 1", "ball.toml:*"},
    {"own_file_is_missing", "geo = \"sphere.geo\"\nsize_m = [0.2, 0.2, 0.2]", "geo = \"mine.stl\"",
     "ball.toml:2:*mine.stl"},
    {"size_of_a_file", "geo = \"sphere.geo\"", "geo = \"mine.stl\"", "ball.toml:3:*body.size_m"},
    {"probe_outside", "at_m = [0.1, 0.1, 0.19]", "at_m = [0.1, 0.1, 0.3]",
     "ball.toml:*probe 'top': at_m: the point (0.1, 0.1, 0.3) m lies outside the body, 0.1 m from its surface"},
    {"not_held", "displacement_m = [0, 0, 0]", "displacement_m = [\"free\", \"free\", 0]", "ball.toml:*not held"},
    {"cut_is_no_flag", "voxels = 100", "voxels = 100\ncut = 3", "ball.toml:*body.cut"},
    {"cut_of_emsm", "\"emsm_random\"", "{ model = \"emsm\", cut = true }", "ball.toml:*unknown option 'cut'"},
    {"measured_whole_cubes", "\"emsm_random\"", "{ model = \"hybmss_avg\", cut = false, coarsened = true }",
     "ball.toml:*hybmss_avg: coarsened = true: its cells are not cut (allowed: cut cells of one size"},
    {"measured_with_a_shift", "\"emsm_random\"", "{ model = \"hybmss_avg\", shift = 0.4, coarsened = true }",
     "ball.toml:*hybmss_avg: coarsened = true: shift is for averaged springs"},
    {"measured_of_another_law", "\"emsm_random\"",
     "{ model = \"hybmss_avg\", curve = \"neo_hooke\", coarsened = true }",
     "ball.toml:*hybmss_avg: coarsened = true: at large strain they follow Hencky's law"},
    {"shift_too_large", "\"emsm_random\"", "{ model = \"hybmss\", shift = 2 }", "ball.toml:*0 <= shift <= 1"},
    {"edge_too_long", "edge_m = 0.03", "edge_m = -3", "ball.toml:*edge_m"},
};
INSTANTIATE_TEST_SUITE_P(Cases, VoxelMistakes, testing::ValuesIn(mistakes),
                         [](const auto& i) { return std::string(i.param.name); });

}  // namespace
}  // namespace springproof::voxel_body_test
