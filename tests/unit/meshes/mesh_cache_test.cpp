#include "meshes/mesher/mesh_cache.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "problem/files/files.h"
#include "problem/processes/child.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

constexpr const char* tetrahedron =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
    "$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";

/// A mesher that writes down each of its calls.
class MeshCaches : public testing::Test {
 protected:
  MeshCaches() {
    const fs::path mesher = find_program("springproof-mesh", "SPRINGPROOF_MESH_PROGRAM"),
                   script = folder_.path / "mesher";
    std::ofstream(script) << "#!/bin/sh\necho call >>" << calls_ << "\nexec " << mesher << " \"$@\"\n";
    chmod(script.c_str(), 0700);
    setenv("SPRINGPROOF_MESH_PROGRAM", script.c_str(), 1);
    use(folder_.path / "meshes");
    std::ofstream(body_) << tetrahedron;
  }
  ~MeshCaches() override {
    unsetenv("SPRINGPROOF_MESH_PROGRAM");
    use("");
  }

  static void use(const fs::path& folder) { setenv("SPRINGPROOF_MESH_CACHE", folder.c_str(), 1); }

  auto calls() const {
    const std::string text = text_of_file(calls_);
    return std::count(text.begin(), text.end(), '\n');
  }
  std::vector<fs::path> kept() const {
    return {fs::directory_iterator(folder_.path / "meshes"), fs::directory_iterator()};
  }

  TemporaryFolder folder_;
  fs::path calls_ = folder_.path / "calls", body_ = folder_.path / "body.msh";
};

TEST_F(MeshCaches, TheSameRequestIsMeshedOnce) {
  const MeshedBody made = mesh_body({.file = body_, .scale = 2}), found = mesh_body({.file = body_, .scale = 2});
  EXPECT_EQ(calls(), 1);
  EXPECT_EQ(found.mesh.nodes, made.mesh.nodes);
  EXPECT_EQ(found.mesh.tetrahedra, made.mesh.tetrahedra);
  EXPECT_EQ(found.notes, made.notes);
  mesh_body({.file = body_, .scale = 3});
  EXPECT_EQ(calls(), 2);
}

TEST_F(MeshCaches, AChangedFileIsMeshedAgainEvenWithItsOldTime) {
  mesh_body({.file = body_});
  const auto time = fs::last_write_time(body_);
  std::string text = tetrahedron;
  text.replace(text.find("2 1 0 0"), 7, "2 3 0 0");
  std::ofstream(body_) << text;
  fs::last_write_time(body_, time);
  EXPECT_EQ(mesh_body({.file = body_}).mesh.nodes.maxCoeff(), 3);
  EXPECT_EQ(calls(), 2);
}

TEST_F(MeshCaches, ADamagedMeshIsMadeAgain) {
  mesh_body({.file = body_});
  ASSERT_EQ(kept().size(), 1U);
  fs::resize_file(kept()[0], fs::file_size(kept()[0]) - 9);
  EXPECT_EQ(mesh_body({.file = body_}).mesh.tetrahedra.size(), 1U);
  std::ofstream(kept()[0]) << "another request";
  EXPECT_EQ(mesh_body({.file = body_}).mesh.tetrahedra.size(), 1U);
  EXPECT_EQ(calls(), 3);
  mesh_body({.file = body_});
  EXPECT_EQ(calls(), 3);
}

TEST_F(MeshCaches, AMeshOfWhichOneBitIsChangedIsMadeAgainWhichIsSaid) {
  const Mesh mesh = mesh_body({.file = body_}).mesh;
  const fs::path file = kept()[0];
  const std::string whole = text_of_file(file);
  int made = 1;
  for (std::size_t byte = 5; byte < whole.size(); byte += whole.size() / 20) {
    std::string bytes = whole;
    bytes[byte] = static_cast<char>(bytes[byte] ^ 4);
    write_file(file, bytes);
    testing::internal::CaptureStderr();
    EXPECT_EQ(mesh_body({.file = body_}).mesh.nodes, mesh.nodes) << byte;
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "note: the kept mesh " + file.string() + " is damaged; it is made anew\n");
    EXPECT_EQ(calls(), ++made);
    EXPECT_EQ(text_of_file(file), whole);
  }
}

