// A quarter of a thick-walled cylinder about z, outer radius size_x = size_y, inner a third of it, length size_z.
// nx cells through the wall, ny around, nz along the axis.
//
//   y
//   |--.  outer
//   |   `.             symmetry planes: x_min (x = 0), y_min (y = 0)
//   `-.   `
//      `.  |           inner
//        |_|___ x
DefineConstant[
  size_x = 9, size_y = 9, size_z = 1,  // [m]
  nx = 8, ny = 8, nz = 1,
  tetrahedra = 0
];

b = size_x;
a = b / 3;
For k In {0 : 1}
  n = 10 * k;
  Point(n + 1) = {0, 0, k * size_z};
  Point(n + 2) = {a, 0, k * size_z};
  Point(n + 3) = {b, 0, k * size_z};
  Point(n + 4) = {0, b, k * size_z};
  Point(n + 5) = {0, a, k * size_z};
  Line(n + 1) = {n + 2, n + 3};
  Circle(n + 2) = {n + 3, n + 1, n + 4};
  Line(n + 3) = {n + 4, n + 5};
  Circle(n + 4) = {n + 5, n + 1, n + 2};
  Curve Loop(n + 1) = {n + 1, n + 2, n + 3, n + 4};
  Plane Surface(n + 1) = {n + 1};
EndFor
For i In {1 : 4}
  Line(20 + i) = {1 + i, 11 + i};
EndFor
// Opposite sides start at opposite corners: so tetrahedra fit their triangles.
Curve Loop(21) = {1, 22, -11, -21};
Curve Loop(22) = {2, 23, -12, -22};
Curve Loop(23) = {24, -13, -23, 3};
Curve Loop(24) = {21, -14, -24, 4};
For i In {21 : 24}
  Surface(i) = {i};
EndFor
Surface Loop(1) = {1, 11, 21, 22, 23, 24};
Volume(1) = {1};

Transfinite Curve{1, 3, 11, 13} = nx + 1;
Transfinite Curve{2, 4, 12, 14} = ny + 1;
Transfinite Curve{21 : 24} = nz + 1;

Physical Surface("z_min") = {1};
Physical Surface("z_max") = {11};
Physical Surface("y_min") = {21};
Physical Surface("outer") = {22};
Physical Surface("x_min") = {23};
Physical Surface("inner") = {24};

Include "structured.inc";
