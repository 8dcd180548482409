// Where the nodes of a lattice lie in the arrays of a GPU.
#pragma once

namespace springproof::gpu {

/// Nodes (x, y, z), counted from 1, at x + row y + plane z, with a margin of places without nodes on all sides, so that
/// no thread looks whether it has neighbours.  A block of threads owns `own_x` x `own_y` columns of nodes and
/// `planes_of_block` planes.
struct Box {
  static constexpr int own_x = 31, own_y = 7;  ///< one less than threads: the first of a line and of a row help only

  int nodes[3] = {};
  int blocks[3] = {};
  int planes_of_block = 0;
  int row = 0, plane = 0, size = 0;

  Box() = default;
  Box(int x, int y, int z) : nodes{x, y, z} {
    blocks[0] = (x + own_x - 1) / own_x;
    blocks[1] = (y + own_y - 1) / own_y;
    // A block repeats one plane of cells; some hundred blocks keep a GPU busy.
    planes_of_block = 32;
    while (planes_of_block > 2 && long(blocks[0]) * blocks[1] * ((z + planes_of_block - 1) / planes_of_block) < 500)
      planes_of_block /= 2;
    blocks[2] = (z + planes_of_block - 1) / planes_of_block;
    row = (blocks[0] * own_x + 2 + 15) / 16 * 16;
    plane = row * (blocks[1] * own_y + 2);
    size = plane * (z + 2);
  }
  int at(int x, int y, int z) const { return x + row * y + plane * z; }
  int number_of_blocks() const { return blocks[0] * blocks[1] * blocks[2]; }
};

}  // namespace springproof::gpu
