// A quarter of a ring in the plane z = 0, outer radius size_x = size_y, radial width size_x * 0.2 / 4.32, thickness
// size_z; root on y = 0, tip on x = 0.  nx cells along the arc, ny through the width, nz through the thickness.
DefineConstant[
  size_x = 4.32, size_y = 4.32, size_z = 0.1,
  nx = 12, ny = 2, nz = 2,
  tetrahedra = 0
];

b = size_x;
a = b * 4.12 / 4.32;
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

Transfinite Curve{1, 3, 11, 13} = ny + 1;
Transfinite Curve{2, 4, 12, 14} = nx + 1;
Transfinite Curve{21 : 24} = nz + 1;

Physical Surface("z_min") = {1};
Physical Surface("z_max") = {11};
Physical Surface("root") = {21};
Physical Surface("outer") = {22};
Physical Surface("tip") = {23};
Physical Surface("inner") = {24};

Include "structured.inc";
