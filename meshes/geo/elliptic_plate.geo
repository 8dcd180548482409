// A quarter of a thick plate between two ellipses: outer half axes size_x, size_y, inner size_x * 2 / 3.25 and
// size_y / 2.75, thickness size_z.  nx cells from the inner to the outer ellipse, ny around, nz (a multiple of 3)
// through the thickness; four times smaller where the inner ellipse meets the x axis than at the far ends of both lines,
// and at the top than at the bottom of the upper third.
// The outer edge has three patches of equal height: edge_low, edge_middle, edge_high.
DefineConstant[
  size_x = 3.25, size_y = 2.75, size_z = 0.6,  // [m]
  nx = 8, ny = 8, nz = 3,
  tetrahedra = 0
];

// Levels 0, 1/3, 2/3, 1 of the thickness, 10 numbers each.
For k In {0 : 3}
  n = 10 * k;
  z = k / 3 * size_z;
  Point(n + 1) = {0, 0, z};
  Point(n + 2) = {size_x * 2 / 3.25, 0, z};
  Point(n + 3) = {size_x, 0, z};
  Point(n + 4) = {0, size_y, z};
  Point(n + 5) = {0, size_y / 2.75, z};
  Line(n + 1) = {n + 2, n + 3};
  Ellipse(n + 2) = {n + 3, n + 1, n + 3, n + 4};
  Line(n + 3) = {n + 4, n + 5};
  Ellipse(n + 4) = {n + 5, n + 1, n + 2, n + 2};
  Curve Loop(n + 1) = {n + 1, n + 2, n + 3, n + 4};
  Plane Surface(n + 1) = {n + 1};
  Transfinite Curve{n + 1, -(n + 3)} = nx + 1 Using Progression 4^(1 / nx);
  Transfinite Curve{n + 2, -(n + 4)} = ny + 1 Using Progression 4^(1 / ny);
EndFor
For k In {0 : 2}
  n = 10 * k;
  For i In {1 : 4}
    Line(40 + n + i) = {n + 1 + i, n + 11 + i};
    Transfinite Curve{40 + n + i} = nz / 3 + 1 Using Progression (k == 2 ? 4^(-3 / nz) : 1);
  EndFor
  // Opposite sides start at opposite corners: so tetrahedra fit their triangles.
  Curve Loop(n + 41) = {n + 1, n + 42, -(n + 11), -(n + 41)};
  Curve Loop(n + 42) = {n + 2, n + 43, -(n + 12), -(n + 42)};
  Curve Loop(n + 43) = {n + 44, -(n + 13), -(n + 43), n + 3};
  Curve Loop(n + 44) = {n + 41, -(n + 14), -(n + 44), n + 4};
  For i In {41 : 44}
    Surface(n + i) = {n + i};
  EndFor
  Surface Loop(k + 1) = {n + 1, n + 11, 40 + n + 1, 40 + n + 2, 40 + n + 3, 40 + n + 4};
  Volume(k + 1) = {k + 1};
EndFor

Physical Surface("bottom") = {1};
Physical Surface("top") = {31};
Physical Surface("y_min") = {41, 51, 61};
Physical Surface("edge_low") = {42};
Physical Surface("edge_middle") = {52};
Physical Surface("edge_high") = {62};
Physical Surface("x_min") = {43, 53, 63};
Physical Surface("hole") = {44, 54, 64};

Include "structured.inc";
