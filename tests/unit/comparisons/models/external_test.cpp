// Displacements of another program: the file, and how they are brought to other points.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "comparisons/models/external.h"
#include "meshes/mesh.h"
#include "problem/system/input_error.h"

namespace springproof::external_test {
namespace {

namespace fs = std::filesystem;

const fs::path file = fs::temp_directory_path() / "springproof_external_test.csv";

ExternalPoints read(const std::string& text, const ExternalFormat& format = {}) {
  std::ofstream(file) << text;
  return read_external_points(file, format);
}

/// What is said against a file, without the file's name.
std::string refusal(const std::string& text, const ExternalFormat& format = {}) {
  try {
    read(text, format);
  } catch (const InputError& error) {
    return std::string(error.what()).substr(file.string().size());
  }
  return "accepted";
}

TEST(ExternalPoints, AreReadInAnyOrderAndUnit) {
  const ExternalPoints p = read("# of an engine\r\nid;uz;x;y;z;ux;uy\r\n7;3;1;2;+3;1;2\r\n\r\n8;-.5;0;0;0;0;1e-3\r\n");
  ASSERT_EQ(p.X.rows(), 2);
  EXPECT_EQ(Vec3(p.X.row(0).transpose()), Vec3(1, 2, 3));
  EXPECT_EQ(Vec3(p.u.row(0).transpose()), Vec3(1, 2, 3));
  EXPECT_EQ(Vec3(p.u.row(1).transpose()), Vec3(0, 1e-3, -0.5));
  EXPECT_EQ(p.lines, (std::vector<int>{3, 5}));
  const ExternalPoints turned = read("x,y,z,X,Y,Z\n100,200,300,101,202,303\n", {0.01, true, 0});
  EXPECT_LE((turned.X.row(0) - Eigen::RowVector3d(1, -3, 2)).norm(), 1e-15);
  EXPECT_LE((turned.u.row(0) - Eigen::RowVector3d(0.01, -0.03, 0.02)).norm(), 1e-14);
  const ExternalPoints of_paraview = read(
      "\"displacement:0\",\"displacement:1\",\"displacement:2\",\"Points:0\",\"Points:1\",\"Points:2\"\n1,2,3,4,5,6\n");
  EXPECT_EQ(Vec3(of_paraview.X.row(0).transpose()), Vec3(4, 5, 6));
}

TEST(ExternalPoints, AreWrittenSoThatTheyReadBackExactly) {
  const Mesh mesh = block_mesh({1, 1.0 / 3, 0.7}, {3, 2, 2});
  const NodalVectors u = mesh.nodes.array().sin() / 7;
  std::ofstream(file) << csv_of(mesh.nodes, u);
  const ExternalPoints p = read_external_points(file, {});
  EXPECT_EQ(p.X, mesh.nodes);
  EXPECT_EQ(p.u, u);
}

TEST(ExternalPoints, AreRefusedWithTheirPlace) {
  const std::string header = "x,y,z,ux,uy,uz\n";
  EXPECT_EQ(refusal(header + "0,0,0,1,2,3\n0,0,0,1,nan,3\n").find(":3:9: is 'nan' (allowed: a finite number"), 0u);
  EXPECT_EQ(refusal(header + "0,0,0,1,2\n").find(":2:1: has 5 fields (allowed: 6, as the header)"), 0u);
  EXPECT_EQ(refusal(header + "0,0,0,1,2,three\n").find(":2:11: is 'three'"), 0u);
  EXPECT_NE(refusal("x,y,z,ux,uy,u_z\n").find("there is no column 'uz'"), std::string::npos);
  EXPECT_NE(refusal("x,y,z,ux,uy,u_z\n").find("did you mean 'u_z'?"), std::string::npos);
  EXPECT_NE(refusal("x,y,z\n1,2,3\n").find("there is no column 'ux'"), std::string::npos);
  EXPECT_NE(refusal("x,x,y,z,ux,uy,uz\n").find(":1:3: column 'x' is named twice"), std::string::npos);
  EXPECT_NE(refusal("x,y,z,ux,uy,uz,X,Y,Z\n").find("one of both"), std::string::npos);
  EXPECT_NE(refusal(header).find("there is no point (needed: lines below the header"), std::string::npos);
  EXPECT_NE(refusal("").find("there is no point (needed: a header with x, y, z"), std::string::npos);
  EXPECT_NE(refusal("x,y,z,ux,uy,uz,poisson_ratio\n0,0,0,0,0,0,0.25\n0,0,0,0,0,0,0.3\n", {1, false, 0.25})
                .find(":3:13: poisson_ratio is 0.3, and [[external]] is of a solid of 0.25"),
            std::string::npos);
  fs::remove(file);
  EXPECT_THROW(read_external_points(file, {}), InputError);
}

TEST(ScatteredField, ReproducesAffineDisplacementsAndItsPoints) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  NodalVectors X(600, 3), u(600, 3);
  Eigen::Matrix3d A;
  A << 0.1, 0.2, -0.3, 0.05, 0.4, 0.1, -0.2, 0.3, 0.2;
  const auto affine = [&](const Vec3& p) -> Vec3 { return A * p + Vec3(1, 2, 3); };
  for (Eigen::Index n = 0; n < X.rows(); ++n) {
    X.row(n) << 2 * uniform(generator), uniform(generator), uniform(generator);
    u.row(n) = affine(X.row(n).transpose()).transpose();
  }
  const ScatteredField field(X, u);
  for (const Vec3& p : {Vec3(1, 0.5, 0.5), Vec3(0, 0, 0), Vec3(1.9, 0.01, 0.99)})
    EXPECT_LE((field.at(p) - affine(p)).norm(), 1e-12) << p.transpose();
  u.row(17) << 9, 9, 9;
  EXPECT_EQ(ScatteredField(X, u).at(X.row(17).transpose()), Vec3(9, 9, 9));
  EXPECT_NEAR(field.distance(Vec3(-1, 0.5, 0.5)), 1, 0.2);
}

TEST(ScatteredField, SpacingIsThatOfALattice) {
  const Mesh mesh = block_mesh({4, 1, 1}, {8, 2, 2});
  const ScatteredField field(mesh.nodes, mesh.nodes);
  EXPECT_NEAR(field.spacing(), 0.5, 1e-12);
  EXPECT_TRUE(field.is_at(Vec3(0.5, 0.5, 1 + 1e-6)));
  EXPECT_FALSE(field.is_at(Vec3(0.5, 0.5, 0.99)));
}

TEST(ScatteredField, PointsInAPlaneSpanNoVolume) {
  const Mesh mesh = block_mesh({1, 1, 1}, {4, 4, 1});
  const NodalVectors plane = mesh.nodes.topRows(25);
  EXPECT_THROW(ScatteredField(plane, plane).at(Vec3(0.3, 0.3, 0.01)), std::invalid_argument);
}

}  // namespace
}  // namespace springproof::external_test
