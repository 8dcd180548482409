// A straight beam along x with a rectangular section: [0, size_x] x [0, size_y] x [0, size_z], equal boxes.
DefineConstant[
  size_x = 2.4, size_y = 0.4, size_z = 0.4,  // [m]
  nx = 24, ny = 4, nz = 4
];

Include "block.geo";