TEST_F(MeshCaches, AMeshUnderTheNameOfAnotherIsNotTaken) {
  mesh_body({.file = body_, .scale = 2});
  const fs::path first = kept()[0], aside = folder_.path / "aside";
  fs::rename(first, aside);
  mesh_body({.file = body_, .scale = 3});
  fs::copy_file(aside, kept()[0], fs::copy_options::overwrite_existing);
  EXPECT_EQ(mesh_body({.file = body_, .scale = 3}).mesh.nodes.maxCoeff(), 3);
}

TEST_F(MeshCaches, ScriptsOfTheUserAndRefusalsAreNotKept) {
  const fs::path script = folder_.path / "own.geo", refused = folder_.path / "refused.msh";
  std::ofstream(script) << "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\n";
  std::ofstream(refused) << "no mesh";
  for (int time = 0; time < 2; ++time) {
    mesh_body({.file = script, .edge = 1});
    EXPECT_THROW(mesh_body({.file = refused}), InputError);
  }
  EXPECT_EQ(calls(), 4);
}

TEST_F(MeshCaches, BuiltInScriptsAreKept) {
  const MeshRequest block{.file = find_geo({.geo = "block.geo"}, {}), .size = {1, 1, 1}, .cells = {1, 1, 1}};
  mesh_body(block);
  mesh_body(block);
  EXPECT_EQ(calls(), 1);
}

TEST_F(MeshCaches, NothingIsKeptWithoutAFolder) {
  for (const char* none : {"", "/proc/none"}) {
    use(none);
    mesh_body({.file = body_});
    mesh_body({.file = body_});
  }
  EXPECT_EQ(calls(), 4);
}

TEST_F(MeshCaches, WhatWasNotUsedForLongestGoesFirst) {
  const auto place = [&](double scale) { return MeshRequest{.file = body_, .scale = scale}; };
  mesh_body(place(1));
  const fs::path first = kept()[0];
  mesh_body(place(2));
  const auto second = [&] { return kept()[0] == first ? kept()[1] : kept()[0]; }();
  using namespace std::chrono_literals;
  fs::resize_file(second, 600'000'000);  // sparse
  fs::last_write_time(second, fs::last_write_time(first) - 1h);
  const fs::path large = folder_.path / "meshes" / "mesh-00112233445566778899aabbccddeeff.cbor";
  fs::copy_file(first, large);
  fs::resize_file(large, 600'000'000);
  mesh_body(place(3));
  EXPECT_FALSE(fs::exists(second));
  EXPECT_TRUE(fs::exists(first));
  EXPECT_TRUE(fs::exists(large));
}

TEST_F(MeshCaches, FilesOfOthersAreNeitherCountedNorRemoved) {
  mesh_body({.file = body_, .scale = 1});
  const fs::path ours = kept()[0], meshes = ours.parent_path();
  using namespace std::chrono_literals;
  std::vector<fs::path> others;
  for (const char* name :
       {"thesis.txt", "photos.tar", "mesh-1.cbor", "0123456789abcdef.cbor",
        "mesh-00112233445566778899aabbccddeeff.cbor", "mesh-00112233445566778899AABBCCDDEEFF.cbor"}) {
    others.push_back(meshes / name);
    std::ofstream(others.back()) << "mine";
    fs::resize_file(others.back(), 1'100'000'000);  // sparse
    fs::last_write_time(others.back(), fs::last_write_time(ours) - 1h);
  }
  fs::create_symlink(others[0], meshes / "mesh-ffffffffffffffffffffffffffffffff.cbor");
  mesh_body({.file = body_, .scale = 2});
  others.push_back(ours);
  for (const fs::path& other : others) EXPECT_TRUE(fs::exists(other)) << other;
  EXPECT_TRUE(fs::is_symlink(meshes / "mesh-ffffffffffffffffffffffffffffffff.cbor"));
}

}  // namespace
}  // namespace springproof
