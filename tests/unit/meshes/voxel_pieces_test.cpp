// The cubes of a body are connected through faces.
#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>

#include "meshes/mesher/mesher.h"
#include "meshes/voxels/voxelise.h"

namespace springproof::voxel_pieces_test {
namespace {

/// Cubes of edge 1 as a body: those that `keep` names of a block.
Mesh body_of(const std::array<int, 3>& cells, const std::function<bool(int, int, int)>& keep) {
  Mesh body = block_mesh(Vec3(cells[0], cells[1], cells[2]), cells);
  std::vector<Hexahedron> kept;
  for (std::size_t c = 0; c < body.hexahedra.size(); ++c)
    if (const auto [i, j, k] = body.grid->cell_index[c]; keep(i, j, k)) kept.push_back(body.hexahedra[c]);
  body.hexahedra = kept;
  body.patches.clear();
  body.grid.reset();
  return body;
}

TEST(VoxelPieces, LeavesOutAFewCubesThatHangOnByAnEdge) {
  const Mesh body = body_of({8, 8, 6}, [](int i, int j, int k) {
    return k < 3 || (i == 0 && j == 0 && k == 4) || (i == 7 && j == 7 && k == 5);
  });
  const Voxels voxels = voxelise(voxel_grid(body, 1), body);
  EXPECT_EQ(voxels.mesh.hexahedra.size(), 192u);
  EXPECT_EQ(voxels.mesh.grid->cells, (std::array<int, 3>{8, 8, 3}));
  ASSERT_EQ(voxels.notes.size(), 1u);
  EXPECT_EQ(voxels.notes[0], "2 of 194 cubes hang on by an edge or lie apart: left out");

  const Mesh on_edge = body_of({9, 8, 4}, [](int i, int, int k) { return (i < 8 && k < 3) || (i == 8 && k == 3); });
  const Mesh one =
      body_of({9, 8, 4}, [](int i, int j, int k) { return (i < 8 && k < 3) || (i == 8 && j == 2 && k == 3); });
  const Voxels kept = voxelise(voxel_grid(one, 1), one);
  EXPECT_EQ(kept.mesh.hexahedra.size(), 192u);
  EXPECT_EQ(kept.notes.front(), "1 of 193 cubes hangs on by an edge or lies apart: left out");
  try {
    voxelise(voxel_grid(on_edge, 1), on_edge);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what())
                  .find("the 200 cubes of 1 m fall into 2 pieces that share no face, the largest of 192; take smaller "
                        "voxels"),
              std::string::npos)
        << error.what();
  }
}

TEST(VoxelPieces, EdgeContactsWithinOnePieceStay) {
  // A ring of seven cubes about two that are missing on a diagonal: cubes touch by an edge, but also go round by faces.
  const Mesh body = body_of({3, 3, 1}, [](int i, int j, int) { return !(i == 0 && j == 0) && !(i == 1 && j == 1); });
  const Voxels voxels = voxelise(voxel_grid(body, 1), body);
  EXPECT_EQ(voxels.mesh.hexahedra.size(), 7u);
  EXPECT_TRUE(voxels.notes.empty());
}

TEST(VoxelPieces, PiecesJoinInEveryDirection) {
  for (int axis = 0; axis < 3; ++axis) {
    std::array<int, 3> cells = {3, 3, 3};
    cells[axis] = 7;
    // Two slabs at the ends and a bar between them, off the middle.
    const auto dumbbell = [&](bool with_bar) {
      return body_of(cells, [=](int i, int j, int k) {
        const int at[] = {i, j, k};
        return at[axis] == 0 || at[axis] == 6 || (with_bar && at[(axis + 1) % 3] == 2 && at[(axis + 2) % 3] == 0);
      });
    };
    EXPECT_EQ(voxelise(voxel_grid(dumbbell(true), 1), dumbbell(true)).mesh.hexahedra.size(), 23u) << axis;
    EXPECT_THROW(voxelise(voxel_grid(dumbbell(false), 1), dumbbell(false)), std::invalid_argument) << axis;
  }
}

}  // namespace
}  // namespace springproof::voxel_pieces_test
