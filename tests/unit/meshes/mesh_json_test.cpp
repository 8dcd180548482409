#include "meshes/mesh_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace springproof::mesh_json_test {
namespace {

TEST(MeshJson, ReadsBackThroughCbor) {
  Mesh mesh = block_mesh({1, 2, 3}, {2, 1, 3});
  mesh.tetrahedra.push_back({0, 1, 2, 6});
  mesh.curved = NodalVectors::Random(27, 3);
  const Mesh back = mesh_from_json(nlohmann::json::from_cbor(nlohmann::json::to_cbor(to_json(mesh))));
  EXPECT_EQ(back.nodes, mesh.nodes);
  EXPECT_EQ(back.curved, mesh.curved);
  EXPECT_EQ(back.hexahedra, mesh.hexahedra);
  EXPECT_EQ(back.tetrahedra, mesh.tetrahedra);
  ASSERT_EQ(back.patches.size(), mesh.patches.size());
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    EXPECT_EQ(back.patches[p].name, mesh.patches[p].name);
    EXPECT_EQ(back.patches[p].facets, mesh.patches[p].facets);
  }
  ASSERT_TRUE(back.grid);
  EXPECT_EQ(back.grid->cells, mesh.grid->cells);
  EXPECT_EQ(back.grid->cell_index, mesh.grid->cell_index);
  EXPECT_EQ(back.grid->spacing, mesh.grid->spacing);
}

TEST(MeshJson, RefusesACutOffList) {
  nlohmann::json j = to_json(block_mesh({1, 1, 1}, {1, 1, 1}));
  j["nodes"].get_binary().pop_back();
  EXPECT_THROW(mesh_from_json(j), std::runtime_error);
}

}  // namespace
}  // namespace springproof::mesh_json_test
